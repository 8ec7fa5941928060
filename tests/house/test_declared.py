"""Imported libraries are declared in pyproject.toml; heavy and optional libraries are imported inside functions."""

import re
import sys
import tomllib
from pathlib import Path

import pytest

from tests.house.import_statements import Import, imports_in

ROOT = Path(__file__).parents[2]
PACKAGES = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
MODULES = {"scikit-fem": "skfem", "pytest-xdist": "xdist"}
"""Modules with another name than their distribution."""
REQUIRED = {"pydantic_core", "PIL"}
"""Requirements of pydantic and of Matplotlib."""
HEAVY = {"matplotlib", "PIL"}
"""Libraries of the core that take long to load; only pictures need them."""


def modules(requirements):
    """Names of the modules in a list of requirements."""
    names = [re.split(r"[<>=!~;\[ ]", line)[0] for line in requirements]
    return {MODULES.get(name, name.replace("-", "_")) for name in names}


CORE = modules(PROJECT["dependencies"]) | REQUIRED
OF_USERS = {"pandas"}
"""Libraries that a user brings along: no dependency, and a message where they are missing."""
ALL = CORE.union(OF_USERS, *map(modules, PROJECT["optional-dependencies"].values()))


def is_wrong(found):
    """Whether the library of an import may be missing, or is loaded too early."""
    if found.library in {*PACKAGES, "__future__", *sys.stdlib_module_names}:
        return False
    return found.library not in (CORE - HEAVY if found.place == "head" else ALL)


def test_every_import_is_declared_and_heavy_libraries_are_imported_inside_functions():
    files = [path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]
    found = [(path, each) for path in files for each in imports_in(path.read_text(encoding="utf-8"))]
    assert len(found) > 1000
    assert [f"{path.relative_to(ROOT)}: {each}" for path, each in found if is_wrong(each)] == []


@pytest.mark.parametrize(
    ("library", "place", "wrong"),
    [
        ("frozendict", "head", True),
        ("frozendict", "function", True),
        ("threadpoolctl", "head", True),
        ("threadpoolctl", "function", False),
        ("gmsh", "head", True),
        ("matplotlib", "head", True),
        ("matplotlib", "type checking", False),
        ("PIL", "function", False),
        ("numpy", "head", False),
        ("skfem", "head", False),
        ("json", "head", False),
        ("cprbm_scene", "head", False),
    ],
)
def test_a_planted_import_is_judged(library, place, wrong):
    assert is_wrong(Import(library, 3, place)) is wrong


def test_imports_are_read_with_their_places():
    source = (
        "import json, skfem.mesh\n"
        "from typing import TYPE_CHECKING\n"
        "if TYPE_CHECKING:\n"
        "    import gmsh\n"
        "else:\n"
        "    import meshio\n"
        "class A:\n"
        "    def f(self):\n"
        "        try:\n"
        "            from matplotlib.figure import Figure\n"
        "        finally:\n"
        "            from . import near\n"
    )
    assert list(imports_in(source)) == [
        Import("json", 1, "head"),
        Import("skfem", 1, "head"),
        Import("typing", 2, "head"),
        Import("gmsh", 4, "type checking"),
        Import("meshio", 6, "head"),
        Import("matplotlib", 10, "function"),
    ]
