"""Curvatures of the energy at an equilibrium of beams in a row, by Ritz's method: is it a minimum?

=======  =================================================================================
symbol   meaning
=======  =================================================================================
s, θ     arc length through all pieces, tangent angle at the equilibrium (EI = 1)
F        force along a piece, as in :mod:`tests.references.rod`
η        small change of θ, a polynomial of s on every piece, continuous
=======  =================================================================================

The energy ½ ∫ (θ' − κ⁰)² ds less the work of dead forces has the second variation

    Q = ∫ η'² + (F_x cos θ + F_y sin θ) η² ds                                                       (1)

on the changes that supports and contacts allow: at some places a combination of

    δx = −∫ sin θ η ds,    δy = ∫ cos θ η ds,    η                                                  (2)

vanishes.  The equilibrium is a minimum where Q over ∫ η'² + η² is positive.  This looks at all changes, where a
determinant sees only an odd number of them change sides; it converges from above.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.linalg import eigh, null_space

from tests.references.rod import shape

Array = NDArray[np.float64]
_DEGREE = 14


@dataclass(frozen=True)
class Loaded:
    """A piece at equilibrium: x, y, θ, M at its start, its force, length and curvature free of stress."""

    start: Array
    force: Array
    length: float
    curvature: float = 0.0


def curvatures(pieces: Sequence[Loaded], held: Sequence[tuple[int, tuple[float, float, float]]]) -> Array:
    """Q over its scale for the changes that are left, ascending.

    Args:
        pieces: in a row; held: after so many pieces, the combination of δx, δy and η that vanishes.
    """
    each = np.eye(_DEGREE + 1)
    node, weight = legendre.leggauss(_DEGREE + 20)
    size = len(pieces) * (_DEGREE + 1)
    Q, scale = np.zeros((2, size, size))
    moved, joined = np.zeros((2, size)), []
    begins = np.zeros(size)
    begins[: _DEGREE + 1] = legendre.legval(-1.0, each)
    after = [np.vstack((moved, begins))]
    for k, piece in enumerate(pieces):
        own = slice(k * (_DEGREE + 1), (k + 1) * (_DEGREE + 1))
        w = 0.5 * piece.length * weight
        theta = shape(piece.start, piece.force, piece.length, piece.curvature, 0.5 * piece.length * (node + 1.0))[2]
        b = legendre.legval(node, each)
        db = legendre.legval(node, legendre.legder(each)) * 2.0 / piece.length
        Q[own, own] = (w * db) @ db.T + (w * (piece.force @ [np.cos(theta), np.sin(theta)]) * b) @ b.T
        scale[own, own] = (w * db) @ db.T + (w * b) @ b.T
        moved[:, own] = b @ (-w * np.sin(theta)), b @ (w * np.cos(theta))
        begins, ends = np.zeros((2, size))
        begins[own], ends[own] = legendre.legval(-1.0, each), legendre.legval(1.0, each)
        joined.append(begins - after[-1][2])
        after.append(np.vstack((moved, ends)))
    rows = [np.array(row) @ after[place] for place, row in held]
    free = null_space(np.array(rows + joined[1:]))
    return np.asarray(eigh(free.T @ Q @ free, free.T @ scale @ free, eigvals_only=True))
