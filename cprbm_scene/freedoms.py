"""Small motions of rigid bodies and beams as rows over the three freedoms of each part.

=======  ===============================================================================
symbol   meaning
=======  ===============================================================================
u, v, ω  small translations, and rotation times ℓ, of a part about the scene's origin
e        unit vector of a drive, a force or a guide
r        place of a point less the origin, m
ℓ        extent of all points, m: rows are pure numbers
=======  ===============================================================================

The displacement of a point along e is (e, r × e/ℓ)·(u, v, ω); a rotation is (0, 0, 1)·(u, v, ω).  All parts have the
same origin: parts with a common motion have common rows.  Rows state the geometry of the initial position.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.curves import unit_vector
from cprbm_scene.statement import (
    BodyLoad,
    Drive,
    FixedBody,
    FreeEnd,
    Moment,
    Point,
    RotationDrive,
    Scene,
    SlidingBody,
    TurningBody,
    WeldedEnd,
)

Row = NDArray[np.float64]
NEGLIGIBLE = 1e-9
"""Share of a row, or of a unit vector, that counts as round-off."""
DEPENDENT = 1.5 * NEGLIGIBLE
"""Part of a row of length one, normal to the rows before, that counts as round-off: rounded directions differ so."""

TURN = np.array([0.0, 0.0, 1.0])
AXES = ((1.0, 0.0), (0.0, 1.0))
unit = unit_vector


class Freedoms:
    """Rows of the parts of a scene; ``owners`` are the names of bodies by point.

    A row (3,) is that of a single part.  A wide row (3·parts,) has the freedoms of all bodies and then of all beams.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene, self.owners = scene, scene.owners
        self.places = {point: np.array(scene.bodies[name].points[point]) for point, name in self.owners.items()}
        self.origin = np.array(next(iter(next(iter(scene.bodies.values())).points.values())))
        self.extent = max(float(np.hypot(*(place - self.origin))) for place in self.places.values()) or 1.0
        self.parts = [*(f"bodies.{name}" for name in scene.bodies), *(f"beams.{name}" for name in scene.beams)]

    def along(self, point: str, direction: Point) -> Row:
        """Row of the displacement of a ``point`` along a direction."""
        e, (x, y) = unit(direction), (self.places[point] - self.origin) / self.extent
        return np.array([e[0], e[1], x * e[1] - y * e[0]])

    def guide(self, name: str) -> list[Row]:
        """Rows of the motions of a body without freedom: all of a fixed body, across a guide, of a pivot."""
        match self.scene.bodies[name]:
            case FixedBody():
                return list(np.eye(3))
            case SlidingBody() as body:
                across = self.along(body.pin or next(iter(body.points)), (-body.along[1], body.along[0]))
                return [across] if body.pin is not None else [across, TURN]
            case TurningBody(about=about):
                return [self.along(about, axis) for axis in AXES]
        return []

    def owner(self, acting: BodyLoad | Drive) -> str:
        """Name of the body of a load or drive."""
        return acting.body if isinstance(acting, Moment | RotationDrive) else self.owners[acting.point]

    def row(self, acting: BodyLoad | Drive) -> Row:
        """Row of the motion prescribed by a drive, or conjugate to a load."""
        return TURN if isinstance(acting, Moment | RotationDrive) else self.along(acting.point, acting.direction)

    def wide(self, rows: Mapping[str, Row]) -> Row:
        """Wide row of length one with the ``rows`` of parts."""
        row = np.concatenate([rows.get(part, np.zeros(3)) for part in self.parts])
        return np.asarray(row / np.linalg.norm(row))

    def constraints(self, drives: Container[str]) -> Iterator[tuple[str, Row]]:
        """Keys and wide rows of guides, pins and some ``drives``."""
        for name in self.scene.bodies:
            yield from ((f"bodies.{name}", self.wide({f"bodies.{name}": row})) for row in self.guide(name))
        for name, pin in self.scene.pins.items():
            for axis in AXES:
                one, other = ((f"bodies.{self.owners[point]}", self.along(point, axis)) for point in pin.points)
                yield f"pins.{name}", self.wide({one[0]: one[1], other[0]: -other[1]})
        for name, drive in self.scene.drives.items():
            if name in drives:
                yield f"drives.{name}", self.wide({f"bodies.{self.owner(drive)}": self.row(drive)})

    def joints(self) -> Iterator[Row]:
        """Wide rows of the beams' ends, with every beam as a rigid part."""
        for name, beam in self.scene.beams.items():
            for end in (beam.start, beam.end):
                if not isinstance(end, FreeEnd):
                    pinned = [self.along(end.point, axis) for axis in AXES]
                    for row in np.eye(3) if isinstance(end, WeldedEnd) else pinned:
                        yield self.wide({f"beams.{name}": row, f"bodies.{self.owners[end.point]}": -row})


def independent(rows: Sequence[Row]) -> list[bool]:
    """For every row, True if the row does not depend on the rows before: the Gram-Schmidt process, done twice."""
    basis, found = np.zeros((0, len(rows[0]) if rows else 0)), []
    for row in rows:
        rest = row / np.linalg.norm(row)
        for _ in range(2):
            rest = rest - basis.T @ (basis @ rest)
        found.append(bool(np.linalg.norm(rest) > DEPENDENT))
        basis = np.vstack((basis, rest / np.linalg.norm(rest))) if found[-1] else basis
    return found
