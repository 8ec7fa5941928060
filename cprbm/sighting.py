"""On which sides of each other two beams lie of which one is beyond the other's ends at rest.

==========  ==============================================================================
side        +1 where A lies on the left of B, −1 on the right, 0 where that was not seen yet
across      the same of B and A
D           side·n·r, :mod:`cprbm.nearest`
==========  ==============================================================================

Where no place of A has a foot on B, nothing says on which side of it A lies.  It is the side on which A is where it
first has one within reach: what is known of it goes from state to state with the rows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cprbm.closest import on_either_side
from cprbm.feet import Lines
from cprbm.first_contact import Sides
from cprbm.kinematics import Positions, State

if TYPE_CHECKING:
    from cprbm.nearest import Pair

UNSEEN: Sides = (0.0, 0.0)


def sight(pair: Pair, state: State, at: Positions, known: Sides) -> Sides:
    """The sides in a state, those that are ``known`` as they are."""
    (side, across), lines = known, pair.lines(state, at)
    if not (pair.seen[0] or side):
        side = pair.side * _sign(pair, lines)
    if not (pair.seen[1] or across):
        across = pair.across * _sign(pair.exchanged(), lines[::-1])
    return side, across


def _sign(pair: Pair, lines: Lines) -> float:
    """+1 where D is positive where A is nearest to B, −1 where it is negative, 0 where A has no foot within reach."""
    D, _ = on_either_side(pair, lines)
    facing = D[np.isfinite(D) & (D != 0.0)]
    return float(np.sign(facing[np.abs(facing).argmin()])) if facing.size else 0.0
