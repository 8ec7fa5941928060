"""Tridiagonal systems with a border, and what their factors say about a minimum.

    [ Q  B ] [a]   [f]
    [ Bᵀ C ] [b] = [g]          Q tridiagonal (n), C small (m)

======  ========================================================
S       C − Bᵀ Q⁻¹ B, the Schur complement
ν(·)    number of negative eigenvalues; ν(K) = ν(Q) + ν(S)
======  ========================================================

A positive definite Q is factorised as LDLᵀ; an indefinite one by pivoted LU, at the same cost.

Q may be singular where the whole is not: under end forces θ′ of a bent beam solves its linearised equation, and between
an inflection and a place of even bending that is all that Q asks.  Unknowns that take part in what is nearly singular,
*anchors*, are moved from Q to the border.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigvalsh_tridiagonal, lapack

from scene.answer import Array, Ints

REFINEMENTS = 3
REFINED = 1e-14  # of the right-hand side


SINGULAR = 1e-4  # EI/ℓ²: a curvature of Q alone below it costs digits
ANCHORS = 8  # at most, beside the given ones
ROUNDED = 1e-14  # of the largest entry


def without(diagonal: Array, off: Array, held: Ints) -> tuple[Array, Array]:
    """A tridiagonal matrix in which the unknowns ``held`` have an equation each to themselves."""
    diagonal, off = diagonal.copy(), off.copy()
    diagonal[held] = 1.0
    off[held[held < len(off)]] = 0.0
    off[held[held > 0] - 1] = 0.0
    return diagonal, off


def anchored(diagonal: Array, off: Array, metric: Array, given: Ints, held: Ints) -> Ints:
    """The ``given`` anchors, and those without which what is left of Q would be nearly singular.

    Args:
        diagonal, off: of Q.
        metric: diagonal of the matrix M by which curvatures are measured, Q x = κ M x.
        given: anchors in any case; ``held``: unknowns that do not move.
    """
    anchors = given
    for _ in range(ANCHORS):
        gone = np.concatenate((anchors, held))
        kept, beside = without(diagonal, off, gone)
        factors = factorised(kept + ROUNDED * float(np.max(np.abs(kept))), beside)
        # two steps of inverse iteration, from a start that no symmetry makes orthogonal to what is sought
        vector = np.cos(0.7 * np.arange(len(kept))) + 1.5
        for _ in range(2):
            vector[gone] = 0.0
            vector /= np.sqrt(metric @ vector**2)
            vector = factors.solve((metric * vector)[:, None])[:, 0]
        vector[gone] = 0.0
        if float(np.sqrt(metric @ vector**2)) * SINGULAR < 1.0:
            break
        anchors = np.append(anchors, np.argmax(np.abs(vector)))
    return anchors


@dataclass(frozen=True, slots=True)
class Tridiagonal:
    """A factorised symmetric tridiagonal matrix."""

    diagonal: Array
    off: Array
    factors: tuple[Array, ...]
    positive: bool

    def solve(self, right: Array) -> Array:
        """Q⁻¹ applied to columns (n, k)."""
        if not right.shape[1]:
            return right.copy()
        if self.positive:
            d, e = self.factors
            solution, _ = lapack.dpttrs(d, e, right)
        else:
            dl, d, du, du2, pivots = self.factors
            solution, _ = lapack.dgttrs(dl, d, du, du2, pivots, right)
        return np.asarray(solution)

    def times(self, x: Array) -> Array:
        """Q applied to columns (n, k)."""
        product = self.diagonal[:, None] * x
        product[:-1] += self.off[:, None] * x[1:]
        product[1:] += self.off[:, None] * x[:-1]
        return np.asarray(product)

    def negative(self) -> int:
        """ν(Q), by Sturm sequences where Q is not positive definite."""
        if self.positive:
            return 0
        lowest = -2.0 * (np.max(np.abs(self.diagonal)) + 2.0 * np.max(np.abs(self.off), initial=0.0))
        return len(
            eigvalsh_tridiagonal(self.diagonal, self.off, select="v", select_range=(lowest, 0.0), check_finite=False)
        )


def factorised(diagonal: Array, off: Array) -> Tridiagonal:
    """Factors of a symmetric tridiagonal matrix.

    Raises:
        np.linalg.LinAlgError: it is exactly singular.
    """
    d, e, info = lapack.dpttrf(diagonal, off)
    if info == 0:
        return Tridiagonal(diagonal, off, (d, e), positive=True)
    *factors, info = lapack.dgttrf(off, diagonal, off)
    if info != 0:
        raise np.linalg.LinAlgError("singular tridiagonal matrix")
    return Tridiagonal(diagonal, off, tuple(factors), positive=False)


@dataclass(frozen=True, slots=True)
class Bordered:
    """A factorised tridiagonal matrix with a border: Q, B (n, m), C (m, m), Q⁻¹B and S (m, m)."""

    tridiagonal: Tridiagonal
    border: Array
    corner: Array
    solved: Array
    schur: Array

    def solve(self, f: Array, g: Array, keep: Ints) -> tuple[Array, Array]:
        """Solution with only the border's columns ``keep`` (indices) in the system.

        Args:
            f: (n,) or (n, k); g: (len(keep),) or (len(keep), k).
            keep: which border columns belong to the system.

        Returns:
            a and b, shaped as f and g.

        Raises:
            np.linalg.LinAlgError: the system is singular.
        """
        upper = f.reshape(len(f), -1)
        lower = g.reshape(len(keep), upper.shape[1])
        a, b = self._once(upper, lower, keep)
        # Q alone can be close to singular where the whole system is not: refine until that is mended
        size = np.max(np.abs(upper), initial=0.0) + np.max(np.abs(lower), initial=0.0)
        for _ in range(REFINEMENTS):
            left_upper = upper - self.tridiagonal.times(a) - self.border[:, keep] @ b
            left_lower = lower - self.border[:, keep].T @ a - self.corner[np.ix_(keep, keep)] @ b
            left = np.max(np.abs(left_upper), initial=0.0) + np.max(np.abs(left_lower), initial=0.0)
            if not left > REFINED * size:
                break
            da, db = self._once(left_upper, left_lower, keep)
            a, b = a + da, b + db
        return a.reshape(f.shape), b.reshape(g.shape)

    def _once(self, upper: Array, lower: Array, keep: Ints) -> tuple[Array, Array]:
        first = self.tridiagonal.solve(upper)
        lower = lower - self.border[:, keep].T @ first
        b: Array = (
            np.asarray(np.linalg.solve(self.schur[np.ix_(keep, keep)], lower), dtype=float) if len(keep) else lower
        )
        return first - self.solved[:, keep] @ b, b

    def negative(self, keep: Ints) -> int:
        """ν of the system with only the border's columns ``keep``."""
        schur = self.schur[np.ix_(keep, keep)]
        return self.tridiagonal.negative() + (int(np.sum(np.linalg.eigvalsh(schur) < 0.0)) if len(keep) else 0)


def bordered(diagonal: Array, off: Array, border: Array, corner: Array) -> Bordered:
    """Factorise Q and form S.

    Raises:
        np.linalg.LinAlgError: Q is exactly singular.
    """
    tridiagonal = factorised(diagonal, off)
    solved = tridiagonal.solve(border)
    schur = corner - border.T @ solved
    return Bordered(tridiagonal, border, corner, solved, 0.5 * (schur + schur.T))
