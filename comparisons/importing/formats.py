"""Formats of drawings, and their readers.

The beginning of a file decides on the format.  gmsh chooses by the ending and runs unknown files as programs: a file
for gmsh therefore needs the ending of its format, and only the ending ``.geo`` lets a file run.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from comparisons.importing import dxf_reader, gmsh_reader
from comparisons.importing.drawing import Drawing, DrawnCurve
from cprbm_scene.files import read_points
from cprbm_scene.mistakes import Mistake, SceneError

_BEGIN = 4096
"""Bytes of a file that decide on the format."""


def read_drawing(path: Path, unit: str) -> Drawing:
    """Content of a drawing with lengths in a ``unit``.

    Raises:
        ImportError: the library for the format is missing.
        SceneError: the file is missing, has another format, or its reader refuses the file.
    """
    found, allowed = "no such file", "a drawing: "
    allowed += ", ".join(f"{name} ({', '.join(endings)})" for name, endings, *_ in _FORMATS)
    if path.is_file():
        found = "a file of another format"
        with path.open("rb") as stream:
            begin = stream.read(_BEGIN)
        for name, endings, pattern, read in _FORMATS:
            if not re.match(pattern, begin) or (not pattern and path.suffix not in endings):
                continue
            if read is not gmsh_reader.read or path.suffix.lower() in endings:
                return read(path, unit)
            found, allowed = f"a {name} file with the ending {path.suffix!r}", f"the ending {endings[0]}"
            break
    raise SceneError([Mistake("", found, allowed, str(path))])


def _read_table(path: Path, unit: str) -> Drawing:
    """The curve through the points of a table."""
    try:
        points = np.array(read_points(path, unit), dtype=float).reshape(-1, 2)
    except SceneError as error:
        raise SceneError([Mistake("", each.found, each.allowed, str(path)) for each in error.mistakes]) from None
    if len(points) < 2:
        raise SceneError([Mistake("", f"{len(points)} points", "at least two points", str(path))])
    places = np.pad(points, ((0, 0), (0, 1)))
    return Drawing((DrawnCurve(path.stem, 1, f"{len(points)} points", places, None),), {}, tagged=True)


_FORMATS: tuple[tuple[str, tuple[str, ...], bytes, Callable[[Path, str], Drawing]], ...] = (
    ("STEP", (".step", ".stp"), rb"\s*ISO-10303-21", gmsh_reader.read),
    ("gmsh mesh", (".msh",), rb"\s*\$(MeshFormat|NOD|Comments)", gmsh_reader.read),
    ("BREP", (".brep",), rb"\s*(DBRep_DrawableShape|CASCADE Topology)", gmsh_reader.read),
    ("IGES", (".iges", ".igs"), rb".{72}S\s*1", gmsh_reader.read),
    ("DXF", (".dxf",), rb"(\s*999\s*\n[^\n]*\n)*\s*0\s*\n\s*SECTION|AutoCAD Binary DXF", dxf_reader.read),
    (
        "table",
        (".csv",),
        rb"(\xef\xbb\xbf)?(\s*#[^\n]*\n|\s)*([^\n]*[,;\t])?[\s\"']*[xyXY][^,;\t\n]*[,;\t]",
        _read_table,
    ),
    ("gmsh geometry", (".geo",), b"", gmsh_reader.read),
)
"""Names, endings, patterns of the beginnings, and readers of all formats; the first fitting pattern counts."""
