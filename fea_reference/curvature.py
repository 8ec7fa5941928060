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
_LOOK = 4  # steps after which Lanczos' method looks at what it has
_ENOUGH = 1e-6  # of the Ritz value: what its vector may leave; the value's own error is of second order in that
_SEED = 20200103
_STIFF = 1e6  # EI/length²: EA of a beam that does not stretch, a hundred times that of a stout one
_CLOSE = 0.9  # of a Ritz value: the μ that is proven to have none below it
_TRIALS = 60


@dataclass(frozen=True, slots=True)
class Mode:
    """The least ``curvature`` μ, and its motions u among all unknowns, ``direction`` (size,) with uᵀ M u = 1."""

    curvature: float
    direction: Array


def positive(model: Model, system: System) -> bool:
    """Whether all μ are above zero, as far as round-off lets it be seen."""
    return _factor(_feasible(model, system).stiffness) is not None


def softest(model: Model, system: System) -> Mode:
    """The least μ, if it is above zero: a Ritz value, and a tenth less is proven to lie below all.

    Where that cannot be proven, a value that can, and if not even zero can, a Ritz value above one below zero that can:
    there is a negative curvature about as large, or round-off hides that there is none.
    """
    on, root = _feasible(model, system), np.sqrt(lumped_mass(model))

    def factor(sigma: float) -> Array | None:
        """Cholesky's of A − σ M; None where there is a pivot below zero."""
        return _factor(on.stiffness - sigma * on.inertia)

    at_zero = factor(0.0)
    if at_zero is None:
        below = _below_zero(factor)
        at_below = factor(below)
        if at_below is None:  # round-off, however far below
            return Mode(below, np.zeros(model.size))
        ritz, u = _ritz(on, at_below, root)
        # rounded to zero it would not say that there was a negative pivot
        return Mode(min(below + ritz, -np.finfo(float).tiny), u)
    ritz, u = _ritz(on, at_zero, root)
    sigma = ritz
    while factor(min(sigma, _CLOSE * ritz)) is None and sigma > 0.0:
        sigma *= 0.5
    return Mode(sigma, u)


def leaning(model: Model, system: System, drag: float) -> Array:
    """Motions u (size,) under faint moments 1 + s per length on all sections, against a ``drag``, EI per length⁴.

    s is the arc length along the beams in the scene's order, in lengths of the longest.  Among all motions that a
    bifurcation leaves free, the moments choose one that depends neither on the mesh nor on the order of assembly.  The
    drag is above every negative curvature; where it is not, the moments themselves.
    """
    on, moments = _feasible(model, system), np.zeros(model.size)
    factor = _factor(on.stiffness + drag * on.inertia)
    lengths = lumped_mass(model)[model.node_dofs[2]]
    moments[model.node_dofs[2]] = lengths * (1.0 + np.cumsum(lengths))
    return moments if factor is None else _solved(on, factor, moments)


@dataclass(frozen=True, slots=True)
class _Feasible:
    """The feasible directions, in an order that makes A a band.

    Attributes:
        T: all unknowns' motions by them (size, q); back: its transpose.
        place: of every direction in that order, (q,).
        stiffness, inertia: lower halves of A and T^T M T (width + 1, q), in LAPACK's order.
    """

    T: csr_array
    back: csr_array
    place: Index
    stiffness: Array
    inertia: Array


def _factor(band: Array) -> Array | None:
    """Cholesky's of a matrix by the lower half of its band; None where there is a pivot below zero."""
    try:
        return np.asarray(cholesky_banded(band, lower=True, check_finite=False))
    except LinAlgError:
        return None


def _feasible(model: Model, system: System) -> _Feasible:
    """T and A."""
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
    """T: every motion by those that nothing holds, follows or guides; zero for what is no motion."""
    joints = [joint for joint in model.joints if not model.free(joint, system.acting)]
    stops = [stop for stop, _ in acting_stops(model.stops, system.acting)]
    # A joint's row is its node's motion, less what the body makes of it, and so is a stop's.
    row_of = {int(dof): int(row) for one in joints for dof, row in zip(one.dofs, one.rows, strict=False)}
    row_of |= {stop.theta: stop.row for stop in stops}
    free = np.ones(model.size, dtype=bool)
    free[list(row_of)] = False
    nodes = model.node_dofs.ravel()
    alone = nodes[free[nodes]]
    rows, columns, entries = [alone], [np.arange(alone.size)], [np.ones(alone.size)]
    count = alone.size
    of_bodies: dict[int, tuple[Index, Array]] = {}
    for group in _together(model):
        dofs = np.concatenate([dofs for i in group if (dofs := model.bodies[i].dofs) is not None])
        held = [hold.row for hold in (*model.guides, *model.drives) if hold.body in group]
        held += [int(row) for hinge in model.hinges if set(hinge.bodies) & group for row in hinge.rows]
        left = null_space(K[held][:, dofs].toarray()) if held else np.eye(dofs.size)
        here = count + np.arange(left.shape[1])
        count += here.size
        of_bodies |= {int(dof): (here, line) for dof, line in zip(dofs, left, strict=True)}
    ways = [(dof, dof, 1.0) for dof in of_bodies]
    for dof, row in row_of.items():
        entry = slice(K.indptr[row], K.indptr[row + 1])
        ways += [
            (dof, int(other), -float(value))
            for other, value in zip(K.indices[entry], K.data[entry], strict=True)
            if int(other) in of_bodies
        ]
    for dof, other, value in ways:
        here, line = of_bodies[other]
        rows.append(np.full(here.size, dof))
        columns.append(here)
        entries.append(value * line)
    return csr_array((np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), (model.size, count))


def _together(model: Model) -> list[set[int]]:
    """Numbers of the bodies that move, those together that hinges join."""
    groups = [{i} for i, body in enumerate(model.bodies) if body.dofs is not None]
    for hinge in model.hinges:
        joined = [group for group in groups if group & set(hinge.bodies)]
        groups = [group for group in groups if group not in joined]
        groups.append(set[int]().union(*joined))
    return groups


def _bands(place: Index, *matrices: csr_array) -> list[Array]:
    """The lower halves of symmetric matrices (m, m), rows and columns at their ``place``, all as wide as the widest."""
    entries = [(np.repeat(place, np.diff(one.indptr)), place[one.indices], one.data) for one in matrices]
    width = max(int((rows - columns).max(initial=0)) for rows, columns, _ in entries)
    bands = []
    for rows, columns, data in entries:
        lower = rows >= columns
        band = np.zeros((width + 1, place.size))
        band[(rows - columns)[lower], columns[lower]] = data[lower]
        bands.append(band)
    return bands


def _ritz(on: _Feasible, factor: Array, root: Array) -> tuple[float, Array]:
    """1 over the largest Ritz value of M^½ T A⁻¹ T^T M^½, whose eigenvalues are 1/μ and zeros, and its u (size,)."""
    moving = np.flatnonzero(root)
    v = np.zeros(root.size)
    v[moving] = root[moving] * np.random.default_rng(_SEED).standard_normal(moving.size)
    v /= np.linalg.norm(v)
    Q = np.zeros((_STEPS, root.size))
    diagonal: list[float] = []
    beside: list[float] = []
    for step in range(_STEPS):
        Q[step] = v
        w = root * _solved(on, factor, root * v)
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


def _solved(on: _Feasible, factor: Array, forces: Array) -> Array:
    """T A⁻¹ T^T of ``forces`` (size,) with the factor of A."""
    right = np.empty(on.place.size)
    right[on.place] = on.back @ forces
    return np.asarray(on.T @ dpbtrs(factor, right, lower=1)[0][on.place])


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
