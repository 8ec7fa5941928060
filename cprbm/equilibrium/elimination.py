"""Exact elimination of chains with a symmetric border, compiled.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
A          block of a chain in the Hessian of the Lagrangian, with three springs ρ at the first node and angle
T          tridiagonal block of the angles
B, D       coupling of the chains with the border, block of the border
X          A⁻¹ Bᵀ: for every chain a matrix, with the border columns that reach the chain
G          Schur complement D − B X
m          number of links of a chain
=========  =====================================================================================

The chains are eliminated without pivoting: the balance of forces gives the forces n by sums from the end, T gives the
angles, the link equations give the positions by sums from the start.  By Sylvester's law A has 2m negative eigenvalues
for the link equations, and as many as T has negative pivots.

The border holds bodies, nodes carried by bodies, the multipliers of the rows, and three unknowns per chain against the
springs (1 on the diagonal, √ρ beside the diagonal).  Closed places add columns, :mod:`cprbm.equilibrium.columns`.
The lower triangle of G counts.
The multiplier of a row with prescribed force is no unknown; 1 stands on the diagonal.

So the Hessian has neg(A) + neg(G) negative eigenvalues.  The equalities account for as many; the
rest is the number of independent directions with falling energy.
"""

from math import cos, sin
from typing import NamedTuple

import numpy as np

from cprbm.chain import PER_LINK, Blocks, RowArrays, compiled
from cprbm.contact import Columns
from cprbm_scene.answer import Array, Flags, Ints

LEAST_PIVOT = 1e-300
"""In place of a pivot that is exactly zero: the sign of the next pivot is right then."""


class Beams(NamedTuple):
    """Chains: index of the first unknown, number of links, number of the first link; springs ρ (beams, 3)."""

    first: Ints
    links: Ints
    first_link: Ints
    springs: Array


class Border(NamedTuple):
    """Coupling of chains and border.

    Attributes:
        first: number of the chains' unknowns; column i is the unknown ``first`` + i, then come springs.
        size: number of border columns.
        rows: border column of the first multiplier.
        begin, column: columns that reach a chain, ordered by chain, and the first of each chain (beams + 1,).
        entry_beam, entry_slot: chain of an entry of B, and number of the column among the chain's columns.
        entry_local, entry_row, entry_value: unknown of the chain, row (−1: spring) and value.
    """

    first: int
    size: int
    rows: int
    begin: Ints
    column: Ints
    entry_beam: Ints
    entry_slot: Ints
    entry_local: Ints
    entry_row: Ints
    entry_value: Array


class Reached(NamedTuple):
    """Columns of rows and closed places by the chains that they reach.

    Attributes:
        begin, column: columns that reach a chain, ordered by chain, and the first of each chain (beams + 1,).
        offset: first value of each chain in ``solved`` (beams + 1,).
        solved: X of all chains, by unknowns and columns.
        entry_beam, entry_slot: of the entries of closed places; −1 for an entry beside the border's unknowns.
    """

    begin: Ints
    column: Ints
    offset: Ints
    solved: Array
    entry_beam: Ints
    entry_slot: Ints


@compiled
def factor_chains(beams: Beams, blocks: Blocks, pivot: Array, ratio: Array) -> int:  # pragma: no cover
    """Write the inverse pivots of T of all chains, and their ratios; the number of negative pivots."""
    negative = 0
    for beam in range(beams.first.size):
        start = beams.first_link[beam]
        for j in range(start, start + beams.links[beam]):
            pivot[j] = blocks.turn[j]
            if j == start:
                pivot[j] += beams.springs[beam, 2]
            else:
                ratio[j] = blocks.next_turn[j - 1] * pivot[j - 1]
                pivot[j] -= ratio[j] * blocks.next_turn[j - 1]
            if pivot[j] == 0.0:
                pivot[j] = LEAST_PIVOT
            negative += pivot[j] < 0.0
            pivot[j] = 1.0 / pivot[j]
    return negative


