"""Closed set of the linearised problem, a linear complementarity problem in the contact forces.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
F        contact forces of all places that may close, after the correction
w        gaps of the linearised problem
G, r     border with the columns of these places, and its load; index f: forces, o: all other unknowns
M, q     compliance of the forces, gaps without any force
L        Cholesky's factor of M
=======  ====================================================================================

The elimination of all other unknowns leaves

    w = q + M F,    F ≥ 0,    w ≥ 0,    F w = 0,    M = G_fo G_oo⁻¹ G_of − G_ff.

M is positive definite where the state without contacts is a minimum.  Then F is the least-squares solution with F ≥ 0
of Lᵀ F = −L⁻¹ q (Lawson and Hanson 1974), and the solution is unique.  Newton's method with this set in every iteration
is the method of Josephy (1979) for F ≥ 0, g ≥ 0.  An exchange of all places with a wrong sign instead may return to the
same sets: the forces of a zone that is too long alternate in sign from joint to joint.
"""

import numpy as np
from scipy.linalg import LinAlgError, cholesky, solve_triangular

from cprbm.equilibrium.factors import SingularError, factored_border, solved_border
from cprbm.equilibrium.linear import Bordered
from cprbm_scene.answer import Array, Flags

SOFT = 1e-14
"""Compliance of every place over the largest: two places at one point share their force."""


def closed_forces(bordered: Bordered, reduced: Array, size: int, forces: Array, room: Array) -> Flags | None:
    """Which forces of a border press in the linearised problem; None where the problem is not convex.

    Args:
        bordered, reduced: border with the columns of all places that may close, and its load.
        size: number of border columns without contacts.
        forces: present forces (forces,).
        room: allowed overlaps (forces,).
    """
    from scipy.optimize import nnls  # sets that settle at once load no optimisers

    count = len(forces)
    if count == 0:
        return np.zeros(0, dtype=bool)  # SciPy's nnls frees its memory twice without unknowns
    G = np.tril(bordered.border) + np.tril(bordered.border, -1).T
    mine = np.zeros(len(G), dtype=bool)
    mine[size : size + count] = True
    beside = G[np.ix_(mine, ~mine)]
    try:
        solved = solved_border(*factored_border(G[np.ix_(~mine, ~mine)]), np.column_stack([beside.T, reduced[~mine]]))
        M = beside @ solved[:, :-1] - G[np.ix_(mine, mine)]
        L = cholesky(M + SOFT * np.max(np.diag(M), initial=0.0) * np.eye(count), lower=True)
        q = reduced[mine] - beside @ solved[:, -1] - M @ forces + room
        return np.asarray(nnls(L.T, -solve_triangular(L, q, lower=True))[0] > 0.0)
    except (SingularError, LinAlgError, ValueError, RuntimeError):
        # no minimum without contacts, numbers without a limit, or no least-squares solution
        return None
