"""Law 1 of the house, held by the source, and shown to bite on planted violations."""

from pathlib import Path

import pytest

from tests.house.imports import sources, violations

ROOT = Path(__file__).parents[2]


def _house(tmp_path, **files):
    """A small house that keeps the law, with ``files`` (room__module: source) put in."""
    lawful = {
        "cprbm_scene____init__": "from cprbm_scene.statement import Scene\n",
        "cprbm_scene__statement": "import pydantic\nclass Scene: ...\n",
        "cprbm____init__": "from cprbm_scene import Scene\nfrom .chain import link\n",
        "cprbm__chain": "import numpy\nfrom cprbm_scene.statement import Scene\ndef link(): ...\n",
        "fea_reference____init__": "from cprbm_scene import Scene\nimport skfem\n",
        "fea_reference__solid__dot____init__": "from fea_reference.solid.mesh import quads\nimport cprbm_scene\n",
        "fea_reference__solid__dot__mesh": "import skfem\nquads = 9\n",
        "elastica_reference____init__": "from cprbm_scene import Scene\nimport scipy\n",
        "comparisons____init__": "",
        "comparisons__pairing": "import cprbm\nimport elastica_reference\nfrom fea_reference import answer\n",
        "comparisons__verdict": "from comparisons import pairing\nfrom cprbm_scene import Scene\n",
        "comparisons__figures": "def draw():\n    import matplotlib.pyplot as plt\n    return plt\n",
    }
    for name, source in (lawful | files).items():
        room, _, module = name.partition("__")
        path = tmp_path / room / (module.replace("__dot__", "/") + ".py")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(source)
    return tmp_path


def test_the_source_keeps_the_law():
    assert violations(ROOT) == []


def test_the_source_is_there_to_be_read():
    assert {"cprbm_scene", "cprbm_scene.reading", "cprbm_scene.statement"} <= set(sources(ROOT))


def test_a_lawful_house_passes(tmp_path):
    assert violations(_house(tmp_path)) == []


def test_two_rooms_that_share_nothing_have_a_door_each(tmp_path):
    house = _house(
        tmp_path,
        fea_reference__solid__dot__gmshed="def f():\n    import gmsh",
        comparisons__imported="def f():\n    import gmsh",
    )
    assert violations(house) == []


def test_the_door_to_the_developers_tools_imports_by_a_name_made_at_run_time(tmp_path):
    source = "from importlib import import_module\ndef load(name):\n    return import_module(name)\n"
    assert violations(_house(tmp_path, comparisons__workshop=source)) == []


PLANTED = {
    "scene imports a solver": ("cprbm_scene__bad", "import cprbm.chain", "cprbm_scene may not import cprbm"),
    "the solid imports beam elements": (
        "fea_reference__solid__dot__bad",
        "def f():\n    from fea_reference.curves import sample",
        "fea_reference.solid may not import fea_reference",
    ),
    "beam elements import the solid": (
        "fea_reference__bad",
        "from fea_reference.solid import answer",
        "fea_reference may not import fea_reference.solid",
    ),
    "the other solver imports the solid": ("cprbm__bad", "import fea_reference.solid", "cprbm may not import"),
    "the solid beside pairing": ("comparisons__verdict", "import fea_reference.solid", "comparisons may not import"),
    "scene imports comparisons": (
        "cprbm_scene__bad",
        "from comparisons import verdict",
        "may not import comparisons",
    ),
    "a solver imports the other": ("cprbm__bad", "import fea_reference", "may not import fea_reference"),
    "the exact one imports a solver": (
        "elastica_reference__bad",
        "from cprbm import circle",
        "elastica_reference may not import cprbm",
    ),
    "the exact one imports comparisons": (
        "elastica_reference__bad",
        "import comparisons.geometry",
        "elastica_reference may not import",
    ),
    "a solver imports the exact one": (
        "fea_reference__bad",
        "import elastica_reference",
        "fea_reference may not import elastica_reference",
    ),
    "the exact one beside pairing": (
        "comparisons__verdict",
        "import elastica_reference",
        "comparisons may not import elastica_reference",
    ),
    "in a function": (
        "cprbm__bad",
        "def f():\n    from fea_reference import x",
        "may not import fea_reference",
    ),
    "in a method in a branch": (
        "fea_reference__bad",
        "class A:\n    def f(self):\n        if self:\n            import cprbm as c\n",
        "fea_reference may not import cprbm",
    ),
    "in a try": ("cprbm__bad", "try:\n    import comparisons\nexcept ImportError:\n    pass", "comparisons"),
    "for type checkers only": (
        "cprbm__bad",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import fea_reference",
        "may not import fea_reference",
    ),
    "else of a type checkers' branch": (
        "cprbm__bad",
        "import typing\nif typing.TYPE_CHECKING:\n    pass\nelse:\n    import fea_reference",
        "may not import fea_reference",
    ),
    "by its name": (
        "cprbm__bad",
        "import importlib\nimportlib.import_module('fea_reference.x')",
        "fea_reference",
    ),
    "by __import__": ("cprbm__bad", "m = __import__('comparisons')", "may not import comparisons"),
    "by a name made at run time": (
        "cprbm__bad",
        "from importlib import import_module\nimport_module('fea' + '_reference')",
        "nobody can tell",
    ),
    "comparisons beside pairing": ("comparisons__tables", "from cprbm import answer", "may not import cprbm"),
    "a sub-package of comparisons": (
        "comparisons__cli__dot__main",
        "from fea_reference import answer",
        "comparisons.cli.main:1",
    ),
    "a second door": (
        "comparisons__views",
        "def f():\n    import matplotlib",
        "its one door is comparisons.figures",
    ),
    "a heavy library at the top": (
        "comparisons__figures",
        "from matplotlib import pyplot",
        "inside the function",
    ),
    "skfem elsewhere": ("comparisons__bad", "def f():\n    import skfem", "only fea_reference may"),
    "a cycle": ("cprbm__chain", "from cprbm.energy import e", None),
    "a relative cycle in functions": ("cprbm__chain", "def f():\n    from . import energy", None),
    "the door to the tools imports tests in a statement": (
        "comparisons__workshop",
        "def f():\n    from tests.robustness import command",
        "not the rooms the tests",
    ),
    "benchmarks in a room": ("comparisons__bad", "import benchmarks.peers", "not the rooms the tests"),
    "tests in a room": ("cprbm__bad", "from tests.references import hinge", "not the rooms the tests"),
}


@pytest.mark.parametrize("plant", PLANTED)
def test_a_planted_violation_is_found(tmp_path, plant):
    name, source, words = PLANTED[plant]
    if words is None:
        house = _house(tmp_path, **{name: source, "cprbm__energy": "from .chain import link\n"})
        assert violations(house) == ["import cycle among cprbm.chain, cprbm.energy"]
    else:
        (sentence,) = violations(_house(tmp_path, **{name: source}))
        assert words in sentence
