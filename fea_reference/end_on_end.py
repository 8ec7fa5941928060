"""Passing of a beam's ends: around each other, through each other, or through the line behind the other end.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
v       vector from the start of the neutral line to its end; varies linearly during a step
T       length of v where both ends touch
α       angle by which v turns between two states in contact
======  =====================================================================================

Two ends face to face are circles and have no side. An end may come around the other, and only the path shows its
motion. If v keeps the length T and turns by α, the straight path comes as near as T cos α/2. A nearer path leads
through the other end, or is too long to decide and has to be cut.

A long step may pass the other end on the left, say, and finish on the right of the line behind the other end. In the
frame of the other end, the path then crosses the final line.
"""

import numpy as np

from fea_reference.hermite import NeutralLine
from fea_reference.state import Complex
from fea_reference.touch import Pair

_TURNS = 1.0  # rad: largest α
_BESIDE = 2.0  # times T plus an element: ends farther apart do not interact


def ends_pass_through(pair: Pair, before: NeutralLine, after: NeutralLine) -> bool:
    """True if one end of a beam in self-contact passes through the other between two states."""
    if any(_crosses_line_behind(pair, before, after, tip) for tip in (0, before.n)):
        return True
    if not pair.ended:
        return False  # a line's ends are points and never touch
    v, there = (complex(line.nodes[-1] - line.nodes[0]) for line in (before, after))
    touching = float(pair.apart(np.array([float(before.n)]), np.zeros(1))[0])
    path = there - v
    share = 0.0 if path == 0.0 else min(1.0, max(0.0, -(v * path.conjugate()).real / abs(path) ** 2))
    # overlapping ends may pass around each other at their present distance
    return abs(v + share * path) < min(touching, abs(v), abs(there)) * float(np.cos(0.5 * _TURNS))


def _crosses_line_behind(pair: Pair, before: NeutralLine, after: NeutralLine, tip: int) -> bool:
    """True if the end at node ``tip``, next to the other end, crosses the line behind the other end."""
    other, n = before.n - tip, before.n

    def in_end_frame(line: NeutralLine, nodes: Complex) -> Complex:
        ahead = np.exp(1j * line.angles[other]) * (1.0 if other == 0 else -1.0)
        return np.asarray((nodes - line.nodes[other]) / ahead)

    (begin,), (end,) = in_end_frame(before, before.nodes[[tip]]), in_end_frame(after, after.nodes[[tip]])
    if abs(begin) > _BESIDE * pair.distance + before.longest:
        return False
    behind = np.arange(n // 2 + 1) if other == 0 else np.arange(n, n - n // 2 - 1, -1)
    line, path = in_end_frame(after, after.nodes[behind]), end - begin
    if path == 0.0:
        return False
    side = ((line - begin) / path).imag
    passes = np.flatnonzero((side[:-1] < 0.0) != (side[1:] < 0.0))
    share = side[passes] / (side[passes] - side[passes + 1])
    where = ((line[passes] + share * (line[passes + 1] - line[passes]) - begin) / path).real
    return bool(np.count_nonzero((where > 0.0) & (where < 1.0)) % 2)
