"""The smallest curvature of the potential energy on the feasible directions.

======  =======================================================================================
symbol  meaning
======  =======================================================================================
K       tangent, with the rows' borders
M       share of a node in the beams' lengths, one for bodies and faces, zero for multipliers
λ       curvature, K v = λ M v
======  =======================================================================================

M has nothing for multipliers, so the finite λ of the bordered system are those on the directions that the rows allow.  The
factors' signs say by Sylvester's law whether an odd number of them is negative: with the λ nearest to zero that finds the
one that changes its sign.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from fea_reference.solid.model import Model
from fea_reference.solid.system import System
from scene.answer import Array

_MODES = 3


def smallest_curvature(model: Model, system: System) -> float:
    """λ nearest to zero, or the least of the few nearest where one is negative; NaN where it is not found."""
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
    return float(found.min())


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
