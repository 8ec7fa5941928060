"""The linear system of a Newton iteration: chains, rows and closed places, compiled.

The kernels assemble the gradient and the Hessian, eliminate the chains, and restore the chains' part of the solution.
A Newton step solves the border by LU factors, :mod:`cprbm.equilibrium.iteration`; a state that is tested for a minimum
has symmetric factors of the border with the inertia, :mod:`cprbm.equilibrium.factors`.
"""

from math import cos, sin
from typing import NamedTuple

import numpy as np

from cprbm.chain import (
    PER_LINK,
    Blocks,
    Joints,
    Links,
    RowArrays,
    add_row_gradient,
    compiled,
    evaluate_chains,
    row_values,
)
from cprbm.contact import Columns
from cprbm.equilibrium.elimination import (
    Beams,
    Border,
    Chains,
    Coupling,
    border_entries,
    coupled_chains,
    eliminate,
    factored_chains,
    solve_columns,
)
from cprbm_scene.answer import Array, Flags, Ints

LARGEST_TURN = 0.5
"""Largest turn of a link in one iteration, rad."""


class Numbers(NamedTuple):
    """Arrays of a mechanism for the kernels, as :class:`cprbm.equilibrium.system.System` names them."""

    links: Links
    joints: Joints
    rows: RowArrays
    beams: Beams
    border: Border
    angles: Ints
    turns: Ints
    motions: Ints


class Bordered(NamedTuple):
    """Border after the elimination of the chains.

    Attributes:
        border: G, lower triangle.
        negative: number of negative pivots of all T.
        columns: of the closed places.
        chains, coupling: factors of the chains, and their coupling with the border.
    """

    border: Array
    negative: int
    columns: Columns
    chains: Chains
    coupling: Coupling


@compiled
def add_gradient(
    z: Array, m: Numbers, driven: Flags, target: Array, stiffness: Array, anchor: Array, gradient: Array
) -> Blocks:  # pragma: no cover
    """Blocks of the Hessian; adds the gradient of the Lagrangian without contacts to ``gradient``.

    Springs of the ``stiffness`` (links,) pull the links' angles to the ``anchor`` (links,).
    """
    first = m.rows.first
    blocks = evaluate_chains(z, m.links, m.joints, gradient)
    add_row_gradient(z, m.rows, z[first:], gradient)
    for j in range(m.angles.size):
        blocks.turn[j] += stiffness[j]
        gradient[m.angles[j]] += stiffness[j] * (z[m.angles[j]] - anchor[j])
    gradient[first:] = np.where(driven, row_values(z, m.rows) - target, 0.0)
    return blocks


@compiled
def reduced_load(
    beams: Beams, border: Border, chains: Chains, coupling: Coupling, driven: Flags, values: Array, load: Array
) -> Array:  # pragma: no cover
    """Load of the border; solves the chains in place. ``values`` (columns,) are the load of the closed places."""
    reduced = np.concatenate((load[border.first :], np.zeros(border.size - load.size + border.first), values))
    reduced[border.rows : border.rows + driven.size] *= driven
    for beam in range(beams.first.size):
        first, size = beams.first[beam], 2 + PER_LINK * beams.links[beam]
        solve_columns(beams, beam, chains, load[first : first + size].reshape((-1, 1)))
    for t in range(coupling.value.size):
        if coupling.beam[t] >= 0:
            reduced[coupling.column[t]] -= coupling.value[t] * load[coupling.unknown[t]]
    return reduced


@compiled
def restored(
    beams: Beams, border: Border, coupling: Coupling, solution: Array, load: Array
) -> None:  # pragma: no cover
    """Turn the chains' solution ``load`` into the whole solution, in place; ``solution`` belongs to the border."""
    for beam in range(beams.first.size):
        y = solution[coupling.reached[coupling.begin[beam] : coupling.begin[beam + 1]]]
        X = coupling.solved[coupling.offset[beam] : coupling.offset[beam + 1]].reshape((-1, y.size))
        load[beams.first[beam] : beams.first[beam] + len(X)] -= X @ y
    load[border.first :] = solution[: load.size - border.first]


@compiled
def linearise(
    z: Array,
    m: Numbers,
    driven: Flags,
    target: Array,
    stiffness: Array,
    anchor: Array,
    columns: Columns,
    gradient: Array,
) -> Bordered:  # pragma: no cover
    """Border at a state with the columns of closed places; adds the gradient without contacts to ``gradient``."""
    blocks = add_gradient(z, m, driven, target, stiffness, anchor, gradient)
    border, springs = m.border, np.ones(m.beams.springs.size)
    G = np.diag(np.concatenate((np.zeros(border.rows), 1.0 - driven, springs, columns.diagonal)))
    for t in range(m.rows.turning_row.size):
        angle, mu = m.rows.turning_index[t], z[m.rows.first + m.rows.turning_row[t]]
        bent = m.rows.turning_cos[t] * cos(z[angle]) + m.rows.turning_sin[t] * sin(z[angle])
        G[angle - border.first, angle - border.first] -= mu * bent
    for c in np.flatnonzero(columns.beside):
        G[border.size + c, border.size + c - 1] += columns.beside[c]
    coupling = coupled_chains(m.beams, border, len(G), border_entries(z, m.rows, m.beams, driven, border, columns))
    chains, negative = factored_chains(m.beams, blocks)
    eliminate(m.beams, chains, border, coupling, G)
    return Bordered(G, negative, columns, chains, coupling)


@compiled
def reduced_system(
    z: Array,
    m: Numbers,
    driven: Flags,
    target: Array,
    stiffness: Array,
    anchor: Array,
    columns: Columns,
    gradient: Array,
) -> tuple[Bordered, Array, Array]:  # pragma: no cover
    """Border, the chains' solution for minus the whole gradient, and the border's load; arguments as of linearise."""
    bordered = linearise(z, m, driven, target, stiffness, anchor, columns, gradient)
    load, values = -gradient, np.zeros(columns.diagonal.size)
    values[: columns.values.size] = columns.values
    return bordered, load, reduced_load(m.beams, m.border, bordered.chains, bordered.coupling, driven, values, load)


@compiled
def correction(change: Array, motions: Ints, turns: Ints) -> tuple[float, float]:  # pragma: no cover
    """Size of a change (size,) of the unknowns, inf if not finite, and the share that turns no part too far."""
    moved, turn = np.abs(change[motions]), np.abs(change[turns]).max()
    if not np.all(np.isfinite(moved)):
        return np.inf, 0.0
    return moved.max(), min(1.0, LARGEST_TURN / turn) if turn > 0.0 else 1.0
