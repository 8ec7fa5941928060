"""What holds a body beside its beams: slides, pivots and drives, one equality each.

======  ======================================================================================
e, r    direction; the held point on the body, from its reference place
Z_h     e·((u, v) + (R(φ) − 1) r) + τ φ − q: a displacement along e (τ = 0), or φ (e = 0, τ = 1)
q       value of the drive; zero for a slide or a pivot
μ       multiplier; −μ e and −μ τ are the force at the point and the moment on the body
======  ======================================================================================

A slide is two of them: none across its direction, and no rotation; a pin in a slot is the first alone, of the pin.  A
pivot is two: its point stays where it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.kinematics import State, arm
from cprbm.model import Model, attached
from cprbm.posture import Linear, point_of, turn_of
from cprbm.standing import Attachment
from cprbm_scene import Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import DisplacementDrive, SlidingBody, TurningBody


@dataclass(frozen=True, slots=True)
class Hold:
    """One equality on a body that moves.

    Attributes:
        drive: the drive's name, or that of the point which is a pivot, or of the body that slides; empty for what keeps
            that from turning.
        at: r and the body.
        along: e, a unit vector or zero.
        turn: τ, one or zero.
        unit: q per unit (SI) of the drive's value.
    """

    drive: str
    at: Attachment
    along: tuple[float, float]
    turn: float
    unit: float

    def linear(self, model: Model) -> Linear:
        """Z_h with the drive at zero, one number."""
        point = point_of(self.at.body, self.at.point, model.references)
        moved = np.array([self.along]) @ point.over
        return Linear(np.zeros(1), moved + self.turn * turn_of(self.at.body, model.n_bodies))

    def row(self, state: State) -> tuple[float, float, float]:
        """∂Z_h over the body's u, v, φ."""
        rx, ry = arm(self.at, state.bodies)
        ex, ey = self.along
        return ex, ey, rx * ey - ry * ex + self.turn


@dataclass(frozen=True, slots=True)
class Held:
    """What a slide, pivot or drive does to a body: ``force`` (2,) at ``place`` (2,), ``moment``; without units."""

    drive: str
    place: Array
    force: Array
    moment: float


def holds_of(scene: Scene, model: Model) -> tuple[Hold, ...]:
    """The scene's slides, pivots and drives."""
    found = []
    for name, body in scene.bodies.items():
        if isinstance(body, SlidingBody):
            body_itself = Attachment(model.free_bodies.index(name), (0.0, 0.0), welded=False)
            ex, ey = _unit(body.along)
            guided = body_itself if body.pin is None else attached(scene, model, body.pin)
            found.append(Hold(name, guided, (-ey, ex), 0.0, 0.0))
            if body.pin is None:
                found.append(Hold("", body_itself, (0.0, 0.0), 1.0, 0.0))
        elif isinstance(body, TurningBody):
            found += [
                Hold(body.about, attached(scene, model, body.about), axis, 0.0, 0.0)
                for axis in ((1.0, 0.0), (0.0, 1.0))
            ]
    for name, drive in scene.drives.items():
        if isinstance(drive, DisplacementDrive):
            found.append(
                Hold(name, attached(scene, model, drive.point), _unit(drive.direction), 0.0, 1.0 / model.unit_length)
            )
        else:
            driven = Attachment(model.free_bodies.index(drive.body), (0.0, 0.0), welded=False)
            found.append(Hold(name, driven, (0.0, 0.0), 1.0, 1.0))
    return tuple(found)


def held(model: Model, holds: tuple[Hold, ...], state: State, multipliers: Array) -> tuple[Held, ...]:
    """What slides and drives do, from their ``multipliers`` (holds,)."""
    found = []
    for hold, mu in zip(holds, multipliers, strict=True):
        b = hold.at.body
        place = model.references[b] + state.bodies[b, :2] + arm(hold.at, state.bodies)
        found.append(Held(hold.drive, place, -mu * np.array(hold.along), float(-mu * hold.turn)))
    return tuple(found)


def _unit(direction: tuple[float, float]) -> tuple[float, float]:
    size = np.hypot(*direction)
    return float(direction[0] / size), float(direction[1] / size)
