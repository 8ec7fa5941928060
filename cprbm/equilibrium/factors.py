"""Factors of the Hessian at a state, inertia and solutions.

The chains are eliminated by :mod:`cprbm.equilibrium.linear`; LAPACK factors the border after Bunch and Kaufman;
a block of two has a single negative eigenvalue.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dsytrf, dsytrs

from cprbm.equilibrium.columns import contact_terms
from cprbm.equilibrium.linear import Bordered, linearise, reduced_load, restored
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array, Flags, Ints

PANEL = 32
"""Columns that LAPACK eliminates together from a large border."""


class SingularError(ArithmeticError):
    """The Hessian is singular to the last digit."""


@dataclass(frozen=True, slots=True)
class Springs:
    """Springs from all links to the angles ``anchor`` (links,): energy ``strength``/2 Σ L (θ − θ₀)²."""

    strength: float
    anchor: Array


@dataclass(frozen=True, eq=False)
class Factors:
    """Factors at a state.

    Attributes:
        system, driven: mechanism, and rows with a prescribed value.
        bordered: border with the columns of the closed places.
        factored, order: factors of the border.
        lost: number of independent directions with falling energy while the closed places stay closed.
    """

    system: System
    driven: Flags
    bordered: Bordered
    factored: Array
    order: Ints
    lost: int

    def solve_both(self, load: Array, values: Array) -> tuple[Array, Array]:
        """Solution (size,) of the Hessian's system, and changes of the contact forces (forces,).

        Prescribed multipliers stay unchanged, and closed places closed, but for ``values`` (at most forces,).
        """
        m, bordered, solution = self.system.numbers, self.bordered, np.array(load)
        both = np.concatenate([values, np.zeros(len(bordered.columns.diagonal) - len(values))])
        reduced = reduced_load(m.beams, m.border, bordered.chains, bordered.coupling, self.driven, both, solution)
        within = solved_border(self.factored, self.order, reduced)
        restored(m.beams, m.border, bordered.coupling, within, solution)
        return solution, within[m.border.size : m.border.size + len(bordered.columns.values)]


def pulls(system: System, springs: Springs | None) -> tuple[Array, Array]:
    """Stiffness and anchor (links,) of springs, zeros without springs."""
    if springs is None:
        nothing = np.zeros(len(system.metric))
        return nothing, nothing
    return springs.strength * system.metric, springs.anchor


def factorise(system: System, state: State, springs: Springs | None = None) -> tuple[Factors, Array]:
    """Factors at a state with the columns of closed places, and the gradient (size,) there.

    Raises:
        SingularError: no number is left to divide by.
    """
    m, pulled = system.numbers, pulls(system, springs)
    columns, gradient = contact_terms(system.geometry, state.z, state.contacts.places, state.contacts.closed)
    bordered = linearise(state.z, m, state.driven, state.target, *pulled, columns, gradient)
    return factors_of(system, state.driven, bordered), gradient


def factored_border(border: Array) -> tuple[Array, Ints]:
    """Factors of a symmetric matrix, given by the lower triangle, and LAPACK's record of the pivots.

    Raises:
        SingularError: no number is left to divide by.
    """
    factored, order, info = dsytrf(border.T, lwork=PANEL * len(border))
    if info > 0:
        raise SingularError("the border has a pivot of zero")
    return factored, order


def solved_border(factored: Array, order: Ints, load: Array) -> Array:
    """Solution of the border's system."""
    return np.asarray(dsytrs(factored, order, load)[0])


def factors_of(system: System, driven: Flags, bordered: Bordered) -> Factors:
    """Factors from a border.

    Raises:
        SingularError: no number is left to divide by.
    """
    factored, order = factored_border(bordered.border)
    pivots, blocks, columns = factored.diagonal(), order < 0, bordered.columns
    if not np.isfinite(pivots).all():
        raise SingularError("the border has a pivot without a limit")
    of_border = int(np.count_nonzero(~blocks & (pivots < 0.0))) + int(np.count_nonzero(blocks)) // 2
    equalities = int(np.count_nonzero(driven)) + len(columns.values) + columns.negative
    return Factors(system, driven, bordered, factored, order, bordered.negative + of_border - equalities)
