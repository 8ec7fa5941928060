"""Border columns of closed places, compiled.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
H          Hessian of the Lagrangian without contacts
F, λ       force of a closed place; a place adds −F λ to the Lagrangian, :mod:`cprbm.contact.gap`
a          column of the force, minus the derivative of the row's value by the unknowns
c          minus the derivative of the value by F
V, S       local motions q, e, λ_ξu of a place, and their coefficients: −F V S Vᵀ is the Hessian of −F λ
X          A⁻¹ of the columns' parts at the chains, kept for pairs of a column and a touched chain
=========  =====================================================================================

With a variable y for every local motion the second derivatives of a place leave the chains' pattern alone:

    [ H + V R Vᵀ  a ]      [ H    V      a  ]
    [    aᵀ       c ]  =>  [ Vᵀ  −R⁻¹    0  ],    R = −F S.
                           [ aᵀ   0      c  ]

By Sylvester's law the left matrix has as many negative eigenvalues as the right matrix, less the negative eigenvalues
of −R⁻¹ = S⁻¹/F.  Two places with a shared force have a common column, the sum of both.

A column has entries at the nodes of two pieces, at most six nodes each.  The chains are eliminated by the kernels of
:mod:`cprbm.equilibrium.elimination`; a column costs the solution of one or two chains.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cprbm.chain import Blocks
from cprbm.chain.compiled import compiled
from cprbm.chain.mechanism import PER_LINK
from cprbm.contact import (
    COUPLING,
    GRADIENT,
    LOCAL,
    SHIFT,
    STENCIL,
    TANGENT,
    TURN,
    CurveArrays,
    Places,
    gap_row,
    local_indices,
)
from cprbm.equilibrium.elimination import Beams, Border, solve_chain
from cprbm_scene.answer import Array, Flags, Ints

MOTIONS = 3
"""Most local motions of a place."""


class Columns(NamedTuple):
    """Columns of closed places: columns of forces first, then columns of local motions.

    Attributes:
        values: of the rows with a force of their own (forces,).
        negative: number of negative eigenvalues of all S⁻¹/F.
        diagonal, beside: block of the columns: diagonal, and entry beside the column before (columns,).
        entry_column, entry_index, entry_value: entries by column, unknown and value.
    """

    values: Array
    negative: int
    diagonal: Array
    beside: Array
    entry_column: Ints
    entry_index: Ints
    entry_value: Array


class Reached(NamedTuple):
    """Chains reached by columns.

    Attributes:
        entry_pair: pair of a column and a chain for every entry, −1 for an entry beside the border's unknowns.
        pair_column, pair_beam, pair_offset: pairs, ordered by chain; first value in ``solved``.
        solved: X.
    """

    entry_pair: Ints
    pair_column: Ints
    pair_beam: Ints
    pair_offset: Ints
    solved: Array


@compiled
def contact_columns(
    z: Array, curves: CurveArrays, places: Places, closed: Flags, gradient: Array
) -> Columns:  # pragma: no cover
    """Columns of the places marked ``closed``; adds the gradient of all −F λ by the unknowns to ``gradient``."""
    number, forces, count = np.zeros(closed.size, np.int64), 0, 0
    for k in range(closed.size):
        number[k] = forces
        forces += closed[k] and places.shares[k] == 0
        count += closed[k]
    values, most = np.zeros(forces), forces + MOTIONS * count
    diagonal, beside = np.zeros(most), np.zeros(most)
    most = (1 + MOTIONS) * LOCAL * count
    entries = np.empty(most, np.int64), np.empty(most, np.int64), np.empty(most)
    vectors, weights, index = np.empty((5, LOCAL)), np.empty((4, 2, STENCIL)), np.empty(LOCAL, np.int64)
    used, at, negative = 0, forces, 0
    for k in range(closed.size):
        if not closed[k]:
            continue
        row = gap_row(z, curves, places, k, vectors, weights)
        local_indices(curves, places, k, index)
        own, F = number[k + places.shares[k]], places.force[k]
        values[own] += row.value
        diagonal[own] -= row.by_force
        for i in range(LOCAL):
            gradient[index[i]] -= F * vectors[GRADIENT, i]
        used = _add_entries(entries, used, own, index, vectors[COUPLING], -1.0)
        if F == 0.0:
            continue
        if row.ee != 0.0 or row.qe != 0.0:
            scale = F * (row.qq * row.ee - row.qe * row.qe)
            diagonal[at], diagonal[at + 1], beside[at + 1] = row.ee / scale, row.qq / scale, -row.qe / scale
            negative += 1 if F * scale < 0.0 else (2 if F * (row.qq + row.ee) < 0.0 else 0)
            used = _add_entries(entries, used, at, index, vectors[TANGENT], 1.0)
            used = _add_entries(entries, used, at + 1, index, vectors[TURN], 1.0)
            at += 2
        elif row.qq != 0.0:
            diagonal[at] = 1.0 / (F * row.qq)
            negative += diagonal[at] < 0.0
            used = _add_entries(entries, used, at, index, vectors[TANGENT], 1.0)
            at += 1
        if row.shift != 0.0:
            diagonal[at] = 1.0 / (F * row.shift)
            negative += diagonal[at] < 0.0
            used = _add_entries(entries, used, at, index, vectors[SHIFT], 1.0)
            at += 1
    return Columns(values, negative, diagonal[:at], beside[:at], entries[0][:used], entries[1][:used], entries[2][:used])


@compiled
def _add_entries(
    entries: tuple[Ints, Ints, Array], used: int, column: int, index: Ints, vector: Array, factor: float
) -> int:  # pragma: no cover
    """Append the entries of a column; the number of all entries."""
    for i in range(LOCAL):
        if vector[i] != 0.0:
            entries[0][used], entries[1][used], entries[2][used] = column, index[i], factor * vector[i]
            used += 1
    return used


@compiled
def reached_chains(beams: Beams, first: int, columns: Columns) -> Reached:  # pragma: no cover
    """Pairs of columns and chains, X not solved; the border's unknowns begin at ``first``."""
    entry_beam = np.full(columns.entry_index.size, -1)
    pair_of = np.full((beams.first.size, columns.diagonal.size), -1)
    for t in range(entry_beam.size):
        if columns.entry_index[t] < first:
            entry_beam[t] = np.searchsorted(beams.first, columns.entry_index[t], side="right") - 1
            pair_of[entry_beam[t], columns.entry_column[t]] = 0
    count = np.sum(pair_of == 0)
    column, of_beam, offset = np.empty(count, np.int64), np.empty(count, np.int64), np.zeros(count + 1, np.int64)
    q = 0
    for beam in range(beams.first.size):
        for c in range(columns.diagonal.size):
            if pair_of[beam, c] == 0:
                pair_of[beam, c], column[q], of_beam[q] = q, c, beam
                offset[q + 1] = offset[q] + 2 + PER_LINK * beams.links[beam]
                q += 1
    for t in range(entry_beam.size):
        if entry_beam[t] >= 0:
            entry_beam[t] = pair_of[entry_beam[t], columns.entry_column[t]]
    return Reached(entry_beam, column, of_beam, offset, np.zeros(offset[count]))


