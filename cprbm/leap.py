"""From where a branch ends to the state that the decrease of the energy leads to.

==========  ==========================================================================
E           potential energy at the fixed values of loads and drives
θ_k         link angles after k steps
L, η        links' lengths; drag
==========  ==========================================================================

A mechanism that is no longer held moves slowly where it is damped: η L dθ/dt = −∂E/∂θ, contacts and stops acting.
Euler's implicit step is itself a minimum,

    θ_{k+1} = argmin E(θ) + ½ η Σ L (θ − θ_k)²,    so that    E(θ_{k+1}) ≤ E(θ_k),

and with η larger than the curvature that was lost a convex one.  The drag falls as the motion slows, and vanishes in
the minimum in which it ends.  Beyond a fold, where curvature falls evenly along the way, a step needs twice as much
drag as the curvature is negative, or it leads out of the reach of Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cprbm.certifying import certify
from cprbm.first_equilibrium import Equilibrium, equilibrium
from cprbm.kinematics import State, most_turned
from cprbm.mechanism import Mechanism
from cprbm.point import Drag, Point, point_at, point_under, potential_energy
from cprbm.settings import Settings
from cprbm.stability import softest
from cprbm_scene import Certificate, Ending
from cprbm_scene.answer import Array

FIRST = 10.0  # η of the first step, S/ℓ³: some curvatures of a straight beam
MOST = 1e7  # η beyond which nothing moves any more
NUDGE = 1e-3  # rad, out of a state that is in equilibrium still
STEP = 0.3  # rad: the most that a link turns by in a step
SLOW = 0.1  # rad: a step of less lets the drag fall
STILL = 0.02  # rad: after such a step it is seen whether there is a minimum near by
EASED, RAISED = 0.4, 4.0
CONVEX = 2.5  # times a negative curvature: the least drag that is tried
FIRMER, SOFTER = 1.6, 0.9  # of that, after a step that failed, and after one that did not
STEPS = 400  # at most, to where a leap ends
ROUNDED = 1e-10  # of the energy


@dataclass(frozen=True, slots=True)
class Landed:
    """The minimum in which a leap ends, and its certificate."""

    point: Point
    certificate: Certificate


def leap(
    mechanism: Mechanism,
    settings: Settings,
    values: dict[str, float],
    start: Point,
    direction: Array,
    steps: int = STEPS,
    farthest: float = np.inf,
) -> Landed | None:
    """Go down from ``start``, which is about in equilibrium, to a certified minimum; None where none is found.

    Args:
        mechanism, settings: what is solved.
        values: of all loads and drives (SI), just beyond those at which the branch ended.
        start: the branch's last state.
        direction: of the curvature that was lost, (n_links,); of its two senses the one that leads lower is taken.
        steps: at most so many.
        farthest: rad; where a link has turned by more, the motion is followed no further.
    """
    nudge = NUDGE * direction / max(float(np.max(np.abs(direction))), 1e-300)
    nudged = [_nudged(mechanism, values, start, way) for way in (nudge, -nudge)]
    tried = [
        # a nudge is longer than thin beams are thick
        _step(mechanism, settings, values, one, FIRST) if not mechanism.passed(start, one) else None
        for one in nudged
    ]
    begun = [one for one in tried if one is not None]
    point = min(begun, key=lambda one: potential_energy(mechanism.problem, one)) if begun else start
    strength, convex = FIRST, CONVEX
    soft = _falling(mechanism, point)
    for _ in range(steps):
        strength = max(strength, convex * soft)
        ahead = _step(mechanism, settings, values, point, strength)
        if ahead is None:
            little = strength < RAISED * CONVEX * soft
            strength *= FIRMER if little else RAISED
            convex = max(convex, strength / soft) if little else convex
            if strength > MOST:
                return None
            continue
        turned = most_turned(point.state, ahead.state)
        point = ahead
        if most_turned(start.state, point.state) > farthest:
            return None
        soft, convex = _falling(mechanism, point), max(SOFTER * convex, CONVEX)
        still = turned < STILL and soft == 0.0
        if still and (landed := _landed(mechanism, settings, values, point)) is not None:
            return landed
        if turned < SLOW:
            strength *= EASED
    return None


def _falling(mechanism: Mechanism, point: Point) -> float:
    """By how much the smallest curvature is negative."""
    curvature = softest(mechanism.problem, point).curvature
    return max(-curvature, 0.0) if np.isfinite(curvature) else 0.0


def _nudged(mechanism: Mechanism, values: dict[str, float], start: Point, way: Array) -> Point:
    state = State(start.state.theta + way, start.state.bodies)
    return point_at(mechanism.problem, values, state, start.mu, start.lam, start.rows)


def _step(
    mechanism: Mechanism, settings: Settings, values: dict[str, float], point: Point, strength: float
) -> Point | None:
    """One step with the drag ``strength``; None where it is too long, goes through something or up."""
    slowed = replace(mechanism.problem, drag=Drag(point.state.theta, strength))
    found = equilibrium(slowed, values, point, settings.tolerance, settings.iterations, settle=True)
    if (
        not found.converged
        or most_turned(point.state, found.point.state) > STEP
        or mechanism.passed(point, found.point)
    ):
        return None
    # as the energy of the problem without drag has it
    return _undragged(mechanism, values, found)


def _undragged(mechanism: Mechanism, values: dict[str, float], found: Equilibrium) -> Point:
    return point_under(mechanism.problem, values, found.point)


def _landed(mechanism: Mechanism, settings: Settings, values: dict[str, float], point: Point) -> Landed | None:
    """The certified minimum near a state, if there is one and it is not higher."""
    problem, most = mechanism.problem, settings.iterations
    found = equilibrium(problem, values, point, settings.tolerance, most, settle=True, farthest=STEP)
    certificate, ending = certify(mechanism, settings, found)
    if (
        ending is not Ending.COMPLETED
        or most_turned(point.state, found.point.state) > STEP
        or mechanism.passed(point, found.point)
    ):
        return None
    before, after = (potential_energy(problem, each) for each in (point, found.point))
    return Landed(found.point, certificate) if after <= before + ROUNDED * abs(before) else None
