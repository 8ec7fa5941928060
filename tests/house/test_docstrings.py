"""What the rooms offer says of itself what a caller must know: arguments, what comes back and is raised, shapes, units.

The examples in docstrings are so.
"""

import builtins
import dataclasses
import doctest
import importlib
import inspect
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROOMS = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")
MODULES = sorted(
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
    for room in ROOMS
    for path in (ROOT / room).rglob("*.py")
    if ">>> " in path.read_text(encoding="utf-8")
)
NUMERIC = re.compile(r"\b(float|Array|Ints|Flags|Positive|Point|Share)\b")
ARRAY = re.compile(r"\b(Array|Ints|Flags)\b")
SHAPE = re.compile(r"\([\w+]+,(?: [\w+]+,?)*\)")


def offered(kind):
    """What the rooms' ``__all__`` name, of a kind."""
    rooms = {room: importlib.import_module(room) for room in ROOMS}
    found = {f"{room}.{name}": getattr(module, name) for room, module in rooms.items() for name in module.__all__}
    return {name: each for name, each in found.items() if kind(each)}


FUNCTIONS = offered(inspect.isfunction)
RECORDS = offered(lambda each: dataclasses.is_dataclass(each) or hasattr(each, "model_fields"))


def sections(text):
    """A docstring's sections by their headings, each a mapping of the names in it to what is said of them."""
    parts = re.split(r"^(Args|Returns|Raises|Source|Example|Attributes):\n", text, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def wrong_with(function):
    """What a caller is not told of a function."""
    told = sections(inspect.getdoc(function) or "")
    signature = inspect.signature(function)
    named = re.findall(r"^    (\w+): \S", told.get("Args", ""), re.MULTILINE)
    wrong = [f"argument {name}" for name in signature.parameters if name not in named]
    wrong += [f"{name} is no argument" for name in named if name not in signature.parameters]
    if signature.return_annotation not in (None, "None") and "Returns" not in told:
        wrong.append("what comes back")
    arrays = [name for name, each in signature.parameters.items() if ARRAY.search(str(each.annotation))]
    for name in arrays:
        said = re.search(rf"^    {name}: (.*(?:\n {{8}}.*)*)", told.get("Args", ""), re.MULTILINE)
        if not said or not SHAPE.search(said[1]):
            wrong.append(f"shape of {name}")
    for error in re.findall(r"^    (\w+):", told.get("Raises", ""), re.MULTILINE):
        if not hasattr(builtins, error) and error != "SceneError":
            wrong.append(f"{error} is not to be had")
    return wrong


def annotations(record):
    """Names of a record's own fields and how they are annotated."""
    if dataclasses.is_dataclass(record):
        return {field.name: str(field.type) for field in dataclasses.fields(record)}
    return {name: str(record.__annotations__.get(name, "")) for name in record.model_fields}


def silent_on(record):
    """Numbers of a record without a name in its docstring or a docstring of the field; arrays without shapes."""
    text = inspect.getdoc(record) or ""
    text += " ".join(name for name, field in getattr(record, "model_fields", {}).items() if field.description)
    numbers = [name for name, annotation in annotations(record).items() if NUMERIC.search(annotation)]
    silent = [name for name in numbers if not re.search(rf"\b{name}\b", text)]
    if any(ARRAY.search(annotation) for annotation in annotations(record).values()) and not SHAPE.search(text):
        silent.append("shapes")
    return silent


def test_there_is_something_to_look_at():
    assert len(FUNCTIONS) >= 10
    assert len(RECORDS) >= 30
    assert len(MODULES) >= 5


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_tells_its_arguments_what_comes_back_and_what_is_raised(name):
    assert wrong_with(FUNCTIONS[name]) == []


@pytest.mark.parametrize("name", RECORDS)
def test_a_record_tells_of_its_numbers_and_of_shapes(name):
    assert silent_on(RECORDS[name]) == []


@pytest.mark.parametrize(
    "solver", ["cprbm.answer", "fea_reference.answer", "elastica_reference.answer", "cprbm.offset_points"]
)
def test_what_computes_names_its_source(solver):
    assert sections(inspect.getdoc(FUNCTIONS[solver]))["Source"].strip()


def test_the_unit_of_every_quantity_stands_in_the_answer_sheet():
    """The quantities that a probe may ask for are those of the table, each with a shape and a unit."""
    from typing import get_args

    import cprbm_scene.answer

    quantities = set(get_args(cprbm_scene.Probe.model_fields["quantity"].annotation))
    rows = re.findall(r"^(\w+) {2,}(\(\w+,\)) {2,}((?:.+)(?:\n {10,}.*)*)", cprbm_scene.answer.__doc__, re.MULTILINE)
    assert {name for name, _, _ in rows} == quantities
    for name, _, said in rows:
        assert re.search(r"\b(m|rad|N|N·m|Pa|J)\b|value of the stepped load", said), name


def test_a_planted_function_that_is_silent_is_found():
    def planted(scene: "Scene", places: "Array") -> "Answer":  # noqa: F821
        """Solve.

        Args:
            scene: the question.
            place: where.

        Raises:
            NoSuchError: never.
        """

    assert wrong_with(planted) == [
        "argument places",
        "place is no argument",
        "what comes back",
        "shape of places",
        "NoSuchError is not to be had",
    ]


def test_a_planted_record_that_is_silent_is_found():
    @dataclasses.dataclass
    class Planted:
        """A thing of some ``size``."""

        size: "float"
        places: "Array"  # noqa: F821

    assert silent_on(Planted) == ["places", "shapes"]


@pytest.mark.parametrize("module", MODULES)
def test_examples_in_docstrings_are_so(module, monkeypatch):
    monkeypatch.chdir(ROOT)
    found = doctest.testmod(importlib.import_module(module))
    assert found.attempted
    assert not found.failed
