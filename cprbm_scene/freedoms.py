"""Which motions of a rigid body slides, drives and loads act on: one row each over the body's three freedoms.

=======  ==================================================================================
symbol   meaning
=======  ==================================================================================
u, v, ω  small translations, and rotation times ℓ, of what is rigid, about the scene's origin
e        unit vector of a drive, a force or a slide
r        place of a driven or loaded point, or of a pivot, less the origin, m
ℓ        extent of all points, m: makes a row a pure number
=======  ==================================================================================

A point's displacement along e is (e, r × e / ℓ)·(u, v, ω); a rotation is (0, 0, 1)·(u, v, ω).  The origin is one
for all bodies, so that bodies which move together have rows in common.  This is the initial position's geometry
and no mechanics: it says which questions make sense.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.statement import (
    Body,
    BodyLoad,
    BodyPin,
    Drive,
    Force,
    Moment,
    Point,
    RotationDrive,
    Scene,
    SlidingBody,
    TurningBody,
)

Row = NDArray[np.float64]
NEGLIGIBLE = 1e-9
"""Share of a row (or of a unit vector) that is round-off."""

_TURN = np.array([0.0, 0.0, 1.0])


def unit(direction: Point) -> Row:
    """The unit vector (2,) of a direction that is not zero."""
    e = np.array(direction) / max(abs(direction[0]), abs(direction[1]))
    return np.asarray(e / np.hypot(e[0], e[1]))


def row_of(scene: Scene, acting: BodyLoad | Drive) -> Row:
    """The motion (3,) that a drive prescribes or that a load does work in, its direction not zero.

    Raises:
        KeyError: its point does not exist.
    """
    if isinstance(acting, Moment | RotationDrive):
        return _TURN
    x, y = _offsets(scene)[body_of(scene, acting), acting.point]
    e = unit(acting.direction)
    return np.array([e[0], e[1], x * e[1] - y * e[0]])


def guide_rows(scene: Scene, name: str) -> list[Row]:
    """The motions that a slide or a pivot prevents of the body of a ``name``; none where it has no guide.

    A slide has a direction, and a pivot or a pin in a slot a point of the body.
    """
    body = scene.bodies[name]
    if isinstance(body, SlidingBody):
        e = unit(body.along)
        if body.pin is None:
            return [np.array([-e[1], e[0], 0.0]), _TURN]
        x, y = _offsets(scene)[name, body.pin]
        return [np.array([-e[1], e[0], x * e[0] + y * e[1]])]
    if isinstance(body, TurningBody):
        x, y = _offsets(scene)[name, body.about]
        return [np.array([1.0, 0.0, -y]), np.array([0.0, 1.0, x])]
    return []


def pin_rows(scene: Scene, pin: BodyPin) -> dict[str, list[Row]]:
    """What a pin makes vanish: for each of its two bodies its part of the two rows.

    Raises:
        KeyError: one of its points does not exist.
    """
    rows = {}
    for point, sign in zip(pin.points, (1.0, -1.0), strict=True):
        name = scene.body_of(point)
        x, y = _offsets(scene)[name, point]
        rows[name] = [sign * np.array([1.0, 0.0, -y]), sign * np.array([0.0, 1.0, x])]
    return rows


def has_guide(scene: Scene, name: str) -> bool:
    """Whether a slide's direction and a pivot's or pin's point are stated, if the body of a ``name`` has them."""
    body = scene.bodies[name]
    if isinstance(body, TurningBody):
        return body.about in body.points
    if isinstance(body, SlidingBody):
        return body.along != (0.0, 0.0) and (body.pin is None or body.pin in body.points)
    return True


def can_turn(body: Body) -> bool:
    """Whether nothing but beams and drives keeps a body from turning."""
    return body.motion in ("free", "turns") or (isinstance(body, SlidingBody) and body.turns)


def body_of(scene: Scene, acting: BodyLoad | Drive) -> str:
    """Name of the body that a load or drive acts on.

    Raises:
        KeyError: its point does not exist.
    """
    return acting.body if isinstance(acting, Moment | RotationDrive) else scene.body_of(acting.point)


def rank(rows: Sequence[Row]) -> int:
    """Number of independent rows."""
    return int(np.linalg.matrix_rank(np.array(rows), tol=NEGLIGIBLE)) if rows else 0


def held(row: Row, rows: Sequence[Row]) -> bool:
    """Whether ``rows`` already prescribe the motion of ``row``."""
    return rank([*rows, row / np.linalg.norm(row)]) == rank(rows)


def is_stated(scene: Scene, acting: BodyLoad | Drive) -> bool:
    """Whether a load or drive names what exists and has a direction: nothing else can be said of it otherwise."""
    return is_named(scene, acting) and (isinstance(acting, Moment | RotationDrive) or acting.direction != (0.0, 0.0))


def is_named(scene: Scene, acting: BodyLoad | Drive) -> bool:
    """Whether the body or point that a load or drive acts on exists."""
    if isinstance(acting, Moment | RotationDrive):
        return acting.body in scene.bodies
    return any(acting.point in body.points for body in scene.bodies.values())


def same_point(scene: Scene, load: BodyLoad, drive: Drive) -> bool:
    """Whether a force acts where a displacement is driven, and along it in part."""
    if not isinstance(load, Force) or isinstance(drive, RotationDrive):
        return False
    if body_of(scene, load) != body_of(scene, drive):
        return False
    offsets, owner = _offsets(scene), body_of(scene, load)
    apart = np.hypot(*(offsets[owner, load.point] - offsets[owner, drive.point]))
    along = abs(float(unit(load.direction) @ unit(drive.direction)))
    return bool(apart <= NEGLIGIBLE) and along > NEGLIGIBLE


def _offsets(scene: Scene) -> dict[tuple[str, str], Row]:
    """r/ℓ (2,) of every body's points."""
    names = [(name, point) for name, body in scene.bodies.items() for point in body.points]
    places = np.array([scene.bodies[name].points[point] for name, point in names])
    origin, extent = frame(scene)
    # first to order one, so that no length is too large or too small to be squared
    size = float(np.max(np.abs(places))) or 1.0
    return dict(zip(names, (places / size - origin / size) / (extent / size), strict=True))


def frame(scene: Scene) -> tuple[Row, float]:
    """The origin (2,) that bodies turn about, m, and ℓ."""
    places = np.array([place for body in scene.bodies.values() for place in body.points.values()])
    size = float(np.max(np.abs(places))) or 1.0
    away = (places - places[0]) / size
    return places[0], size * (float(np.max(np.hypot(away[:, 0], away[:, 1]))) or 1.0)
