"""``cprbm sweep`` and ``comparisons.sweep``: tables and samples, children and clusters, interruptions and failures."""

import json
import math
import os
import random
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import comparisons
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.sweeps import outcome as outcomes
from comparisons.sweeps import tables, workers
from comparisons.sweeps.demands import Measure
from comparisons.sweeps.outcome import Outcome
from comparisons.sweeps.points import Axis
from comparisons.sweeps.running import known_outcomes
from cprbm_scene import read
from tests.sweeps.planted import Poisoned, called_here
from tests.sweeps.scenes import CANTILEVER, table

ROOT = Path(__file__).parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "NUMBA_DISABLE_JIT": "1"}
ENVIRONMENT["DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES"] = "1"
IN_CHILDREN = pytest.mark.usefixtures("children", "interpreted")
GRID = ("--vary", "t=1.6mm..2.4mm:3", "--vary", "L=90..110:2")


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """File of a cantilever with parameters."""
    path = tmp_path_factory.mktemp("scene") / "cantilever.toml"
    path.write_text(CANTILEVER.format(stations="[0.5, '= P']"), "utf-8")
    return path


def swept(scene, out, *options, solvers=None):
    return run(["sweep", str(scene), "-n", "6", "--quiet", "--out", str(out), *options], solvers)


