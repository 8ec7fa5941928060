"""Whether two lines cross.

==========  ============================================================
P, Q        points of the one line (m, 2) and of the other (n, 2)
u × v       u_x v_y − u_y v_x
==========  ============================================================

Two pieces cross where each has its ends on both sides of the other.  Where lines touch, or one ends on the other, the
straight pieces between their points may cross by what the lines are curved: how deeply they cross tells the difference.
"""

from __future__ import annotations

import numpy as np

from cprbm_scene.answer import Array, Ints

A_TIME = 64  # pieces of one line that are held against those of another
AT_ONCE = 512  # pieces of a line that are held against the others together: a table of all pairs has no room


def cross(P: Array, Q: Array) -> bool:
    """Whether the lines through the points P and Q cross, straight between the points."""
    low, high = np.minimum(Q[:-1], Q[1:]), np.maximum(Q[:-1], Q[1:])
    for first in range(0, len(P) - 1, A_TIME):
        some = P[first : first + A_TIME + 1]
        # of Q what the box round these pieces meets
        near = ((low <= some.max(axis=0)) & (high >= some.min(axis=0))).all(axis=1).nonzero()[0]
        if near.size and _crossing(some, Q[near[0] : near[-1] + 2])[0].size:
            return True
    return False


def own_crossings(P: Array) -> tuple[Ints, Ints, Array]:
    """Where a line crosses itself: numbers of the pieces (k,), of those further along (k,), and how deeply (k,).

    The depth is the way to the next crossing or to an end of the line, times the sine of the angle between the pieces:
    by so much, about, one part lies beyond the other.
    """
    pieces: list[tuple[Ints, Ints]] = []
    for first in range(0, len(P) - 1, AT_ONCE):
        of, to = _crossing(P[first : first + AT_ONCE + 1], P[first:])
        pieces.append((first + of[of <= to], first + to[of <= to]))
    here, there = (np.concatenate(each) for each in zip(*pieces, strict=True))
    if not here.size:
        return here, there, np.zeros(0)
    along, away = np.diff(P, axis=0), P[there] - P[here]
    length = np.hypot(along[:, 0], along[:, 1])
    s = np.concatenate(([0.0], np.cumsum(length)))
    one, other = along[here], along[there]
    across = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    t = (away[:, 0] * other[:, 1] - away[:, 1] * other[:, 0]) / across
    u = (away[:, 0] * one[:, 1] - away[:, 1] * one[:, 0]) / across
    first, second = s[here] + t * length[here], s[there] + u * length[there]
    apart = np.maximum(np.abs(first[:, None] - first), np.abs(second[:, None] - second))
    np.fill_diagonal(apart, np.inf)
    way = np.minimum(np.minimum(first, s[-1] - second), np.min(apart, axis=1))
    return here, there, np.abs(across) / (length[here] * length[there]) * way


def _crossing(P: Array, Q: Array) -> tuple[Ints, Ints]:
    """Numbers of pieces of P (k,), in order, and of those of Q (k,) that they cross."""
    (x, y), (u, v) = P.T, Q.T
    side = np.diff(x)[:, None] * (v - y[:-1, None]) - np.diff(y)[:, None] * (u - x[:-1, None])
    # few pieces of Q have their ends on both sides of one of P, continued: only these are seen the other way
    of, to = np.nonzero(side[:, 1:] * side[:, :-1] < 0.0)
    along_x, along_y = u[to + 1] - u[to], v[to + 1] - v[to]
    before = along_x * (y[of] - v[to]) - along_y * (x[of] - u[to])
    behind = along_x * (y[of + 1] - v[to]) - along_y * (x[of + 1] - u[to])
    both = before * behind < 0.0
    return of[both], to[both]
