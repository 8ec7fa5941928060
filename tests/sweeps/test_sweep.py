"""``cprbm sweep`` and ``comparisons.sweep``: tables, interruptions, failing points, wrong questions, the elastica."""

import math
import os
import random
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import comparisons
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.sweeps import tables, workers
from comparisons.sweeps.demands import Measure
from comparisons.sweeps.outcome import Outcome
from comparisons.sweeps.points import Axis
from comparisons.sweeps.running import known_outcomes
from cprbm_scene import read
from tests.sweeps.elastica import tip
from tests.sweeps.scenes import CANTILEVER, table

ROOT = Path(__file__).parents[2]


@pytest.fixture
def scene(tmp_path):
    """File of a cantilever with parameters."""
    path = tmp_path / "cantilever.toml"
    path.write_text(CANTILEVER.format(stations="[0.5, '= P']"), "utf-8")
    return path


def swept(scene, out, *options):
    return run(["sweep", str(scene), "-n", "6", "--quiet", "--out", str(out), *options])


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
    assert swept(scene, tmp_path / "s", "--vary", "t=1.6mm..2.4mm:3", "--vary", "L=90..110:2") == 0
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
    lines = len((tmp_path / "s" / "outcomes.jsonl").read_text("utf-8").splitlines())
    assert swept(scene, tmp_path / "s", "--vary", "t=1.6mm..2.4mm:5", "--vary", "L=90..110:2") == 0
    assert lines == 6
    assert len((tmp_path / "s" / "outcomes.jsonl").read_text("utf-8").splitlines()) == 10
    known = {row["key"]: row for row in last}
    assert sum(row["key"] in known for row in table(tmp_path / "s", "last.csv")) == 6


def test_a_number_that_is_constant_but_for_round_off_has_a_map(scene, tmp_path):
    """The force at the clamp is the load, whatever the thickness and the length."""
    text = scene.read_text("utf-8").replace('of = "B"\nquantity = "displacement"', 'of = "A"\nquantity = "reaction"')
    scene.write_text(text, "utf-8")
    assert swept(scene, tmp_path / "s", "--vary", "t=1.9mm..2.1mm:2", "--vary", "L=90..110:2") == 0
    assert len({row["value"] for row in table(tmp_path / "s") if row["component"] == "y"}) > 1
    assert (tmp_path / "s" / "parameters.svg").exists()


@pytest.mark.usefixtures("children", "interpreted")
def test_executors_give_the_same_table_bit_for_bit(scene, tmp_path, monkeypatch):
    """Serial, threads, and processes of the caller; 6 points, more than an executor has at a time."""
    monkeypatch.setattr(workers, "WINDOW", 4)
    vary = {"t": list(np.linspace(1.6e-3, 2.4e-3, 3)), "L": list(np.linspace(0.09, 0.11, 2))}
    choices = Choices(links=4)
    with ThreadPoolExecutor(1) as serial, ProcessPoolExecutor(1, mp_context=get_context("spawn")) as processes:
        for name, executor in (("serial", serial), ("local", None), ("processes", processes)):
            comparisons.sweep(read(scene), vary, choices=choices, executor=executor, out=tmp_path / name)
    serial = table(tmp_path / "serial")
    assert len(serial) == 6 * 2 * 2
    assert table(tmp_path / "local") == table(tmp_path / "processes") == serial


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
    journal = tmp_path / "s" / "outcomes.jsonl"
    lines = len(journal.read_bytes().splitlines())
    swept(scene, tmp_path / "s", "--vary", "t=1.6mm..2.4mm:5", "--elements", "8")
    assert len(journal.read_bytes().splitlines()) == lines, "the comparison has the answer of the plain point too"
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


@pytest.mark.parametrize("sample", ["sobol:4", "lhs:4", "points.csv"])
def test_samples(scene, tmp_path, sample):
    (tmp_path / "points.csv").write_text("t,L\n1.7mm,95\n0.0019m,100mm\n", "utf-8")
    source = str(tmp_path / sample) if sample.endswith("csv") else sample
    assert swept(scene, tmp_path / "s", "--sample", source) == 0
    values = [float(row["t, mm"]) for row in table(tmp_path / "s", "last.csv")]
    assert values == [1.7, 1.9] if sample.endswith("csv") else len(set(values)) == 4
    assert all(1.0 <= value <= 3.0 for value in values)


