"""Whether two lines cross.

==========  ============================================================
P, Q        points of the one line (m, 2) and of the other (n, 2)
u × v       u_x v_y − u_y v_x
==========  ============================================================

Two pieces cross where each has its ends on both sides of the other.
"""

from __future__ import annotations

import numpy as np

from scene.answer import Array, Flags, Ints


def cross(P: Array, Q: Array) -> bool:
    """Whether the lines through the points P and Q cross, straight between the points."""
    return bool(np.any(_parted(P, Q) & _parted(Q, P).T))


def crossings(P: Array) -> tuple[Ints, Ints]:
    """Numbers of the pieces (k,) of a line that cross pieces (k,) further along, straight between the points P."""
    parted = _parted(P, P)
    here, there = np.nonzero(np.triu(parted & parted.T))
    return here, there


def _parted(P: Array, Q: Array) -> Flags:
    """Whether the ends of each piece of Q lie on both sides of each piece of P, continued, (m − 1, n − 1) of bool."""
    along = np.diff(P, axis=0)[:, None]
    away = Q[None] - P[:-1, None]
    side = along[..., 0] * away[..., 1] - along[..., 1] * away[..., 0]
    return np.asarray(side[:, 1:] * side[:, :-1] < 0.0)
