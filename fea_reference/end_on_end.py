"""Ends of one beam that meet: whether one has come past the other round it, or through it.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
v       from the start of the neutral line to its end; straight on the straight way
T       length of v where both ends touch each other
α       angle by which v turns between two states that touch
======  =====================================================================================

Where nothing of one end is beside the other, each has a circle about it and no side: it comes round to either, and what
it does is told from the way alone.  Of a way along which v has the length T and turns by α, the straight one comes as
near as T cos α/2.  One that comes nearer leads through, or is too long to tell: it is to be cut.
"""

from __future__ import annotations

import numpy as np

from fea_reference.hermite import NeutralLine
from fea_reference.touch import Pair

_TURNS = 1.0  # rad: the most that α may be


def ends_through(pair: Pair, before: NeutralLine, after: NeutralLine) -> bool:
    """Whether on the way between two states of a beam that may touch itself one end goes through the other."""
    if not pair.ended:
        return False  # a line's ends are points, which never touch
    v, there = (complex(line.nodes[-1] - line.nodes[0]) for line in (before, after))
    touching = float(pair.apart(np.array([float(before.n)]), np.zeros(1))[0])
    way = there - v
    share = 0.0 if way == 0.0 else min(1.0, max(0.0, -(v * way.conjugate()).real / abs(way) ** 2))
    # ends that overlap already go round each other as near as they are
    return abs(v + share * way) < min(touching, abs(v), abs(there)) * float(np.cos(0.5 * _TURNS))
