"""Stops: limits of the angle at which a beam stands at its pin, as rows beside those of the contacts.

======  ======================================================================================
θ_e     angle of the first or last link, which is the tangent at the beam's end; θ_e⁰ stress-free
φ       rotation of the body that the pin is on; zero for the ground
β       angle from the line between the body's two points to the beam as it leaves the pin, β₀ as drawn
β_l,u   its limits
c       β − β_u and β_l − β, both ≤ 0; λ is the moment by which the body holds the beam
======  ======================================================================================

    β = β₀ + (θ_e − θ_e⁰) − φ
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import atan2, pi, remainder, tau

import numpy as np

from cprbm.first_contact import Blocks, Group
from cprbm.kinematics import Positions, State
from cprbm.model import Model
from cprbm_scene import FreeEnd, Scene
from cprbm_scene.answer import Array, Ints

STRAIGHT = 1e-9  # rad: an angle so close to −π as drawn is π, which rounding turns into either


@dataclass(frozen=True, slots=True)
class AngleStop:
    """One stop.

    Attributes:
        name: of the stop.
        link: θ_e in the shared numbering.
        body: number of the free body of the pin; −1 for the ground.
        drawn: β₀ − θ_e⁰, rad.
        limits: those of β that there are, (m,), rad; signs: +1 for the most, −1 for the least.
        arc: where on the beam the pin is, units of length.
    """

    name: str
    link: int
    body: int
    drawn: float
    limits: Array
    signs: Array
    arc: float

    def angle(self, state: State) -> float:
        """β, rad."""
        turned = state.bodies[self.body, 2] if self.body >= 0 else 0.0
        return float(self.drawn + state.theta[self.link] - turned)

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The rows at a state; they are linear in the unknowns."""
        m = len(self.limits)
        numbers = [self.link] if self.body < 0 else [self.link, len(state.theta) + 3 * self.body + 2]
        angles = np.tile(np.array(numbers, dtype=np.intp), (m, 1))
        return (
            Group(
                contact=self.name,
                values=self.signs * (self.angle(state) - self.limits),
                joints=np.zeros((m, 0), dtype=np.intp),
                angles=angles,
                slopes=self.signs[:, None] * np.array([1.0, -1.0])[: len(numbers)],
                curvature=_straight(angles),
                keys=tuple(range(m)),
                arc=np.full(m, self.arc),
            ),
        )


def _straight(angles: Ints) -> Callable[[Array], Blocks]:
    """The second derivative of rows that have none."""
    none = Blocks(np.zeros((0, 0), dtype=np.intp), angles[:0], np.zeros((0, angles.shape[1], angles.shape[1])))
    return lambda multipliers: none


def stop_of(scene: Scene, model: Model, name: str) -> AngleStop:
    """One of the scene's stops."""
    stop = scene.stops[name]
    chain = model.chain(stop.beam)
    end = scene.beams[stop.beam].start if stop.end == "start" else scene.beams[stop.beam].end
    assert not isinstance(end, FreeEnd)
    owner = scene.body_of(end.point)
    (px, py), (qx, qy) = (scene.bodies[owner].points[point] for point in (end.point, stop.towards))
    length = chain.line.length
    # a beam leaves its start along its tangent, and its end against it
    arc, link, back = (0.0, chain.first_link, 0.0) if stop.end == "start" else (length, chain.first_link + chain.n, pi)
    leaves = float(chain.line.angle(np.array([arc]))[0]) + back
    beta = remainder(leaves - atan2(qy - py, qx - px), tau)
    beta += tau if beta < STRAIGHT - pi else 0.0
    limits = [(stop.most, 1.0), (stop.least, -1.0)]
    given = [(limit, sign) for limit, sign in limits if limit is not None]
    return AngleStop(
        name=name,
        link=link,
        body=model.free_bodies.index(owner) if owner in model.free_bodies else -1,
        drawn=beta - float(model.rest[link]),
        limits=np.array([limit for limit, _ in given]),
        signs=np.array([sign for _, sign in given]),
        arc=arc / model.unit_length,
    )
