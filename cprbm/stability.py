"""Stability of an equilibrium: curvatures of the potential energy on the directions that are free.

==========  =================================================================================
K           Newton's system with the equalities and the contacts that press, on θ
M           metric ∫ dθ² ds: the links' lengths, zero for links that do not turn
κ, φ        √M K⁻¹ √M x = x/κ, φ = x/√M; κ in EI/ℓ² of the stiffest beam
==========  =================================================================================
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.linalg import eigh_tridiagonal, lapack

from cprbm.newton import local_system_at, many, own_system
from cprbm.point import Point, Problem
from cprbm.stretching import folds
from cprbm_scene.answer import Array, Flags

DENSE = 120  # unknowns up to which all curvatures are computed at once
LANCZOS = 40  # steps
BLOCK = 5  # vectors at once where the ones that are wanted are the highest
BLOCKS = 8
KNOWN = (
    1e-4  # of the eigenvalue: what is left of the equation that its vector solves; its own error goes with the square
)
HELD = 1e-3  # of the least compliance that a chain's springs leave any motion: less is round-off, and nothing is free
SMALL = 1e-9  # of the largest compliance: negative ones below it are round-off


@dataclass(frozen=True, slots=True)
class Softest:
    """The smallest ``curvature`` κ, or of several negative ones that nearest to zero, and its direction (n_links,)."""

    curvature: float
    direction: Array


def softest(problem: Problem, point: Point) -> Softest:
    """κ and φ of PE on the directions that keep the equalities and the pressing contacts.

    Minus infinity where the system is singular or a linkage folds, infinity where no direction is free.
    """
    if folds(problem, point):
        return Softest(float("-inf"), np.zeros(problem.model.n_links))
    root = np.sqrt(problem.model.lengths)
    root[problem.closure.fixed] = 0.0
    try:
        if many(point.rows):
            value, vector = _extreme(_local_inverse(problem, point, root), problem.model.n_links, lowest=None)
        elif own_system(problem, point).stable:
            value, vector = _highest(_bordered_inverse(problem, point, root), problem.model.n_links)
        else:
            value, vector = _extreme(_bordered_inverse(problem, point, root), problem.model.n_links, lowest=True)
    except (np.linalg.LinAlgError, RuntimeError):
        return Softest(float("-inf"), np.zeros(problem.model.n_links))
    # joints of links h long, side by side, turn against each other by 4 E·I/h² at most
    least = 0.25 * float(np.min(root, where=root > 0.0, initial=1.0)) ** 4
    if abs(value) <= HELD * least:
        return Softest(float("inf"), np.zeros(problem.model.n_links))
    direction = np.divide(vector, root, out=np.zeros_like(vector), where=root > 0.0)
    return Softest(1.0 / value, direction)


def smallest_curvature(problem: Problem, point: Point) -> float:
    """κ, as :func:`softest` finds it."""
    return softest(problem, point).curvature


def released(point: Point, others: Flags) -> Point:
    """A state in which no rows but these ``others`` (m,) hold anything any more."""
    return replace(point, lam=np.where(others, point.lam, 0.0))


def _bordered_inverse(problem: Problem, point: Point, root: Array) -> Callable[[Array], Array]:
    """√M K⁻¹ √M on columns over θ.

    With P the anchors' places in the border, V = P − Q⁻¹B and I₀ the identity but for the anchors,
    K⁻¹ = I₀ Q⁻¹ I₀ + V S⁻¹ Vᵀ: nothing stands in the anchors' rows of Q⁻¹B.
    """
    found = own_system(problem, point)
    kept = found.kept
    V = -kept.solved
    V[found.anchors, found.n_bodies + np.arange(len(found.anchors))] = 1.0
    V *= root[:, None]
    free = root[:, None].copy()
    free[found.anchors] = 0.0

    def inverse(x: Array) -> Array:
        through = kept.tridiagonal.solve(free * x)
        through *= free
        through += V @ kept.schur.solve(V.T @ x)
        return through

    return inverse


def _local_inverse(problem: Problem, point: Point, root: Array) -> Callable[[Array], Array]:
    """√M K⁻¹ √M on columns over θ, through the system with the joints' positions."""
    found = local_system_at(problem, point)
    active = point.lam > 0.0
    factors = found.factorised(active)
    size, n = found.size + int(np.sum(active)), found.n_links

    def inverse(x: Array) -> Array:
        right = np.zeros((size, x.shape[1]))
        right[:n] = root[:, None] * x
        return np.asarray(root[:, None] * factors.solve(right)[:n])

    return inverse


