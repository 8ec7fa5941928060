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
from functools import lru_cache

import numpy as np
from scipy.linalg import LinAlgError, cholesky_banded, eigh_tridiagonal, null_space
from scipy.linalg.lapack import dpbtrs
from scipy.sparse import csc_matrix, csr_array
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
    on = _feasible(model, system)
    root = np.sqrt(on.mass)

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
    """Motion u (size,) under small moments (1 + s)² per length on all sections, against a ``drag`` (EI per length⁴).

    s is the arc length along the beams in the scene's order, in lengths of the longest. At a bifurcation the moments
    select a mode independent of the mesh and of the order of assembly. Moments of the first degree do no work on the
    antisymmetric mode of a beam clamped at both ends. The drag has to exceed every negative
    curvature; otherwise the moments themselves are returned.
    """
    on, moments = _feasible(model, system), np.zeros(model.size)
    factor = _factor(on.stiffness + drag * on.inertia)
    lengths = on.mass[model.node_dofs[2]]
    moments[model.node_dofs[2]] = lengths * (1.0 + np.cumsum(lengths)) ** 2
    return moments if factor is None else on.solve(factor, moments)


@dataclass(frozen=True, slots=True)
class _Feasible:
    """The feasible directions, in an order with a small bandwidth of A.

    Attributes:
        rows, columns, entries: T, motions of all unknowns (size,) by the directions (q,).
        mass: M, (size,).
        stiffness, inertia: lower halves of A and T^T M T (width + 1, q), in LAPACK's band storage.
    """

    rows: Index
    columns: Index
    entries: Array
    mass: Array
    stiffness: Array
    inertia: Array

    def solve(self, factor: Array, forces: Array) -> Array:
        """T A⁻¹ T^T times ``forces`` (size,), by the factor of A."""
        right = np.bincount(self.columns, self.entries * forces[self.rows], factor.shape[1])
        directions = dpbtrs(factor, right, lower=1)[0]
        return np.asarray(np.bincount(self.rows, self.entries * directions[self.columns], forces.size), dtype=float)


def _factor(band: Array) -> Array | None:
    """Cholesky factor of a matrix in lower band storage; None for a negative pivot."""
    try:
        return np.asarray(cholesky_banded(band, lower=True, check_finite=False))
    except LinAlgError:
        return None


def _feasible(model: Model, system: System) -> _Feasible:
    """T, A and the lumped mass on the feasible directions."""
    K, mass = system.tangent.matrix, lumped_mass(model)
    rows, columns, entries = _directions(model, system, K)
    axial = model.element_dofs[6]
    place, bands = _layout(*(of.tobytes() for of in (K.indices, K.indptr.astype(np.int64), rows, columns, axial)))
    compliance = np.maximum(-K.diagonal()[axial], model.elements.length / _STIFF)
    return _Feasible(rows, place[columns], entries, mass, *bands(K.data, compliance, entries, mass[rows]))


