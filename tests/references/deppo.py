"""An inextensible circular arch, clamped at one end and pinned at the other, with a dead force at its crown: its fold.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
R, a     radius and half the opening angle of the arch, symmetric about the vertical; EI = R = 1
P, w     dead force downwards at the crown, and the way the crown has come down
M, F     moment of the clamp, on the left, and force of the crown on the left half
κ⁰       −1/R: the arch is run through from the left, clockwise
=======  =================================================================================

The left half begins at (−sin a, cos a) with tangent angle a, the right half ends at (sin a, cos a) with M = 0; the
force jumps by P between them.  Those are three equations R in M, F_x, F_y and P.  The branch from the unloaded arch is
stable under P up to det ∂R/∂(M, F_x, F_y) = 0, where P is largest, and under w up to det ∂(R, w)/∂(M, F_x, F_y, P) = 0,
where w is largest.

Source: D. A. DaDeppo and R. Schmidt, Instability of clamped-hinged circular arches subjected to a point load, Journal
of Applied Mechanics 42 (1975) 894-896: 8.97 EI/R² for an opening angle of 215°.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from tests.references.branch import vanishing
from tests.references.rod import TIGHT, carried

Array = NDArray[np.float64]
BENCHMARK = float(np.radians(107.5))


@dataclass(frozen=True, slots=True)
class Crown:
    """P, the clamp's M and F, and the crown's place and rotation, without dimension."""

    force: float
    moment: float
    reaction: Array
    place: Array
    rotation: float


@cache
def force_fold(a: float = BENCHMARK) -> Crown:
    """Where P is largest."""
    return _first(a, lambda J: J[:3, :3])


@cache
def displacement_fold(a: float = BENCHMARK) -> Crown:
    """Where w is largest."""
    return _first(a, lambda J: J)


def whole(a: float, X: Array, tolerance: float = TIGHT) -> tuple[Array, Array, Array]:
    """R (3,), ∂(R, crown's y)/∂(M, F_x, F_y, P) (4, 4), and the crown's x, y, θ, M."""
    start = np.array([-np.sin(a), np.cos(a), a, X[0]])
    crown, D = carried(start, X[1:3], a, -1.0, tolerance)
    by_X = np.zeros((6, 4))
    by_X[:4, :3] = D[:, 3:]
    by_X[4:, 1:] = [[1.0, 0.0, 0.0], [0.0, 1.0, 1.0]]
    end, D = carried(crown, X[1:3] + np.array([0.0, X[3]]), a, -1.0, tolerance)
    rows = [0, 1, 3]
    return end[rows] - [np.sin(a), np.cos(a), 0.0], np.vstack(((D @ by_X)[rows], by_X[1])), crown


def _first(a: float, part: Callable[[Array], Array]) -> Crown:
    def equations(X: Array, tolerance: float) -> tuple[Array, Array]:
        R, J, _ = whole(a, X, tolerance)
        return R, J[:3]

    def wanted(X: Array, tolerance: float) -> float:
        return float(np.linalg.det(part(whole(a, X, tolerance)[1])))

    X = vanishing(equations, wanted, np.zeros(4), np.array([0.0, 0.0, 0.0, 1.0]), 0.5, 200)
    crown = whole(a, X)[2]
    return Crown(X[3], X[0], -X[1:3], crown[:2], crown[2])
