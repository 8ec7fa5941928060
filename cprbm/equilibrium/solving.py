"""Equilibria, and repeated rows.

The active set decides about contacts (:mod:`cprbm.equilibrium.contact_points`).  A solved equilibrium has the factors
and the gradient of the final state, the closed places included.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from cprbm.chain import row_values
from cprbm.equilibrium.contact_points import touched_equilibrium
from cprbm.equilibrium.contact_set import NotConvergedError
from cprbm.equilibrium.factors import Factors, SingularError, Springs, factorise
from cprbm.equilibrium.rank import repeated_rows
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array

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
        """Gaps of all places of contact."""
        return self.state.contacts.gaps(self.system.geometry, self.state.z)

    def response(self, load: Array) -> Array:
        """Change (size,) of the unknowns under a ``load`` (size,), the closed places kept closed."""
        return self.factors.solve(load)

    @cached_property
    def values(self) -> Array:
        """f of all rows."""
        return np.asarray(row_values(self.state.z, self.system.rows))


def equilibrium(system: System, start: State, iterations: int, springs: Springs | None = None) -> Solved:
    """Equilibrium near a state under the state's targets, with the contacts that press there.

    Args:
        system: the mechanism.
        start: state with targets.
        iterations: largest number of Newton iterations.
        springs: springs on the links' angles, of a descent.

    Raises:
        NotConvergedError: no equilibrium was found.
    """
    solved = _near(system, start, iterations, springs)
    while (missed := _contradicted(solved)) is not None:
        # a repeated row of a straight beam may be independent once the beam is bent
        state = solved.state
        repeated = repeated_rows(system, state)
        if repeated.sum() >= state.repeated.sum():
            name = system.mechanism.rows[missed].name
            raise NotConvergedError(f"row {name} contradicts the others", locked=name)
        counting = replace(state, driven=(state.driven | state.repeated) & ~repeated, repeated=repeated)
        solved = _near(system, counting, iterations, springs)
    return solved


def _near(system: System, start: State, iterations: int, springs: Springs | None) -> Solved:
    """Equilibrium with the prescribed rows of a state.

    Raises:
        NotConvergedError: no equilibrium was found.
    """
    touched = touched_equilibrium(system, start, iterations, springs)
    return at_state(system, touched.state, springs, touched.iterations)


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
