"""Tables of a sweep: a line per number, and a line per point with the numbers of the last stations.

Numbers are in the units of the scene's file; every number of the long table stands beside its unit.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from comparisons.formats import file_unit
from comparisons.present.csv_table import csv_text, in_unit
from comparisons.sweeps.outcome import Outcome, Record
from comparisons.sweeps.running import Sweep, Task
from comparisons.writing import write
from cprbm_scene import Scene

_VALUES = ("value", "fea", "difference", "stated")
_PLACES = ("stage", "station", "station_unit", "branch", "probe", "component", "arc_length", "arc_length_unit")


def records(sweep: Sweep) -> Iterator[dict[str, Any]]:
    """Every number of a sweep with its point, SI; a point without numbers has a record too."""
    for task, outcome in sweep.points():
        for number in outcome.numbers or ({},):
            yield {**_point(task, outcome), **number}


def _point(task: Task, outcome: Outcome) -> dict[str, Any]:
    return {
        "point": task.number,
        **task.point,
        "solver": outcome.solver,
        "ending": outcome.ending,
        "sentence": outcome.sentence,
        "verdict": outcome.verdict,
        "reason": outcome.reason,
        "iterations": outcome.iterations,
        "seconds": outcome.seconds,
        "key": task.key,
    }


def write_tables(folder: Path, sweep: Sweep) -> None:
    """Write ``numbers.csv`` and ``last.csv``.

    Raises:
        OSError: a file cannot be written.
    """
    names = {axis.name: f"{axis.name}, {axis.unit}".rstrip(", ") for axis in sweep.axes}
    heads = ["point", *names.values(), "solver"]
    tails = ["ending", "verdict", "reason", "iterations", "seconds", "key", "sentence"]
    long = ({**_in_units(sweep, record, names)} for record in records(sweep))
    columns = [*heads, *_PLACES, *_VALUES, "unit", "word", *tails]
    write(folder / "numbers.csv", csv_text(columns, long))
    rows = [_wide(sweep, task, outcome, names) for task, outcome in sweep.points()]
    wide = dict.fromkeys(name for row in rows for name in row if name not in (*heads, *tails))
    write(folder / "last.csv", csv_text([*heads, *tails[:-1], *wide, "sentence"], rows))


def _wide(sweep: Sweep, task: Task, outcome: Outcome, names: Mapping[str, str]) -> dict[str, Any]:
    """A point with the numbers of the last station of every stage; without the stresses along beams."""
    row = _in_units(sweep, _point(task, outcome), names)
    for number in last_numbers(outcome):
        factor, unit = file_unit(sweep.scene, number["unit"])
        row[f"{number['stage']} {name_of(number)}, {unit}"] = in_unit(number["value"], factor)
    return row


def last_numbers(outcome: Outcome) -> list[Record]:
    """Numbers of the last station of every stage, without values along beams."""
    last = {number["stage"]: number["station"] for number in outcome.numbers}
    return [
        number
        for number in outcome.numbers
        if number["station"] == last[number["stage"]] and number["arc_length"] is None
    ]


def name_of(number: Record) -> str:
    """Probe and component."""
    return ".".join(filter(None, (number["probe"], number["component"])))


def _in_units(sweep: Sweep, record: Mapping[str, Any], names: Mapping[str, str]) -> dict[str, Any]:
    row = {name: value for name, value in record.items() if name not in names}
    for axis in sweep.axes:
        row[names[axis.name]] = in_unit(record[axis.name], axis.size)
    if "unit" in record:
        _convert(sweep.scene, row, "unit", _VALUES)
        _convert(sweep.scene, row, "station_unit", ("station",))
        row["arc_length_unit"] = "m"
        _convert(sweep.scene, row, "arc_length_unit", ("arc_length",))
    return row


def _convert(scene: Scene, row: dict[str, Any], unit: str, columns: Iterable[str]) -> None:
    factor, row[unit] = file_unit(scene, row[unit])
    row.update({column: in_unit(row.get(column), factor) for column in columns})
