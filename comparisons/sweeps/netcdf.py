"""A sweep as NetCDF through xarray (extra ``netcdf``).

Variables are ``STAGE.PROBE.COMPONENT`` in SI over the points, the stations of the stage, and the places of a stress;
``STAGE.station`` and ``STAGE.branch`` belong to all variables of a stage.  A missing number is NaN.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from comparisons.sweeps.outcome import Record
from comparisons.sweeps.running import Sweep
from comparisons.sweeps.tables import name_of
from cprbm_scene.answer import Array


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
