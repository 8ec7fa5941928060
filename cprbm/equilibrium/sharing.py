"""Forces of repeated rows, in rigid links the limit of a small axial compliance.

A repeated row's unit force is balanced by the other rows and the chains' forces, in any amount.  A small axial
compliance chooses the amounts with the least energy of stretching, Σ L N²/EA, with the same EA of all links.
"""

import numpy as np
from scipy.linalg import lstsq

from cprbm.chain import add_row_gradient
from cprbm.equilibrium.solving import Solved
from cprbm_scene.answer import Array


def balanced_forces(solved: Solved, row: int) -> Array:
    """Changes (size,) of all unknowns in balance with a unit force of a repeated row; displacements vanish."""
    system = solved.system
    load, weight = np.zeros(system.size), np.zeros(len(system.rows.constant))
    weight[row] = 1.0
    add_row_gradient(solved.state.z, system.rows, weight, load)
    balanced = -solved.response(load)
    balanced[system.rows.first + row] = 1.0
    return balanced


def shared_multipliers(solved: Solved) -> Array:
    """Unknowns (size,) of a solved state with shared forces of repeated rows."""
    system, z = solved.system, solved.state.z.copy()
    rows = np.flatnonzero(solved.state.repeated)
    if not len(rows):
        return z
    motions = np.array([balanced_forces(solved, int(row)) for row in rows])
    indices = system.links.first[:, None] + [2, 3]
    direction = np.column_stack([np.cos(z[system.angles]), np.sin(z[system.angles])])
    weight = np.sqrt(system.links.length)

    def stretch(vector: Array) -> Array:
        return np.asarray(weight * np.einsum("ij,ij->i", vector[indices], direction))

    share = lstsq(np.array([stretch(each) for each in motions]).T, -stretch(z))[0]
    forces = np.concatenate([indices.ravel(), np.arange(system.rows.first, system.size)])
    z[forces] += (share @ motions)[forces]
    return z
