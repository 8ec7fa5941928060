"""Newton's method for an equilibrium with fixed rows.

The first iteration starts from the last state under new targets and so makes the prediction along the path's tangent.
Later iterations converge quadratically; at the level of round-off the last correction stays small.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from cprbm.chain import row_values
from cprbm.equilibrium.factors import Factors, SingularError, Springs, factorise
from cprbm.equilibrium.rank import repeated_rows
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array

CLOSE = 1e-9
"""Correction of angles (rad) and positions (longest beam) whose square is below round-off."""

ROUNDED = 1e-6
"""Largest correction that round-off leaves on the finest meshes."""

SHRINKING = 0.25
"""Ratio of corrections above which an iteration below ``ROUNDED`` no longer converges: round-off is reached."""

LARGEST_TURN = 0.5
"""Largest turn of a link in one iteration, rad."""

REPEATED = 1e-9
"""Largest violation of a row that repeats others, in units of length or rad."""


class NotConvergedError(Exception):
    """Newton's method found no equilibrium; ``locked`` names the contradicted row."""

    def __init__(self, reason: str, locked: str = "") -> None:
        super().__init__(reason)
        self.locked = locked


@dataclass(frozen=True, eq=False)
class Solved:
    """An equilibrium, the Hessian's factors and the gradient there, and the number of Newton iterations."""

    system: System
    state: State
    factors: Factors
    gradient: Array
    iterations: int

    @cached_property
    def values(self) -> Array:
        """f of all rows."""
        return np.asarray(row_values(self.state.z, self.system.rows))


def equilibrium(system: System, start: State, iterations: int, springs: Springs | None = None) -> Solved:
    """Equilibrium near a state under the state's targets.

    Args:
        system: the mechanism.
        start: state with targets.
        iterations: largest number of Newton iterations.
        springs: springs on the links' angles, of a descent.

    Raises:
        NotConvergedError: no equilibrium was found.
    """
    solved = _iterated(system, start, iterations, springs)
    while (missed := _contradicted(solved)) is not None:
        # a repeated row of a straight beam may be independent once the beam is bent
        state = solved.state
        repeated = repeated_rows(system, state)
        if repeated.sum() >= state.repeated.sum():
            name = system.mechanism.rows[missed].name
            raise NotConvergedError(f"row {name} contradicts the others", locked=name)
        counting = replace(state, driven=(state.driven | state.repeated) & ~repeated, repeated=repeated)
        solved = _iterated(system, counting, iterations, springs)
    return solved


def _iterated(system: System, start: State, iterations: int, springs: Springs | None) -> Solved:
    """Equilibrium with the prescribed rows of a state.

    Raises:
        NotConvergedError: no equilibrium was found.
    """
    z = start.z.copy()
    forced = ~start.driven
    z[system.rows.first :][forced] = start.target[forced] * ~start.repeated[forced]
    state, last = replace(start, z=z), np.inf
    try:
        for iteration in range(1, iterations + 1):
            factors, gradient = factorise(system, state, springs)
            change = -factors.solve(gradient)
            size, share = correction(system, change)
            change[system.rows.first :][forced] = 0.0
            z += share * change
            if has_converged(size, last):
                return Solved(system, state, *factorise(system, state, springs), iteration)
            last = size
    except SingularError as singular:
        raise NotConvergedError("the system is singular") from singular
    raise NotConvergedError(f"{iterations} iterations did not converge")


def correction(system: System, change: Array) -> tuple[float, float]:
    """Size of a change (size,) of the unknowns, and the share of the change that turns no part too far.

    Raises:
        NotConvergedError: the change is not finite.
    """
    turn = float(np.abs(change[system.turns]).max())
    size = float(np.abs(change[system.motions]).max())
    if not np.isfinite(size):
        raise NotConvergedError("the correction is not finite")
    return size, min(1.0, LARGEST_TURN / turn) if turn > 0.0 else 1.0


def has_converged(size: float, last: float) -> bool:
    """Whether a correction of this size after the ``last`` is as small as it gets."""
    return size < CLOSE or SHRINKING * last < size < ROUNDED


def _contradicted(solved: Solved) -> int | None:
    """Number of a violated repeated row, or None."""
    state = solved.state
    if not state.repeated.any():
        return None
    missed = np.where(state.repeated, np.abs(solved.values - state.target), 0.0)
    worst = int(np.argmax(missed))
    return worst if missed[worst] > REPEATED else None
