"""Stops within a load step: event functions of frozen rows, and their location.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
e        event function of a stop: f of an open stop, −μ of a closed stop; both are positive or zero
=======  ====================================================================================

A step is solved with the rows frozen.  Where e < 0 at the end of the step, Brent's method locates the first zero of e.
The step ends there, and the stop closes or opens.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from cprbm.equilibrium.contact_set import NotConvergedError
from cprbm.equilibrium.factors import Springs
from cprbm.equilibrium.solving import Solved, equilibrium
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array, Flags

TOUCHING = 1e-10
"""Event function, in rad or units of moment, below which an event has happened."""

LOCATED = 1e-12
"""Accuracy of the fraction of a step."""

STEPS = 60
"""Most states on which an event is located by slopes."""

CHANGES = 20
"""Changes of the stops after which their search ends."""


class StopChange(NamedTuple):
    """A stop's ``row`` closes or opens at a fraction ``share`` of a step."""

    share: float
    row: int


def event_values(solved: Solved, acting: Flags) -> Array:
    """e of all rows; infinite for all rows but acting stops."""
    values = np.where(solved.state.driven, -solved.state.multipliers(solved.system), solved.values)
    return np.where(solved.system.limits & acting, values, np.inf)


def first_event(
    before: Solved, after: Solved, acting: Flags, solve: Callable[[float, frozenset[int]], Solved]
) -> StopChange | None:
    """The first stop that closes or opens in a step; None without any.

    Args:
        before, after: the step.
        acting: which stops act.
        solve: state at a fraction of the step, with pairs kept open.
    """
    begin, end = event_values(before, acting), event_values(after, acting)

    def value(row: int, share: float) -> float:
        return float(event_values(solve(share, frozenset()), acting)[row])

    happened = np.flatnonzero(end < -TOUCHING).tolist()
    shares = [0.0 if begin[row] <= TOUCHING else located(partial(value, row)) for row in happened]
    return min((StopChange(*change) for change in zip(shares, happened, strict=True)), default=None)


def located(event: Callable[[float], float]) -> float:
    """Share of a step at which an event function vanishes."""
    from scipy.optimize import brentq  # steps without events load no optimisers

    return float(brentq(event, 0.0, 1.0, xtol=LOCATED))


def located_by_slopes(event: Callable[[float], tuple[float, float]], end: tuple[float, float]) -> float:
    """Share of a step at which an event function with a slope vanishes; ``end`` holds both at the end of the step.

    The share is the zero of the cubic through both ends of the bracket.  The bracket is halved after a state with more
    than half the least value so far.
    """
    low, high, halved = (0.0, *event(0.0)), (1.0, *end), False
    for _ in range(STEPS):
        known = np.isfinite((low, high)).all() and not halved
        share = _zero_of_cubic(low, high) if known else 0.5 * (low[0] + high[0])
        here = (share, *event(share))
        if here[1] == 0.0 or high[0] - low[0] < LOCATED:
            break
        halved = not halved and abs(here[1]) > 0.5 * min(abs(low[1]), abs(high[1]))
        low, high = (here, high) if (here[1] > 0.0) == (low[1] > 0.0) else (low, here)
    return share


def _zero_of_cubic(low: tuple[float, float, float], high: tuple[float, float, float]) -> float:
    """Share between two shares at which the cubic with their values and slopes vanishes."""
    (a, f, df), (b, g, dg) = low, high
    bend, turn = 3.0 * (g - f) - (b - a) * (2.0 * df + dg), 2.0 * (f - g) + (b - a) * (df + dg)
    return a + (b - a) * located(lambda x: f + x * ((b - a) * df + x * (bend + x * turn)))


def changed(state: State, row: int, system: System) -> State:
    """The state with a stop closed or opened."""
    driven, z = state.driven.copy(), state.z.copy()
    driven[row] = not driven[row]
    z[system.rows.first + row] = 0.0
    return replace(state, driven=driven, z=z)


def with_stops(system: System, state: State, acting: Flags, iterations: int, springs: Springs | None = None) -> Solved:
    """Equilibrium near a state with all stops within limits or pushing.

    Raises:
        NotConvergedError: no equilibrium was found.
    """
    for _ in range(CHANGES):
        solved = equilibrium(system, state, iterations, springs)
        values = event_values(solved, acting)
        worst = int(np.argmin(values)) if len(values) else 0
        if not len(values) or values[worst] >= -TOUCHING:
            return solved
        state = changed(solved.state, worst, system)
    raise NotConvergedError("the stops do not settle")
