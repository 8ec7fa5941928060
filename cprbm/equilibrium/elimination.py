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

from typing import NamedTuple

import numpy as np

from cprbm.chain import PER_LINK, Blocks, RowArrays, compiled, compiled_inner
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
    """Columns of the border.

    Attributes:
        first: number of the chains' unknowns; column i is the unknown ``first`` + i, then come springs.
        size: number of border columns.
        rows: border column of the first multiplier.
    """

    first: int
    size: int
    rows: int


class Coupling(NamedTuple):
    """Entries of B, of rows, springs and closed places, and X by the chains.

    Attributes:
        column, unknown, value: border column, unknown and value of an entry.
        beam: chain of an entry; −1 for an entry beside the border's unknowns.
        slot, row: number of the column among the chain's columns, first value of the unknown's row in ``solved``.
        begin, reached: border columns that reach a chain, ordered by chain, and the first of each chain (beams + 1,).
        offset: first value of each chain in ``solved`` (beams + 1,).
        solved: X of all chains, by unknowns and columns.
    """

    column: Ints
    unknown: Ints
    value: Array
    beam: Ints
    slot: Ints
    row: Ints
    begin: Ints
    reached: Ints
    offset: Ints
    solved: Array


class Chains(NamedTuple):
    """Factors of the chains: coupling and compliance of the Hessian's blocks, inverse pivots and ratios of T."""

    coupling: Array
    compliance: Array
    pivot: Array
    ratio: Array


@compiled
def factored_chains(beams: Beams, blocks: Blocks) -> tuple[Chains, int]:  # pragma: no cover
    """Factors of all chains, and the number of negative pivots of all T."""
    negative, pivot, ratio = 0, blocks.turn.copy(), np.zeros(blocks.turn.size)
    for beam in range(beams.first.size):
        start = beams.first_link[beam]
        pivot[start] += beams.springs[beam, 2]
        for j in range(start, start + beams.links[beam]):
            if j > start:
                ratio[j] = blocks.next_turn[j - 1] * pivot[j - 1]
                pivot[j] -= ratio[j] * blocks.next_turn[j - 1]
            if pivot[j] == 0.0:
                pivot[j] = LEAST_PIVOT
            negative += pivot[j] < 0.0
            pivot[j] = 1.0 / pivot[j]
    return Chains(blocks.coupling, blocks.compliance, pivot, ratio), negative


@compiled_inner
def _sum_forces(coupling: Array, m: int, force: Array, x: Array) -> None:  # pragma: no cover
    """Turn forces (2, columns) on the last node into resultants at the first node.

    The force n_j takes the place of p_{j+1}, and θ loses the forces' part.
    """
    count = x.shape[1]
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


@compiled_inner
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


@compiled_inner
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
def solve_columns(beams: Beams, beam: int, chains: Chains, x: Array) -> None:  # pragma: no cover
    """Solve A X = B in place; ``x`` (unknowns, columns) belongs to a chain.

    All columns are in the inner loops, which the processor does at once.
    """
    m, start = beams.links[beam], beams.first_link[beam]
    end = start + m
    place = x[5 * m : 5 * m + 2].copy()
    _sum_forces(chains.coupling[start:end], m, place, x)
    _solve_angles(chains.pivot[start:end], chains.ratio[start:end], m, x)
    for axis in range(2):
        place[axis] /= beams.springs[beam, axis]
        x[axis] = place[axis]
    _sum_places(chains.coupling[start:end], chains.compliance[start:end], m, place, x)


@compiled
def border_entries(
    z: Array, rows: RowArrays, beams: Beams, driven: Flags, border: Border, columns: Columns
) -> tuple[Ints, Ints, Array]:  # pragma: no cover
    """Column, unknown and value of the entries of prescribed rows, of springs, and of closed places."""
    linear, turning = np.flatnonzero(driven[rows.linear_row]), np.flatnonzero(driven[rows.turning_row])
    angle, count = rows.turning_index[turning], 3 * beams.first.size
    slope = rows.turning_sin[turning] * np.cos(z[angle]) - rows.turning_cos[turning] * np.sin(z[angle])
    held = (beams.first.reshape((-1, 1)) + np.array([0, 1, PER_LINK - 1])).ravel()
    row, springs = np.concatenate((rows.linear_row[linear], rows.turning_row[turning])), np.sqrt(beams.springs).ravel()
    of_springs = border.size - count + np.arange(count)
    return (
        np.concatenate((border.rows + row, of_springs, border.size + columns.entry_column)),
        np.concatenate((rows.linear_index[linear], angle, held, columns.entry_index)),
        np.concatenate((rows.linear_factor[linear], slope, springs, columns.entry_value)),
    )


@compiled
def coupled_chains(
    beams: Beams, border: Border, size: int, entries: tuple[Ints, Ints, Array]
) -> Coupling:  # pragma: no cover
    """Entries by chain, and X with the entries for values; ``size`` is the number of all columns."""
    count, (column, unknown, value) = beams.first.size, entries
    beam = np.searchsorted(beams.first, unknown, "right") - 1
    row, slot, slots = np.empty_like(beam), np.empty_like(beam), np.full((count, size), -1)
    for t in range(value.size):
        if unknown[t] < border.first:
            slots[beam[t], column[t]] = 0
        else:
            beam[t] = -1
    reached = np.empty(np.count_nonzero(slots == 0), np.int64)
    begin, offset = np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)
    for k in range(count):
        own = np.flatnonzero(slots[k] == 0)
        slots[k][own] = np.arange(own.size)
        begin[k + 1], offset[k + 1] = begin[k] + own.size, offset[k] + own.size * (2 + PER_LINK * beams.links[k])
        reached[begin[k] : begin[k + 1]] = own
    solved = np.zeros(offset[count])
    for t in range(value.size):
        k = beam[t]
        if k >= 0:
            slot[t] = slots[k, column[t]]
            row[t] = offset[k] + (unknown[t] - beams.first[k]) * (begin[k + 1] - begin[k])
            solved[row[t] + slot[t]] += value[t]
    return Coupling(column, unknown, value, beam, slot, row, begin, reached, offset, solved)


@compiled
def eliminate(beams: Beams, chains: Chains, border: Border, coupling: Coupling, G: Array) -> None:  # pragma: no cover
    """Solve for X, add the border's own entries to G and subtract B X."""
    column, begin, offset, solved = coupling.column, coupling.begin, coupling.offset, coupling.solved
    for beam in range(beams.first.size):
        x = solved[offset[beam] : offset[beam + 1]].reshape((-1, begin[beam + 1] - begin[beam]))
        solve_columns(beams, beam, chains, x)
    for t in range(column.size):
        beam, of_column = coupling.beam[t], G[column[t]]
        if beam < 0:
            of_column[coupling.unknown[t] - border.first] += coupling.value[t]
        else:
            for other in range(coupling.slot[t] + 1):
                product = coupling.value[t] * solved[coupling.row[t] + other]
                of_column[coupling.reached[begin[beam] + other]] -= product