@compiled
def eliminate_columns(
    beams: Beams, blocks: Blocks, pivot: Array, ratio: Array, border: Border, X: Array, columns: Columns, G: Array
) -> Reached:  # pragma: no cover
    """Write the columns' part of the border into G, chains eliminated; ``X`` belongs to the rows' columns."""
    reached = reached_chains(beams, border.first, columns)
    solved, offset, at = reached.solved, reached.pair_offset, border.size
    for c in range(columns.diagonal.size):
        G[at + c, at + c] += columns.diagonal[c]
        G[at + c, at + c - 1] += columns.beside[c]
    for t in range(columns.entry_index.size):
        q, i, value = reached.entry_pair[t], columns.entry_index[t], columns.entry_value[t]
        if q >= 0:
            solved[offset[q] + i - beams.first[reached.pair_beam[q]]] += value
        else:
            G[at + columns.entry_column[t], i - border.first] += value
    for q in range(reached.pair_column.size):
        solve_chain(beams, reached.pair_beam[q], blocks, pivot, ratio, solved[offset[q] : offset[q + 1]])
    for t in range(columns.entry_index.size):
        q, value = reached.entry_pair[t], columns.entry_value[t]
        if q < 0:
            continue
        beam, row = reached.pair_beam[q], G[at + columns.entry_column[t]]
        local = columns.entry_index[t] - beams.first[beam]
        for other in range(border.beam_pairs[beam], border.beam_pairs[beam + 1]):
            row[border.pair_column[other]] -= value * X[border.pair_offset[other] + local]
        other = q
        while other >= 0 and reached.pair_beam[other] == beam:
            row[at + reached.pair_column[other]] -= value * solved[offset[other] + local]
            other -= 1
    return reached


@compiled
def reduce_columns(size: int, columns: Columns, reached: Reached, load: Array, reduced: Array) -> None:  # pragma: no cover
    """Subtract the columns times the chains' solution ``load`` from the border's load; ``size`` of the rows' border."""
    for t in range(columns.entry_index.size):
        if reached.entry_pair[t] >= 0:
            reduced[size + columns.entry_column[t]] -= columns.entry_value[t] * load[columns.entry_index[t]]


@compiled
def restore_columns(beams: Beams, size: int, reached: Reached, solution: Array, load: Array) -> None:  # pragma: no cover
    """Subtract X times the border's solution from the chains' part."""
    for q in range(reached.pair_column.size):
        first, begin, end = beams.first[reached.pair_beam[q]], reached.pair_offset[q], reached.pair_offset[q + 1]
        y = solution[size + reached.pair_column[q]]
        for i in range(end - begin):
            load[first + i] -= y * reached.solved[begin + i]
