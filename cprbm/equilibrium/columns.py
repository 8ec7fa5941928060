"""Border columns of closed places, compiled.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
H          Hessian of the Lagrangian without contacts
F, λ       force of a closed place; a place adds −F λ to the Lagrangian, :mod:`cprbm.contact.gap`
a          column of the force, minus the derivative of the row's value by the unknowns
c          minus the derivative of the value by F
V, S       local motions q, e, λ_ξu of a place, and their coefficients: −F V S Vᵀ is the Hessian of −F λ
=========  =====================================================================================

With a variable y for every local motion the second derivatives of a place leave the chains' pattern alone:

    [ H + V R Vᵀ  a ]      [ H    V      a  ]
    [    aᵀ       c ]  =>  [ Vᵀ  −R⁻¹    0  ],    R = −F S.
                           [ aᵀ   0      c  ]

By Sylvester's law the left matrix has as many negative eigenvalues as the right matrix, less the negative eigenvalues
of −R⁻¹ = S⁻¹/F.  Two places with a shared force have a common column, the sum of both.

A column has entries at the nodes of two pieces, at most six nodes each: it reaches one chain or two.
"""

import numpy as np

from cprbm.chain import compiled
from cprbm.contact import (
    COUPLING,
    GRADIENT,
    LOCAL,
    SHIFT,
    STENCIL,
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
    return Columns(
        values, negative, diagonal[:at], beside[:at], entries[0][:used], entries[1][:used], entries[2][:used]
    )


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
