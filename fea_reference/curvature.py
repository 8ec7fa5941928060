"""Is an equilibrium a minimum?  The smallest curvature of the potential energy on the feasible directions.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
K       the tangent of the Lagrangian, with the joints' rows and the axial forces
S       the block of K⁻¹ that belongs to the nodes' and bodies' motions
M       lumped mass: arc length for the nodes, one for the bodies
μ       curvatures: K u = μ M u on the feasible directions, in EI per length of the longest beam to the fourth
======  =====================================================================================

Forces outside of the joints' rows move the mechanism along feasible directions only, so S is the inverse of
the energy's second derivative on them and zero across, and M^½ S M^½ has the eigenvalues 1/μ.  Lanczos'
method finds the outermost of them first; a Ritz value below zero proves a direction of negative curvature,
unless it is round-off, which a solution with K makes grow with the third power of the number of elements.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigvalsh_tridiagonal
from scipy.sparse.linalg import SuperLU

from fea_reference.model import Model
from scene.answer import Array

_STEPS = 40
_SEED = 20200103
_NOISE = 1e-9  # of the largest 1/μ, or what round-off makes of it: eigenvalues at zero are infeasible directions


def smallest_curvature(model: Model, factors: SuperLU) -> float:
    """Smallest μ, or the negative one nearest to zero; ``factors`` are those of K."""
    nodes = model.node_dofs
    h = model.elements.length
    lumped = np.zeros(nodes.shape[1])
    for beam in model.beams:
        own = lumped[beam.nodes]
        own[:-1] += 0.5 * h[beam.elements]
        own[1:] += 0.5 * h[beam.elements]
    root = np.zeros(model.size)
    root[nodes] = np.sqrt(lumped)
    for body in model.bodies:
        if body.dofs is not None:
            root[body.dofs] = 1.0

    v = root * np.random.default_rng(_SEED).standard_normal(model.size)
    v /= np.linalg.norm(v)
    basis: list[Array] = []
    diagonal: list[float] = []
    beside: list[float] = []
    for _ in range(_STEPS):
        basis.append(v)
        w = root * factors.solve(root * v)
        diagonal.append(float(v @ w))
        Q = np.array(basis)
        w -= Q.T @ (Q @ w)
        w -= Q.T @ (Q @ w)
        beta = float(np.linalg.norm(w))
        if beta <= 1e-12 * max(map(abs, diagonal)):
            break
        beside.append(beta)
        v = w / beta
    ritz = eigvalsh_tridiagonal(np.array(diagonal), np.array(beside[: len(diagonal) - 1]))
    low, high = float(ritz[0]), float(ritz[-1])
    noise = max(_NOISE, float(np.finfo(float).eps) * float(h.size) ** 3)
    return 1.0 / (low if low < -noise * max(abs(low), abs(high)) else high)