@lru_cache(maxsize=32)
def _layout(
    indices: bytes, indptr: bytes, rows: bytes, columns: bytes, axial: bytes
) -> tuple[Index, Callable[[Array, Array, Array, Array], tuple[Array, Array]]]:
    """Places (q,) of the directions, and the bands of A and T^T M T, for matrices K and T of given patterns.

    The patterns are indices and pointers of K, rows and columns of T, sorted by rows, and the unknowns of the axial
    forces. The bands follow from the entries of K, the compliances c l, the entries of T and the mass of their rows.
    """
    K_columns, pointer, T_rows, T_columns, forces = (
        np.frombuffer(of, dtype=kind)
        for of, kind in ((indices, np.int32), *((of, np.int64) for of in (indptr, rows, columns, axial)))
    )
    unknowns, size = np.arange(pointer.size - 1), int(T_columns.max(initial=-1)) + 1
    K_rows, begin = np.repeat(unknowns, np.diff(pointer)), np.searchsorted(T_rows, np.arange(pointer.size))
    count = np.diff(begin)

    def of_motions(here: Index, there: Index) -> tuple[Index, Index]:
        """Numbers of the pairs of unknowns with pairs of entries of T, and these entries (2, k)."""
        return _all_pairs(begin[here], count[here], begin[there], count[there])

    own, own_pairs = of_motions(K_rows, K_columns)
    element = np.full(unknowns.size, -1)
    element[forces] = np.arange(forces.size)
    stretching = np.flatnonzero((element[K_rows] >= 0) & (count[K_columns] > 0))
    start, stop = (np.searchsorted(K_rows[stretching], forces, side) for side in ("left", "right"))
    of_element, (first, second) = _all_pairs(start, stop - start, start, stop - start)
    pair, pairs = of_motions(K_columns[stretching[first]], K_columns[stretching[second]])
    first, second, of_element = stretching[first[pair]], stretching[second[pair]], of_element[pair]
    pairs, mass_pairs = np.concatenate([own_pairs, pairs], axis=1), of_motions(unknowns, unknowns)[1]

    pattern = csr_array((np.ones(pairs.shape[1]), tuple(T_columns[pairs])), (size, size))
    place = np.empty(size, dtype=np.int64)
    place[reverse_cuthill_mckee(pattern, symmetric_mode=True)] = np.arange(size)
    width = int(np.abs(np.diff(place[T_columns[pairs]], axis=0)).max(initial=0)) + 1

    # in the band, or behind the band for terms above the diagonal
    at, mass_at = (
        np.where(row >= column, (row - column) * size + column, width * size)
        for row, column in (place[T_columns[on]] for on in (pairs, mass_pairs))
    )

    def band(at: Index, terms: Array) -> Array:
        return np.asarray(np.bincount(at, terms, width * size + 1), dtype=float)[:-1].reshape(width, size)

    def bands(K: Array, compliance: Array, T: Array, mass: Array) -> tuple[Array, Array]:
        values = np.concatenate([K[own], K[first] * K[second] / compliance[of_element]])
        left, right = mass_pairs
        return band(at, values * T[pairs[0]] * T[pairs[1]]), band(mass_at, mass[left] * T[left] * T[right])

    return place, bands


def _all_pairs(start: Index, count: Index, other_start: Index, other_count: Index) -> tuple[Index, Index]:
    """Numbers of two ranges (k,), and all pairs (2, k) of a number of the first with a number of the second."""
    many = count * other_count
    number = np.repeat(np.arange(count.size), many)
    within = np.arange(number.size) - (np.cumsum(many) - many)[number]
    pair = np.array(np.divmod(within, np.maximum(other_count[number], 1)))
    return number, pair + np.array([start[number], other_start[number]])


def _directions(model: Model, system: System, K: csc_matrix) -> tuple[Index, Index, Array]:
    """T, sorted by rows: all motions by the independent motions; no entries for forces and multipliers."""
    joints = [joint for joint in model.joints if not model.free(joint, system.acting)]
    stops = [stop for stop, _ in acting_stops(model.stops, system.acting)]
    # a row of a joint or stop is the node's motion minus the body's contribution
    row_of = {dof: row for joint in joints for dof, row in zip(joint.dofs.tolist(), joint.rows.tolist(), strict=False)}
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
        free_motions = null_space(_lines(K, constrained)[:, dofs]) if constrained else np.eye(dofs.size)
        here = count + np.arange(free_motions.shape[1])
        count += here.size
        of_bodies |= {int(dof): (here, line) for dof, line in zip(dofs, free_motions, strict=True)}
    couplings = [(dof, dof, 1.0) for dof in of_bodies]
    moved = list(of_bodies)
    if moved:
        held, lines = list(row_of), _lines(K, list(row_of.values()))[:, moved]
        couplings += [(held[i], moved[j], -float(lines[i, j])) for i, j in np.argwhere(lines).tolist()]
    for dof, other, value in couplings:
        here, line = of_bodies[other]
        rows.append(np.full(here.size, dof))
        columns.append(here)
        entries.append(value * line)
    all_rows = np.concatenate(rows)
    order = np.argsort(all_rows, kind="stable")
    return all_rows[order], np.concatenate(columns)[order], np.concatenate(entries)[order]


def _lines(K: csc_matrix, rows: list[int]) -> Array:
    """Rows (k, size) of a symmetric matrix."""
    lines = np.zeros((len(rows), K.shape[0]))
    for line, row in zip(lines, rows, strict=True):
        entry = slice(K.indptr[row], K.indptr[row + 1])
        line[K.indices[entry]] = K.data[entry]
    return lines


def _connected_bodies(model: Model) -> list[set[int]]:
    """Sets of moving bodies connected by hinges."""
    groups = [{i} for i, body in enumerate(model.bodies) if body.dofs is not None]
    for hinge in model.hinges:
        joined = [group for group in groups if group & set(hinge.bodies)]
        groups = [group for group in groups if group not in joined]
        groups.append(set[int]().union(*joined))
    return groups


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
        w = root * on.solve(factor, root * v)
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
