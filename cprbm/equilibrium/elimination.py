"""Exact elimination of chains with a symmetric border, compiled.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
A          block of a chain in the Hessian of the Lagrangian, with three springs ρ at the first node and angle
T          tridiagonal block of the angles
B, D       coupling of the chains with the border, block of the border
X          A⁻¹ Bᵀ, kept for pairs of a border column and a touched chain
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

from __future__ import annotations

from math import cos, isfinite, sin
from typing import NamedTuple

from cprbm.chain import Blocks, RowArrays
from cprbm.chain.compiled import compiled
from cprbm.chain.mechanism import PER_LINK
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
        pair_column, pair_beam, pair_offset: pairs of a column and a chain, ordered by chain; first value in X.
        beam_pairs: first pair of each chain, and the number of pairs (beams + 1,).
        entry_pair, entry_index, entry_row, entry_value: entries of B by pair, unknown, row (−1: spring) and value.
    """

    first: int
    size: int
    rows: int
    pair_column: Ints
    pair_beam: Ints
    pair_offset: Ints
    beam_pairs: Ints
    entry_pair: Ints
    entry_index: Ints
    entry_row: Ints
    entry_value: Array


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
def solve_chain(
    beams: Beams, beam: int, blocks: Blocks, pivot: Array, ratio: Array, x: Array
) -> None:  # pragma: no cover
    """Solve A x = b in place; ``x`` holds the unknowns of a chain."""
    m, start = beams.links[beam], beams.first_link[beam]
    C, K = blocks.coupling, blocks.compliance
    nx, ny = x[5 * m], x[5 * m + 1]
    # the force n_j takes the place of p_{j+1} until the positions are known
    for j in range(m - 1, -1, -1):
        i = 5 * j
        x[i + 5], x[i + 6] = nx, ny
        c = C[start + j]
        x[i + 4] -= c[1, 0] * nx + c[1, 1] * ny
        if j > 0:
            x[i - 1] -= c[0, 0] * nx + c[0, 1] * ny
        if j < m - 1:
            x[i + 9] -= c[2, 0] * nx + c[2, 1] * ny
        nx += x[i]
        ny += x[i + 1]
    for j in range(1, m):
        x[5 * j + 4] -= ratio[start + j] * x[5 * j - 1]
    x[5 * m - 1] *= pivot[start + m - 1]
    for j in range(m - 2, -1, -1):
        x[5 * j + 4] = x[5 * j + 4] * pivot[start + j] - ratio[start + j + 1] * x[5 * j + 9]
    px, py = nx / beams.springs[beam, 0], ny / beams.springs[beam, 1]
    x[0], x[1] = px, py
    bx, by = 0.0, 0.0
    for j in range(m):
        i = 5 * j
        nx, ny = x[i + 5], x[i + 6]
        c, k = C[start + j], K[start + j]
        px += x[i + 2] - k[1, 0, 0] * nx - k[1, 0, 1] * ny - c[1, 0] * x[i + 4]
        py += x[i + 3] - k[1, 1, 0] * nx - k[1, 1, 1] * ny - c[1, 1] * x[i + 4]
        if j > 0:
            px -= k[0, 0, 0] * bx + k[0, 0, 1] * by + c[0, 0] * x[i - 1]
            py -= k[0, 1, 0] * bx + k[0, 1, 1] * by + c[0, 1] * x[i - 1]
        if j < m - 1:
            fx, fy = x[i + 10], x[i + 11]
            px -= k[2, 0, 0] * fx + k[2, 0, 1] * fy + c[2, 0] * x[i + 9]
            py -= k[2, 1, 0] * fx + k[2, 1, 1] * fy + c[2, 1] * x[i + 9]
        x[i + 2], x[i + 3], x[i + 5], x[i + 6] = nx, ny, px, py
        bx, by = nx, ny


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
def eliminate(
    beams: Beams, blocks: Blocks, pivot: Array, ratio: Array, driven: Flags, border: Border, X: Array, G: Array
) -> int:  # pragma: no cover
    """Write X and subtract B X from G; the number of negative pivots of all T."""
    negative = factor_chains(beams, blocks, pivot, ratio)
    X[:] = 0.0
    for t in range(border.entry_pair.size):
        q, r = border.entry_pair[t], border.entry_row[t]
        if r < 0 or driven[r]:
            at = border.pair_offset[q] + border.entry_index[t] - beams.first[border.pair_beam[q]]
            X[at] += border.entry_value[t]
    for q in range(border.pair_column.size):
        beam = border.pair_beam[q]
        size = 2 + PER_LINK * beams.links[beam]
        solve_chain(beams, beam, blocks, pivot, ratio, X[border.pair_offset[q] : border.pair_offset[q] + size])
    for t in range(border.entry_pair.size):
        q, r = border.entry_pair[t], border.entry_row[t]
        if r >= 0 and not driven[r]:
            continue
        beam = border.pair_beam[q]
        local, column = border.entry_index[t] - beams.first[beam], border.pair_column[q]
        for other in range(border.beam_pairs[beam], q + 1):
            G[column, border.pair_column[other]] -= border.entry_value[t] * X[border.pair_offset[other] + local]
    return negative


@compiled
def negative_pivots(factored: Array, order: Ints) -> int:  # pragma: no cover
    """Number of negative eigenvalues of LAPACK's factors after Bunch and Kaufman; −1 if a pivot is not finite."""
    negative, doubles = 0, 0
    for i in range(order.size):
        if not isfinite(factored[i, i]):
            return -1
        if order[i] < 0:
            doubles += 1
        elif factored[i, i] < 0.0:
            negative += 1
    return negative + doubles // 2


@compiled
def reduce_load(
    beams: Beams, blocks: Blocks, pivot: Array, ratio: Array, driven: Flags, border: Border, load: Array, reduced: Array
) -> None:  # pragma: no cover
    """Solve all chains for a load in place, and subtract B times the solution from the border's load."""
    for beam in range(beams.first.size):
        first, size = beams.first[beam], 2 + PER_LINK * beams.links[beam]
        solve_chain(beams, beam, blocks, pivot, ratio, load[first : first + size])
    for t in range(border.entry_pair.size):
        r = border.entry_row[t]
        if r < 0 or driven[r]:
            reduced[border.pair_column[border.entry_pair[t]]] -= border.entry_value[t] * load[border.entry_index[t]]


@compiled
def restore(beams: Beams, border: Border, X: Array, solution: Array, load: Array) -> None:  # pragma: no cover
    """Subtract X times the border's solution from the chains' part."""
    for q in range(border.pair_column.size):
        beam, y = border.pair_beam[q], solution[border.pair_column[q]]
        if y != 0.0:
            first, offset = beams.first[beam], border.pair_offset[q]
            for i in range(2 + PER_LINK * beams.links[beam]):
                load[first + i] -= y * X[offset + i]
