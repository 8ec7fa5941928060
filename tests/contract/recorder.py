"""The recorder: all promises of the running program."""

import contextlib
import csv
import importlib
import io
import json
import tempfile
from collections.abc import Iterable, Mapping
from functools import partial
from pathlib import Path

from comparisons.cli.main import commands, run

from .commands import commands_of
from .commands import promised_by as of_command
from .packages import Packages
from .promises import Promises, Value, merged
from .python_names import exported, promised_by_name
from .runs import SCENES, situations
from .runs import promised_by as of_situation
from .scene_keys import FILES, promised_by_file, promised_by_schema


def command_line(further: Iterable[str] = ()) -> Promises:
    """Commands, arguments, options, choices and defaults; ``further`` names hidden commands."""
    return merged(of_command(name, command) for name, command in commands_of(commands, further))


def exits_and_documents(command_names: set[str], packages: Packages) -> Promises:
    """Exit codes and JSON keys in all situations with a present command and library."""
    with tempfile.TemporaryDirectory() as folder:
        parts = [
            of_situation(situation, place, Path(folder), packages)
            for place, situation in enumerate(situations())
            if situation.possible and situation.meant in command_names
        ]
    return merged(parts)


def helps(command_names: Iterable[str]) -> Promises:
    """Exit codes of every command with a request for help, and with an unknown option."""
    promises: Promises = {}
    for name in command_names:
        for form in ("--help", "-h", "--no-such-option"):
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                promises[f"{name} exit: {form}"] = run([*name.split()[1:], form])
    return promises


def schema() -> dict[str, object]:
    """The JSON schema of scene files, as ``cprbm schema`` prints it."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        assert run(["schema"]) == 0
    found: dict[str, object] = json.loads(said.getvalue())
    return found


def scene_format(packages: Packages) -> Promises:
    """Built-in cases, keys of scene files, and stored scene files."""
    from comparisons.cases import asked, names

    read_question = importlib.import_module(packages.scene).read_question
    cases = [promised_by_file(f"scene case {name}", partial(asked, name)) for name in names()]
    files = [promised_by_file(f"scene file {file.name}", partial(read_question, file)) for file in FILES.glob("*.toml")]
    return merged([promised_by_schema(schema()), *cases, *files])


def tables(packages: Packages) -> Promises:
    """Columns of the library's tables of an answer."""
    import comparisons
    import cprbm

    scene = importlib.import_module(packages.scene).read(SCENES / "cantilever.toml")
    answer = cprbm.answer(scene, cprbm.Settings(links=6))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "numbers.csv"
        comparisons.write_csv(file, scene, answer)
        columns = next(csv.reader(file.read_text("utf-8").splitlines()))
    records: list[Mapping[str, object]] = [*comparisons.records(scene, answer)]
    return {
        **{f"python comparisons.write_csv column {place}": column for place, column in enumerate(columns, start=1)},
        **{f"python comparisons.records column {key}": "" for key in records[0]},
    }


def library(names: Iterable[str], packages: Iterable[str]) -> Promises:
    """Public names of the library, documented and exported."""
    return merged([*map(promised_by_name, names), *map(exported, packages)])


def program(packages: Packages, further: Iterable[str] = ()) -> Promises:
    """All promises except the names of the library."""
    line = command_line(further)
    names = {item for item, value in line.items() if value in ("command", "group")}
    return merged([line, helps(names), exits_and_documents(names, packages), scene_format(packages), tables(packages)])


def promised_names(promises: Mapping[str, Value]) -> set[str]:
    """The full names of the library in a recording."""
    kinds = ("class", "function", "name")
    return {
        item.split()[1]
        for item, value in promises.items()
        if item.startswith("python ") and value in kinds and item.count(" ") == 1
    }
