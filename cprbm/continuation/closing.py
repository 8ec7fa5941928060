"""Contacts that close or open within a load step, and their location.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
g        least gap of an open pair of curves
F        sum of the contact forces of a closed pair
=======  ====================================================================================

The gap of a pair may be least between two joints; a moving place without a force finds the minimum.
The first closing is located on states with the pair kept open, by values and slopes of g along the tangent:
g = −CLOSED there, so that the active set closes the pair in the least gap.  An opening is the zero of F, continued by
−g where the pair is open.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cprbm.contact import TOUCHING, Contacts, Geometry, taken, touching_as_drawn
from cprbm.continuation.limits import located, located_by_slopes
from cprbm.continuation.path import tangent
from cprbm.equilibrium.contact_set import NotConvergedError, with_fixed_places
from cprbm.equilibrium.neighbours import least_between
from cprbm.equilibrium.solving import Solved, at_state
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array, Flags

CLOSED = 1e-11
"""Overlap, over the longest beam, of a contact at the closing: ten times the active set's round-off."""


LOCATED = 0.5
"""Accuracy of the overlap at a closing, over ``CLOSED``."""

ALONG = 1e-6
"""Part of a step along the tangent for the slope of a gap."""

RELEASED = 1e-9
"""Force of an opening contact, over the force at the begin of the step, that counts as none."""

LET_GO = 0.1
"""Force of an opening contact, over the force at the begin of the step: a larger force jumps to zero."""


class ContactChange(NamedTuple):
    """Pairs that close or open at a fraction ``share`` of a step, the pair ``first`` exactly there."""

    share: float
    pairs: frozenset[int]
    closes: bool
    first: int


def least_gap(geometry: Geometry, z: Array, contacts: Contacts, pair: int) -> float:
    """Least gap of an open pair, between joints too; inf if the curves are far apart."""
    full = with_fixed_places(geometry, z, replace(contacts, kept_open=frozenset()))
    gaps = full.gaps(geometry, z)
    mine = gaps[full.places.pair == pair]
    least = float(mine.min(initial=np.inf))
    if geometry.joints_alone:
        return least
    known = full.places, full.closed, gaps, pair, contacts.counters
    return min(least, least_between(z, geometry.arrays, geometry.sites, *known))


def pressing(solved: Solved) -> frozenset[int]:
    """Numbers of the closed pairs."""
    contacts = solved.state.contacts
    return frozenset(contacts.places.pair[contacts.closed].tolist())


def pressing_names(solved: Solved) -> frozenset[str]:
    """Names of the contacts that press, at an own pin too."""
    geometry, rows = solved.system.geometry, solved.system.mechanism.rows
    pins = {row.name.removesuffix(".pin") for row, closed in zip(rows, solved.state.driven, strict=True) if closed}
    return frozenset(pair.name for k, pair in enumerate(geometry.pairs) if k in pressing(solved) or pair.name in pins)


def drawn_names(system: System, state: State) -> frozenset[str]:
    """Names of the contacts that touch in a state as drawn: such contacts neither close nor open later."""
    geometry, contacts = system.geometry, state.contacts
    at_ends = touching_as_drawn(geometry, state.z, contacts)
    gaps = {pair: least_gap(geometry, state.z, contacts, pair) for pair in range(len(geometry.pairs))}
    return frozenset(geometry.pairs[pair].name for pair, gap in gaps.items() if pair in at_ends or gap < TOUCHING)


def touches(solved: Solved) -> bool:
    """True if open places touch: the state has no two-sided tangent."""
    return bool(np.any(np.abs(solved.gaps[~solved.state.contacts.closed]) < TOUCHING))


def kept_open(state: State, pairs: frozenset[int]) -> State:
    """The state with open pairs, which stay open in an equilibrium."""
    contacts = state.contacts
    kept = ~np.isin(contacts.places.pair, list(pairs))
    places, closed = taken(contacts.places, kept), contacts.closed[kept]
    apart = taken(contacts.places, ~kept & ~contacts.closed) if pairs else contacts.apart
    return replace(state, contacts=replace(contacts, places=places, closed=closed, kept_open=pairs, apart=apart))


def may_close(state: State) -> State:
    """The state with pairs that are free to close again."""
    return replace(state, contacts=replace(state.contacts, kept_open=frozenset(), apart=None))


