"""Points of a curve from a table of separated values, with a header of names and units: ``x [mm], y [mm]``.

The table may have further columns, blank lines and lines of comment that begin with ``#``.  Columns are separated by
commas, semicolons or tabs; numbers have a decimal point.
"""

from __future__ import annotations

import csv
import re
from contextlib import suppress
from fractions import Fraction
from pathlib import Path

from cprbm_scene.units import LARGEST, SIZES, mistake

LONGEST = 1_000_000
"""Largest size of a table in bytes: twenty times a table of the most points of a spline."""

_COLUMN = re.compile(r"\s*([xy])\s*(?:[\[(/_]?\s*(?:in\s)?\s*(mm|cm|um|µm|m|in)\s*[\])]?)?\s*", re.IGNORECASE)
_HEADER = "a header with the columns x and y, such as 'x [mm], y [mm]'; units are m, cm, mm, um and in"


def read_points(path: Path, unit: str) -> tuple[tuple[float, float], ...]:
    """Points of the columns x and y, in a unit of length.

    Args:
        path: file in UTF-8, with or without a byte-order mark.
        unit: unit of the points, and of columns without a unit: m, cm, mm, um or in.

    Raises:
        SceneError: the file cannot be read, or has a wrong header or number; the error names file, row and
            column.
    """
    try:
        with path.open("rb") as stream:
            text = stream.read(LONGEST + 1).decode("utf-8-sig")
    except FileNotFoundError:
        raise mistake(
            f"{str(path)!r}, which is no file", "a path of a table of points, from the scene's folder"
        ) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "no text in UTF-8"
        raise mistake(f"{str(path)!r}, which cannot be read ({reason})", "a table of points in UTF-8") from None
    if len(text) > LONGEST:
        raise mistake(f"{path.name!r}, a longer file", f"at most {LONGEST // 1_000_000} MB of points")
    lines = [
        (row, line)
        for row, line in enumerate(text.splitlines(), start=1)
        if line.strip(" \t,;#") and not line.lstrip().startswith("#")
    ] or [(1, "")]
    first, header = lines[0]
    mark = next((mark for mark in ";\t" if mark in header), ",")
    names = [_COLUMN.fullmatch(name.strip("\"' ")) for name in header.split(mark)]
    columns = {
        name[1].lower(): (i, (name[2] or unit).lower().replace("µ", "u")) for i, name in enumerate(names) if name
    }
    if set(columns) != {"x", "y"}:
        raise mistake(f"{header[:80]!r} in {path.name}, row {first}", _HEADER)
    cells = ((row, next(csv.reader([line], delimiter=mark))) for row, line in lines[1:])
    return tuple(
        (_number(path, row, line, "x", *columns["x"], unit), _number(path, row, line, "y", *columns["y"], unit))
        for row, line in cells
    )


def _number(path: Path, row: int, cells: list[str], name: str, column: int, own: str, unit: str) -> float:
    """Number of a cell in a unit of length."""
    cell = cells[column].strip() if column < len(cells) else ""
    with suppress(ValueError):
        if abs(number := float(cell)) <= LARGEST:
            return number if own == unit else float(Fraction(repr(number)) * SIZES[own] / SIZES[unit])
    raise mistake(f"{cell!r} in {path.name}, row {row}, column {name}", "a finite number with a decimal point")
