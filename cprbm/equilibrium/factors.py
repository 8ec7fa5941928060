"""Factors of the Hessian at a state, inertia and solutions.

The chains are eliminated by :mod:`cprbm.equilibrium.elimination`; LAPACK factors the border after Bunch and Kaufman;
a block of two has a single negative eigenvalue.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dsytrf, dsytrs

from cprbm.chain import Blocks, add_row_gradient, empty_blocks, evaluate_chains, row_values
from cprbm.equilibrium.elimination import border_block, eliminate, negative_pivots, reduce_load, restore
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array, Flags, Ints


class SingularError(ArithmeticError):
    """The Hessian is singular to the last digit."""


@dataclass(frozen=True, slots=True)
class Springs:
    """Springs from all links to the angles ``anchor`` (links,): energy ``strength``/2 Σ L (θ − θ₀)²."""

    strength: float
    anchor: Array


@dataclass(frozen=True, eq=False)
class Factors:
    """Factors at a state; ``lost`` is the number of independent directions with falling energy."""

    system: System
    driven: Flags
    blocks: Blocks
    pivot: Array
    ratio: Array
    columns: Array
    border: Array
    order: Ints
    lost: int

    def solve(self, load: Array) -> Array:
        """Solution (size,) of the Hessian's system; the multipliers of rows with prescribed force stay unchanged."""
        system, border = self.system, self.system.border
        solution = np.array(load)
        reduced = np.zeros(border.size)
        reduced[: system.size - border.first] = solution[border.first :]
        reduced[border.rows : border.rows + len(self.driven)][~self.driven] = 0.0
        of_chains = (system.beams, self.blocks, self.pivot, self.ratio)
        reduce_load(*of_chains, self.driven, border, solution, reduced)
        within = dsytrs(self.border, self.order, reduced, lower=1)[0]
        restore(system.beams, border, self.columns, within, solution)
        solution[border.first :] = within[: system.size - border.first]
        return solution


def gradient_of(system: System, state: State, blocks: Blocks, springs: Springs | None = None) -> Array:
    """Gradient (size,) of the Lagrangian; writes the blocks of the Hessian."""
    gradient = np.zeros(system.size)
    evaluate_chains(state.z, system.links, system.joints, blocks, gradient)
    add_row_gradient(state.z, system.rows, state.multipliers(system), gradient)
    if springs is not None:
        stiffness = springs.strength * system.metric
        blocks.turn[:] += stiffness
        gradient[system.angles] += stiffness * (state.z[system.angles] - springs.anchor)
    violation = row_values(state.z, system.rows) - state.target
    gradient[system.rows.first :] = np.where(state.driven, violation, 0.0)
    return gradient


def factorise(system: System, state: State, springs: Springs | None = None) -> tuple[Factors, Array]:
    """Factors at a state, and the gradient there.

    Raises:
        SingularError: no number is left to divide by.
    """
    count = len(system.metric)
    blocks = empty_blocks(count, count - len(system.beams.first))
    gradient = gradient_of(system, state, blocks, springs)
    border = system.border
    G = np.zeros((border.size, border.size), order="F")
    border_block(state.z, system.rows, state.driven, border, G)
    pivot, ratio, columns = np.zeros(count), np.zeros(count), np.empty(border.pair_offset[-1])
    negative = eliminate(system.beams, blocks, pivot, ratio, state.driven, border, columns, G)
    factored, order, info = dsytrf(G, lower=1, overwrite_a=1)
    of_border = negative_pivots(factored, order)
    if info > 0 or of_border < 0:
        raise SingularError("the border has a pivot of zero")
    lost = negative + of_border - int(state.driven.sum())
    return Factors(system, state.driven, blocks, pivot, ratio, columns, factored, order, lost), gradient
