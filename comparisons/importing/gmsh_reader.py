"""The door to gmsh: tagged curves of a file as places along the curves, in a process of their own.

gmsh has one state per process, and a wrong file may end the process.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from comparisons.executor import WorkerDiedError, call_fresh
from comparisons.importing.drawing import Drawing, DrawnCurve
from cprbm_scene.answer import Array
from cprbm_scene.mistakes import Mistake, SceneError

SAMPLES = 2001
"""Places along a curve with a formula."""


def read(path: Path) -> Drawing:
    """Tagged curves and points of a file, whose ending tells gmsh the format.

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
        try:
            gmsh.open(path)
        except Exception as error:
            return f"what gmsh does not read ({str(error).strip() or 'without a reason'})"
        return _drawing(gmsh.model)
    finally:
        gmsh.finalize()


def _drawing(model) -> Drawing:  # type: ignore[no-untyped-def]  # noqa: ANN001 - gmsh has no types
    groups = {dim: [(model.getPhysicalName(dim, g), g) for _, g in model.getPhysicalGroups(dim)] for dim in (0, 1)}
    named = [
        (name or f"curves{group}", int(number))
        for name, group in groups[1]
        for number in model.getEntitiesForPhysicalGroup(1, group)
    ]
    tagged = bool(named)
    if not named:
        names = [(model.getEntityName(1, k).rpartition("/")[2], int(k)) for _, k in model.getEntities(1)]
        tagged = any(name for name, _ in names)
        named = [(name or f"curve{number}", number) for name, number in names]
    points = {
        name or f"points{group}": np.array([_place(model, k) for k in model.getEntitiesForPhysicalGroup(0, group)])
        for name, group in groups[0]
    }
    return Drawing(tuple(_curve(model, tag, number) for tag, number in named), points, tagged)


def _place(model, number: int) -> Sequence[float]:  # type: ignore[no-untyped-def]  # noqa: ANN001
    _, places, _ = model.mesh.getNodes(0, number)
    return list(places[:3]) if len(places) else list(model.getValue(0, number, []))


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
    after = {}
    for kind, each in zip(kinds, nodes, strict=True):
        for element in each.reshape(-1, model.mesh.getElementProperties(kind)[3]):
            chain = [element[0], *element[2:], element[1]]  # both ends stand before the inner nodes
            after.update({int(a): int(b) for a, b in pairwise(chain)})
    begin = next(iter(set(after) - set(after.values())), next(iter(after)))
    order = [begin]
    while order[-1] in after and (len(order) == 1 or order[-1] != begin):
        order.append(after[order[-1]])
    return np.array([model.mesh.getNode(node)[0] for node in order])
