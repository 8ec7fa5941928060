"""Is an equilibrium a minimum?  The smallest curvature of the potential energy on the feasible directions.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
K       the tangent of the Lagrangian, with the joints' rows and the axial forces
u, q    motions of all nodes and bodies; those that no joint, stop, guide or drive gives, u = T q
H, B    K's block of the motions, and its rows of the axial forces by them
c l     the axial forces' diagonal in K, turned round: compliance times length
M       lumped mass, diagonal in u: arc length for the nodes, one for the bodies
A       T^T (H + B^T (c l)⁻¹ B) T
μ       curvatures: A q = μ T^T M T q, in EI per length of the longest beam to the fourth
======  =====================================================================================

Where a beam does not stretch there is no c; it is given a small one, under which its curvatures are no larger: on the
feasible directions B u = 0, so an A that is positive definite proves that H is there.

A is symmetric and, ordered along the beams, a band.  By Sylvester's law of inertia A − σ T^T M T has as many negative
pivots as there are μ below σ, and Cholesky's method ends at the first.  The least μ is bracketed with it: from above
by a Ritz value of Lanczos' method with (A − σ T^T M T)⁻¹, which lies above it whatever the start, from below by a σ
that leaves no negative pivot.  Round-off moves a pivot by the unit round-off times the diagonal of A, hence a μ by some
u 12 EI/h⁴.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded, eigh_tridiagonal, null_space
from scipy.sparse import block_diag, csr_array, diags_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

from fea_reference.hermite import Index
from fea_reference.mass import lumped_mass
from fea_reference.model import Model
from fea_reference.stops import acting_stops
from fea_reference.system import System
from scene.answer import Array

_STEPS = 30
_SEED = 20200103
_STIFF = 1e6  # EI/length²: EA of a beam that does not stretch, a hundred times that of a stout one
_CLOSE = 0.9  # of a Ritz value: the μ that is proven to have none below it
_TRIALS = 60


@dataclass(frozen=True, slots=True)
class Mode:
    """The least ``curvature`` μ, and its motions u among all unknowns, ``direction`` (size,) with uᵀ M u = 1."""

    curvature: float
    direction: Array


def smallest_curvature(model: Model, system: System) -> float:
    """The least μ, see :func:`softest`."""
    return softest(model, system).curvature


def softest(model: Model, system: System) -> Mode:
    """The least μ, if it is above zero: a Ritz value, and a tenth less is proven to lie below all.

    Where that cannot be proven, a value that can, and if not even zero can, a Ritz value above one below zero that can:
    there is a negative curvature about as large, or round-off hides that there is none.
    """
    motions, T, A, mass = _on_feasible_directions(model, system)
    order = np.asarray(reverse_cuthill_mckee(A, symmetric_mode=True))
    T = T[:, order]
    stiffness, inertia = _bands(A[order][:, order], (T.T @ diags_array(mass) @ T).tocsr())

    def factor(sigma: float) -> Array | None:
        """Cholesky's of A − σ M; None where there is a pivot below zero."""
        try:
            return np.asarray(cholesky_banded(stiffness - sigma * inertia, lower=True, check_finite=False))
        except LinAlgError:
            return None

    def mode(curvature: float, u: Array) -> Mode:
        direction = np.zeros(model.size)
        direction[motions] = u
        return Mode(curvature, direction)

    root = np.sqrt(mass)
    at_zero = factor(0.0)
    if at_zero is None:
        below = _below_zero(factor)
        at_below = factor(below)
        if at_below is None:  # round-off, however far below
            return mode(below, np.zeros(motions.size))
        ritz, u = _ritz(T, at_below, root)
        # rounded to zero it would not say that there was a negative pivot
        return mode(min(below + ritz, -np.finfo(float).tiny), u)
    ritz, u = _ritz(T, at_zero, root)
    if factor(_CLOSE * ritz) is not None:
        return mode(ritz, u)
    sigma = 0.5 * ritz
    while factor(sigma) is None and sigma > 0.0:
        sigma *= 0.5
    return mode(sigma, u)


