"""The marker ``internals`` on planted test modules, and the list of public names against the documentation."""

import importlib
import inspect
import re
from pathlib import Path
from types import SimpleNamespace

import pytest

from tests import conftest
from tests.house.internals import ROOT, Internals, product_names
from tests.house.public_names import DOCUMENTED, EXPORTING

HERE = Path(__file__).parent
PUBLIC = {"solver": frozenset({"answer"}), "harness.verdict": frozenset({"Verdict"})}
PRODUCT = {
    "solver/__init__.py": "from solver.march import step as answer\n__all__ = ['answer']\n",
    "solver/march.py": "def step(): ...\n",
    "harness/__init__.py": "",
    "harness/verdict.py": "class Verdict: ...\nclass Row: ...\n",
    "tests/helper.py": "from solver.march import step\n",
    "tests/deeper.py": "from tests.helper import step\n",
    "tests/plain.py": "import numpy\nfrom solver import answer\n",
    "tests/conftest.py": "def inner():\n    from solver.march import step\n    return step\n",
    "tests/inside/conftest.py": "import solver.march\n",
}


@pytest.fixture
def names_for(tmp_path):
    """Function from the source of a planted test module to its internal names."""

    def names_for(source, fixtures=(), folder="tests"):
        for name, text in (PRODUCT | {f"{folder}/test_planted.py": source}).items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return Internals(tmp_path, PUBLIC).names_for(tmp_path / folder / "test_planted.py", fixtures)

    return names_for


@pytest.mark.parametrize(
    "source",
    [
        "import numpy as np\nprint(np.linalg.norm)",
        "import solver\nsolver.answer().stations",
        "from solver import answer\nanswer().march",
        "from harness.verdict import Verdict",
        "from harness import verdict\nverdict.Verdict",
        "import harness.verdict as words\nprint(words.Verdict, words.__file__)",
        "from tests.plain import answer",
        "def test(monkeypatch):\n    monkeypatch.setattr('solver.answer', None)",
        "program = 'import solver; solver.answer()'",
        "path = 'solver.py'",
        "text = 'solver and harness import nothing'",
    ],
)
def test_public_names_leave_a_test_unmarked(names_for, source):
    assert names_for(source) == []


@pytest.mark.parametrize(
    ("source", "name"),
    [
        ("import solver.march", "solver.march"),
        ("from solver import march", "solver.march"),
        ("from solver.march import step", "solver.march.step"),
        ("def test():\n    from solver.march import step", "solver.march.step"),
        ("import solver\nsolver.march", "solver.march"),
        ("import solver as s\ns.march.step()", "solver.march.step"),
        ("from harness import verdict\nverdict.Row", "harness.verdict.Row"),
        ("from tests.helper import step", "solver.march.step"),
        ("from tests import deeper", "solver.march.step"),
        ("import tests.deeper", "solver.march.step"),
        ("def test(monkeypatch):\n    monkeypatch.setattr('solver.march.step', None)", "solver.march.step"),
        ("import solver\ndef test(monkeypatch):\n    monkeypatch.setattr(solver, 'other', None)", "solver.other"),
        ("import importlib\nimportlib.import_module('solver.march')", "solver.march"),
        ("program = 'from solver.march import step'", "solver.march.step"),
        ("program = 'if True:\\n  import solver\\n  solver.march.step()'", "solver.march.step"),
        ("program = f'from solver.march import step\\n{1 + 1}'", "solver.march.step"),
        ("program = 'from solver.march import step\\n{program:}}'", "solver.march.step"),
    ],
)
def test_an_internal_name_is_found(names_for, source, name):
    assert name in names_for(source)


def test_an_import_inside_a_fixture_counts_for_the_users_of_the_fixture(names_for):
    assert names_for("def test(): ...") == []
    assert names_for("def test(inner): ...", fixtures=["inner"]) == ["solver.march.step"]


def test_an_import_at_the_head_of_a_conftest_counts_for_its_folder(names_for):
    assert names_for("def test(): ...", folder="tests/inside") == ["solver.march"]


def test_the_marker_is_set_on_collected_tests_where_markers_are_requested(request):
    """This folder holds both kinds: test_threads imports solver modules, this module imports none."""
    modules = {path.name: pytest.Module.from_parent(request.session, path=path) for path in HERE.glob("test_*.py")}
    for requested in ("", "not internals"):
        config = SimpleNamespace(option=SimpleNamespace(markexpr=requested))
        conftest.pytest_collection_modifyitems(config, list(modules.values()))
        marked = {name for name, module in modules.items() if module.get_closest_marker("internals")}
        assert "test_internals.py" not in marked
        assert ("test_threads.py" in marked) is bool(requested)


def documented(module):
    """Names of a module on the pages of docs/api."""
    pages = "".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "docs" / "api").glob("*.md")))
    found = set(re.findall(rf"auto(?:class|function):: {re.escape(module)}\.(\w+)$", pages, re.MULTILINE))
    for options in re.findall(rf"automodule:: {re.escape(module)}$((?:\n +:.*$)*)", pages, re.MULTILINE):
        members = re.search(r":members:(.*)$", options, re.MULTILINE)[1].replace(",", " ").split()
        excluded = re.search(r":exclude-members:(.*)$", options, re.MULTILINE)
        hidden = excluded[1].replace(",", " ").split() if excluded else []
        found.update(members or (name for name in defined(module) if name not in hidden))
    return found


def defined(module):
    """Names of the public classes and functions of a module, also those in ``__all__``, if they have a docstring."""
    owner = importlib.import_module(module)
    exported = getattr(owner, "__all__", ())
    kinds = {*inspect.getmembers(owner, inspect.isclass), *inspect.getmembers(owner, inspect.isfunction)}
    return [
        name
        for name, value in kinds
        if (value.__module__ == module or name in exported) and value.__doc__ and name[0] != "_"
    ]


@pytest.mark.parametrize("module", DOCUMENTED)
def test_the_list_names_what_the_pages_document(module):
    assert set(DOCUMENTED[module]) == documented(module)


def test_every_documented_module_is_on_the_list():
    pages = [path.read_text(encoding="utf-8") for path in (ROOT / "docs" / "api").glob("*.md")]
    named = re.findall(r"auto(module|class|function):: ([\w.]+)", "".join(pages))
    modules = {name if kind == "module" else name.rpartition(".")[0] for kind, name in named}
    assert modules <= {*EXPORTING, *DOCUMENTED}


def test_every_public_name_exists():
    missing = [
        f"{module}.{name}"
        for module, names in product_names().items()
        for name in names
        if not hasattr(importlib.import_module(module), name)
    ]
    assert missing == []


def test_exported_names_are_read_from_the_source():
    assert product_names()["cprbm_scene"] == set(importlib.import_module("cprbm_scene").__all__)
