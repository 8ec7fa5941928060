"""The door to gmsh: tagged curves of a file as points along them, read in a process of its own.

gmsh keeps one state for its whole process, and a file that it does not take may end it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from comparisons.executor import WorkerDiedError, call_fresh
from cprbm_scene.answer import Array
from cprbm_scene.mistakes import Mistake, SceneError

SAMPLES = 2001
"""Points along a curve that is known between them."""


@dataclass(frozen=True, slots=True)
class Traced:
    """A curve of a file.

    Attributes:
        tag: name of the physical group, or of the entity; of one without either gmsh's number.
        number: gmsh's number of the curve.
        kind: what gmsh calls it.
        points: along it, (k, 3), in the file's unit.
        directions: unit tangents (2, 3) at its two ends; None where only places are known, as of a mesh.
    """

    tag: str
    number: int
    kind: str
    points: Array
    directions: Array | None


@dataclass(frozen=True, slots=True)
class Drawn:
    """What a file holds: its ``curves``, and by the name of each physical group of points where these are, (k, 3)."""

    curves: tuple[Traced, ...]
    points: dict[str, Array]
    tagged: bool


def read(path: Path) -> Drawn:
    """The tagged curves of a file, and its tagged points.

    Raises:
        ImportError: gmsh is not there, or a library of the system that it wants is not.
        SceneError: the file is none that gmsh reads.
    """
    if not path.is_file():
        raise SceneError([Mistake("", "no such file", "a .geo, .step or .msh file", str(path))])
    try:
        found = call_fresh(_read, str(path))
    except WorkerDiedError:
        found = "a file at which gmsh ends by force"
    if isinstance(found, str):
        raise SceneError([Mistake("", found, "a .geo, .step or .msh file that gmsh reads", str(path))])
    return found


def _read(path: str) -> Drawn | str:
    """The same, or what was found in its place."""
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
        return _found(gmsh.model)
    finally:
        gmsh.finalize()


def _found(model) -> Drawn:  # type: ignore[no-untyped-def]  # noqa: ANN001 - gmsh has no types
    named = [
        (model.getPhysicalName(1, group) or f"curves{group}", int(number))
        for _, group in model.getPhysicalGroups(1)
        for number in model.getEntitiesForPhysicalGroup(1, group)
    ]
    tagged = bool(named)
    if not named:
        for _, number in model.getEntities(1):
            name = model.getEntityName(1, number).rpartition("/")[2]
            tagged |= bool(name)
            named.append((name or f"curve{number}", int(number)))
    points = {
        model.getPhysicalName(0, group) or f"points{group}": np.array(
            [_place(model, number) for number in model.getEntitiesForPhysicalGroup(0, group)]
        )
        for _, group in model.getPhysicalGroups(0)
    }
    return Drawn(tuple(_traced(model, tag, number) for tag, number in named), points, tagged)


def _place(model, number: int) -> Sequence[float]:  # type: ignore[no-untyped-def]  # noqa: ANN001
    _, places, _ = model.mesh.getNodes(0, number)
    return list(places[:3]) if len(places) else list(model.getValue(0, number, []))


def _traced(model, tag: str, number: int) -> Traced:  # type: ignore[no-untyped-def]  # noqa: ANN001
    kind = model.getType(1, number)
    if kind.startswith("Discrete"):
        return Traced(tag, number, kind, _nodes(model, number), None)
    (first,), (last,) = model.getParametrizationBounds(1, number)
    t = np.linspace(first, last, SAMPLES)
    places = np.array(model.getValue(1, number, t)).reshape(-1, 3)
    ways = np.array(model.getDerivative(1, number, [first, last])).reshape(-1, 3)
    sizes = np.linalg.norm(ways, axis=1)
    return Traced(tag, number, kind, places, ways / sizes[:, None] if np.all(sizes > 0.0) else None)


def _nodes(model, number: int) -> Array:  # type: ignore[no-untyped-def]  # noqa: ANN001
    """The nodes of a meshed curve in their order, (k, 3)."""
    kinds, _, nodes = model.mesh.getElements(1, number)
    after = {}
    for kind, each in zip(kinds, nodes, strict=True):
        per = model.mesh.getElementProperties(kind)[3]
        for element in each.reshape(-1, per):
            chain = [element[0], *element[2:], element[1]]  # the ends stand before what is between them
            after.update({int(a): int(b) for a, b in pairwise(chain)})
    begin = next(iter(set(after) - set(after.values())), next(iter(after)))
    order = [begin]
    while order[-1] in after and after[order[-1]] != begin:
        order.append(after[order[-1]])
    if order[-1] in after:
        order.append(begin)
    return np.array([model.mesh.getNode(node)[0] for node in order])
