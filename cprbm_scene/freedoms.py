"""Small motions of rigid bodies as rows over the three freedoms of a body; loads and drives along them.

=======  ===============================================================================
symbol   meaning
=======  ===============================================================================
u, v, ω  small translations, and rotation times ℓ, of a body about the scene's origin
e        unit vector of a drive, a force or a guide
r        place of a point less the origin, m
ℓ        extent of all points, m: rows are pure numbers
=======  ===============================================================================

The displacement of a point along e is (e, r × e/ℓ)·(u, v, ω); a rotation is (0, 0, 1)·(u, v, ω).  All bodies have the
same origin: bodies with a common motion have common rows.  Rows state the geometry of the initial position.


A load or drive acts on a movable body, along a motion that no guide and no other drive holds.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.curves import unit_vector
from cprbm_scene.mistakes import Mistake, broken
from cprbm_scene.statement import (
    BeamForce,
    BeamMoment,
    BodyLoad,
    DisplacementDrive,
    Drive,
    FixedBody,
    Force,
    Moment,
    PinnedEnd,
    Point,
    RotationDrive,
    Scene,
    SlidingBody,
    TurningBody,
)

Row = NDArray[np.float64]
NEGLIGIBLE = 1e-9
"""Share of a row, or of a unit vector, that counts as round-off."""

TURN = np.array([0.0, 0.0, 1.0])
AXES = ((1.0, 0.0), (0.0, 1.0))
unit = unit_vector


class Freedoms:
    """Rows (3,) of the bodies of a scene; ``owners`` are the names of bodies by point."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.owners = scene.owners
        self.places = {point: np.array(scene.place_of(point)) for point in self.owners}
        self.origin = np.array(next(iter(next(iter(scene.bodies.values())).points.values())))
        self.extent = max(float(np.hypot(*(place - self.origin))) for place in self.places.values()) or 1.0

    def along(self, point: str, direction: Point) -> Row:
        """Row of the displacement of a ``point`` along a direction."""
        e, (x, y) = unit(direction), (self.places[point] - self.origin) / self.extent
        return np.array([e[0], e[1], x * e[1] - y * e[0]])

    def guide(self, name: str) -> list[Row]:
        """Rows of the motions without freedom: all of a fixed body, across a guide, of a pivot."""
        match self.scene.bodies[name]:
            case FixedBody():
                return list(np.eye(3))
            case SlidingBody() as body:
                across = self.along(body.pin or next(iter(body.points)), (-body.along[1], body.along[0]))
                return [across] if body.pin is not None else [across, TURN]
            case TurningBody(about=about):
                return [self.along(about, axis) for axis in AXES]
            case _:
                return []

    def owner(self, acting: BodyLoad | Drive) -> str:
        """Name of the body of a load or drive."""
        return acting.body if isinstance(acting, Moment | RotationDrive) else self.owners[acting.point]

    def row(self, acting: BodyLoad | Drive) -> Row:
        """Row of the motion prescribed by a drive, or conjugate to a load."""
        if isinstance(acting, Moment | RotationDrive):
            return TURN
        return self.along(acting.point, acting.direction)


def rank(rows: Sequence[Row] | Row) -> int:
    """Number of independent rows."""
    return int(np.linalg.matrix_rank(np.array(rows), tol=NEGLIGIBLE)) if len(rows) else 0


def held(row: Row, rows: Sequence[Row]) -> bool:
    """True if ``row`` depends on ``rows``."""
    return rank([*rows, row / np.linalg.norm(row)]) == rank(rows)


def wrong_actions(scene: Scene) -> Iterator[Mistake]:
    """Loads and drives of fixed bodies or across guides, and motions with two drives or with a drive and a load."""
    if not any(body.points for body in scene.bodies.values()):
        return
    freedoms = Freedoms(scene)
    driven: dict[str, dict[str, Row]] = {}
    drives = {f"drives.{name}": drive for name, drive in scene.drives.items()}
    loads = {f"loads.{name}": load for name, load in scene.loads.items() if isinstance(load, BodyLoad)}
    for key, acting in (drives | loads).items():
        known = scene.bodies if isinstance(acting, Moment | RotationDrive) else freedoms.owners
        named = acting.body if isinstance(acting, Moment | RotationDrive) else acting.point
        if named not in known or any(acting.rules()):
            continue
        owner = freedoms.owner(acting)
        mistakes = list(_without_freedom(freedoms, key, acting))
        if not mistakes and not any(scene.bodies[owner].rules()):
            mistakes = list(_driven_already(freedoms, key, acting, driven.setdefault(owner, {})))
            if not mistakes and key in drives:
                driven[owner][key] = freedoms.row(acting)
        yield from mistakes
    for name, load in scene.loads.items():
        if isinstance(load, BeamForce | BeamMoment):
            yield from _held_end(scene, name, load)


