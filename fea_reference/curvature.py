"""Smallest curvature of the potential energy on the feasible directions: stability of an equilibrium.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
K       tangent of the Lagrangian, with the joints' rows and the axial forces
u, q    motions of all nodes and bodies; the independent motions under all constraints, u = T q
H, B    K's block of the motions, and its rows of the axial forces by the motions
c l     negative diagonal of the axial forces in K: compliance times length
M       lumped mass, diagonal in u: arc length for the nodes, one for the bodies
A       T^T (H + B^T (c l)⁻¹ B) T
μ       curvatures: A q = μ T^T M T q, in EI per length of the longest beam to the fourth
======  =====================================================================================

An inextensible beam has c = 0 and is given a small c, which does not lower the curvatures: B u = 0 holds on the
feasible directions, so that a positive definite A proves a positive definite H there.

A is symmetric and, ordered along the beams, banded. By Sylvester's law of inertia A − σ T^T M T has as many negative
pivots as there are μ below σ. Cholesky's method stops at the first negative pivot. This brackets the least μ. An
upper bound is a Ritz value of Lanczos' method with (A − σ T^T M T)⁻¹, from any start vector; a lower bound is a σ
without negative pivot. Round-off moves a pivot by the unit round-off times the diagonal of A, hence μ by u 12 EI/h⁴.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cholesky_banded, eigh_tridiagonal, null_space
from scipy.linalg.lapack import dpbtrs
from scipy.sparse import csr_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

from cprbm_scene.answer import Array
from fea_reference.hermite import Index
from fea_reference.mass import lumped_mass
from fea_reference.model import Model
from fea_reference.stops import acting_stops
from fea_reference.system import System

_STEPS = 30
_LOOK = 4  # steps between two checks of convergence in Lanczos' method
_ENOUGH = 1e-6  # times the Ritz value: accepted residual of its vector; the error of the value is of second order
_SEED = 20200103
_STIFF = 1e6  # EI/length²: EA of an inextensible beam, a hundred times the EA of a stout beam
_CLOSE = 0.9  # times a Ritz value: proven lower bound of all μ
_TRIALS = 60


@dataclass(frozen=True, slots=True)
class Mode:
    """The least ``curvature`` μ and its mode u, ``direction`` (size,) with uᵀ M u = 1."""

    curvature: float
    direction: Array


def all_positive(model: Model, system: System) -> bool:
    """True if all μ are positive up to round-off."""
    return _factor(_feasible(model, system).stiffness) is not None


def softest(model: Model, system: System) -> Mode:
    """The least μ and its mode, accurate to a tenth.

    For a positive least μ a Ritz value; Cholesky's method proves that 0.9 of the value is a lower bound. Without such
    a proof a smaller value with a proof is returned. If even zero has none, the result is negative: a Ritz value
    above a proven negative bound. Then a curvature of this size is negative, or round-off hides the sign.
    """
    on, root = _feasible(model, system), np.sqrt(lumped_mass(model))

    def factor(sigma: float) -> Array | None:
        """Cholesky factor of A − σ M; None for a negative pivot."""
        return _factor(on.stiffness - sigma * on.inertia)

    at_zero = factor(0.0)
    if at_zero is None:
        below = _below_zero(factor)
        at_below = factor(below)
        if at_below is None:  # round-off, however low the bound
            return Mode(below, np.zeros(model.size))
        ritz, u = _ritz(on, at_below, root)
        # a zero would not show the negative pivot
        return Mode(min(below + ritz, -np.finfo(float).tiny), u)
    ritz, u = _ritz(on, at_zero, root)
    sigma = ritz
    while factor(min(sigma, _CLOSE * ritz)) is None and sigma > 0.0:
        sigma *= 0.5
    return Mode(sigma, u)


def moment_mode(model: Model, system: System, drag: float) -> Array:
    """Motion u (size,) under small moments 1 + s per length on all sections, against a ``drag`` (EI per length⁴).

    s is the arc length along the beams in the scene's order, in lengths of the longest. At a bifurcation the moments
    select a mode independent of the mesh and of the order of assembly. The drag has to exceed every negative
    curvature; otherwise the moments themselves are returned.
    """
    on, moments = _feasible(model, system), np.zeros(model.size)
    factor = _factor(on.stiffness + drag * on.inertia)
    lengths = lumped_mass(model)[model.node_dofs[2]]
    moments[model.node_dofs[2]] = lengths * (1.0 + np.cumsum(lengths))
    return moments if factor is None else _solve(on, factor, moments)


@dataclass(frozen=True, slots=True)
class _Feasible:
    """The feasible directions, in an order with a small bandwidth of A.

    Attributes:
        T: motions of all unknowns by the directions (size, q); back: the transpose.
        place: position (q,) of every direction in this order.
        stiffness, inertia: lower halves of A and T^T M T (width + 1, q), in LAPACK's band storage.
    """

    T: csr_array
    back: csr_array
    place: Index
    stiffness: Array
    inertia: Array


def _factor(band: Array) -> Array | None:
    """Cholesky factor of a matrix in lower band storage; None for a negative pivot."""
    try:
        return np.asarray(cholesky_banded(band, lower=True, check_finite=False))
    except LinAlgError:
        return None


def _feasible(model: Model, system: System) -> _Feasible:
    """T, A and the lumped mass on the feasible directions."""
    tangent = system.tangent
    K = csr_array((tangent.data, tangent.indices, tangent.indptr), tangent.shape)  # symmetric
    T = _directions(model, system, K)
    back = T.T.tocsr()
    KT = K @ T
    axial = model.element_dofs[6]
    BT = KT[axial]
    compliance = np.maximum(-tangent.diagonal()[axial], model.elements.length / _STIFF)
    BT.data /= np.sqrt(np.repeat(compliance, np.diff(BT.indptr)))
    A = csr_array(back @ KT + BT.T.tocsr() @ BT)
    order = reverse_cuthill_mckee(A, symmetric_mode=True)
    place = np.empty(order.size, dtype=np.int64)
    place[order] = np.arange(order.size)
    mass = np.repeat(lumped_mass(model), np.diff(T.indptr))
    stiffness, inertia = _bands(place, A, csr_array(back @ csr_array((mass * T.data, T.indices, T.indptr), T.shape)))
    return _Feasible(T, back, place, stiffness, inertia)


def _directions(model: Model, system: System, K: csr_array) -> csr_array:
    """T: all motions by the independent motions; zero rows for forces and multipliers."""
    joints = [joint for joint in model.joints if not model.free(joint, system.acting)]
    stops = [stop for stop, _ in acting_stops(model.stops, system.acting)]
    # a row of a joint or stop is the node's motion minus the body's contribution
    row_of = {int(dof): int(row) for joint in joints for dof, row in zip(joint.dofs, joint.rows, strict=False)}
    row_of |= {stop.theta: stop.row for stop in stops}
    free = np.ones(model.size, dtype=bool)
    free[list(row_of)] = False
    nodes = model.node_dofs.ravel()
    independent = nodes[free[nodes]]
    rows, columns, entries = [independent], [np.arange(independent.size)], [np.ones(independent.size)]
    count = independent.size
    of_bodies: dict[int, tuple[Index, Array]] = {}
    for group in _connected_bodies(model):
        dofs = np.concatenate([dofs for i in group if (dofs := model.bodies[i].dofs) is not None])
        constrained = [hold.row for hold in (*model.guides, *model.drives) if hold.body in group]
        constrained += [int(row) for hinge in model.hinges if set(hinge.bodies) & group for row in hinge.rows]
        free_motions = null_space(K[constrained][:, dofs].toarray()) if constrained else np.eye(dofs.size)
        here = count + np.arange(free_motions.shape[1])
        count += here.size
        of_bodies |= {int(dof): (here, line) for dof, line in zip(dofs, free_motions, strict=True)}
    couplings = [(dof, dof, 1.0) for dof in of_bodies]
    for dof, row in row_of.items():
        entry = slice(K.indptr[row], K.indptr[row + 1])
        couplings += [
            (dof, int(other), -float(value))
            for other, value in zip(K.indices[entry], K.data[entry], strict=True)
            if int(other) in of_bodies
        ]
    for dof, other, value in couplings:
        here, line = of_bodies[other]
        rows.append(np.full(here.size, dof))
        columns.append(here)
        entries.append(value * line)
    return csr_array((np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), (model.size, count))


def _connected_bodies(model: Model) -> list[set[int]]:
    """Sets of moving bodies connected by hinges."""
    groups = [{i} for i, body in enumerate(model.bodies) if body.dofs is not None]
    for hinge in model.hinges:
        joined = [group for group in groups if group & set(hinge.bodies)]
        groups = [group for group in groups if group not in joined]
        groups.append(set[int]().union(*joined))
    return groups


def _bands(place: Index, *matrices: csr_array) -> list[Array]:
    """Lower bands of symmetric matrices (m, m) in the order ``place``, all of the largest width."""
    entries = [(np.repeat(place, np.diff(matrix.indptr)), place[matrix.indices], matrix.data) for matrix in matrices]
    width = max(int((rows - columns).max(initial=0)) for rows, columns, _ in entries)
    bands = []
    for rows, columns, data in entries:
        lower = rows >= columns
        band = np.zeros((width + 1, place.size))
        band[(rows - columns)[lower], columns[lower]] = data[lower]
        bands.append(band)
    return bands


def _ritz(on: _Feasible, factor: Array, root: Array) -> tuple[float, Array]:
    """Reciprocal of the largest Ritz value of M^½ T A⁻¹ T^T M^½, with eigenvalues 1/μ and zeros, and its u (size,)."""
    moving = np.flatnonzero(root)
    v = np.zeros(root.size)
    v[moving] = root[moving] * np.random.default_rng(_SEED).standard_normal(moving.size)
    v /= np.linalg.norm(v)
    Q = np.zeros((_STEPS, root.size))
    diagonal: list[float] = []
    beside: list[float] = []
    for step in range(_STEPS):
        Q[step] = v
        w = root * _solve(on, factor, root * v)
        diagonal.append(float(v @ w))
        so_far = Q[: step + 1]
        w -= so_far.T @ (so_far @ w)
        w -= so_far.T @ (so_far @ w)
        beta = float(np.linalg.norm(w))
        last = beta <= 1e-12 * max(diagonal) or step == _STEPS - 1
        if last or step % _LOOK == _LOOK - 1:
            values, vectors = eigh_tridiagonal(np.array(diagonal), np.array(beside))
            if last or beta * abs(float(vectors[-1, -1])) <= _ENOUGH * float(values[-1]):
                break
        beside.append(beta)
        v = w / beta
    u = np.zeros(root.size)
    u[moving] = (so_far.T @ vectors[:, -1])[moving] / root[moving]
    return 1.0 / float(values[-1]), u


def _solve(on: _Feasible, factor: Array, forces: Array) -> Array:
    """T A⁻¹ T^T times ``forces`` (size,), by the factor of A."""
    right = np.empty(on.place.size)
    right[on.place] = on.back @ forces
    return np.asarray(on.T @ dpbtrs(factor, right, lower=1)[0][on.place])


def _below_zero(factor: Callable[[float], Array | None]) -> float:
    """The largest σ without negative pivot, to a tenth of its value."""
    definite, indefinite = -1.0, 0.0
    for _ in range(_TRIALS):
        if factor(definite) is not None:
            break
        definite, indefinite = 4.0 * definite, definite
    for _ in range(_TRIALS):
        if indefinite - definite <= -0.1 * definite:
            break
        middle = 0.5 * (definite + indefinite)
        definite, indefinite = (definite, middle) if factor(middle) is None else (middle, indefinite)
    return definite
