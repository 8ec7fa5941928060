"""A solved equilibrium, and the end of Newton's method.

The iterations converge quadratically; at the level of round-off the last correction stays small.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cprbm.chain import row_values
from cprbm.equilibrium.factors import Factors
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
    contact_values: Array

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


def has_converged(size: float, last: float) -> bool:
    """Whether a correction of this size after the ``last`` is as small as it gets."""
    return size < CLOSE or SHRINKING * last < size < ROUNDED
