"""What the rooms import is declared: at the head of a module the core alone, what an extra brings where it is used."""

import re
import sys
import tomllib
from pathlib import Path

import pytest

from tests.house.imports import ROOMS, Import, imports_of, sources

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
MODULES = {"scikit-fem": "skfem", "pydantic": "pydantic", "pytest-xdist": "xdist"}
BROUGHT = {"pydantic_core", "PIL"}
"""By pydantic, of which it is a part; by matplotlib, which writes no picture without it."""


def _modules(asked):
    names = [re.split(r"[<>=!~;\[ ]", line)[0] for line in asked]
    return {MODULES.get(name, name.replace("-", "_")) for name in names}


CORE = _modules(PROJECT["dependencies"]) | BROUGHT
ALL = CORE.union(*map(_modules, PROJECT["optional-dependencies"].values()))


def undeclared(each: Import) -> bool:
    """Whether an import is of a library that is not there with what is installed."""
    library = (each.module or "").partition(".")[0]
    if library in {*ROOMS, "", "__future__"} or library in sys.stdlib_module_names:
        return False
    return library not in (ALL if each.late or each.typing_only else CORE)


def test_every_import_is_declared():
    files = sources(ROOT)
    found = [each for module, path in files.items() for each in imports_of(module, path, set(files))]
    assert len(found) > 1000
    assert [str(each) for each in found if undeclared(each)] == []


@pytest.mark.parametrize(
    ("module", "late", "wrong"),
    [
        ("frozendict", False, True),
        ("frozendict", True, True),
        ("threadpoolctl", False, True),
        ("threadpoolctl", True, False),
        ("numpy.linalg", False, False),
        ("skfem", False, False),
        ("json", False, False),
        ("cprbm_scene.answer", False, False),
    ],
)
def test_a_planted_import_is_told(module, late, wrong):
    assert undeclared(Import("scene.bad", module, 3, late, typing_only=False)) is wrong
