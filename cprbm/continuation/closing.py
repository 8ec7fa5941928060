"""Stops and contacts that close or open within a load step, and their location.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
e        event function of a stop: f of an open stop, −μ of a closed stop; both are positive or zero
g        least gap of an open pair of curves
F        sum of the contact forces of a closed pair
=======  ====================================================================================

A step is solved with the rows frozen.  Where e < 0 at the end of the step, Brent's method locates the first zero of e.
The step ends there, and the stop closes or opens.

Pairs that are open at the begin of a step stay open in the step.  The gap of a pair may be least between two joints;
a moving place without a force finds the minimum.  Where g < 0 at the end, the first closing is located by values and
slopes of g along the tangent: g = −CLOSED there, so that the active set closes the pair in the least gap.  A gap that
jumps has no zero, and the step is too long, as after a passage over an end.  An opening is the zero of F, continued by
−g where the pair is open.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from cprbm.contact import TOUCHING, Geometry, Places, sweeps_any_point, taken, touching_as_drawn
from cprbm.continuation.path import SMALLEST_TURN, tangent, turned
from cprbm.equilibrium import (
    NotConvergedError,
    Solved,
    Springs,
    State,
    System,
    equilibrium,
    gap_rates,
    with_fixed_places,
    with_minima,
)
from cprbm_scene.answer import Array, Flags

HAPPENED = 1e-10
"""Event function, in rad or units of moment, below which an event has happened."""

ACCURACY = 1e-12
"""Accuracy of the fraction of a step."""

TOGETHER = 1e-6
"""Part of a step in which two changes are a single change, as in a symmetric mechanism, or a change and the end."""

STEPS = 60
"""Most states on which an event is located by slopes."""

CHANGES = 20
"""Changes of the stops after which their search ends."""

CLOSED = 1e-11
"""Overlap, over the longest beam, of a contact at the closing: ten times the active set's round-off."""


LOCATED = 0.5
"""Accuracy of the overlap at a closing, over ``CLOSED``."""

RELEASED = 1e-9
"""Force of an opening contact, over the force at the begin of the step, that counts as none."""

LET_GO = 0.1
"""Force of an opening contact, over the force at the begin of the step: a larger force jumps to zero."""


class Change(NamedTuple):
    """A stop's ``row``, or the ``pairs`` of a contact, close or open at a fraction ``share`` of a step.

    The pair ``first`` closes exactly there.  A closing pair overlaps at the ``share`` of the state, and touches earlier
    by the part ``early`` of the step.
    """

    share: float
    row: int = -1
    pairs: frozenset[int] = frozenset()
    closes: bool = False
    first: int = -1
    early: float = 0.0


def event_values(solved: Solved, acting: Flags) -> Array:
    """e of all rows; infinite for all rows but acting stops."""
    values = np.where(solved.state.driven, -solved.state.multipliers(solved.system), solved.values)
    return np.where(solved.system.limits & acting, values, np.inf)


def stop_changes(before: Solved, after: Solved, acting: Flags, solve: Callable[[float], Solved]) -> list[Change]:
    """Stops that close or open in a step.

    Args:
        before, after: the step.
        acting: which stops act.
        solve: state at a fraction of the step.
    """
    begin, end = event_values(before, acting), event_values(after, acting)
    happened = np.flatnonzero(end < -HAPPENED).tolist()
    values = ((row, lambda share, row=row: float(event_values(solve(share), acting)[row])) for row in happened)
    shares = [0.0 if begin[row] <= HAPPENED else located(value) for row, value in values]
    return [Change(*change) for change in zip(shares, happened, strict=True)]


def located(event: Callable[[float], float]) -> float:
    """Share of a step at which an event function vanishes."""
    from scipy.optimize import brentq  # steps without events load no optimisers

    return float(brentq(event, 0.0, 1.0, xtol=ACCURACY))


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
        if here[1] == 0.0 or high[0] - low[0] < ACCURACY:
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
        if values.min(initial=0.0) >= -HAPPENED:
            return solved
        state = changed(solved.state, int(np.argmin(values)), system)
    raise NotConvergedError("the stops do not settle")


def nearest_place(geometry: Geometry, state: State, pair: int) -> tuple[float, Places, Flags]:
    """Least gap of an open pair, between joints too, all places, and the mark of the nearest.

    The gap is inf, and no place is marked, if the curves are far apart.
    """
    full = with_fixed_places(geometry, state.z, state.contacts)
    settled, gaps, _ = full.settled(geometry, state.z)
    places, gaps = with_minima(geometry, state.z, replace(full, places=settled), gaps, [pair])
    gaps = np.append(np.where(places.pair == pair, gaps, np.inf), np.inf)
    nearest = (np.arange(len(gaps)) == np.argmin(gaps)) & np.isfinite(gaps)
    return float(gaps.min()), places, nearest[:-1]


def apart_pairs(solved: Solved, pairs: frozenset[int]) -> frozenset[int]:
    """The pairs whose curves do not touch."""
    return frozenset(pair for pair in pairs if nearest_place(solved.system.geometry, solved.state, pair)[0] > TOUCHING)


def pressing(solved: Solved) -> frozenset[int]:
    """Numbers of the closed pairs."""
    return frozenset(taken(solved.state.contacts.places, solved.state.contacts.closed).pair.tolist())


