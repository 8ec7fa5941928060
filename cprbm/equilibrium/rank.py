"""Repeated rows.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
J        derivatives of the prescribed rows by coordinates that satisfy the link equations
G        J Jᵀ with a unit diagonal
=======  ====================================================================================

Without an axial compliance the positions of a chain follow from the first node and the links' angles.  A parallel
guide of three straight blades has more rows then than the coordinates can tell apart: the third blade keeps the plate
level, as the other two do.  Such rows are left out and checked afterwards.  Once the blades are bent, all rows count.
Cholesky's factorisation of G with pivots gives the rank.
"""

import numpy as np
from scipy.linalg.lapack import dpstrf

from cprbm.chain import PER_LINK, add_row_gradient
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array, Flags

DEPENDENT = 1e-12
"""Pivot of G below which a row repeats others: round-off of products leaves 1e-15."""


def repeated_rows(system: System, state: State) -> Flags:
    """Which of the prescribed rows repeat others at a state."""
    candidates = np.flatnonzero(state.driven | state.repeated)
    repeated = np.zeros(len(state.driven), dtype=bool)
    if not len(candidates):
        return repeated
    J = row_derivatives(system, state)[candidates]
    size = np.sqrt(np.einsum("ij,ij->i", J, J))
    J /= np.where(size > 0.0, size, 1.0)[:, None]
    order, rank = dpstrf(J @ J.T, tol=DEPENDENT, lower=1)[1:3]
    repeated[candidates[order[rank:] - 1]] = True
    return repeated


def row_derivatives(system: System, state: State) -> Array:
    """J of all rows (rows, coordinates): first nodes, angles, bodies; with axial compliance all nodes."""
    count, first = len(system.rows.constant), system.rows.first
    gradient = np.zeros((count, first))
    for r in range(count):
        add_row_gradient(state.z, system.rows, np.eye(count)[r], gradient[r])
    if system.lengthening:
        return gradient
    for start, links in zip(system.beams.first, system.beams.links, strict=True):
        nodes = start + PER_LINK * np.arange(links + 1)
        angles = nodes[:-1] + PER_LINK - 1
        along = np.diff(state.z[nodes]), np.diff(state.z[nodes + 1])
        # a turn of a link moves all nodes behind the link
        behind = [np.cumsum(gradient[:, nodes + axis][:, ::-1], axis=1)[:, ::-1] for axis in (0, 1)]
        gradient[:, angles] += along[0] * behind[1][:, 1:] - along[1] * behind[0][:, 1:]
        for axis in (0, 1):
            gradient[:, nodes[1:] + axis] = 0.0
            gradient[:, nodes[0] + axis] = behind[axis][:, 0]
    return gradient
