"""Files of a sweep's numbers: two CSV tables, and NetCDF through xarray (extra ``netcdf``).

The long table has a line per number with its unit, the wide table a line per point with the numbers of the last
stations; both are in the units of the scene's file.  NetCDF is in SI: variables ``STAGE.PROBE.COMPONENT`` over the
points, the stations of the stage, and the places of a stress, with ``STAGE.station`` and ``STAGE.branch``.  A missing
number is NaN.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.formats import file_unit
from comparisons.present.csv_table import csv_text, in_file_units, in_unit
from comparisons.sweeps.outcome import Outcome, Record
from comparisons.writing import write
from cprbm_scene.answer import Array

if TYPE_CHECKING:
    from comparisons.sweeps.running import Sweep, Task

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
    heads = ["point", *(axis.label for axis in sweep.axes), "solver"]
    tails = ["ending", "verdict", "reason", "iterations", "seconds", "key", "sentence"]
    long = (_in_units(sweep, record) for record in records(sweep))
    columns = [*heads, *_PLACES, *_VALUES, "unit", "word", *tails]
    write(folder / "numbers.csv", csv_text(columns, long))
    rows = [_wide(sweep, task, outcome) for task, outcome in sweep.points()]
    wide = dict.fromkeys(name for row in rows for name in row if name not in (*heads, *tails))
    write(folder / "last.csv", csv_text([*heads, *tails[:-1], *wide, "sentence"], rows))


def _wide(sweep: Sweep, task: Task, outcome: Outcome) -> dict[str, Any]:
    """A point with the numbers of the last station of every stage; without the stresses along beams."""
    row = _in_units(sweep, _point(task, outcome))
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


def _in_units(sweep: Sweep, record: Mapping[str, Any]) -> dict[str, Any]:
    """A record with the units of the scene's file; parameters have their units in the keys."""
    row = in_file_units(sweep.scene, record) if "unit" in record else {**record}
    return row | {axis.label: in_unit(row.pop(axis.name), axis.size) for axis in sweep.axes}


def write_netcdf(path: Path, sweep: Sweep) -> None:
    """Write all numbers of a sweep.

    Raises:
        OSError: the file cannot be written.
        ImportError: xarray is not installed.
    """
    import xarray

    found = list(sweep.points())
    data = xarray.Dataset({"point": ("point", [task.number for task, _ in found])}, attrs={"scene": sweep.scene.name})
    for axis in sweep.axes:
        data[axis.name] = "point", [task.point[axis.name] for task, _ in found]
    for name in ("solver", "ending", "verdict"):
        data[name] = "point", [getattr(outcome, name) for _, outcome in found]
    for stage in sweep.scene.stages:
        rows = [[each for each in outcome.numbers if each["stage"] == stage.name] for _, outcome in found]
        stations = f"{stage.name}.stations"
        for key in ("station", "branch"):
            data[f"{stage.name}.{key}"] = ("point", stations), _table(rows, key)[:, :, 0]
        for name, unit in {name_of(each): each["unit"] for row in rows for each in row}.items():
            values = _table([[each for each in row if name_of(each) == name] for row in rows], "value", rows)
            dimensions = ("point", stations, f"{stage.name}.{name}.places")[: 2 + (values.shape[2] > 1)]
            data[f"{stage.name}.{name}"] = dimensions, values.reshape(values.shape[: len(dimensions)]), {"unit": unit}
    data.to_netcdf(path, engine="scipy")


def _table(rows: Sequence[Sequence[Record]], key: str, whole: Sequence[Sequence[Record]] | None = None) -> Array:
    """Values (points, stations, places) of a ``key`` of ``rows``; ``whole`` rows state all stations by point."""
    cells = {}
    orders = [list(dict.fromkeys(each["station"] for each in row)) for row in whole or rows]
    for place, (row, order) in enumerate(zip(rows, orders, strict=True)):
        counts = Counter[float]()
        for each in row:
            cells[place, order.index(each["station"]), counts[each["station"]]] = each[key]
            counts[each["station"]] += 1
    sizes = len(rows), max(map(len, orders)), 1 + max((places for _, _, places in cells), default=0)
    table = np.full(sizes, np.nan)
    for cell, value in cells.items():
        table[cell] = value
    return table