def test_a_table_of_points_may_have_a_single_point_comments_and_semicolons(scene, tmp_path):
    (tmp_path / "points.csv").write_text("t\n1.7mm\n", "utf-8")
    assert swept(scene, tmp_path / "s", "--sample", str(tmp_path / "points.csv")) == 0
    assert (tmp_path / "s" / "index.html").exists()
    (tmp_path / "points.csv").write_bytes(b"# measured\r\n\r\nt;L\r\n1.7mm; 95\r\n\r\n1.9mm;100mm\r\n")
    assert swept(scene, tmp_path / "s", "--sample", str(tmp_path / "points.csv")) == 0
    assert [row["L, mm"] for row in table(tmp_path / "s", "last.csv")] == ["95.0", "100.0"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("t,L\n1.7mm,95\n# thin\n1.9mm\n", "row 4: found 1 values of t, L; allowed: a value for every name"),
        ("t,t\n1.7,1.8\n", "row 2: found 2 values of t, t; allowed: a value for every name, each name once"),
        ("t\n1,7\n", "row 2: found 2 values of t;"),
        ("t\n1.7\nthin\n", "row 3: found 'thin'; allowed: a finite number, as 1.9mm"),
        ("thick\n1.7\n", "row 2: found 'thick', which names no parameter; allowed: the name of a parameter: 't', 'L'"),
        ("t\n", "found 0 rows below the names t"),
        ("", "found 0 rows below the names (none)"),
    ],
)
def test_a_wrong_table_is_named_with_its_row(scene, tmp_path, capsys, text, said):
    (tmp_path / "points.csv").write_text(text, "utf-8")
    assert swept(scene, tmp_path / "s", "--sample", str(tmp_path / "points.csv")) == 2
    assert f"points.csv: {said}" in capsys.readouterr().err


def test_figures_leave_out_numbers_that_do_not_depend_on_the_parameters(scene):
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


POISONED = """
import os, sys, time
from comparisons.cli.main import run
from comparisons.pairing import Solvers, cprbm_answer


class Poisoned:
    def __call__(self, scene, choices):
        with open({marks!r}, "a") as stream:
            stream.write("x")
        thickness = round(scene.beams["b"].thickness * 1e3, 6)
        if thickness == 1.8:
            os._exit(7)
        if thickness == 2.0:
            time.sleep(600.0)
        if thickness == 2.2:
            raise ZeroDivisionError("a beam of no length")
        return cprbm_answer(scene, choices)


if __name__ == "__main__":
    sys.exit(run(["sweep", *sys.argv[1:]], Solvers(cprbm=Poisoned())))
"""


def program(tmp_path, text):
    (tmp_path / "program.py").write_text(text, "utf-8")
    return [sys.executable, str(tmp_path / "program.py")]


ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "NUMBA_DISABLE_JIT": "1"}


