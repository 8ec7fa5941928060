"""How far an end of a beam that presses on another has to go there until it slips off, or until it slips off a corner.

==========  ===========================================================================
s_e, σ_e    arc length of an end, and of its foot on the other beam
p           σ_e; beyond an end from there along the tangent
ℓ           length of the other beam
==========  ===========================================================================

Nothing beyond a beam's end faces it: an end that goes past the other's presses on nothing any more, whatever it pressed
with just before, and there is no equilibrium near by.

A corner of something rigid that comes past a beam's end presses on its round face from there on, by a force that turns
away with 2/t: what it held against the beam's side, it pushes off.
"""

from __future__ import annotations

import numpy as np

from cprbm.edge import Edge
from cprbm.feet import Lines, distance_along, past_foot
from cprbm.nearest import Pair
from cprbm.point import Point

SAME = 1e-6  # of an element: where a row stands that is an end's


def left_to_go(pair: Pair, point: Point) -> float | None:
    """p or ℓ − p, whichever is less, units of length; None where a contact is not that of one end on a side."""
    end = _pressing_end(pair, point)
    return None if end is None else _left(*_seen(pair, point, mine=end[0]), end[1])


def left_of_side(edge: Edge, point: Point) -> float | None:
    """How far from the nearest end of the beam a corner presses, units of length.

    None where none does, or another place than that end is pressed as well.
    """
    corners, others = _places(edge, point)
    if len(corners) != 1:
        return None
    start, stop = edge.a.s[[0, -1]].tolist()
    nearest = start if corners[0] - start < stop - corners[0] else stop
    return abs(corners[0] - nearest) if all(s == nearest for s in others) else None


def slipped_off(edge: Edge, before: Point, after: Point) -> bool:
    """Whether a corner alone pressed on the side ``before``, and an end alone lies on a piece of the edge ``after``.

    In between that corner pressed on the end's round face, or pushed it off.
    """
    (corners, others), (no_more, ends) = _places(edge, before), _places(edge, after)
    return len(corners) == 1 and not others and not no_more and len(ends) == 1 and ends[0] in edge.a.s[[0, -1]]


def _places(edge: Edge, point: Point) -> tuple[list[float], list[float]]:
    """Arc lengths at which corners press on the beam's side, and those of what else presses but corners on its ends."""
    corners, others = [], []
    for group, lam in point.rows.shares(point.lam):
        for row in np.flatnonzero(lam > 0.0).tolist() if group.contact == edge.name else ():
            key, s = group.keys[row], float(group.arc[row])
            if edge.on_corner(key):
                corners.append(s)
            elif not edge.by_corner(key):
                others.append(s)
    return corners, others


def slipped(pair: Pair, before: Point, after: Point) -> bool:
    """Whether the end that pressed on a side ``before``, and alone, has come past the other beam's end ``after``.

    Not that of a thick beam which leads from it towards the other: that one's end has come to lie on it by then.
    """
    end = _pressing_end(pair, before)
    if end is None or _leads_across(*_seen(pair, before, mine=end[0]), end[1]):
        return False
    here, there = (_left(*_seen(pair, point, mine=end[0]), end[1]) for point in (before, after))
    return here > 0.0 > there


def _pressing_end(pair: Pair, point: Point) -> tuple[bool, int] | None:
    """Whether the end that presses, and no other place, is one of the contact's first beam, and which (0 or −1)."""
    parts = [(group.arc, lam) for group, lam in point.rows.shares(point.lam) if group.contact == pair.name]
    arcs = np.concatenate([arc[lam > 0.0] for arc, lam in parts]) if parts else np.zeros(0)
    if arcs.size != 1:
        return None
    for mine in (True, False):
        one, both = _seen(pair, point, mine=mine)
        ends = one.a.s[[0, -1]]
        _, feet, facing = distance_along(one, both, ends)
        # the row of an end stands there, or at its foot, on the contact's first beam
        here = facing & (np.abs((ends if mine else feet) - arcs) <= SAME * one.a.h)
        if here.any():
            return mine, -int(here[-1])
    return None


def _seen(pair: Pair, point: Point, *, mine: bool) -> tuple[Pair, Lines]:
    """The contact in a state, and both lines, with the beam as the first whose end it is."""
    pair = pair.brought_to(point.state)
    lines = pair.lines(point.state, point.at)
    return (pair, lines) if mine else (pair.exchanged(), lines[::-1])


def _left(one: Pair, both: Lines, which: int) -> float:
    """What is left to go of the first beam's end, less than nothing beyond the other's."""
    ends = one.a.s[[which]]
    _, feet, _ = distance_along(one, both, ends)
    p = float((feet + past_foot(one, both, ends, feet))[0])
    return min(p, float(one.b.s[-1]) - p)


def _leads_across(one: Pair, both: Lines, which: int) -> bool:
    """Whether the first beam leads from its end towards the side of the second on which that presses."""
    ends = one.a.s[[which]]
    _, feet, _ = distance_along(one, both, ends)
    end, foot = one.on_a(both, ends), one.on_b(both, feet)
    inwards = np.array([np.cos(end.tangent[0]), np.sin(end.tangent[0])]) * (1.0 if which == 0 else -1.0)
    away = np.array([end.x[0] - foot.x[0], end.y[0] - foot.y[0]])
    return one.offset > 0.0 and float(inwards @ away) < 0.0
