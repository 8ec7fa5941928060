"""Whether the branch goes from one equilibrium to another: it is looked for half-way between them.

==========  ==============================================================================
θ_0, θ_1    link angles at both ends of a load step
w_0, w_1    the ways that the rates there make of the step, :mod:`cprbm.rate`
θ_m         (θ_0 + θ_1)/2 + (w_0 − w_1)/8, the middle of the cubic through both
Δ           Newton's step from there, under loads and drives half-way between
==========  ==============================================================================

On one branch the cubic is the branch but for a small part of the step, and Δ is that part.  Where a rate makes far more
of the step than it is, there is no such cubic.
"""

from __future__ import annotations

import numpy as np

from cprbm.kinematics import State
from cprbm.newton import newton_step
from cprbm.point import Point, Problem, point_at
from cprbm_scene.answer import Array

EVEN = 0.25  # of the step, by which it may differ from what the rates at both ends make of it: no more need be known
ASIDE = 0.1  # of the step, by which the branch may be beside the cubic half-way
STEEP = 3.0  # a cubic whose ends are no steeper than so many times its chord goes one way only


def uneven(lengths: Array, change: Array, start: Array, end: Array, shifted: float) -> bool:
    """Whether a step is not the mean of what the rates make of it, so that it must be looked for half-way.

    Args:
        lengths: of the links, the metric; (n_links,) as all others.
        change: θ_1 − θ_0.
        start, end: w_0 and w_1.
        shifted: rad, by which links may turn besides.
    """
    left = change - 0.5 * (start + end)
    allowed = max(EVEN**2 * float(lengths @ change**2), shifted**2 * float(np.sum(lengths)))
    return float(lengths @ left**2) > allowed


def doubt(problem: Problem, values: dict[str, float], before: Point, after: Point, start: Array, end: Array) -> float:
    """How doubtful it is that the branch goes from one equilibrium to another; no more than one is believed.

    Args:
        problem: of which both are equilibria.
        values: of loads and drives half-way (SI).
        before, after: the equilibria.
        start, end: w_0 and w_1 (n_links,).
    """
    lengths, fixed = problem.model.lengths, problem.closure.fixed
    size, first, last = (
        float(np.sqrt(lengths @ way**2)) for way in (after.state.theta - before.state.theta, start, end)
    )
    steep = max(first, last) / (STEEP * size)
    if steep > 1.0:
        return steep
    theta = 0.5 * (before.state.theta + after.state.theta) + 0.125 * (start - end)
    theta[fixed] = problem.model.rest[fixed]
    state = State(theta, 0.5 * (before.state.bodies + after.state.bodies))
    guess = point_at(problem, values, state, 0.5 * (before.mu + after.mu), after.lam, after.rows)
    try:
        step, _, _ = newton_step(problem, guess)
    except np.linalg.LinAlgError:
        return np.inf
    return float(np.sqrt(lengths @ step[: problem.model.n_links] ** 2)) / (ASIDE * size)
