"""How far an end of a beam that presses on another has to go there until it slips off.

==========  ===========================================================================
s_e, σ_e    arc length of an end, and of its foot on the other beam
p           σ_e; beyond an end from there along the tangent
ℓ           length of the other beam
==========  ===========================================================================

Nothing beyond a beam's end faces it: an end that goes past the other's presses on nothing any more, whatever it pressed
with just before, and there is no equilibrium near by.
"""

from __future__ import annotations

import numpy as np

from cprbm.nearest import Pair, distance_along, past_foot
from cprbm.point import Point

SAME = 1e-6  # of an element: where a row stands that is an end's


def left_to_go(pair: Pair, point: Point) -> float | None:
    """p or ℓ − p, whichever is less, units of length; None where a contact is not that of one end on a side."""
    parts = [(group.arc, lam) for group, lam in point.rows.shares(point.lam) if group.contact == pair.name]
    arcs = np.concatenate([arc[lam > 0.0] for arc, lam in parts]) if parts else np.zeros(0)
    if arcs.size != 1:
        return None
    pair = pair.brought_to(point.state)
    lines = pair.lines(point.state, point.at)
    for one, both, mine in ((pair, lines, True), (pair.exchanged(), lines[::-1], False)):
        ends = one.a.s[[0, -1]]
        _, feet, facing = distance_along(one, both, ends)
        # the row of an end stands there, or at its foot, on the contact's first beam
        here = facing & (np.abs((ends if mine else feet) - arcs) <= SAME * one.a.h)
        if here.any():
            p = feet[here] + past_foot(one, both, ends[here], feet[here])
            return float(np.minimum(p, one.b.s[-1] - p).min())
    return None