def pressing_names(solved: Solved) -> frozenset[str]:
    """Names of the contacts that press, at an own pin too."""
    geometry, rows = solved.system.geometry, solved.system.mechanism.rows
    pins = {row.name.removesuffix(".pin") for row, closed in zip(rows, solved.state.driven, strict=True) if closed}
    return frozenset(pair.name for k, pair in enumerate(geometry.pairs) if k in pressing(solved) or pair.name in pins)


def drawn_names(system: System, state: State) -> frozenset[str]:
    """Names of the contacts that touch in a state as drawn: such contacts neither close nor open later."""
    geometry = system.geometry
    at_ends = touching_as_drawn(geometry, state.z, state.contacts)
    return frozenset(
        pair.name
        for k, pair in enumerate(geometry.pairs)
        if k in at_ends or nearest_place(geometry, state, k)[0] < TOUCHING
    )


def kept_open(state: State, pairs: frozenset[int]) -> State:
    """The state with open pairs, which stay open in an equilibrium."""
    contacts = state.contacts
    kept = ~(contacts.of_pairs(pairs) & (contacts.closed | contacts.places.moves))
    remaining = replace(contacts, places=taken(contacts.places, kept), closed=contacts.closed[kept], kept_open=pairs)
    return replace(state, contacts=remaining)


class Pressed(NamedTuple):
    """Closed places that may lift off together: a pair, or the places on a ``piece`` (−1: all)."""

    pair: int
    piece: int = -1

    def places(self, solved: Solved) -> Flags:
        """The closed places in a state."""
        contacts = solved.state.contacts
        on_piece = (contacts.places.piece == self.piece) | (self.piece < 0)
        return np.asarray(contacts.pressing(self.pair) & on_piece)

    def force(self, solved: Solved) -> float:
        """Sum of the contact forces."""
        return float(solved.state.contacts.places.force[self.places(solved)].sum())


def contact_changes(
    before: Solved, after: Solved, closing: frozenset[int], solve: Callable[[float], Solved]
) -> list[Change]:
    """The first closing of pairs, and the first opening with the pairs that open together, in a step.

    Args:
        before, after: the step.
        closing: pairs kept open that overlap at the end.
        solve: state at a fraction of the step.

    Raises:
        NotConvergedError: a state on the way was not found, or the step is too long.
    """
    old, new = pressing(before), pressing(after)
    changes = _closing(before, after, closing, solve) if closing else []
    if (apart_pairs(before, new - old) or (closing and not changes)) and turned(before, after) > SMALLEST_TURN:
        raise NotConvergedError("a contact closes on the way to a state that the contact alone leads to")
    openings = sorted((each for pair in sorted(old - new) for each in _opening(pair, solve)), key=itemgetter(0))
    together = frozenset(each.first for each in openings if each.share < openings[0].share + TOGETHER)
    return changes + [each._replace(pairs=together) for each in openings[:1]]


def _closing(before: Solved, after: Solved, pairs: frozenset[int], solve: Callable[[float], Solved]) -> list[Change]:
    """The first closing of pairs kept open; empty where no state on the way has a gap of ``-CLOSED`` without a passage.

    Raises:
        NotConvergedError: a state on the way was not found.
    """
    change = after.state.target - before.state.target

    @cache
    def least(share: float) -> tuple[float, float, int]:
        solved = solve(share)
        geometry, state = solved.system.geometry, solved.state
        near = ((*nearest_place(geometry, state, pair), pair) for pair in sorted(pairs))
        gap, places, nearest, pair = min(near, key=itemgetter(0))
        return gap, float(gap_rates(geometry, state.z, places, nearest, tangent(solved, change)).sum()), pair

    def event(share: float) -> tuple[float, float]:
        gap, slope, _ = least(share)
        return gap + CLOSED if abs(gap + CLOSED) > LOCATED * CLOSED else 0.0, slope

    end = event(1.0)
    share = located_by_slopes(event, end) if end[0] <= 0.0 else 1.0
    gap, slope, first = least(share)
    # an end that begins the step before another end has no side: another place touches after the end's passage
    points = after.system.geometry.arrays, after.system.geometry.points, after.state.contacts.counters
    if end[0] > 0.0 or abs(gap) > TOUCHING or sweeps_any_point(before.state.z, solve(share).state.z, *points):
        return []
    return [Change(share, pairs=pairs, closes=True, first=first, early=min(share, CLOSED / max(-slope, CLOSED)))]


def _opening(pair: int, solve: Callable[[float], Solved]) -> list[Change]:
    """The opening of a pair; empty if the force does not change its sign.

    Raises:
        NotConvergedError: a state was not found, or the force jumps to zero.
    """

    def force(share: float) -> float:
        solved = solve(share)
        if pair in pressing(solved):
            return Pressed(pair).force(solved)
        return -nearest_place(solved.system.geometry, solved.state, pair)[0]

    begin, end = force(0.0), force(1.0)
    if not begin > 0.0 > end:
        return []

    def event(share: float) -> float:
        # force and gap of equal size at both ends; an open state at the opening has another tangent
        value = force(share)
        return (value if value > RELEASED * begin else 0.0) if value > 0.0 else value * begin / -end

    share = located(event)
    if force(share) > LET_GO * begin:
        raise NotConvergedError("a contact lets go under force")
    # a force that vanishes at the end of the step is below RELEASED a little earlier
    return [Change(share if share < 1.0 - TOGETHER else 1.0, pairs=frozenset([pair]), first=pair)]