class Pressed(NamedTuple):
    """Closed places that may lift off together: a pair, or the joint at the begin of a ``piece`` (−1: all)."""

    pair: int
    piece: int = -1

    def places(self, solved: Solved) -> Flags:
        """The closed places in a state."""
        contacts = solved.state.contacts
        joint = (contacts.places.piece == self.piece) | (self.piece < 0)
        return np.asarray(contacts.pressing(self.pair) & joint)

    def force(self, solved: Solved) -> float:
        """Sum of the contact forces."""
        return float(solved.state.contacts.places.force[self.places(solved)].sum())


def pressing_joints(solved: Solved) -> list[Pressed]:
    """Closed joints where all places are joints; else empty."""
    return pressing_places(solved) if solved.system.geometry.joints_alone else []


def pressing_places(solved: Solved) -> list[Pressed]:
    """All closed places."""
    contacts = solved.state.contacts
    pair, piece = contacts.places.pair[contacts.closed], contacts.places.piece[contacts.closed]
    return [Pressed(*each) for each in zip(pair.tolist(), piece.tolist(), strict=True)]


def may_lift(solved: Solved) -> list[Pressed]:
    """Closed pairs, and every closed place."""
    return [*(Pressed(pair) for pair in sorted(pressing(solved))), *pressing_places(solved)]


def without(solved: Solved, lifted: Pressed) -> Solved:
    """The state without closed places, of which the force is about zero.

    Raises:
        NotConvergedError: the Hessian is singular.
    """
    state, contacts = solved.state, solved.state.contacts
    closed = contacts.closed & ~lifted.places(solved)
    return at_state(solved.system, replace(state, contacts=replace(contacts, closed=closed)))


def first_change(
    before: Solved, after: Solved, solve: Callable[[float, frozenset[int]], Solved]
) -> ContactChange | None:
    """The first pair that closes or opens in a step.

    Args:
        before, after: the step.
        solve: state at a fraction of the step, with pairs kept open.

    Raises:
        NotConvergedError: a state on the way was not found.
    """
    old, new = pressing(before), pressing(after)
    found = _closing(before, after, new - old, solve)
    for pair in sorted(old - new):
        found += _opening(pair, solve)
    return min(found, default=None)


def _closing(
    before: Solved, after: Solved, pairs: frozenset[int], solve: Callable[[float, frozenset[int]], Solved]
) -> list[ContactChange]:
    """The first closing of some pairs; empty for pairs that touch already, or stay apart when kept open."""
    apart = frozenset(pair for pair in pairs if _gap(before, pair) > TOUCHING)
    if not apart:
        return []

    change, first = after.state.target - before.state.target, dict[float, int]()

    def gap(share: float) -> tuple[float, float]:
        solved = solve(share, apart) if share else before
        moved = solved.state.z + ALONG * tangent(solved, change)
        gaps = {pair: _gap(solved, pair) for pair in apart}
        first[share] = min(gaps, key=lambda pair: gaps[pair])
        found = gaps[first[share]]
        overlap, slope = found + CLOSED, (_gap(solved, first[share], moved) - found) / ALONG
        return overlap if abs(overlap) > LOCATED * CLOSED else 0.0, slope

    end = gap(1.0)
    if end[0] >= 0.0:
        return []
    share = located_by_slopes(gap, end)
    return [ContactChange(share, apart, closes=True, first=first[share])]


def _opening(pair: int, solve: Callable[[float, frozenset[int]], Solved]) -> list[ContactChange]:
    """The opening of a pair; empty if the force does not change its sign.

    Raises:
        NotConvergedError: a state was not found, or the force jumps to zero.
    """

    def force(share: float) -> float:
        solved = solve(share, frozenset())
        return Pressed(pair).force(solved) if pair in pressing(solved) else -_gap(solved, pair)

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
    return [ContactChange(share, frozenset([pair]), closes=False, first=pair)]


def _gap(solved: Solved, pair: int, z: Array | None = None) -> float:
    """g at a state, or at other unknowns ``z``; a pair without places is far apart."""
    geometry, state = solved.system.geometry, solved.state
    return least_gap(geometry, state.z if z is None else z, state.contacts, pair)
