"""Smallest curvature of the potential energy on the feasible directions.

======  =======================================================================================
symbol  meaning
======  =======================================================================================
K       tangent, bordered by the rows
M       share of a node in the beams' lengths, one for bodies and faces, zero for multipliers
λ       curvature, K v = λ M v
======  =======================================================================================

M is zero for multipliers, so that the finite λ of the bordered system belong to the directions permitted by the rows.
The λ nearest to zero are computed; along a branch from a minimum the first sign change is among them. The sign of K's
determinant, corrected for one negative pivot per row, shows whether an odd number of negative λ was missed.
"""

import numpy as np
from scipy.sparse import coo_matrix, diags_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import ArpackError, LinearOperator, SuperLU, eigsh

from cprbm_scene.answer import Array, Ints
from fea_reference.solid.model import Model
from fea_reference.solid.system import System

_MODES = 3


def smallest_curvature(model: Model, system: System) -> float:
    """λ nearest to zero, or the least of the nearest if any is negative; NaN if a negative λ was missed."""
    mass = masses(model)
    if system.factors is None:
        return 0.0
    inverse = LinearOperator((model.size, model.size), matvec=system.factors.solve, dtype=float)
    start = system.carried.T @ np.resize([1.0, 0.7], system.carried.shape[0])
    try:
        values = eigsh(
            system.tangent, k=_MODES, M=diags_array(mass).tocsc(), sigma=0.0, OPinv=inverse, v0=start,
            return_eigenvectors=False, tol=1e-6,
        )  # fmt: skip
    except ArpackError:
        return float("nan")
    negative = int((values < 0.0).sum()) + len(model.rows)
    return float(values.min()) if _odd(system.factors) == bool(negative % 2) else float("nan")


def has_odd_negative_count(model: Model, system: System) -> bool:
    """True if the tangent's determinant shows an odd number of negative curvatures: no minimum."""
    return system.factors is not None and _odd(system.factors) != bool(len(model.rows) % 2)


def _odd(factors: SuperLU) -> bool:
    """True if the determinant is negative."""
    negative = int((factors.U.diagonal() < 0.0).sum())
    return bool((negative + _transpositions(factors.perm_r) + _transpositions(factors.perm_c)) % 2)


def _transpositions(permutation: Ints) -> int:
    """Number of transpositions in a permutation."""
    n = permutation.size
    cycles, _ = connected_components(coo_matrix((np.ones(n), (np.arange(n), permutation)), (n, n)))
    return n - int(cycles)


def masses(model: Model) -> Array:
    """The diagonal of M (size,)."""
    mesh = model.mesh
    nodal = np.zeros(len(mesh.places))
    area = mesh.weights.sum(axis=1) / 9.0
    np.add.at(nodal, mesh.cells, np.broadcast_to(area[:, None], mesh.cells.shape))
    for beam, length in enumerate(model.lengths):
        own = mesh.beams == beam
        nodal[own] *= length / nodal[own].sum()
    mass = np.zeros(model.size)
    mass[: model.free.size] = np.repeat(nodal, 2)[model.free]
    mass[model.free.size : model.size - len(model.rows)] = 1.0
    return mass
