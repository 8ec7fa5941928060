"""Pins between bodies: two points that stay together, two equalities each.

======  ======================================================================================
p, q    the two points, on the body one and on the body other
r       from a body's reference place to its point, turned with it
Z_p     p − q
μ       multiplier; −μ is the force at p on the body one, μ that at q on the body other
======  ======================================================================================

    ∂p/∂(u, v, φ) = [I, J r]        (J turns by a right angle, counter-clockwise)

One of the two may be a point of the ground; the pin is a support then.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cprbm.holding import Held
from cprbm.kinematics import State, arm, place
from cprbm.model import Model, attached
from cprbm.posture import Linear, point_of
from cprbm.standing import Attachment
from cprbm_scene import Scene
from cprbm_scene.answer import Array


@dataclass(frozen=True, slots=True)
class Hinge:
    """A pin between two bodies: its ``points``, p and q; ``names`` are theirs."""

    names: tuple[str, str]
    points: tuple[Attachment, Attachment]

    def linear(self, model: Model) -> Linear:
        """Z_p, two numbers."""
        p, q = (point_of(point.body, point.point, model.references) for point in self.points)
        return p - q

    def rows(self, state: State) -> Iterator[tuple[int, Array]]:
        """∂Z_p over u, v, φ, (2, 3), of each body that moves."""
        for point, sign in self._moving():
            rx, ry = arm(point, state.bodies)
            yield point.body, sign * np.array([[1.0, 0.0, -ry], [0.0, 1.0, rx]])

    def held(self, model: Model, state: State, multipliers: Array) -> Iterator[Held]:
        """What the ground does to the other body, if one of the points is the ground's."""
        for name, point, sign in zip(self.names, self.points, (1.0, -1.0), strict=True):
            if point.body < 0:
                at = np.array(place(model, point, state.bodies))
                yield Held(name, at, sign * np.asarray(multipliers), 0.0)

    def _moving(self) -> Iterator[tuple[Attachment, float]]:
        for point, sign in zip(self.points, (1.0, -1.0), strict=True):
            if point.body >= 0:
                yield point, sign


def hinges_of(scene: Scene, model: Model) -> tuple[Hinge, ...]:
    """The scene's pins between bodies."""
    return tuple(
        Hinge(pin.points, (attached(scene, model, pin.points[0]), attached(scene, model, pin.points[1])))
        for pin in scene.pins.values()
    )
