"""The smallest curvature of the potential energy on the feasible directions.

======  =======================================================================================
symbol  meaning
======  =======================================================================================
K       tangent, with the rows' borders
M       share of a node in the beams' lengths, one for bodies and faces, zero for multipliers
λ       curvature, K v = λ M v
======  =======================================================================================

M has nothing for multipliers, so the finite λ of the bordered system are those on the directions that the rows allow.
The λ nearest to zero are found, of which one is the first that changes its sign on a way that begins at a minimum; and
the sign of K's determinant says whether, beside one per row, an odd number of negative ones has been missed.
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
    """λ nearest to zero, or the least of the few nearest where one is negative; NaN where one is missed."""
    mass = masses(model)
    if system.factors is None:
        return 0.0
    inverse = LinearOperator((model.size, model.size), matvec=system.factors.solve, dtype=float)
    start = system.carried.T @ np.resize([1.0, 0.7], system.carried.shape[0])
    try:
        found = eigsh(
            system.tangent, k=_MODES, M=diags_array(mass).tocsc(), sigma=0.0, OPinv=inverse, v0=start,
            return_eigenvectors=False, tol=1e-6,
        )  # fmt: skip
    except ArpackError:
        return float("nan")
    negative = int((found < 0.0).sum()) + len(model.rows)
    return float(found.min()) if _odd(system.factors) == bool(negative % 2) else float("nan")


def beside_minima(model: Model, system: System) -> bool:
    """Whether the tangent's determinant says that the number of negative curvatures is odd: no minimum."""
    return system.factors is not None and _odd(system.factors) != bool(len(model.rows) % 2)


def _odd(factors: SuperLU) -> bool:
    """Whether the determinant is negative."""
    negative = int((factors.U.diagonal() < 0.0).sum())
    return bool((negative + _transpositions(factors.perm_r) + _transpositions(factors.perm_c)) % 2)


def _transpositions(permutation: Ints) -> int:
    """How many make up a permutation."""
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
