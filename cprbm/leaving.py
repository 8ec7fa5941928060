"""Whether a branch has ended where no law says why: what the decrease of the energy leads to from its last state.

Where what lies flat lifts off, a contact's place goes from element to element, and the chain's equilibrium may cease at
a border between two while the smallest curvature is still positive: nothing goes to zero by which the end could be
foretold.  What tells it is that just beyond, under nearly the same loads, a motion with drag (:mod:`cprbm.leap`) leads
far away.  If there were an equilibrium near the last one, that is where it would come to rest.
"""

from __future__ import annotations

import numpy as np

from cprbm.critical import BranchEnd, Minimum
from cprbm.following import Way
from cprbm.kinematics import State, most_changed, most_turned
from cprbm.leap import Landed, leap
from cprbm.mechanism import Mechanism
from cprbm.point import Point, point_at
from cprbm.rate import carried_by_others, rate, strayed
from cprbm.settings import Settings
from cprbm.stability import softest
from cprbm_scene import Loss
from cprbm_scene.answer import Array

STEPS = 30  # of a motion that leads to a state beside: one that goes on for longer leads far away, or in circles
BESIDE = 0.3  # rad: a state in which links and bodies are turned by no more is beside another
ASTRAY = 2.0  # times that: what turns farther on the way there is followed no further
SAME = 0.1  # of what links turn by: states that are apart by less are one
NEAR = 1e-3  # of the value beyond: an end that is not known better than that is none


def aside(
    mechanism: Mechanism, settings: Settings, values: dict[str, float], start: Point, direction: Array
) -> Landed | None:
    """What :func:`cprbm.leap.leap` lands in, with its arguments, if that is beside ``start``; else None.

    None as well where as far to the other side there is another: which of them it comes to nothing says.
    """
    landed = leap(mechanism, settings, values, start, direction, STEPS, ASTRAY * BESIDE)
    if landed is None or most_changed(start.state, landed.point.state) > BESIDE:
        return None
    there, here = landed.point.state, start.state
    opposite = State(2.0 * here.theta - there.theta, 2.0 * here.bodies - there.bodies)
    point = point_at(mechanism.problem, values, opposite, start.mu, start.lam, start.rows)
    other = leap(mechanism, settings, values, point, np.zeros_like(direction), STEPS)
    apart = 0.0 if other is None else most_turned(there, other.point.state)
    return landed if apart <= SAME * most_turned(here, there) else None


def left(mechanism: Mechanism, settings: Settings, last: Minimum, way: Way) -> BranchEnd | Landed | None:
    """The fold between the ``last`` minimum, where a ``way`` begins, and where that leads to; None where none is told.

    Where the motion comes to rest no farther than a step may lead, and other rows press there than before, that is the
    state that Newton's method did not find.

    Args:
        mechanism, settings: what was followed.
        last: the last minimum on the branch.
        way: to the nearest values at which no minimum was found that continues the branch.
    """
    width = abs(way.value(1.0) - last.value)
    if width > NEAR * abs(way.value(1.0)):
        return None
    problem = mechanism.problem
    soft = softest(problem, last.point)
    landed = leap(mechanism, settings, way.at(1.0), last.point, soft.direction, STEPS)
    if landed is None:
        return None
    change = landed.point.state.theta - last.point.state.theta
    ways = [rate(problem, point, way.change) for point in (last.point, landed.point)]
    shifted = carried_by_others(problem.model, last.point, landed.point)
    if not strayed(problem.model.lengths, change, ways[0], ways[1], shifted):
        held = [point.rows.pressed(point.lam) for point in (last.point, landed.point)]
        return landed if held[0] != held[1] else None
    value = 0.5 * (last.value + way.value(1.0))
    far = most_changed(last.point.state, landed.point.state) > BESIDE
    return BranchEnd(value, width, Loss.FOLD, "", last.curvature, last.curvature, soft.direction, far)
