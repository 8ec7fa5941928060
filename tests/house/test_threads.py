"""Linear algebra has one thread while a solver works: in the program always, from Python where threadpoolctl is."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
pytest.importorskip("threadpoolctl")

THREADS = "print(json.dumps(sorted({one['num_threads'] for one in threadpool_info() if one['user_api'] == 'blas'})))"


def _run(program):
    environment = os.environ | {"OMP_NUM_THREADS": "2", "OPENBLAS_NUM_THREADS": "2", "PYTHONPATH": str(ROOT)}
    environment["NUMBA_DISABLE_JIT"] = "1"  # with ten links machine code takes longer to load
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_the_program_has_one_whatever_the_environment_says_and_without_threadpoolctl():
    program = f"""
import json, sys
from comparisons.cli import program
sys.modules["threadpoolctl"] = None
sys.argv = ["cprbm", "solve", "hinge", "-n", "10", "--quiet"]
try:
    program.main()
except SystemExit as stop:
    assert stop.code == 0, stop.code
del sys.modules["threadpoolctl"]
from threadpoolctl import threadpool_info
{THREADS}
"""
    assert _run(program) == [[1]]


def test_from_python_there_is_one_as_long_as_a_solver_works():
    program = f"""
import json
import scipy.linalg
from threadpoolctl import threadpool_info
from cprbm_scene.solving import one_thread
{THREADS}
with one_thread():
    {THREADS}
{THREADS}
"""
    before, within, after = _run(program)
    if before == [1]:
        pytest.skip("BLAS has one thread on this machine in any case")
    assert within == [1]
    assert after == before


def test_a_library_that_is_loaded_later_has_one_too():
    program = f"""
import json
from cprbm_scene.solving import one_thread
with one_thread():
    pass
import scipy.linalg
from threadpoolctl import threadpool_info
with one_thread():
    {THREADS}
"""
    assert _run(program) == [[1]]


@pytest.mark.parametrize("room", ["cprbm.results.stations", "fea_reference.solve", "fea_reference.solid.solve"])
def test_each_solver_works_within_it(room, monkeypatch):
    """Seen from inside: the first state is sought only while the threads are held."""
    import importlib
    from contextlib import contextmanager

    import comparisons.cases
    import cprbm

    module = importlib.import_module(room)
    held = []

    @contextmanager
    def noted():
        held.append(True)
        yield
        held.append(False)

    monkeypatch.setattr(module, "one_thread", noted)
    package = cprbm if room.startswith("cprbm") else module
    case = "tapered" if package is cprbm else "hinge"
    ready = package.prepared(comparisons.cases.opened(case), module.Settings())
    seen = []

    class StoppedError(Exception):
        pass

    def stop(*given, **named):
        seen.append(list(held))
        raise StoppedError

    firsts = {"cprbm.results.stations": "assembled", "fea_reference.solve": "assemble_ends"}
    monkeypatch.setattr(module, firsts.get(room, "reset_step"), stop)
    with pytest.raises(StoppedError):
        ready.answer()
    assert seen == [[True]]
