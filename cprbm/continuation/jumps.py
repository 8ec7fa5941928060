"""The test for a step to another branch of minima.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
Δθ       turns of the links in a step
τ₀, τ₁   tangents dθ of the step at both ends
Π₀′, Π₁′ power of the step at both ends; Π″ their rates
=======  ====================================================================================

On a single branch Δθ is near the mean of both tangents, and the change of Π near Hermite's quadrature
(Π₀′ + Π₁′)/2 + (Π₀″ − Π₁″)/12.  Steps on a single branch reached 0.43 and 0.18 in all
built-in cases, steps to another branch 0.69 and 0.23 at least: either test is enough for an alarm.
"""

from __future__ import annotations

import numpy as np

from cprbm.continuation.closing import pressing_joints, touches
from cprbm.continuation.path import potential, power, power_rate, tangent
from cprbm.equilibrium.solving import Solved
from cprbm_scene.answer import Array

BENT = 0.5
"""Largest distance of the turns from the mean of both tangents, over the largest turn."""

MISSED = 0.25
"""Largest error of the quadrature, over half the change of the power in the step."""

OUTSIDE = 1.1
"""Largest distance of the mean power of a step from the mean of both ends, over half the change, with one tangent."""

SMALLEST_TURN = 1e-4
"""Turn in a step, rad, below which tangents are not compared: such a step cannot lead to another branch."""

SMALLEST_WORK = 1e-9
"""Power, and its change over the power, below which the energy is not compared: round-off of its sum is near."""


def jumped(before: Solved, after: Solved, change: Array) -> bool:
    """True if a step between two minima, with a ``change`` of the targets, left the branch.

    Where open places touch at the first state, the tangent there is one-sided.  Where all places are joints and other
    joints press at the end, the tangent has changed at every exchange of joints.  Then only the energy tells.
    """
    system = before.system
    rates = tangent(before, change), tangent(after, change)
    angles = system.angles
    turn = after.state.z[angles] - before.state.z[angles]
    largest = float(np.abs(turn).max())
    mean = 0.5 * (rates[0][angles] + rates[1][angles])
    one_sided = touches(before) or pressing_joints(before) != pressing_joints(after)
    if (
        not one_sided
        and max(largest, float(np.abs(mean).max())) > SMALLEST_TURN
        and float(np.abs(turn - mean).max()) > BENT * largest
    ):
        return True
    powers = power(before, change), power(after, change)
    scale, spread = max(abs(powers[0]), abs(powers[1])), abs(powers[1] - powers[0])
    if scale < SMALLEST_WORK or spread < SMALLEST_WORK * scale or largest < SMALLEST_TURN:
        return False
    curved = power_rate(before, change, rates[0]) - power_rate(after, change, rates[1])
    gained = potential(system, after.state) - potential(system, before.state)
    missed = gained - 0.5 * (powers[0] + powers[1])
    return abs(missed) > OUTSIDE * 0.5 * spread if one_sided else abs(missed - curved / 12.0) > MISSED * 0.5 * spread
