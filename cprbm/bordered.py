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
from scipy.linalg import lapack

from cprbm_scene.answer import Array, Ints

REFINEMENTS = 3
REFINED = 1e-14  # of the right-hand side


SINGULAR = 1e-4  # EI/ℓ²: a curvature of Q alone below it costs digits
SUSPECT = 30.0 * SINGULAR  # what a vector with a part in every direction is bent by, times this, is one or more
ANCHORS = 8  # at most, beside the given ones
ROUNDED = 1e-14  # of the largest entry


def generic(metric: Array, held: Ints) -> Array:
    """A right-hand side of size one that no symmetry makes orthogonal to anything, but zero at the unknowns ``held``.

    Args:
        metric: diagonal of the matrix M by which vectors are measured (n,).
        held: unknowns that do not move.
    """
    vector = np.cos(0.7 * np.arange(len(metric))) + 1.5
    vector[held] = 0.0
    return np.asarray(metric * vector / np.sqrt(metric @ vector**2))


class Held:
    """Some of n ``unknowns`` that have an equation each to themselves; ``beside`` are their places off the diagonal."""

    def __init__(self, unknowns: Ints, n: int) -> None:
        self.unknowns = unknowns
        self.beside = np.concatenate((unknowns[unknowns < n - 1], unknowns[unknowns > 0] - 1))


def without(diagonal: Array, off: Array, held: Held) -> tuple[Array, Array]:
    """A tridiagonal matrix in which the unknowns ``held`` have an equation each to themselves."""
    diagonal, off = diagonal.copy(), off.copy()
    diagonal[held.unknowns] = 1.0
    off[held.beside] = 0.0
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
        kept, beside = without(diagonal, off, Held(gone, len(diagonal)))
        factors = factorised(kept + ROUNDED * float(np.max(np.abs(kept))), beside)
        # two steps of inverse iteration
        vector = factors.solve(generic(metric, gone)[:, None])[:, 0]
        vector[gone] = 0.0
        vector = factors.solve((metric * vector / np.sqrt(metric @ vector**2))[:, None])[:, 0]
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
        found: Array = solution
        return found

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
        lowest = -2.0 * float(np.abs(self.diagonal).max() + 2.0 * np.abs(self.off).max())
        # of the eigenvalues from there to zero only the number is wanted: they need not be parted from each other
        by_values, unsorted = 1, "B"
        number, _, _, _, info = lapack.dstebz(self.diagonal, self.off, by_values, lowest, 0.0, 1, 1, -lowest, unsorted)
        if info > 1:
            raise np.linalg.LinAlgError("eigenvalues cannot be counted")
        return int(number)

    def nearly_singular(self, right: Array, metric: Array) -> bool:
        """Whether Q may be: a ``right`` side (n,) of size one, as :func:`generic` makes it, bends it far."""
        bent = self.solve(right[:, None])[:, 0]
        return not SUSPECT**2 * float(metric @ bent**2) < 1.0


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


class Symmetric:
    """A factorised symmetric matrix (m, m), indefinite as it may be: LDLᵀ with blocks of one and two (Bunch, Kaufman).

    Attributes:
        negative: number of its negative eigenvalues.

    Raises:
        np.linalg.LinAlgError: it is exactly singular.
    """

    def __init__(self, matrix: Array) -> None:
        self.negative = 0
        if not len(matrix):
            return
        self._factors, self._pivots, info = lapack.dsytrf(matrix, lower=1)
        if info != 0:
            raise np.linalg.LinAlgError("singular Schur complement")
        # of every block of two one eigenvalue is negative, and two entries of the pivots are
        paired, below = self._pivots < 0, self._factors.diagonal() < 0.0
        self.negative = int(np.count_nonzero(below & ~paired)) + int(np.count_nonzero(paired)) // 2

    def solve(self, right: Array) -> Array:
        """Solution for columns (m, k)."""
        if not len(right):
            return right
        solution: Array = lapack.dsytrs(self._factors, self._pivots, right, lower=1)[0]
        return solution


@dataclass(frozen=True, slots=True)
class Kept:
    """A factorised bordered system with some of the border's columns only, as :class:`Bordered` has them."""

    tridiagonal: Tridiagonal
    border: Array
    corner: Array
    solved: Array
    schur: Symmetric

    @property
    def negative(self) -> int:
        """ν(K)."""
        return self.tridiagonal.negative() + self.schur.negative

    def solve(self, f: Array, g: Array) -> tuple[Array, Array]:
        """Solution.

        Args:
            f: (n,) or (n, k); g: (m,) or (m, k).

        Returns:
            a and b, shaped as f and g.
        """
        upper = f.reshape(len(f), -1)
        lower = g.reshape(len(g), upper.shape[1])
        a, b = self.once(upper, lower)
        # Q alone can be close to singular where the whole system is not: refine until that is mended
        size = np.abs(upper).max(initial=0.0) + np.abs(lower).max(initial=0.0)
        for _ in range(REFINEMENTS):
            left_upper = upper - self.tridiagonal.times(a) - self.border @ b
            left_lower = lower - self.border.T @ a - self.corner @ b
            left = np.abs(left_upper).max(initial=0.0) + np.abs(left_lower).max(initial=0.0)
            if not left > REFINED * size:
                break
            da, db = self.once(left_upper, left_lower)
            a, b = a + da, b + db
        return a.reshape(f.shape), b.reshape(g.shape)

    def once(self, upper: Array, lower: Array) -> tuple[Array, Array]:
        """Solution for columns (n, k) and (m, k), not refined."""
        first = self.tridiagonal.solve(upper)
        b = self.schur.solve(lower - self.border.T @ first)
        return first - self.solved @ b, b


@dataclass(frozen=True, slots=True)
class Bordered:
    """A factorised tridiagonal matrix with a border: Q, B (n, m), C (m, m), Q⁻¹B and S (m, m)."""

    tridiagonal: Tridiagonal
    border: Array
    corner: Array
    solved: Array
    schur: Array

    def kept(self, keep: Ints) -> Kept:
        """The system with only the border's columns ``keep`` (indices).

        Raises:
            np.linalg.LinAlgError: it is exactly singular.
        """
        square = keep[:, None], keep
        return Kept(
            self.tridiagonal,
            self.border[:, keep],
            self.corner[square],
            self.solved[:, keep],
            Symmetric(self.schur[square]),
        )


def bordered(tridiagonal: Tridiagonal, border: Array, corner: Array) -> Bordered:
    """Form S."""
    solved = tridiagonal.solve(border)
    schur = corner - border.T @ solved
    # where Q is nearly singular the two halves differ by more than round-off
    return Bordered(tridiagonal, border, corner, solved, 0.5 * (schur + schur.T))
