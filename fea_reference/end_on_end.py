"""Ends of one beam that meet: whether one has come past the other round it, or through it, or through the line behind.

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

A long way may pass the other end on the one side and come to lie on the other side of the line behind it.  As the other
end sees it, it then crosses the line as it lies afterwards.
"""

import numpy as np

from fea_reference.hermite import NeutralLine
from fea_reference.state import Complex
from fea_reference.touch import Pair

_TURNS = 1.0  # rad: the most that α may be
_BESIDE = 2.0  # T and an element: ends that are farther apart are not beside each other


def ends_through(pair: Pair, before: NeutralLine, after: NeutralLine) -> bool:
    """Whether on the way between two states of a beam that may touch itself one end goes through the other."""
    if any(_across(pair, before, after, tip) for tip in (0, before.n)):
        return True
    if not pair.ended:
        return False  # a line's ends are points, which never touch
    v, there = (complex(line.nodes[-1] - line.nodes[0]) for line in (before, after))
    touching = float(pair.apart(np.array([float(before.n)]), np.zeros(1))[0])
    way = there - v
    share = 0.0 if way == 0.0 else min(1.0, max(0.0, -(v * way.conjugate()).real / abs(way) ** 2))
    # ends that overlap already go round each other as near as they are
    return abs(v + share * way) < min(touching, abs(v), abs(there)) * float(np.cos(0.5 * _TURNS))


def _across(pair: Pair, before: NeutralLine, after: NeutralLine, tip: int) -> bool:
    """Whether the end at node ``tip``, which was beside the other one, crosses the line behind that."""
    other, n = before.n - tip, before.n

    def seen(line: NeutralLine, nodes: Complex) -> Complex:
        ahead = np.exp(1j * line.angles[other]) * (1.0 if other == 0 else -1.0)
        return np.asarray((nodes - line.nodes[other]) / ahead)

    (begin,), (end,) = seen(before, before.nodes[[tip]]), seen(after, after.nodes[[tip]])
    if abs(begin) > _BESIDE * pair.distance + before.longest:
        return False
    behind = np.arange(n // 2 + 1) if other == 0 else np.arange(n, n - n // 2 - 1, -1)
    line, way = seen(after, after.nodes[behind]), end - begin
    if way == 0.0:
        return False
    side = ((line - begin) / way).imag
    passes = np.flatnonzero((side[:-1] < 0.0) != (side[1:] < 0.0))
    share = side[passes] / (side[passes] - side[passes + 1])
    where = ((line[passes] + share * (line[passes + 1] - line[passes]) - begin) / way).real
    return bool(np.count_nonzero((where > 0.0) & (where < 1.0)) % 2)
