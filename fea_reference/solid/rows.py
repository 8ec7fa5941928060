"""Constraints of bodies: pins between bodies, slides, pivots and drives, all as rows with a multiplier.

======  ===================================================================
symbol  meaning
======  ===================================================================
d, r    direction and arm of a share on one body; without d the share is φ
c       Σ d·(X + (R(φ) − I) r) − value, or Σ φ − value; for an assembled end + apart − value × way
μ       multiplier, added to the energy as μ c
======  ===================================================================
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import BodyPin, DisplacementDrive, Drive, Scene, SlidingBody, TurningBody
from fea_reference.solid.bodies import BodyPart, Tie, across, is_face_alone, turned


@dataclass(frozen=True, slots=True)
class Share:
    """A body's share in a row: ``direction`` d (2,) or None, ``arm`` r (2,)."""

    body: int
    direction: Array | None
    arm: Array


@dataclass(frozen=True, slots=True)
class Row:
    """A row: ``name`` of its origin, ``shares``, number of the multiplier, and the ``drive`` that steps the row.

    For an assembled end ``point`` is the target and ``apart`` the initial distance from the target along the row.
    ``way`` is the distance at the start of the motion.
    """

    name: str
    shares: tuple[Share, ...]
    multiplier: int
    drive: str | None = None
    point: str = ""
    apart: float = 0.0
    way: float = 1.0

    def violation(self, bodies: tuple[BodyPart, ...], z: Array) -> float:
        """c for the value zero."""
        value = self.apart
        for share in self.shares:
            body = bodies[share.body]
            value += (
                float(body.state(z)[2])
                if share.direction is None
                else float(share.direction @ body.motion(share.arm, z))
            )
        return value

    def gradient(self, bodies: tuple[BodyPart, ...], z: Array) -> tuple[Ints, Array]:
        """Unknowns (k,) and the derivatives (k,) of c."""
        dofs, slopes = [np.empty(0, dtype=np.intp)], [np.empty(0)]
        for share in self.shares:
            body = bodies[share.body]
            if body.dofs is None:
                continue
            d = share.direction
            dofs.append(body.dofs)
            slopes.append(
                np.array([0.0, 0.0, 1.0])
                if d is None
                else np.array([*d, d @ across(turned(share.arm, z[body.dofs[2]]))])
            )
        return np.concatenate(dofs), np.concatenate(slopes)

    def second(self, bodies: tuple[BodyPart, ...], z: Array) -> list[tuple[int, float]]:
        """Unknowns φ and ∂²c/∂φ², the only second derivatives."""
        return [
            (int(dofs[2]), -float(share.direction @ turned(share.arm, z[dofs[2]])))
            for share in self.shares
            if share.direction is not None and (dofs := bodies[share.body].dofs) is not None
        ]


def rows_of(scene: Scene, bodies: tuple[BodyPart, ...], first: int) -> tuple[Row, ...]:
    """A scene's rows, with multipliers from the unknown ``first`` on."""
    number = {body.name: i for i, body in enumerate(bodies)}
    parts: list[tuple[str, tuple[Share, ...], str | None]] = []
    for name, both in scene.pins.items():
        parts += _pin_rows(name, both, scene, bodies, number)
    for name, body in scene.bodies.items():
        i = number[name]
        if isinstance(body, SlidingBody):
            along = np.array(body.along) / np.hypot(*body.along)
            pin = np.zeros(2) if body.pin is None else bodies[i].arm(body.pin)
            parts.append((name, (Share(i, across(along), pin),), None))
            if body.pin is None:
                parts.append((name, (Share(i, None, pin),), None))
        elif isinstance(body, TurningBody):
            parts += [(name, (Share(i, direction, bodies[i].arm(body.about)),), None) for direction in np.eye(2)]
    parts += [(name, (_drive_share(drive, scene, bodies, number),), name) for name, drive in scene.drives.items()]
    return tuple(Row(name, shares, first + i, drive) for i, (name, shares, drive) in enumerate(parts))


def _pin_rows(
    name: str, both: BodyPin, scene: Scene, bodies: tuple[BodyPart, ...], number: dict[str, int]
) -> list[tuple[str, tuple[Share, ...], str | None]]:
    first, second = (number[scene.body_of(point)] for point in both.points)
    arms = bodies[first].arm(both.points[0]), bodies[second].arm(both.points[1])
    return [(name, (Share(first, e, arms[0]), Share(second, -e, arms[1])), None) for e in np.eye(2)]


def _drive_share(drive: Drive, scene: Scene, bodies: tuple[BodyPart, ...], number: dict[str, int]) -> Share:
    if isinstance(drive, DisplacementDrive):
        i = number[scene.body_of(drive.point)]
        return Share(i, np.array(drive.direction) / np.hypot(*drive.direction), bodies[i].arm(drive.point))
    return Share(number[drive.body], None, np.zeros(2))


def assembly_rows(
    scene: Scene, ties: Sequence[Tie], bodies: tuple[BodyPart, ...], number: Mapping[str, int], first: int, drive: str
) -> tuple[Row, ...]:
    """Pins of ends drawn apart from their points, stepped by ``drive``, with multipliers from ``first`` on."""
    rows: list[Row] = []
    for tie in ties:
        if not is_face_alone(tie, scene):
            continue
        other = number[scene.body_of(tie.point)]
        arm = bodies[other].arm(tie.point)
        apart = bodies[tie.body].centre - bodies[other].centre - arm
        for e in np.eye(2):
            shares = (Share(tie.body, e, np.zeros(2)), Share(other, -e, arm))
            rows.append(Row(tie.point, shares, first + len(rows), drive, tie.point, float(e @ apart)))
    return tuple(rows)