def _without_freedom(freedoms: Freedoms, key: str, acting: BodyLoad | Drive) -> Iterator[Mistake]:
    """The mistake of a fixed body, or of a motion that a guide holds."""
    scene, owner = freedoms.scene, freedoms.owner(acting)
    body = scene.bodies[owner]
    turns = isinstance(acting, Moment | RotationDrive)
    place, direction = ("body", "body") if turns else ("point", "direction")
    what = "a drive of" if isinstance(acting, RotationDrive) else "a moment on"
    if isinstance(acting, Force | DisplacementDrive):
        what = f"{'a force' if isinstance(acting, Force) else 'a drive'} at {acting.point!r}, a point of"
    guide = "towards the pivot" if isinstance(body, TurningBody) else "across the slide"
    turning = f"the rotation of {owner!r}, which slides and does not turn"
    across = turning if turns else f"a direction {guide} of {owner!r}"
    allowed = "a body that can turn" if turns else "a direction along which the point can move"
    movable = {name: each.points for name, each in scene.bodies.items() if each.motion != "fixed"}
    names = movable if turns else [point for points in movable.values() for point in points]
    can_move = f"a {place} that can move: {', '.join(map(repr, names)) or 'there is none'}"
    fixed = body.motion == "fixed"
    held_by_guide = not fixed and not any(body.rules()) and held(freedoms.row(acting), freedoms.guide(owner))
    return broken(
        (fixed, f"{key}.{place}", f"{what} the fixed body {owner!r}", can_move),
        (held_by_guide, f"{key}.{direction}", across, allowed),
    )


def _driven_already(
    freedoms: Freedoms, key: str, acting: BodyLoad | Drive, driven: dict[str, Row]
) -> Iterator[Mistake]:
    """The mistake of a motion that earlier drives of the body hold, of loads only by drives from the start on."""
    row, owner, load = freedoms.row(acting), freedoms.owner(acting), isinstance(acting, BodyLoad)
    drives = {name: freedoms.scene.drives[name.removeprefix("drives.")] for name in driven}
    drives = {name: drive for name, drive in drives.items() if drive.begins is None or not load}
    opposed = [name for name, drive in drives.items() if _opposed(freedoms, acting, drive)]
    twice = bool(opposed) or held(row, [*freedoms.guide(owner), *(driven[name] for name in drives)])
    first = " and ".join(opposed or drives)
    return broken(
        (
            twice and load,
            key,
            f"a load on a freedom of {owner!r} that is driven by {first}",
            "a load or a drive on one freedom, not both",
        ),
        (
            twice and not load,
            key,
            f"a freedom of {owner!r} that is driven already by {first}",
            "one drive for each freedom",
        ),
    )


def _held_end(scene: Scene, name: str, load: BeamForce | BeamMoment) -> Iterator[Mistake]:
    """A load at an end of a beam on a fixed body; under a moment a pinned end turns."""
    if load.beam not in scene.beams or load.at not in (0.0, 1.0):
        return iter(())
    end = scene.beams[load.beam].start if load.at == 0.0 else scene.beams[load.beam].end
    fixed = {point for body in scene.bodies.values() if body.motion == "fixed" for point in body.points}
    turns, point = isinstance(load, BeamMoment) and isinstance(end, PinnedEnd), end.point
    found = f"{load.at:g}, an end of {load.beam!r} that is held at {point!r}, a point of a fixed body"
    return broken((not turns and point in fixed, f"loads.{name}.at", found, "a place of the beam that can move"))


def _opposed(freedoms: Freedoms, load: BodyLoad | Drive, drive: Drive) -> bool:
    """True for a force at the place of a driven displacement, with a component along the displacement."""
    if not isinstance(load, Force) or isinstance(drive, RotationDrive):
        return False
    apart = freedoms.places[load.point] - freedoms.places[drive.point]
    component = abs(float(unit(load.direction) @ unit(drive.direction)))
    return float(abs(apart).max()) <= NEGLIGIBLE * freedoms.extent and component > NEGLIGIBLE
