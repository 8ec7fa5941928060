"""Files of a scene: plain data of a TOML file, and points of a table of separated values.

A table has a header of names and units, ``x [mm], y [mm]``, and may have further columns, blank lines and lines of
comment that begin with ``#``.  Columns are separated by commas, semicolons or tabs; numbers have a decimal point.
"""

from __future__ import annotations

import csv
import re
import tomllib
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from cprbm_scene.mistakes import SceneError
from cprbm_scene.units import LARGEST, SIZES, mistake

LONGEST = 1_000_000
"""Largest size of a file in bytes: a hundred times the longest built-in case."""
DEEPEST = 32
_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+"""
_DEEP_KEY = re.compile(rf"(?<![\w-])(?:{_PART}){{{DEEPEST}}}", re.ASCII)
"""A dotted key deeper than any scene's: the parser's time and memory grow with the square of the parts."""

_COLUMN = re.compile(r"\s*([xy])\s*(?:[\[(/_]?\s*(?:in\s)?\s*(mm|cm|um|µm|m|in)\s*[\])]?)?\s*", re.IGNORECASE)
_HEADER = "a header with the columns x and y, such as 'x [mm], y [mm]'; units are m, cm, mm, um and in"


def text_of(path: str | Path, content: str, readable: str, name: str = "") -> str:
    """Text of a file in UTF-8, with or without a byte-order mark.

    Args:
        path: the file.
        content: contents of the file, for the message on a file that is larger than :data:`LONGEST`.
        readable: description of a readable file, for the other messages.
        name: begin of the found values in the messages.

    Raises:
        SceneError: the file cannot be read, or is too large.
    """
    try:
        with Path(path).open("rb") as stream:
            found = stream.read(LONGEST + 1)
        if len(found) <= LONGEST:
            return found.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise mistake(f"{name}bytes that are no UTF-8 text (at byte {error.start})", readable) from None
    except (OSError, ValueError) as error:
        raise mistake(
            f"{name}a file that cannot be read ({getattr(error, 'strerror', None) or error})", readable
        ) from None
    raise mistake(f"{name}a file that is larger", f"at most {LONGEST // 1_000_000} MB of {content} in UTF-8")


def toml_data(path: str | Path) -> dict[str, Any]:
    """Plain data of a TOML file in UTF-8, with or without a byte-order mark.

    Raises:
        SceneError: the file cannot be read, is too large or too deep, or is no TOML.
    """
    readable = "a readable TOML file in UTF-8"
    try:
        text = text_of(path, "TOML", readable)
        if not _DEEP_KEY.search(text):
            return tomllib.loads(text)
        wrong = mistake(f"a key of more than {DEEPEST} parts", "the keys of a scene")
    except SceneError as error:
        wrong = error
    except (RecursionError, ValueError) as error:
        # nested too deeply, or an integer with too many digits
        wrong = mistake(f"text that is no TOML ({error})", readable)
    raise SceneError([replace(each, file=str(path)) for each in wrong.mistakes])


def read_points(path: Path, unit: str) -> tuple[tuple[float, float], ...]:
    """Points of the columns x and y, in a unit of length.

    Args:
        path: file in UTF-8, with or without a byte-order mark.
        unit: unit of the points, and of columns without a unit: m, cm, mm, um or in.

    Raises:
        SceneError: the file cannot be read, or has a wrong header or number; the error names file, row and
            column.
    """
    text = text_of(
        path, "points", "a table of points in UTF-8, with a path from the scene's folder", f"{str(path)!r}, "
    )
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
