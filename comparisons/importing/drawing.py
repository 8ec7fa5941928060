"""Drawings: curves and named points of all formats, and the doors to ezdxf and gmsh.

The beginning of a file decides on the format.  gmsh chooses by the ending and runs unknown files as programs: a file
for gmsh therefore needs the ending of its format, and only the ending ``.geo`` lets a file run.  gmsh has one state per
process, and a wrong file may end the process: gmsh reads in a process of its own.
"""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from comparisons.executor import WorkerDiedError, call_fresh
from cprbm_scene import Array, Mistake, SceneError
from cprbm_scene.units import read_points

_BEGIN = 4096
"""Bytes of a file that decide on the format."""

_ON_CURVE, _ON_ARC = 2001, 61
"""Places along a curve, and along an arc, whose fitted circle has a relative error of round-off."""

_PLACES: dict[str, Callable[[Any], Iterable[Iterable[float]]]] = {
    "LINE": lambda line: (line.dxf.start, line.dxf.end),
    "ARC": lambda arc: arc.vertices(arc.angles(_ON_ARC)),
    "ELLIPSE": lambda ellipse: ellipse.vertices(ellipse.params(_ON_CURVE)),
    "SPLINE": lambda spline: spline.construction_tool().approximate(_ON_CURVE - 1),
}
"""Places along the curves of a DXF drawing by the kind of the entity."""

_READ_BY_GMSH = "a .geo, .step or .msh file that gmsh reads"

_UNITS = {1: "in", 4: "mm", 5: "cm", 6: "m", 13: "um"}
"""Units by the number of a DXF header's variable $INSUNITS; 0 stands for a drawing without a unit."""


@dataclass(frozen=True, slots=True)
class DrawnCurve:
    """A curve of a drawing.

    Attributes:
        tag: name of the group or layer; without either a name with the number.
        number: number of the curve in the drawing.
        kind: name of the curve's kind in the drawing.
        points: places along the curve, (k, 3), in the drawing's unit.
        directions: unit tangents (2, 3) at both ends; None for a curve known by places alone.
    """

    tag: str
    number: int
    kind: str
    points: Array
    directions: Array | None


@dataclass(frozen=True, slots=True)
class Drawing:
    """Content of a drawing: curves; places (k, 3) of named points; sentences on entities without a curve."""

    curves: tuple[DrawnCurve, ...]
    points: dict[str, Array]
    refused: tuple[str, ...] = ()


def read_drawing(path: Path, unit: str) -> Drawing:
    """Content of a drawing with lengths in a ``unit``.

    Raises:
        ImportError: the library for the format is missing.
        OSError: the file cannot be read.
        SceneError: the file has another format, or its reader refuses the file.
    """
    with path.open("rb") as stream:
        begin = stream.read(_BEGIN)
    for name, endings, pattern, read in _FORMATS:
        if not re.match(pattern, begin) or (not pattern and path.suffix not in endings):
            continue
        if read is not _with_gmsh or path.suffix.lower() in endings:
            return read(path, unit)
        raise _refused(path, f"a {name} file with the ending {path.suffix!r}", f"the ending {endings[0]}")
    formats = ", ".join(f"{name} ({', '.join(endings)})" for name, endings, *_ in _FORMATS)
    raise _refused(path, "a file of another format", f"a drawing: {formats}")


def _refused(path: Path, found: str, allowed: str) -> SceneError:
    return SceneError([Mistake("", found, allowed, str(path))])


def _read_table(path: Path, unit: str) -> Drawing:
    """The curve through the points of a table."""
    try:
        points = np.array(read_points(path, unit), dtype=float).reshape(-1, 2)
    except SceneError as error:
        raise SceneError([Mistake("", each.found, each.allowed, str(path)) for each in error.mistakes]) from None
    if len(points) < 2:
        raise _refused(path, f"{len(points)} points", "at least two points")
    curve = DrawnCurve(
        tag=path.stem,
        number=1,
        kind=f"{len(points)} points",
        points=np.pad(points, ((0, 0), (0, 1))),
        directions=None,
    )
    return Drawing((curve,), {})


def _with_ezdxf(path: Path, unit: str) -> Drawing:
    """Curves and polylines of a DXF drawing's model space; a layer is a group of curves or points."""
    import ezdxf

    try:
        document = ezdxf.readfile(path)
    except Exception as error:  # of a broken file ezdxf raises errors of any kind
        found = f"a file that ezdxf does not read ({str(error).strip() or type(error).__name__})"
        raise _refused(path, found, "a DXF file") from None
    number = document.header.get("$INSUNITS", 0)
    stated = _UNITS.get(number, "another unit")
    if number and stated != unit:
        found = f"a drawing in {stated} ($INSUNITS = {number}), read in {unit}"
        remedy = f"--unit {stated}; a wrong unit of the drawing is mended afterwards, by the key units of the scene"
        raise _refused(path, found, remedy if number in _UNITS else "a drawing in mm")
    curves, refused, points = list[DrawnCurve](), list[str](), dict[str, list[Array]]()
    for entity in document.modelspace():
        kind, layer = entity.dxftype(), entity.dxf.layer
        parts = list(entity.virtual_entities()) if kind in ("LWPOLYLINE", "POLYLINE") else [entity]
        if kind == "POINT":
            points.setdefault(layer, []).append(np.array(entity.dxf.location))
        elif {part.dxftype() for part in parts} <= _PLACES.keys():
            for place, part in enumerate(parts, len(curves) + 1):
                curve = DrawnCurve(
                    tag=layer if layer != "0" else f"curve{place}",
                    number=place,
                    kind=f"{kind} {entity.dxf.handle}",
                    points=np.array([tuple(each) for each in _PLACES[part.dxftype()](part)]),
                    directions=None,
                )
                curves.append(curve)
        else:
            refused.append(
                f"{kind} on the layer {layer!r} (entity {entity.dxf.handle}), "
                "no line, arc, spline, elliptic arc or polyline"
            )
    return Drawing(tuple(curves), {layer: np.array(each) for layer, each in points.items()}, tuple(refused))


