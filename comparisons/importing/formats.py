"""Formats of drawings, and their readers.

The beginning of a file decides on the format.  gmsh chooses by the ending and runs unknown files as programs: a file
for gmsh therefore needs the ending of its format, and only the ending ``.geo`` lets a file run.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from comparisons.importing.drawing import Drawing, DrawnCurve
from cprbm_scene.mistakes import Mistake, SceneError
from cprbm_scene.point_table import read_points

_BEGIN = 4096
"""Bytes of a file that decide on the format."""


def read_drawing(path: Path, unit: str) -> Drawing:
    """Content of a drawing with lengths in a ``unit``.

    Raises:
        ImportError: the library for the format is missing.
        SceneError: the file is missing, has another format, or its reader refuses the file.
    """
    if not path.is_file():
        raise SceneError([Mistake("", "no such file", f"a drawing: {_known()}", str(path))])
    with path.open("rb") as stream:
        begin = stream.read(_BEGIN)
    for name, endings, pattern, read in _FORMATS:
        if re.match(pattern, begin) and (endings != GEOMETRY or path.suffix in GEOMETRY):
            if read is _by_gmsh and path.suffix.lower() not in endings:
                found = f"a {name} file with the ending {path.suffix!r}"
                raise SceneError([Mistake("", found, f"the ending {endings[0]}", str(path))])
            return read(path, unit)
    raise SceneError([Mistake("", "a file of another format", f"a drawing: {_known()}", str(path))])


def _known() -> str:
    return ", ".join(f"{name} ({', '.join(endings)})" for name, endings, *_ in _FORMATS)


def _by_gmsh(path: Path, unit: str) -> Drawing:
    from comparisons.importing import gmsh_reader

    return gmsh_reader.read(path)


def _by_ezdxf(path: Path, unit: str) -> Drawing:
    from comparisons.importing import dxf_reader

    return dxf_reader.read(path, unit)


def _table(path: Path, unit: str) -> Drawing:
    """The curve through the points of a table."""
    try:
        points = np.array(read_points(path, unit), dtype=float).reshape(-1, 2)
    except SceneError as error:
        raise SceneError([Mistake("", each.found, each.allowed, str(path)) for each in error.mistakes]) from None
    if len(points) < 2:
        raise SceneError([Mistake("", f"{len(points)} points", "at least two points", str(path))])
    points = np.column_stack((points, np.zeros(len(points))))
    return Drawing((DrawnCurve(path.stem, 1, f"{len(points)} points", points, None),), {}, tagged=True)


GEOMETRY = (".geo",)
_FORMATS: tuple[tuple[str, tuple[str, ...], bytes, Callable[[Path, str], Drawing]], ...] = (
    ("STEP", (".step", ".stp"), rb"\s*ISO-10303-21", _by_gmsh),
    ("gmsh mesh", (".msh",), rb"\s*\$(MeshFormat|NOD|Comments)", _by_gmsh),
    ("BREP", (".brep",), rb"\s*(DBRep_DrawableShape|CASCADE Topology)", _by_gmsh),
    ("IGES", (".iges", ".igs"), rb".{72}S\s*1", _by_gmsh),
    ("DXF", (".dxf",), rb"(\s*999\s*\n[^\n]*\n)*\s*0\s*\n\s*SECTION|AutoCAD Binary DXF", _by_ezdxf),
    ("table", (".csv",), rb"(\xef\xbb\xbf)?(\s*#[^\n]*\n|\s)*([^\n]*[,;\t])?[\s\"']*[xy][^,;\t\n]*[,;\t]", _table),
    ("gmsh geometry", GEOMETRY, b"", _by_gmsh),
)
"""Names, endings, patterns of the beginnings, and readers of all formats; the first fitting pattern counts."""
