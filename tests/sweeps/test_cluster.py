"""A sweep on a Dask cluster: a scheduler and two worker processes on this machine."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from pathlib import Path

import pytest

from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.sweeps import workers
from tests.sweeps.planted import Poisoned
from tests.sweeps.scenes import CANTILEVER, table

pytestmark = pytest.mark.usefixtures("children", "interpreted")
pytest.importorskip("distributed", reason="the extra 'cluster' is not installed")

ROOT = Path(__file__).parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1"}
ENVIRONMENT["NUMBA_DISABLE_JIT"] = "1"  # as many points are solved sooner than the kernels are loaded


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
    folder = tmp_path_factory.mktemp("cluster")
    file = folder / "scheduler.json"
    worker = ("worker", "--scheduler-file", str(file), "--nthreads", "1", "--death-timeout", "60")
    with dask(folder, "scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file)):
        while not file.exists():
            time.sleep(0.05)
        with dask(folder, *worker) as first, dask(folder, *worker) as second:
            yield json.loads(file.read_text())["address"].replace("tcp://", "dask://"), (first, second)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "cantilever.toml"
    path.write_text(CANTILEVER.format(stations="[0.5, '= P']"), "utf-8")
    return path


def swept(scene, out, place, *options, solvers=None):
    return run(["sweep", str(scene), "-n", "6", "--quiet", "--out", str(out), "--on", place, *options], solvers)


GRID = ("--vary", "t=1.6mm..2.4mm:3", "--vary", "L=90..110:2")


@pytest.fixture(scope="module")
def serial(scene, tmp_path_factory):
    """Table of 6 points from one process."""
    folder = tmp_path_factory.mktemp("serial")
    assert swept(scene, folder, "local:1", *GRID) == 0
    rows = table(folder)
    assert len(rows) == 6 * 2 * 2
    return rows


def test_a_cluster_gives_the_table_of_one_process(scene, tmp_path, cluster, serial):
    assert swept(scene, tmp_path, cluster[0], *GRID) == 0
    assert table(tmp_path) == serial


@pytest.mark.parametrize("worker", [False, True], ids=["child", "worker"])
def test_a_poisoned_point_is_a_row_and_costs_at_most_four_further_executions(scene, tmp_path, cluster, worker):
    """6 points; at a point the child dies, or its worker with the child."""
    marks = tmp_path / "marks"
    vary = ("--vary", "t=1.6mm..2.4mm:3", "--vary", "L=90..110:2")
    text = scene.read_text("utf-8").replace('thickness = "= t"', 'thickness = "= t + (L - 90)*1e-4"')
    (tmp_path / "scene.toml").write_text(text, "utf-8")
    planted = Solvers(cprbm=Poisoned(str(marks), worker))
    assert swept(tmp_path / "scene.toml", tmp_path / "s", cluster[0], *vary, solvers=planted) == 1
    rows = table(tmp_path / "s", "last.csv")
    assert [row["point"] for row in rows] == [str(number + 1) for number in range(6)]
    assert [row["ending"] for row in rows if row["ending"] != "COMPLETED"] == ["CRASHED"]
    executions = marks.read_text().split()
    assert 2 <= executions.count("2.0") <= 5
    if not worker:  # a worker that dies takes finished results with it
        assert len(executions) == 6 + 1


def test_a_killed_worker_loses_nothing(scene, tmp_path, cluster, serial):
    """The nanny and the worker die in the middle of the sweep; the other worker takes the points."""
    journal = tmp_path / "s" / "outcomes.jsonl"

    def kill():
        while not journal.exists() or journal.read_bytes().count(b"\n") < 2:
            time.sleep(0.01)
        os.killpg(cluster[1][1].pid, signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    assert swept(scene, tmp_path / "s", cluster[0], *GRID) == 0
    killer.join()
    assert table(tmp_path / "s") == serial


def test_another_version_at_a_worker_is_refused(scene, tmp_path, cluster, capsys, monkeypatch):
    monkeypatch.setattr(workers, "program", lambda: "another")
    assert swept(scene, tmp_path / "s", cluster[0], *GRID) == 2
    error = capsys.readouterr().err
    assert "another version of cprbm" in error
    assert error.count("\n") == 1


def test_a_place_without_a_scheduler_is_refused(scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(workers, "CONNECT", 1.0)
    assert swept(scene, tmp_path / "s", "dask://127.0.0.1:9", *GRID) == 2
    error = capsys.readouterr().err
    assert "dask://127.0.0.1:9" in error
    assert error.count("\n") == 1
