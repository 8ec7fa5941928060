"""What is imported when: a library is loaded by what uses it, and not before.

Each program runs in an interpreter of its own, since this one has loaded everything by now.
"""

import json
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
NEVER_OF_A_SOLVE = (
    *("skfem", "shapely", "matplotlib", "pyvista", "gmsh", "meshio", "casadi", "jinja2", "rich", "multiprocessing"),
)
ELSEWHERE = ("fea_reference", "elastica_reference", "comparisons")
FRAME = "import json, sys\n{program}\nprint(json.dumps(sorted({{name.split('.')[0] for name in sys.modules}}\
 | {{name for name in sys.modules if name.startswith('scipy.')}})))"
CANTILEVER = """
import cprbm
from cprbm_scene import scene_from
from tests.cprbm.scenes import cantilever_data, force
assert cprbm.answer(scene_from(cantilever_data(force(0.0, -1.0), [0.1]))).completed
"""


@cache
def loaded(program):
    """Top-level names of all that a program has imported, and every module of SciPy."""
    done = subprocess.run(
        [sys.executable, "-c", FRAME.format(program=program)], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return set(json.loads(done.stdout.splitlines()[-1]))


@pytest.mark.parametrize("arguments", [["list"], ["--help"], ["--version"], ["solve", "--help"]])
def test_what_solves_nothing_loads_no_numbers(arguments):
    found = loaded(f"from comparisons.cli.main import run\nassert run({arguments}) == 0")
    assert "comparisons" in found
    assert not found & {"numpy", "scipy", "pydantic", "rich", "concurrent", "cprbm_scene", "cprbm", *NEVER_OF_A_SOLVE}


def test_a_plain_solve_loads_neither_the_other_solvers_nor_what_draws():
    found = loaded(CANTILEVER)
    assert {"numpy", "cprbm"} <= found
    assert not found & {*NEVER_OF_A_SOLVE, *ELSEWHERE}


def test_without_contact_nothing_of_scipy_but_linear_algebra_is_loaded():
    assert not loaded(CANTILEVER) & {"scipy.optimize", "scipy.spatial", "scipy.interpolate"}


def test_the_command_solves_with_one_solver():
    found = loaded("from comparisons.cli.main import run\nassert run(['solve', 'hinge', '--quiet']) == 0")
    assert "cprbm" in found
    others = {"fea_reference", "elastica_reference"}
    assert not found & others.union(NEVER_OF_A_SOLVE).difference({"shapely", "multiprocessing"})