def swept_here(scene, out, *options):
    """A sweep in this process."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(outcomes, "call_limited", called_here)
        return swept(scene, out, *options)


@pytest.fixture(scope="module")
def serial(scene, tmp_path_factory):
    """Table of 6 points from this process, whose figures are printed."""
    folder = tmp_path_factory.mktemp("serial")
    assert swept_here(scene, folder, *GRID) == 0
    rows = table(folder)
    assert len(rows) == 6 * 2 * 2
    return rows


def lines_of(folder):
    """Number of whole lines of a journal."""
    journal = folder / "outcomes.jsonl"
    return journal.read_bytes().count(b"\n") if journal.exists() else 0


# -- Tables


def test_numbers_of_a_measure_and_texts_with_units():
    record = {"stage": "load", "station": 1.0, "probe": "b.bending_stress", "component": "", "branch": 0}
    stresses = [
        {**record, "arc_length": place, "value": value} for place, value in ((0.0, 2.0), (0.1, -3.0), (0.2, 1.0))
    ]
    force = {**record, "probe": "c.force", "arc_length": None, "value": -5.0}
    missing = {**stresses[0], "station": 2.0, "value": None}  # of a comparison whose CPRBM stops at the first station
    outcome = Outcome("compare", "STEP_TOO_SMALL", "", numbers=(*stresses, force, missing))
    stress, pressure = (Measure("load", probe, "", False, 1, 1.0, "") for probe in ("b.bending_stress", "c.force"))
    assert (stress.last(outcome)["value"], stress.values(outcome)) == (3.0, [3.0])
    assert (pressure.last(outcome), pressure.values(outcome)) == (force, [-5.0])
    degree = math.radians(1.0)
    axis = Axis("turn", 0.0, 30.0 * degree, unit="deg", size=degree)
    assert axis.text(axis.high) == "turn = 30°"
    assert (axis.label, axis.column) == ("turn, °", "turn, deg")
    measure = Measure("load", "A.rotation", "", every=False, stations=1, size=degree, unit="deg")
    assert measure.text(12.5) == "12.5°"
    assert replace(measure, unit="mm").text(12.5) == "12.5 mm"


def test_a_grid_has_a_row_per_number_and_a_larger_grid_takes_the_points_over(scene, tmp_path, capsys):
    assert swept(scene, tmp_path / "s", *GRID) == 0
    rows, last = table(tmp_path / "s"), table(tmp_path / "s", "last.csv")
    assert [(row["t, mm"], row["L, mm"], row["station"], row["component"]) for row in rows[:4]] == [
        ("1.6", "90.0", "0.5", "x"),
        ("1.6", "90.0", "0.5", "y"),
        ("1.6", "90.0", "1.0", "x"),
        ("1.6", "90.0", "1.0", "y"),
    ]
    assert len(rows) == 6 * 2 * 2
    assert len(last) == 6
    assert {row["unit"] for row in rows} == {"mm"}
    assert last[0]["load B.displacement.y, mm"] == rows[3]["value"]
    assert "cantilever: 6 points, unchecked." in capsys.readouterr().out
    page = (tmp_path / "s" / "index.html").read_text("utf-8")
    assert "t = 1.6 mm to t = 2.4 mm (3 values)" in page
    assert lines_of(tmp_path / "s") == 6
    assert swept(scene, tmp_path / "s", "--vary", "t=1.6mm..2.4mm:5", "--vary", "L=90..110:2") == 0
    assert lines_of(tmp_path / "s") == 10
    known = {row["key"]: row for row in last}
    assert sum(row["key"] in known for row in table(tmp_path / "s", "last.csv")) == 6


def test_figures_leave_out_numbers_that_do_not_depend_on_the_parameters(scene, tmp_path):
    """The drop at the first station alone depends on the point; the shift is the same but for round-off."""
    record = {"stage": "load", "probe": "B.displacement", "branch": 0, "arc_length": None}

    def outcome(drop, round_off):
        values = {"x": (-1e-3, -2e-3 + round_off), "y": (drop, -5e-3)}
        return Outcome("cprbm", "COMPLETED", "", numbers=tuple(
            {**record, "component": name, "station": station, "value": value}
            for name, pair in values.items() for station, value in zip((0.5, 1.0), pair, strict=True)
        ))  # fmt: skip

    def shown(*outcomes):
        return [each.name for each in tables.dependent(read(scene), [(None, each) for each in outcomes])]

    assert shown(outcome(-3e-3, 0.0), outcome(-4e-3, 1e-16)) == ["B.displacement.y"]
    assert shown(outcome(-3e-3, 0.0)) == ["B.displacement.x", "B.displacement.y"]
    # the force at the clamp is the load, whatever the thickness and the length: round-off alone still has a map
    text = scene.read_text("utf-8").replace('of = "B"\nquantity = "displacement"', 'of = "A"\nquantity = "reaction"')
    (tmp_path / "reaction.toml").write_text(text, "utf-8")
    assert swept(tmp_path / "reaction.toml", tmp_path / "s", "--vary", "t=1.9mm..2.1mm:2", "--vary", "L=90..110:2") == 0
    assert len({row["value"] for row in table(tmp_path / "s") if row["component"] == "y"}) > 1
    assert (tmp_path / "s" / "parameters.svg").exists()


def test_shards_merge_to_the_whole(scene, tmp_path):
    vary = ["--vary", "t=1.6mm..2.4mm:5"]
    for shard in ("1/2", "2/2"):
        assert swept(scene, tmp_path / shard.replace("/", "of"), *vary, "--shard", shard) == 0
    assert [row["point"] for row in table(tmp_path / "2of2", "last.csv")] == ["2", "4"]
    merged = ["--merge", str(tmp_path / "1of2"), "--merge", str(tmp_path / "2of2")]
    assert swept(scene, tmp_path / "merged", *vary, *merged) == 0
    assert not (tmp_path / "merged" / "outcomes.jsonl").exists(), "nothing was solved again"
    assert swept(scene, tmp_path / "whole", *vary) == 0
    assert table(tmp_path / "merged") == table(tmp_path / "whole")


def test_checked_points_have_a_verdict(scene, tmp_path, capsys):
    assert swept(scene, tmp_path / "s", "--vary", "t=1.6mm..2.4mm:5", "--check", "2", "--elements", "8") in (0, 3)
    rows = table(tmp_path / "s", "last.csv")
    assert [row["solver"] for row in rows] == ["compare", "cprbm", "cprbm", "cprbm", "compare"]
    assert all(row["verdict"] for row in rows if row["solver"] == "compare")
    assert " of 2 checked points, 3 unchecked" in capsys.readouterr().out
    assert any(row["stated"] for row in table(tmp_path / "s"))
    lines = lines_of(tmp_path / "s")
    swept(scene, tmp_path / "s", "--vary", "t=1.6mm..2.4mm:5", "--elements", "8")
    assert lines_of(tmp_path / "s") == lines, "the comparison has the answer of the plain point too"
    assert [row["solver"] for row in table(tmp_path / "s", "last.csv")].count("compare") == 2


def test_netcdf_has_the_numbers_of_the_table(scene, tmp_path):
    xarray = pytest.importorskip("xarray", reason="the extra 'netcdf' is not installed")
    assert swept(scene, tmp_path / "s", "--vary", "t=1.6mm..2.4mm:3", "--netcdf") == 0
    with xarray.open_dataset(tmp_path / "s" / "sweep.nc", engine="scipy") as data:
        assert data["t"].values == pytest.approx([1.6e-3, 2.0e-3, 2.4e-3])
        assert list(data["ending"].values) == ["COMPLETED"] * 3
        assert data["load.station"].values.tolist() == [[0.5, 1.0]] * 3
        values = data["load.B.displacement.y"]
        assert values.attrs == {"unit": "m"}
        rows = [float(row["value"]) for row in table(tmp_path / "s") if row["component"] == "y"]
        assert values.values.ravel() == pytest.approx(1e-3 * np.array(rows), rel=1e-12)


def test_samples_are_drawn_or_stand_in_a_table_with_comments_and_semicolons(scene, tmp_path):
    def values(sample, name="t, mm"):
        assert swept(scene, tmp_path / "s", "--sample", str(sample)) == 0
        return [float(row[name]) for row in table(tmp_path / "s", "last.csv")]

    for sample in ("sobol:4", "lhs:4"):
        drawn = values(sample)
        assert len(set(drawn)) == 4, sample
        assert all(1.0 <= value <= 3.0 for value in drawn), sample
    path = tmp_path / "points.csv"
    path.write_text("t,L\n1.7mm,95\n0.0019m,100mm\n", "utf-8")
    assert values(path) == [1.7, 1.9]
    path.write_text("t\n1.7mm\n", "utf-8")  # a single point
    assert values(path) == [1.7]
    assert (tmp_path / "s" / "index.html").exists()
    path.write_bytes(b"# measured\r\n\r\nt;L\r\n1.7mm; 95\r\n\r\n1.9mm;100mm\r\n")
    assert values(path, "L, mm") == [95.0, 100.0]


# -- Children


@IN_CHILDREN
def test_executors_give_the_same_table_bit_for_bit(scene, tmp_path, monkeypatch):
    """A thread, children, and processes of the caller; 6 points, more than an executor has at a time."""
    monkeypatch.setattr(workers, "WINDOW", 4)
    vary = {"t": list(np.linspace(1.6e-3, 2.4e-3, 3)), "L": list(np.linspace(0.09, 0.11, 2))}

    def rows(name, executor):
        comparisons.sweep(read(scene), vary, choices=Choices(links=4), executor=executor, out=tmp_path / name)
        return table(tmp_path / name)

    with ThreadPoolExecutor(1) as thread, monkeypatch.context() as patch:
        patch.setattr(outcomes, "call_limited", called_here)
        serial = rows("serial", thread)
    assert len(serial) == 6 * 2 * 2
    assert rows("local", None) == serial
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as processes:
        assert rows("processes", processes) == serial


@IN_CHILDREN
def test_poisoned_points_are_rows_and_are_tried_twice(scene, tmp_path, capsys):
    marks, options = tmp_path / "marks", ["--vary", "t=1.6mm..2.4mm:5", "--at-most", "5"]
    planted = Poisoned(str(marks), {1.8: "child", 2.0: "sleep", 2.2: "fault"})
    assert swept(scene, tmp_path / "s", *options, solvers=Solvers(cprbm=planted)) == 1
    rows = table(tmp_path / "s", "last.csv")
    assert [row["ending"] for row in rows] == ["COMPLETED", "CRASHED", "TIME_LIMIT", "FAULT", "COMPLETED"]
    parts = ("7", "the same command tries again"), ("5 s", "a longer --at-most tries again"), ("a beam of no length",)
    for row, said in zip(rows[1:4], parts, strict=True):
        assert [part for part in said if part not in row["sentence"]] == []
    assert len(marks.read_text().split()) == 5 + 2
    assert "3 of 5 points failed (1 CRASHED, 1 FAULT, 1 TIME_LIMIT)" in capsys.readouterr().out
    assert swept_here(scene, tmp_path / "s", *options) == 1, "the crash has passed, the other failures stand"
    rows = table(tmp_path / "s", "last.csv")
    assert [row["ending"] for row in rows] == ["COMPLETED", "COMPLETED", "TIME_LIMIT", "FAULT", "COMPLETED"]


@IN_CHILDREN
def test_kills_of_the_parent_end_in_the_same_table(scene, tmp_path, serial):
    """Kills at random times; every later run goes on from the lines that stand."""
    command = [sys.executable, "-m", "comparisons", "sweep", str(scene), "-n", "6", "--quiet", *GRID]
    drawn, lines = random.Random(905), 0
    for _ in range(2):
        process = subprocess.Popen(
            [*command, "--out", str(tmp_path)], env=ENVIRONMENT, cwd=ROOT, stdout=subprocess.DEVNULL
        )
        wanted = lines + drawn.randrange(3)
        while lines_of(tmp_path) <= wanted and process.poll() is None:
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)
        process.wait()
        assert lines_of(tmp_path) >= lines
        lines = lines_of(tmp_path)
    with (tmp_path / "outcomes.jsonl").open("ab") as stream:
        stream.write(b'{"key": "cut short by a kill", "solv')
    assert swept_here(scene, tmp_path, *GRID) == 0
    assert table(tmp_path) == serial
    assert lines_of(tmp_path) == len(known_outcomes([tmp_path])) == 6


# -- A Dask cluster: a scheduler and two worker processes on this machine


@contextmanager
def dask(folder, *arguments):
    """A process of Dask in a session of its own; ends with the context."""
    command = [sys.executable, "-m", "dask", *arguments, "--no-dashboard"]
    with (folder / f"{arguments[0]}.log").open("ab") as log:
        process = subprocess.Popen(command, cwd=folder, env=ENVIRONMENT, stdout=log, stderr=log, start_new_session=True)
    try:
        yield process
    finally:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """Address of a scheduler, and the processes of its two workers."""
    pytest.importorskip("distributed", reason="the extra 'cluster' is not installed")
    folder = tmp_path_factory.mktemp("cluster")
    file = folder / "scheduler.json"
    worker = ("worker", "--scheduler-file", str(file), "--nthreads", "1", "--death-timeout", "60")
    with dask(folder, "scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file)):
        while not file.exists():
            time.sleep(0.05)
        with dask(folder, *worker) as first, dask(folder, *worker) as second:
            yield json.loads(file.read_text())["address"].replace("tcp://", "dask://"), (first, second)


@IN_CHILDREN
@pytest.mark.parametrize("fate", ["child", "worker"])
def test_a_poisoned_point_is_a_row_and_costs_at_most_four_further_executions(scene, tmp_path, cluster, fate):
    """6 points; at a point the child dies, or its worker with the child."""
    marks = tmp_path / "marks"
    text = scene.read_text("utf-8").replace('thickness = "= t"', 'thickness = "= t + (L - 90)*1e-4"')
    (tmp_path / "scene.toml").write_text(text, "utf-8")
    planted = Solvers(cprbm=Poisoned(str(marks), {2.0: fate}))
    assert swept(tmp_path / "scene.toml", tmp_path / "s", "--on", cluster[0], *GRID, solvers=planted) == 1
    rows = table(tmp_path / "s", "last.csv")
    assert [row["point"] for row in rows] == [str(number + 1) for number in range(6)]
    assert [row["ending"] for row in rows if row["ending"] != "COMPLETED"] == ["CRASHED"]
    executions = marks.read_text().split()
    assert 2 <= executions.count("2.0") <= 5
    if fate == "child":  # a worker that dies takes finished results with it
        assert len(executions) == 6 + 1


@IN_CHILDREN
def test_a_cluster_gives_the_table_of_one_process_though_a_worker_is_killed(scene, tmp_path, cluster, serial):
    """The nanny and the worker die in the middle of the sweep; the other worker takes the points."""

    def kill():
        while lines_of(tmp_path) < 2:
            time.sleep(0.01)
        os.killpg(cluster[1][1].pid, signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    assert swept(scene, tmp_path, "--on", cluster[0], *GRID) == 0
    killer.join()
    assert table(tmp_path) == serial


def test_a_cluster_of_another_version_or_without_a_scheduler_is_refused(scene, tmp_path, cluster, capsys, monkeypatch):
    monkeypatch.setattr(workers, "program", lambda: "another")
    monkeypatch.setattr(workers, "CONNECT", 1.0)
    for place, said in ((cluster[0], "another version of cprbm"), ("dask://127.0.0.1:9", "dask://127.0.0.1:9")):
        assert swept(scene, tmp_path / "s", "--on", place, *GRID) == 2, place
        error = capsys.readouterr().err
        assert said in error
        assert error.count("\n") == 1
