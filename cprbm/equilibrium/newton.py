"""Newton's method for an equilibrium with fixed rows, and a solved equilibrium.

The first iteration starts from the last state under new targets and so makes the prediction along the path's tangent.
Later iterations converge quadratically; at the level of round-off the last correction stays small.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from cprbm.chain import row_values
from cprbm.equilibrium.factors import Factors, SingularError, Springs, factorise
from cprbm.equilibrium.linear import correction
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array

CLOSE = 1e-9
"""Correction of angles (rad) and positions (longest beam) whose square is below round-off."""

ROUNDED = 1e-6
"""Largest correction that round-off leaves on the finest meshes."""

SHRINKING = 0.25
"""Ratio of corrections above which an iteration below ``ROUNDED`` no longer converges: round-off is reached."""


class NotConvergedError(Exception):
    """Newton's method found no equilibrium; ``locked`` names the contradicted row."""

    def __init__(self, reason: str, locked: str = "") -> None:
        super().__init__(reason)
        self.locked = locked


@dataclass(frozen=True, eq=False)
class Solved:
    """An equilibrium, the Hessian's factors and the gradient there, and the number of Newton iterations.

    The gradient belongs to the unknowns; ``contact_values`` are the values of the closed places' rows.
    """

    system: System
    state: State
    factors: Factors
    gradient: Array
    iterations: int
    contact_values: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def lost(self) -> int:
        """Number of independent directions with falling energy."""
        return self.factors.lost

    @cached_property
    def gaps(self) -> Array:
        """Gaps of all places of contact."""
        geometry, contacts = self.system.geometry, self.state.contacts
        return np.zeros(0) if geometry is None or contacts is None else contacts.gaps(geometry, self.state.z)

    def response(self, load: Array) -> Array:
        """Change (size,) of the unknowns under a ``load`` (size,), the closed places kept closed."""
        return self.factors.solve(load)

    @cached_property
    def values(self) -> Array:
        """f of all rows."""
        return np.asarray(row_values(self.state.z, self.system.rows))


def newton(system: System, start: State, iterations: int, springs: Springs | None) -> Solved:
    """Equilibrium near a state under the state's targets, without contacts.

    Args:
        system: the mechanism.
        start: state with targets.
        iterations: largest number of Newton iterations.
        springs: springs on the links' angles, of a descent.

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
            size, share = correction(change, system.motions, system.turns)
            if not np.isfinite(size):
                raise NotConvergedError("the correction is not finite")
            change[system.rows.first :][forced] = 0.0
            z += share * change
            if has_converged(size, last):
                return Solved(system, state, *factorise(system, state, springs), iteration)
            last = size
    except SingularError as singular:
        raise NotConvergedError("the system is singular") from singular
    raise NotConvergedError(f"{iterations} iterations did not converge")


def has_converged(size: float, last: float) -> bool:
    """Whether a correction of this size after the ``last`` is as small as it gets."""
    return size < CLOSE or SHRINKING * last < size < ROUNDED
