"""Modules of a user with names of the project must not break the program or the library."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

OWN_MODULES = ("scene.py", "exact.py", "comparisons.py", "tests.py")
PROGRAM = Path(sys.executable).with_name("cprbm")
SCENE = Path(__file__).parents[1] / "contract" / "scenes" / "cantilever.toml"

FIRST_ON_THE_PATH = f"""
from comparisons.cli.main import run

if __name__ == "__main__":
    raise SystemExit(run(["robustness", "--replay", {str(SCENE)!r}, "--quiet"]))
"""


@pytest.fixture
def folder(tmp_path):
    """A folder of modules; an import of a module ends the process."""
    for name in OWN_MODULES:
        (tmp_path / name).write_text(f'raise SystemExit("imported the user\'s own {name}")\n')
    return tmp_path


INTERPRETED = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
"""With ten links machine code takes longer to load than the interpreted kernels take to solve."""


def _run(command, folder, environment=None):
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env=environment)


def test_the_program_shares_its_work_among_processes(folder):
    command = [PROGRAM, "compare", "tapered", "-n", "10", "--elements", "10", "--quiet"]
    done = _run(command, folder, INTERPRETED)
    assert done.returncode in (0, 3), done.stderr
    assert "user's own" not in done.stderr


def test_the_tools_of_a_checkout_run_where_the_user_s_folder_comes_first_on_the_path(folder):
    (folder / "program.py").write_text(FIRST_ON_THE_PATH)
    (folder / "comparisons.py").unlink()
    done = _run([sys.executable, "program.py"], folder)
    assert done.returncode in (0, 3), done.stderr
    assert done.stderr == ""


def test_the_solvers_are_imported(folder):
    done = _run([sys.executable, "-c", "import cprbm, fea_reference, elastica_reference, cprbm_scene"], folder)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_planted_module_is_imported(folder):
    done = _run([sys.executable, "-c", "import scene"], folder)
    assert done.returncode == 1
    assert "user's own scene.py" in done.stderr