@compiled
def _sum_forces(coupling: Array, m: int, x: Array) -> Array:  # pragma: no cover
    """Resultants (2, columns) at the first node; the force n_j takes the place of p_{j+1}, θ loses the forces' part."""
    force, count = x[5 * m : 5 * m + 2].copy(), x.shape[1]
    for j in range(m - 1, -1, -1):
        i, c = 5 * j, coupling[j]
        for axis in range(2):
            n = force[axis]
            for q in range(count):
                x[i + 5 + axis, q] = n[q]
            for link in range(max(j - 1, 0), min(j + 2, m)):
                factor = c[1 + link - j, axis]
                for q in range(count):
                    x[5 * link + 4, q] -= factor * n[q]
            for q in range(count):
                n[q] += x[i + axis, q]
    return force


@compiled
def _solve_angles(pivot: Array, ratio: Array, m: int, x: Array) -> None:  # pragma: no cover
    """Solve T θ = b in place."""
    count = x.shape[1]
    for j in range(1, m):
        for q in range(count):
            x[5 * j + 4, q] -= ratio[j] * x[5 * j - 1, q]
    for q in range(count):
        x[5 * m - 1, q] *= pivot[m - 1]
    for j in range(m - 2, -1, -1):
        for q in range(count):
            x[5 * j + 4, q] = x[5 * j + 4, q] * pivot[j] - ratio[j + 1] * x[5 * j + 9, q]


@compiled
def _sum_places(coupling: Array, compliance: Array, m: int, place: Array, x: Array) -> None:  # pragma: no cover
    """Write forces and positions behind the first node at ``place`` (2, columns), which is lost."""
    count = x.shape[1]
    for j in range(m):
        i, c, k = 5 * j, coupling[j], compliance[j]
        for axis in range(2):
            p = place[axis]
            for q in range(count):
                p[q] += x[i + 2 + axis, q]
            for link in range(max(j - 1, 0), min(j + 2, m)):
                # forces of links before are in their own places already
                n, turn, near = 5 * link + (2 if link < j else 5), 5 * link + 4, 1 + link - j
                a, b, factor = k[near, axis, 0], k[near, axis, 1], c[near, axis]
                for q in range(count):
                    p[q] -= a * x[n, q] + b * x[n + 1, q] + factor * x[turn, q]
        for axis in range(2):
            for q in range(count):
                x[i + 2 + axis, q] = x[i + 5 + axis, q]
            for q in range(count):
                x[i + 5 + axis, q] = place[axis, q]


@compiled
def solve_columns(
    beams: Beams, beam: int, blocks: Blocks, pivot: Array, ratio: Array, x: Array
) -> None:  # pragma: no cover
    """Solve A X = B in place; ``x`` (unknowns, columns) belongs to a chain.

    All columns are in the inner loops, which the processor does at once.
    """
    m, start = beams.links[beam], beams.first_link[beam]
    end = start + m
    place = _sum_forces(blocks.coupling[start:end], m, x)
    _solve_angles(pivot[start:end], ratio[start:end], m, x)
    for axis in range(2):
        place[axis] /= beams.springs[beam, axis]
        x[axis] = place[axis]
    _sum_places(blocks.coupling[start:end], blocks.compliance[start:end], m, place, x)


@compiled
def border_block(z: Array, rows: RowArrays, driven: Flags, border: Border, G: Array) -> None:  # pragma: no cover
    """Write D: rows beside bodies and carried nodes, second derivatives by rotations, springs."""
    first, at = border.first, border.rows
    for r in range(driven.size):
        if not driven[r]:
            G[at + r, at + r] = 1.0
    for c in range(at + driven.size, border.size):
        G[c, c] = 1.0
    for t in range(rows.linear_row.size):
        r, i = rows.linear_row[t], rows.linear_index[t] - first
        if i >= 0 and driven[r]:
            G[at + r, i] += rows.linear_factor[t]
            G[i, at + r] += rows.linear_factor[t]
    for t in range(rows.turning_row.size):
        r, i = rows.turning_row[t], rows.turning_index[t] - first
        a, b = cos(z[i + first]), sin(z[i + first])
        A, B = rows.turning_cos[t], rows.turning_sin[t]
        G[i, i] -= z[rows.first + r] * (A * a + B * b)
        if driven[r]:
            G[at + r, i] += B * a - A * b
            G[i, at + r] += B * a - A * b


