"""Equilibria, and repeated rows.

The active set decides about contacts (:mod:`cprbm.equilibrium.contact_points`).  A solved equilibrium has the factors
and the gradient of the final state, the closed places included.

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

A repeated row's unit force is balanced by the other rows and the chains' forces, in any amount.  In rigid links the
limit of a small axial compliance counts, with the same EA of all links: the least energy of stretching, Σ L N²/EA.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import lstsq
from scipy.linalg.lapack import dpstrf

from cprbm.chain import PER_LINK, add_row_gradient, row_values
from cprbm.equilibrium.contact_points import touched_equilibrium
from cprbm.equilibrium.contact_set import NotConvergedError
from cprbm.equilibrium.factors import Factors, SingularError, Springs, factorise
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array, Flags

DEPENDENT = 1e-12
"""Pivot of G below which a row repeats others: round-off of products leaves 1e-15."""

REPEATED = 1e-9
"""Largest violation of a row that repeats others, in units of length or rad."""


@dataclass(frozen=True, eq=False)
class Solved:
    """An equilibrium, the Hessian's factors and the gradient there, and the number of Newton iterations.

    The gradient belongs to the unknowns.
    """

    system: System
    state: State
    factors: Factors
    gradient: Array
    iterations: int

    @property
    def lost(self) -> int:
        """Number of independent directions with falling energy."""
        return self.factors.lost

    @cached_property
    def gaps(self) -> Array:
        """Gaps of all places of contact; inf for pairs kept open."""
        gaps = self.state.contacts.gaps(self.system.geometry, self.state.z)
        return np.where(self.state.contacts.of_pairs(self.state.contacts.kept_open), np.inf, gaps)

    def response(self, load: Array) -> Array:
        """Change (size,) of the unknowns under a ``load`` (size,), the closed places kept closed."""
        return self.factors.solve_both(load, np.zeros(0))[0]

    @cached_property
    def values(self) -> Array:
        """f of all rows."""
        return np.asarray(row_values(self.state.z, self.system.rows))


def equilibrium(
    system: System,
    start: State,
    iterations: int,
    springs: Springs | None = None,
    awaited: frozenset[int] = frozenset(),
) -> Solved:
    """Equilibrium near a state under the state's targets, with the contacts that press there.

    Args:
        system: the mechanism.
        start: state with targets.
        iterations: largest number of Newton iterations.
        springs: springs on the links' angles, of a descent.
        awaited: open pairs whose closing ends the search.

    Raises:
        ContactClosesError: awaited pairs overlap in the equilibrium.
        NotConvergedError: no equilibrium was found.
    """
    while True:
        touched = touched_equilibrium(system, start, iterations, springs, awaited)
        solved = at_state(system, touched.state, springs, touched.iterations)
        missed, state = _contradicted(solved), solved.state
        if missed is None:
            return solved
        # a repeated row of a straight beam may be independent once the beam is bent
        repeated = repeated_rows(system, state)
        if repeated.sum() >= state.repeated.sum():
            name = system.mechanism.rows[missed].name
            raise NotConvergedError(f"row {name} contradicts the others")
        start = replace(state, driven=(state.driven | state.repeated) & ~repeated, repeated=repeated)


def at_state(system: System, state: State, springs: Springs | None = None, iterations: int = 0) -> Solved:
    """A state in equilibrium, with factors and gradient.

    Raises:
        NotConvergedError: the Hessian is singular.
    """
    try:
        factors, gradient = factorise(system, state, springs)
    except SingularError as singular:
        raise NotConvergedError("the system is singular") from singular
    return Solved(system, state, factors, gradient, iterations)


def _contradicted(solved: Solved) -> int | None:
    """Number of a violated repeated row, or None."""
    state = solved.state
    if not state.repeated.any():
        return None
    missed = np.where(state.repeated, np.abs(solved.values - state.target), 0.0)
    worst = int(np.argmax(missed))
    return worst if missed[worst] > REPEATED else None


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


def balanced_forces(solved: Solved, row: int) -> Array:
    """Changes (size,) of all unknowns in balance with a unit force of a repeated row; displacements vanish."""
    system = solved.system
    load = np.zeros(system.size)
    add_row_gradient(solved.state.z, system.rows, np.eye(len(system.rows.constant))[row], load)
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

    def stretch(vector: Array) -> Array:
        return np.asarray(np.sqrt(system.links.length) * np.einsum("ij,ij->i", vector[indices], direction))

    share = lstsq(np.array([stretch(each) for each in motions]).T, -stretch(z))[0]
    forces = np.concatenate([indices.ravel(), np.arange(system.rows.first, system.size)])
    z[forces] += (share @ motions)[forces]
    return z
