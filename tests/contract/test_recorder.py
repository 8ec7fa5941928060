"""The recorder sees every kind of promise, in small examples with items written by hand."""

import enum
import sys
import tomllib
from dataclasses import dataclass
from types import ModuleType

import click
import pytest

from comparisons.cli.main import commands

from .commands import commands_of, promised_by
from .declared import broken
from .documents import paths
from .promises import merged, text
from .python_names import exported, promised_by_name
from .recorder import command_line, schema
from .runs import situations
from .scene_keys import FILES, keys_of, promised_by_file, promised_by_schema
from .today import undeclared


@click.group("demo")
def demo():
    """A group of commands."""


@demo.command("paint")
@click.argument("walls", nargs=-1, required=True)
@click.option("-c", "--colour", type=click.Choice(["red", "blue"]), default="red")
@click.option("--coats", type=int, required=True)
@click.option("--tape", multiple=True)
@click.option("--dry/--wet")
def paint(**given):
    """Paint."""


def test_a_command_has_its_arguments_options_choices_and_defaults():
    assert promised_by("demo paint", paint) == {
        "demo paint": "command",
        "demo paint argument 1": "several",
        "demo paint option -c": "value",
        "demo paint option --colour": "value",
        "demo paint choice --colour red": "",
        "demo paint choice --colour blue": "",
        "demo paint default -c": "red",
        "demo paint default --colour": "red",
        "demo paint option --coats": "value",
        "demo paint option --tape": "values, repeated",
        "demo paint option --dry": "flag",
        "demo paint option --wet": "flag",
        "demo paint requires": ["--coats", "argument 1"],
    }


class _Hiding(click.Group):
    def list_commands(self, context):
        return []


def test_a_hidden_command_is_found_by_its_promised_name():
    hiding = _Hiding("demo", commands={"paint": paint})
    assert [name for name, _ in commands_of(hiding, path=("demo",))] == ["demo"]
    found = [name for name, _ in commands_of(hiding, ["demo paint", "demo plaster"], ("demo",))]
    assert found == ["demo", "demo paint"]


def test_an_option_gone_from_the_program_is_named(monkeypatch):
    before = command_line()
    solve = dict(commands_of(commands))["cprbm solve"]
    monkeypatch.setattr(solve, "params", [each for each in solve.params if "--json" not in each.opts])
    (sentence,) = broken(before, command_line())
    assert sentence.startswith("The promise 'cprbm solve option --json' is gone.")


def test_paths_of_a_document():
    document = {
        "rows": [{"n": 3}, {"n": {"beam1": 3}, "why": None}],
        "solvers": {"cprbm": {"ending": "x"}, "fea": {}},
        "strata": {"beams: 2": 0.5},
        "uncertainty": {"cprbm": 1.0, "theory": 2.0},
    }
    assert sorted(set(paths(document, {"beam1"}))) == [
        "rows",
        "rows[].n",
        "rows[].n.*",
        "rows[].why",
        "solvers",
        "solvers.*",
        "solvers.*.ending",
        "solvers.cprbm",
        "solvers.fea",
        "strata",
        "strata.*",
        "uncertainty",
        "uncertainty.cprbm",
        "uncertainty.theory",
    ]


def test_keys_of_a_schema():
    part = {
        "properties": {
            "name": {"type": "string"},
            "beams": {"additionalProperties": {"$ref": "#/defs/beam"}},
        },
        "required": ["name"],
        "defs": {
            "beam": {
                "properties": {
                    "kind": {"const": "straight"},
                    "ends": {"type": "array", "items": {"properties": {"joint": {"enum": ["weld", "pin"]}}}},
                }
            }
        },
    }
    assert promised_by_schema(part) == {
        "scene key name": "",
        "scene key beams": "",
        "scene key beams.*": "",
        "scene key beams.*.kind": "",
        "scene choice beams.*.kind straight": "",
        "scene key beams.*.ends": "",
        "scene key beams.*.ends[]": "",
        "scene key beams.*.ends[].joint": "",
        "scene choice beams.*.ends[].joint weld": "",
        "scene choice beams.*.ends[].joint pin": "",
        "scene requires (file)": ["name"],
        "scene requires beams.*": [],
        "scene requires beams.*.ends[]": [],
    }