@compiled
def reached_chains(beams: Beams, border: Border, columns: Columns) -> Reached:  # pragma: no cover
    """Chains that the columns of rows and closed places reach, X zero."""
    count, entries = beams.first.size, columns.entry_index.size
    entry_beam, entry_slot = np.searchsorted(beams.first, columns.entry_index, "right") - 1, np.full(entries, -1)
    slot, reach = np.full((count, columns.diagonal.size), -1), 0
    for t in range(entries):
        beam, c = entry_beam[t], columns.entry_column[t]
        if columns.entry_index[t] < border.first:
            reach += slot[beam, c] < 0
            slot[beam, c] = 0
        else:
            entry_beam[t] = -1
    begin, offset = np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)
    column = np.empty(border.column.size + reach, np.int64)
    for beam in range(count):
        own = border.column[border.begin[beam] : border.begin[beam + 1]]
        end = begin[beam] + own.size
        column[begin[beam] : end] = own
        for c in range(columns.diagonal.size):
            if slot[beam, c] == 0:
                slot[beam, c], column[end] = end - begin[beam], border.size + c
                end += 1
        begin[beam + 1] = end
        offset[beam + 1] = offset[beam] + (end - begin[beam]) * (2 + PER_LINK * beams.links[beam])
    for t in range(entries):
        if entry_beam[t] >= 0:
            entry_slot[t] = slot[entry_beam[t], columns.entry_column[t]]
    return Reached(begin, column, offset, np.zeros(offset[count]), entry_beam, entry_slot)


@compiled
def _subtract_product(
    reached: Reached, beam: int, slot: int, local: int, value: float, G: Array
) -> None:  # pragma: no cover
    """Subtract an entry of B times a row of X from G."""
    begin = reached.begin[beam]
    at, row = reached.offset[beam] + local * (reached.begin[beam + 1] - begin), G[reached.column[begin + slot]]
    for other in range(slot + 1):
        row[reached.column[begin + other]] -= value * reached.solved[at + other]


@compiled
def eliminate(
    beams: Beams, blocks: Blocks, pivot: Array, ratio: Array, driven: Flags, border: Border, columns: Columns, G: Array
) -> tuple[int, Reached]:  # pragma: no cover
    """Add the columns' block to G and subtract B X; the number of negative pivots of all T, and the columns' X."""
    negative = factor_chains(beams, blocks, pivot, ratio)
    reached = reached_chains(beams, border, columns)
    begin, offset, solved = reached.begin, reached.offset, reached.solved
    for c in range(columns.diagonal.size):
        at = border.size + c
        G[at, at] += columns.diagonal[c]
        G[at, at - 1] += columns.beside[c]
    for t in range(border.entry_beam.size):
        beam, r = border.entry_beam[t], border.entry_row[t]
        if r < 0 or driven[r]:
            at = offset[beam] + border.entry_local[t] * (begin[beam + 1] - begin[beam]) + border.entry_slot[t]
            solved[at] += border.entry_value[t]
    for t in range(columns.entry_index.size):
        beam, i = reached.entry_beam[t], columns.entry_index[t]
        if beam >= 0:
            at = offset[beam] + (i - beams.first[beam]) * (begin[beam + 1] - begin[beam]) + reached.entry_slot[t]
            solved[at] += columns.entry_value[t]
        else:
            G[border.size + columns.entry_column[t], i - border.first] += columns.entry_value[t]
    for beam in range(beams.first.size):
        x = solved[offset[beam] : offset[beam + 1]].reshape((-1, begin[beam + 1] - begin[beam]))
        solve_columns(beams, beam, blocks, pivot, ratio, x)
    for t in range(border.entry_beam.size):
        if border.entry_row[t] < 0 or driven[border.entry_row[t]]:
            of_entry = border.entry_beam[t], border.entry_slot[t], border.entry_local[t]
            _subtract_product(reached, of_entry[0], of_entry[1], of_entry[2], border.entry_value[t], G)
    for t in range(columns.entry_index.size):
        beam = reached.entry_beam[t]
        if beam >= 0:
            local = columns.entry_index[t] - beams.first[beam]
            _subtract_product(reached, beam, reached.entry_slot[t], local, columns.entry_value[t], G)
    return negative, reached
