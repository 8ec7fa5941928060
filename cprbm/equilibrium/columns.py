"""Border columns of closed places, compiled.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
H          Hessian of the Lagrangian without contacts
F, λ       force of a closed place; a place adds −F λ to the Lagrangian, :mod:`cprbm.contact.gap`
a          column of the force, minus the derivative of the row's value by the unknowns
c          minus the derivative of the value by F
V, s       local motions of a place and their coefficients: −F Σ s (V·du)² is the Hessian of −F λ
=========  =====================================================================================

The form of a place in q and e is the sum of two squares, λ_ξu² is the third.  With a variable y for every local motion
the second derivatives of a place leave the chains' pattern alone:

    [ H + V R Vᵀ  a ]      [ H    V      a  ]
    [    aᵀ       c ]  =>  [ Vᵀ  −R⁻¹    0  ],    R = −F s.
                           [ aᵀ   0      c  ]

By Sylvester's law the left matrix has as many negative eigenvalues as the right matrix, less the negative eigenvalues
of −R⁻¹ = 1/(F s).  Two places with a shared force have a common column, the sum of both.

A column has entries at the nodes of two pieces, at most six nodes per piece, and reaches a single chain or two chains.
"""

import numpy as np

from cprbm.chain import compiled, compiled_inner
from cprbm.contact import (
    COUPLING,
    GRADIENT,
    LOCAL,
    SHIFT,
    TANGENT,
    TURN,
    Columns,
    CurveArrays,
    Geometry,
    Places,
    gap_row,
    local_indices,
)
from cprbm_scene.answer import Array, Flags, Ints

MOTIONS = 3
"""Most local motions of a place."""


def contact_terms(geometry: Geometry, z: Array, places: Places, closed: Flags) -> tuple[Columns, Array]:
    """Columns of the places marked ``closed``, and the gradient (size,) of all −F λ; shared forces are equal."""
    gradient = np.zeros(len(z))
    if geometry.law is not None:
        return geometry.law.columns(z, places, closed, gradient), gradient
    return contact_columns(z, geometry.arrays, places, closed, gradient), gradient


def gap_rates(geometry: Geometry, z: Array, places: Places, which: Flags, motion: Array) -> Array:
    """Changes of the gaps of the places marked ``which`` with a ``motion`` (size,) of the unknowns."""
    columns, _ = contact_terms(geometry, z, places._replace(shares=np.zeros_like(places.shares)), which)
    moved = columns.entry_value * motion[columns.entry_index]
    return np.asarray(-np.bincount(columns.entry_column, moved, len(columns.diagonal))[: len(columns.values)])


@compiled_inner
def squares_of(
    a: float, b: float, c: float
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:  # pragma: no cover
    """The form a x² + 2 b x y + c y² as the sum of two squares: coefficient and unit vector of either square."""
    mean, half = 0.5 * (a + c), 0.5 * (a - c)
    size, lean = np.hypot(half, b), 0.5 * np.arctan2(b, half)
    return (mean + size, np.cos(lean), np.sin(lean)), (mean - size, -np.sin(lean), np.cos(lean))


@compiled
def contact_columns(
    z: Array, curves: CurveArrays, places: Places, closed: Flags, gradient: Array
) -> Columns:  # pragma: no cover
    """Columns of the places marked ``closed``; adds the gradient of all −F λ by the unknowns to ``gradient``."""
    own, count = closed & (places.shares == 0), int(np.count_nonzero(closed))
    number, forces = np.cumsum(own) - 1, int(np.count_nonzero(own))
    values, diagonal = np.zeros(forces), np.zeros(forces + MOTIONS * count)
    most = (1 + MOTIONS) * LOCAL * count
    entries = np.empty(most, np.int64), np.empty(most, np.int64), np.empty(most)
    vectors, index = np.empty((5, LOCAL)), np.empty(LOCAL, np.int64)
    used, at = 0, forces
    for k in range(closed.size):
        if not closed[k]:
            continue
        row = gap_row(z, curves, places, k, vectors)
        local_indices(curves, places, k, index)
        column, F = int(number[k + places.shares[k]]), places.force[k]
        values[column] += row.value
        diagonal[column] -= row.by_force
        for i in range(LOCAL):
            gradient[index[i]] -= F * vectors[GRADIENT, i]
        used = _add_entries(entries, used, column, index, -vectors[COUPLING])
        (one, ax, ay), (other, bx, by) = squares_of(row.frame.qq, row.frame.qe, row.frame.ee)
        for s, q, e, shift in ((one, ax, ay, 0.0), (other, bx, by, 0.0), (row.shift, 0.0, 0.0, 1.0)):
            if F * s != 0.0:
                motion = q * vectors[TANGENT] + e * vectors[TURN] + shift * vectors[SHIFT]
                diagonal[at], used = 1.0 / (F * s), _add_entries(entries, used, at, index, motion)
                at += 1
    of_entries, unknown, value = entries
    negative = int(np.count_nonzero(diagonal[forces:at] < 0.0))
    return Columns(values, negative, diagonal[:at], np.zeros(at), of_entries[:used], unknown[:used], value[:used])


@compiled_inner
def _add_entries(
    entries: tuple[Ints, Ints, Array], used: int, column: int, index: Ints, vector: Array
) -> int:  # pragma: no cover
    """Append the entries of a column; the number of all entries."""
    for i in range(LOCAL):
        if vector[i] != 0.0:
            entries[0][used], entries[1][used], entries[2][used] = column, index[i], vector[i]
            used += 1
    return used