def _extreme(inverse: Callable[[Array], Array], n: int, *, lowest: bool | None) -> tuple[float, Array]:
    """The lowest or highest eigenvalue of a symmetric operator on R^n, and its vector.

    Where it is unknown which of the two is wanted, the lowest if it is negative.
    """
    if n <= DENSE:
        full = inverse(np.eye(n))
        values, vectors = np.linalg.eigh(0.5 * (full + full.T))
    else:
        values, vectors = _ritz(inverse, n)
    if lowest is None:
        lowest = bool(values[0] < -SMALL * abs(values[-1]))
    end = 0 if lowest else -1
    return float(values[end]), vectors[:, end]


def _highest(inverse: Callable[[Array], Array], n: int) -> tuple[float, Array]:
    """The highest eigenvalue of a symmetric positive semidefinite operator on R^n, and its vector.

    By Krylov spaces of a few vectors, smooth and with no symmetry; the compliances of a beam fall with the square of
    their number at least, so that a few steps settle the first.
    """
    columns = min(BLOCK, n)
    most = columns * min(BLOCKS, n // columns)
    basis, images, projected = np.empty((n, most)), np.empty((n, most)), np.empty((most, most))
    vectors = _smooth(n, columns)
    for so_far in range(columns, most + 1, columns):
        new, space = slice(so_far - columns, so_far), basis[:, :so_far]
        basis[:, new] = _orthonormal(vectors)
        image = inverse(basis[:, new])
        images[:, new] = image
        parts = space.T @ image
        projected[:so_far, new] = parts
        if so_far > columns:
            # the upper triangle is all that is read
            values, vectors, _ = lapack.dsyevd(projected[:so_far, :so_far])
            value, part = float(values[-1]), vectors[:, -1]
            found = space @ part
            left = images[:, :so_far] @ part - value * found
            if float(left @ left) <= (KNOWN * value) ** 2:
                return value, found
        # twice, lest what is left of a vector that lay in the space is round-off in that space
        vectors = image - space @ parts
        vectors -= space @ (space.T @ vectors)
    return _extreme(inverse, n, lowest=False)


@cache
def _smooth(n: int, columns: int) -> Array:
    """Vectors (n, columns) with which Krylov spaces begin."""
    found = np.cos(np.outer(np.arange(n) / n, 1.7 + 2.3 * np.arange(columns))) + 1.5 / (1.0 + np.arange(columns))
    found.flags.writeable = False
    return np.asarray(found)


def _orthonormal(vectors: Array) -> Array:
    """An orthonormal basis (n, k) of the space of some vectors, by Householder's reflections."""
    factors, tau, _, _ = lapack.dgeqrf(vectors)
    basis, _, _ = lapack.dorgqr(factors, tau)
    return np.asarray(basis)


def _ritz(inverse: Callable[[Array], Array], n: int) -> tuple[Array, Array]:
    """Eigenvalues and vectors, the outer of them good, by Lanczos' method from a start with no symmetry.

    With full reorthogonalisation.  The compliances of a beam fall with the fourth power of their number, so that a few
    steps settle the ends.
    """
    vector = np.cos(0.7 * np.arange(n)) + 1.5
    basis = np.zeros((n, LANCZOS))
    diagonal, off = np.zeros(LANCZOS), np.zeros(LANCZOS)
    vector /= np.linalg.norm(vector)
    steps = LANCZOS
    for k in range(LANCZOS):
        basis[:, k] = vector
        image = inverse(vector[:, None])[:, 0]
        diagonal[k] = vector @ image
        for _ in range(2):
            image = image - basis[:, : k + 1] @ (basis[:, : k + 1].T @ image)
        off[k] = np.linalg.norm(image)
        if off[k] <= 1e-13 * np.max(np.abs(diagonal)):
            steps = k + 1
            break
        vector = image / off[k]
    values, vectors = eigh_tridiagonal(diagonal[:steps], off[: steps - 1])
    return values, basis[:, :steps] @ vectors