@pytest.mark.usefixtures("children", "interpreted")
def test_poisoned_points_are_rows_and_are_tried_twice(scene, tmp_path):
    marks = tmp_path / "marks"
    command = [*program(tmp_path, POISONED.format(marks=str(marks))), str(scene), "-n", "6", "--quiet", "--out"]
    options = [str(tmp_path / "s"), "--vary", "t=1.6mm..2.4mm:5", "--at-most", "10"]
    done = subprocess.run([*command, *options], env=ENVIRONMENT, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr
    rows = table(tmp_path / "s", "last.csv")
    assert [row["ending"] for row in rows] == ["COMPLETED", "CRASHED", "TIME_LIMIT", "FAULT", "COMPLETED"]
    assert "7" in rows[1]["sentence"]
    assert "10 s" in rows[2]["sentence"]
    assert "a beam of no length" in rows[3]["sentence"]
    assert len(marks.read_text()) == 5 + 2
    assert "3 of 5 points failed (1 CRASHED, 1 FAULT, 1 TIME_LIMIT)" in done.stdout
    assert "the same command tries again" in rows[1]["sentence"]
    assert "a longer --at-most tries again" in rows[2]["sentence"]
    assert swept(scene, tmp_path / "s", *options[1:]) == 1, "the crash has passed, the other failures stand"
    rows = table(tmp_path / "s", "last.csv")
    assert [row["ending"] for row in rows] == ["COMPLETED", "COMPLETED", "TIME_LIMIT", "FAULT", "COMPLETED"]


@pytest.mark.usefixtures("children", "interpreted")
def test_kills_of_the_parent_end_in_the_same_table(scene, tmp_path):
    """Kills at random times; every later run goes on from the lines that stand."""
    vary = ["--vary", "t=1.6mm..2.4mm:4", "--vary", "L=90..110:2"]
    assert swept(scene, tmp_path / "whole", *vary) == 0
    options = [str(scene), "-n", "6", "--quiet", "--out", str(tmp_path / "killed"), *vary]
    command = [sys.executable, "-m", "comparisons", "sweep", *options]
    journal, drawn, lines = tmp_path / "killed" / "outcomes.jsonl", random.Random(905), 0
    for _ in range(2):
        process = subprocess.Popen(command, env=ENVIRONMENT, cwd=ROOT, stdout=subprocess.DEVNULL)
        wanted = lines + drawn.randrange(3)
        while (len(journal.read_bytes().splitlines()) if journal.exists() else 0) <= wanted:
            if process.poll() is not None:
                break
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)
        process.wait()
        now = journal.read_bytes().count(b"\n")
        assert now >= lines
        lines = now
    with journal.open("ab") as stream:
        stream.write(b'{"key": "cut short by a kill", "solv')
    assert swept(scene, tmp_path / "killed", *vary) == 0
    assert table(tmp_path / "killed") == table(tmp_path / "whole")
    assert len(journal.read_bytes().splitlines()) == len(known_outcomes([tmp_path / "killed"])) == 8


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--vary", "thickness=1mm..2mm:3"], "names no parameter"),
        (["--vary", "t=1N..2N:3"], "a finite number, as 1.9mm"),
        (["--vary", "t=1mm..5mm:3"], "a number from 1 to 3 mm"),
        (["--vary", "t=1mm..2mm:1"], "two values or more"),
        (["--vary", "t=1mm..2mm"], "without a number of values"),
        (["--vary", "t=1mm..2mm:3", "--vary", "t=1mm..2mm:4"], "a parameter once"),
        (["--vary", "L=-100..100:3"], "1 of 3 points without a valid scene"),
        (["--sample", "halton:9"], "sobol:K or lhs:K"),
        (["--sample", "absent.csv"], "No such file"),
        (["--vary", "t=1mm..2mm:3", "--shard", "4/3"], "I/N with I from 1 to N"),
        (["--vary", "t=1mm..2mm:3", "--on", "remote"], "local:N"),
        ([], "neither --vary nor --sample"),
    ],
)
def test_a_wrong_question_is_a_sentence(scene, tmp_path, capsys, options, said):
    assert swept(scene, tmp_path / "s", *options) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert not (tmp_path / "s").exists()


def test_a_cantilever_follows_the_elastica_with_order_four(tmp_path):
    """α = P L² / (E I) from 0.2 to 10, with the closed form of Bisshopp and Drucker; E I / L² is 4/3 N.

    The chain has order four on a beam without contact (docs/method.md).
    """
    path = tmp_path / "cantilever.toml"
    path.write_text(CANTILEVER.format(stations="['= P']"), "utf-8")
    alphas, errors = (0.2, 1.0, 4.0, 10.0), {}
    for links in (20, 40, 80, 160):
        swept = comparisons.sweep(read(path), {"P": [4.0 / 3.0 * alpha for alpha in alphas]}, choices=Choices(links))
        values = [[number["value"] / 0.1 for number in outcome.numbers] for _, outcome in swept.points()]
        errors[links] = [np.hypot(*np.subtract(value, tip(alpha))) for value, alpha in zip(values, alphas, strict=True)]
    assert max(errors[40]) < 5e-4
    orders = [np.log2(np.divide(errors[n], errors[2 * n])) for n in (20, 40, 80)]
    np.testing.assert_allclose(orders, 4.0, atol=0.1)
