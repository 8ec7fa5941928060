"""The door to gmsh: tagged curves of a file as places along the curves, in a process of their own.

gmsh has one state per process, and a wrong file may end the process.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import shapely

from comparisons.executor import WorkerDiedError, call_fresh
from comparisons.importing.drawing import Drawing, DrawnCurve
from cprbm_scene.answer import Array
from cprbm_scene.mistakes import Mistake, SceneError

SAMPLES = 2001
"""Places along a curve with a formula."""


def read(path: Path, unit: str) -> Drawing:
    """Tagged curves and points of a file, whose ending tells gmsh the format; gmsh knows no ``unit``.

    Raises:
        ImportError: gmsh or a library of the system is missing.
        SceneError: gmsh refuses the file.
    """
    try:
        found = call_fresh(_read, str(path))
    except WorkerDiedError:
        found = "a file that ends gmsh by force"
    if isinstance(found, str):
        raise SceneError([Mistake("", found, "a .geo, .step or .msh file that gmsh reads", str(path))])
    return found


def _read(path: str) -> Drawing | str:
    """The drawing, or gmsh's reason for refusing the file."""
    try:
        import gmsh
    except OSError as error:  # the wheel wants libraries of the desktop
        raise ImportError(str(error), name="gmsh") from None
    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(path)
        return _drawing(gmsh.model)
    except Exception as error:  # gmsh raises no other class
        return f"what gmsh does not read ({str(error).strip() or 'without a reason'})"
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
        return Drawing(tuple(_curve(model, *each) for each in named), points, tagged=True)
    every = [(model.getEntityName(1, k).rpartition("/")[2], int(k)) for _, k in model.getEntities(1)]
    curves = tuple(_curve(model, name or f"curve{k}", k) for name, k in every)
    return Drawing(curves, points, tagged=any(name for name, _ in every))


def _place(model, number: int) -> Array:  # type: ignore[no-untyped-def]  # noqa: ANN001
    """Place (3,) of a point, of a mesh its node."""
    _, places, _ = model.mesh.getNodes(0, number)
    return np.array(places[:3] if len(places) else model.getValue(0, number, []))


def _curve(model, tag: str, number: int) -> DrawnCurve:  # type: ignore[no-untyped-def]  # noqa: ANN001
    kind = model.getType(1, number)
    if kind.startswith("Discrete"):
        return DrawnCurve(tag, number, kind, _nodes(model, number), None)
    (first,), (last,) = model.getParametrizationBounds(1, number)
    places = np.array(model.getValue(1, number, np.linspace(first, last, SAMPLES))).reshape(-1, 3)
    along = np.array(model.getDerivative(1, number, [first, last])).reshape(-1, 3)
    sizes = np.linalg.norm(along, axis=1)
    return DrawnCurve(tag, number, kind, places, along / sizes[:, None] if np.all(sizes > 0.0) else None)


def _nodes(model, number: int) -> Array:  # type: ignore[no-untyped-def]  # noqa: ANN001
    """The nodes of a meshed curve in their order, (k, 3)."""
    kinds, _, nodes = model.mesh.getElements(1, number)
    edges = []
    for kind, each in zip(kinds, nodes, strict=True):
        for first, last, *inner in each.reshape(-1, model.mesh.getElementProperties(kind)[3]):
            edges.append([model.mesh.getNode(node)[0] for node in (first, *inner, last)])
    line = shapely.line_merge(shapely.multilinestrings([shapely.linestrings(edge) for edge in edges]), directed=True)
    return np.asarray(shapely.get_coordinates(line, include_z=True))