def _with_gmsh(path: Path, unit: str) -> Drawing:
    """Tagged curves and points of a file, whose ending tells gmsh the format; gmsh knows no ``unit``."""
    try:
        return call_fresh(_read, path)
    except WorkerDiedError:
        raise _refused(path, "a file that ends gmsh by force", _READ_BY_GMSH) from None


def _read(path: Path) -> Drawing:
    """The drawing in a file; an error states gmsh's reason for refusing the file."""
    try:
        import gmsh
    except OSError as error:  # the wheel wants libraries of the desktop
        raise ImportError(str(error), name="gmsh") from None
    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        return _drawing(gmsh.model)
    except Exception as error:  # gmsh raises no other class
        found = f"what gmsh does not read ({str(error).strip() or 'without a reason'})"
        raise _refused(path, found, _READ_BY_GMSH) from None
    finally:
        gmsh.finalize()


def _drawing(model) -> Drawing:  # type: ignore[no-untyped-def]  # noqa: ANN001 - gmsh has no types
    points, named = dict[str, Array](), list[tuple[str, int]]()
    for dim, group in model.getPhysicalGroups():
        name, entities = model.getPhysicalName(dim, group), model.getEntitiesForPhysicalGroup(dim, group)
        if dim == 0:
            points[name or f"points{group}"] = np.array([_place(model, k) for k in entities])
        elif dim == 1:
            named += [(name or f"curves{group}", int(k)) for k in entities]
    if named:
        return Drawing(tuple(_curve(model, *each) for each in named), points)
    every = [(model.getEntityName(1, k).rpartition("/")[2], int(k)) for _, k in model.getEntities(1)]
    return Drawing(tuple(_curve(model, name or f"curve{k}", k) for name, k in every), points)


def _place(model, number: int) -> Array:  # type: ignore[no-untyped-def]  # noqa: ANN001
    """Place (3,) of a point, of a mesh its node."""
    _, places, _ = model.mesh.getNodes(0, number)
    return np.array(places[:3] if len(places) else model.getValue(0, number, []))


def _curve(model, tag: str, number: int) -> DrawnCurve:  # type: ignore[no-untyped-def]  # noqa: ANN001
    kind = model.getType(1, number)
    if kind.startswith("Discrete"):
        return DrawnCurve(tag, number, kind, _nodes(model, number), None)
    (first,), (last,) = model.getParametrizationBounds(1, number)
    places = np.array(model.getValue(1, number, np.linspace(first, last, _ON_CURVE))).reshape(-1, 3)
    along = np.array(model.getDerivative(1, number, [first, last])).reshape(-1, 3)
    sizes = np.linalg.norm(along, axis=1)
    return DrawnCurve(tag, number, kind, places, along / sizes[:, None] if np.all(sizes > 0.0) else None)


def _nodes(model, number: int) -> Array:  # type: ignore[no-untyped-def]  # noqa: ANN001
    """The nodes of a meshed curve in their order, (k, 3)."""
    kinds, _, nodes = model.mesh.getElements(1, number)
    edges = [
        [model.mesh.getNode(node)[0] for node in (first, *inner, last)]
        for kind, each in zip(kinds, nodes, strict=True)
        for first, last, *inner in each.reshape(-1, model.mesh.getElementProperties(kind)[3])
    ]
    line = shapely.line_merge(shapely.multilinestrings([shapely.linestrings(edge) for edge in edges]), directed=True)
    return np.asarray(shapely.get_coordinates(line, include_z=True))


_FORMATS: tuple[tuple[str, tuple[str, ...], bytes, Callable[[Path, str], Drawing]], ...] = (
    ("STEP", (".step", ".stp"), rb"\s*ISO-10303-21", _with_gmsh),
    ("gmsh mesh", (".msh",), rb"\s*\$(MeshFormat|NOD|Comments)", _with_gmsh),
    ("BREP", (".brep",), rb"\s*(DBRep_DrawableShape|CASCADE Topology)", _with_gmsh),
    ("IGES", (".iges", ".igs"), rb".{72}S\s*1", _with_gmsh),
    ("DXF", (".dxf",), rb"(\s*999\s*\n[^\n]*\n)*\s*0\s*\n\s*SECTION|AutoCAD Binary DXF", _with_ezdxf),
    (
        "table",
        (".csv",),
        rb"(\xef\xbb\xbf)?(\s*#[^\n]*\n|\s)*([^\n]*[,;\t])?[\s\"']*[xyXY][^,;\t\n]*[,;\t]",
        _read_table,
    ),
    ("gmsh geometry", (".geo",), b"", _with_gmsh),
)
"""Names, endings, patterns of the beginnings, and readers of all formats; the first fitting pattern counts."""
