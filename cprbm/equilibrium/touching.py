"""Closed places of contact in the linear system of an equilibrium, by :mod:`cprbm.equilibrium.columns`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.contact import Geometry, Places
from cprbm.equilibrium.columns import Columns, contact_columns
from cprbm.equilibrium.factors import Factors, factors_of
from cprbm.equilibrium.linear import border_of
from cprbm_scene.answer import Array, Flags


@dataclass(frozen=True, eq=False)
class ContactTerms:
    """Terms of the closed places at a state.

    Attributes:
        gradient: of −F λ of all closed places by the unknowns (size,).
        columns: of the border.
    """

    gradient: Array
    columns: Columns

    @property
    def values(self) -> Array:
        """Values of the rows with a force of their own (forces,)."""
        return self.columns.values


def contact_terms(geometry: Geometry, z: Array, places: Places, closed: Flags) -> ContactTerms:
    """Terms of the places marked ``closed``; sharing places have equal forces."""
    gradient = np.zeros(len(z))
    return ContactTerms(gradient, contact_columns(z, geometry.arrays, places, closed, gradient))


@dataclass(frozen=True, eq=False)
class Touching:
    """Factors of the Hessian with contacts."""

    factors: Factors

    @property
    def lost(self) -> int:
        """Number of independent directions in which the energy falls while the closed places stay closed."""
        return self.factors.lost

    def solve(self, load: Array, values: Array) -> tuple[Array, Array]:
        """Change of the unknowns and of the forces for a load (size,) and values of the rows (at most forces,)."""
        return self.factors.solve_both(load, values)


def touching(free: Factors, terms: ContactTerms) -> Touching:
    """Factors with contacts from factors without.

    Raises:
        SingularError: no number is left to divide by.
    """
    bordered = border_of(free.system.numbers, free.work, free.driven, free.bordered.rows, terms.columns)
    return Touching(factors_of(free.system, free.driven, free.work, bordered))
