"""Small motions of rigid bodies as rows over the three freedoms of a body.

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
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.curves import unit_vector
from cprbm_scene.statement import (
    BodyLoad,
    Drive,
    FixedBody,
    Moment,
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