def test_the_stored_files_use_every_key_of_the_schema(promised):
    """So the reader, and not the schema alone, is held to every key; items of lists of numbers are no keys."""
    items = {item.removeprefix("scene key ") for item in promised if item.startswith("scene key ")}
    used = {key for file in FILES.glob("*.toml") for key in keys_of(tomllib.loads(file.read_text("utf-8")), items)}
    assert {item for item in items if not item.endswith("[]")} - used == set()


def test_a_file_that_is_refused_says_why():
    def refuse():
        raise ValueError("beams: none")

    assert promised_by_file("scene file a.toml", refuse) == {"scene file a.toml": "refused: beams: none"}


@pytest.fixture
def module(monkeypatch):
    """A module with a class, an enumeration and a function."""

    class Colour(enum.Enum):
        RED = 1

    @dataclass
    class Wall:
        height: float
        colour: str = "red"

        @property
        def area(self):
            return self.height

        def painted(self):
            return self

        def _private(self):
            return self

    def paint(wall, *, coats=1):
        return wall, coats

    made = ModuleType("made_up_walls")
    vars(made).update(Colour=Colour, Wall=Wall, paint=paint, __all__=["Wall", "paint"])
    monkeypatch.setitem(sys.modules, "made_up_walls", made)
    return made


def test_names_of_a_module(module):
    assert exported("made_up_walls") == {
        "python made_up_walls exports Wall": "",
        "python made_up_walls exports paint": "",
    }
    assert merged(map(promised_by_name, ["made_up_walls.Wall", "made_up_walls.paint", "made_up_walls.Colour"])) == {
        "python made_up_walls.Wall": "class",
        "python made_up_walls.Wall field height": "",
        "python made_up_walls.Wall field colour": "",
        "python made_up_walls.Wall field area": "",
        "python made_up_walls.Wall method painted": "",
        "python made_up_walls.Wall requires": ["height"],
        "python made_up_walls.paint": "function",
        "python made_up_walls.paint parameter wall": "place 1",
        "python made_up_walls.paint parameter coats": "by name",
        "python made_up_walls.paint requires": ["wall"],
        "python made_up_walls.Colour": "class",
        "python made_up_walls.Colour member RED": "",
    }


def test_names_that_are_not_there_promise_nothing(module):
    assert promised_by_name("made_up_walls.Roof") == promised_by_name("no_such_package.Roof") == {}
    assert exported("no_such_package") == {}


def test_one_item_has_one_value():
    with pytest.raises(ValueError, match="recorded as 0 and as 1"):
        merged([{"exit": 0}, {"exit": 1}])


def test_a_recording_has_an_item_a_line():
    assert text({"b": ["x"], "a": 1}) == '{\n "a": 1,\n "b": ["x"]\n}\n'


def test_one_entry_is_of_one_command():
    promised = {
        "cprbm a": "command",
        "cprbm a option -q": "flag",
        "cprbm b": "command",
        "cprbm b exit: x": 0,
        "cprbm b exit: y": 2,
        "cprbm b option -q": "flag",
    }
    left = {"cprbm b": "command", "cprbm b exit: x": 2, "cprbm b exit: y": 2}
    drafts = tomllib.loads(undeclared(promised, left, []))["change"]
    assert [draft["promise"] for draft in drafts] == [
        ["cprbm a", "cprbm a *"],
        ["cprbm b exit: x", "cprbm b option -q"],
    ]


def test_situations_have_names_of_their_own_and_promises(promised):
    """A situation without a promise in the recording would test nothing."""
    exits = [f"{each.meant} exit: {each.name}" for each in situations() if each.possible]
    assert len(exits) == len(set(exits))
    assert set(exits) <= set(promised)


def test_the_schema_is_of_scenes():
    assert {"beams", "stages", "probes"} <= set(schema()["properties"])