def _on_feasible_directions(model: Model, system: System) -> tuple[Index, csr_array, csr_array, Array]:
    """Which unknowns are the motions (u,), T (u, q), A (q, q) and the diagonal of M (u,)."""
    K = csr_array(system.tangent)
    bodies = [body.dofs for body in model.bodies if body.dofs is not None]
    motions = np.concatenate([model.node_dofs.T.ravel(), *bodies])
    axial = model.element_dofs[6]
    place = np.full(model.size, -1)
    place[motions] = np.arange(motions.size)

    joints = [joint for joint in model.joints if not model.free(joint, system.acting)]
    stops = [stop for stop, _ in acting_stops(model.stops, system.acting)]
    held = np.concatenate(
        [
            np.array([stop.theta for stop in stops], dtype=np.int64),
            *(joint.dofs[: joint.rows.size] for joint in joints),
        ]
    )
    rows = np.concatenate([np.array([stop.row for stop in stops], dtype=np.int64), *(joint.rows for joint in joints)])
    free = np.ones(motions.size, dtype=bool)
    free[place[held]] = False
    # A joint's row is its node's motion, less what the body makes of it, and so is a stop's.
    follow = csr_array((motions.size, motions.size))
    if held.size:
        own = csr_array((np.ones(held.size), (place[held], np.arange(held.size))), (motions.size, held.size))
        follow = own @ K[rows][:, motions]
    T = csr_array(diags_array(np.ones(motions.size)) - follow)[:, free] @ _bodies_motions(model, K, int(free.sum()))

    compliance = np.maximum(-K.diagonal()[axial], model.elements.length / _STIFF)
    B = K[axial][:, motions] @ T
    A = T.T @ K[motions][:, motions] @ T + B.T @ diags_array(1.0 / compliance) @ B

    return motions, T, csr_array(A), lumped_mass(model)[motions]


def _bodies_motions(model: Model, K: csr_array, size: int) -> csr_array:
    """What hinges, guides and drives leave free of ``size`` motions, of which the last are the bodies', (size, q)."""
    if model.hinges:
        dofs = np.concatenate([body.dofs for body in model.bodies if body.dofs is not None])
        rows = [*(row for hinge in model.hinges for row in hinge.rows)]
        rows += [hold.row for hold in (*model.guides, *model.drives)]
        nodes = diags_array(np.ones(size - dofs.size))
        return csr_array(block_diag([nodes, csr_array(null_space(K[rows][:, dofs].toarray()))]))
    blocks = []
    for i, body in enumerate(model.bodies):
        if body.dofs is None:
            continue
        rows = [hold.row for hold in (*model.guides, *model.drives) if hold.body == i]
        blocks.append(null_space(K[rows][:, body.dofs].toarray()) if rows else np.eye(3))
    nodes = diags_array(np.ones(size - 3 * len(blocks)))
    return csr_array(block_diag([nodes, *blocks]))


def _bands(*matrices: csr_array) -> list[Array]:
    """The lower halves of symmetric matrices (m, m), all as wide as the widest, in LAPACK's order."""
    entries = [matrix.tocoo() for matrix in matrices]
    width = max(int((one.coords[0] - one.coords[1]).max(initial=0)) for one in entries)
    bands = []
    for one in entries:
        rows, columns = one.coords
        band = np.zeros((width + 1, one.shape[0]))
        lower = rows >= columns
        band[(rows - columns)[lower], columns[lower]] = one.data[lower]
        bands.append(band)
    return bands


def _ritz(T: csr_array, factor: Array, root: Array) -> tuple[float, Array]:
    """1 over the largest Ritz value of M^½ T A⁻¹ T^T M^½, whose eigenvalues are 1/μ and zeros, and its u."""
    v = root * np.random.default_rng(_SEED).standard_normal(root.size)
    v /= np.linalg.norm(v)
    basis: list[Array] = []
    diagonal: list[float] = []
    beside: list[float] = []
    for _ in range(_STEPS):
        basis.append(v)
        w = root * (T @ cho_solve_banded((factor, True), T.T @ (root * v), check_finite=False))
        diagonal.append(float(v @ w))
        Q = np.array(basis)
        w -= Q.T @ (Q @ w)
        w -= Q.T @ (Q @ w)
        beta = float(np.linalg.norm(w))
        if beta <= 1e-12 * max(diagonal):
            break
        beside.append(beta)
        v = w / beta
    values, vectors = eigh_tridiagonal(np.array(diagonal), np.array(beside[: len(diagonal) - 1]))
    return 1.0 / float(values[-1]), np.asarray((np.array(basis).T @ vectors[:, -1]) / root)


def _below_zero(factor: Callable[[float], Array | None]) -> float:
    """The largest σ, to a tenth of itself, that leaves no negative pivot."""
    none, some = -1.0, 0.0
    for _ in range(_TRIALS):
        if factor(none) is not None:
            break
        none, some = 4.0 * none, none
    for _ in range(_TRIALS):
        if some - none <= -0.1 * none:
            break
        middle = 0.5 * (none + some)
        none, some = (none, middle) if factor(middle) is None else (middle, some)
    return none
