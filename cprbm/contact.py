"""What a contact formulation hands to the equilibrium solver.

A gap depends on a few local numbers: positions of some joints and angles of
some links.  With these as z, a formulation states its constraints c(z) ≤ 0,
their first derivatives, and the second derivative of λ·c; how z depends on the
unknowns is the same for all and lives in :mod:`cprbm.kinematics`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cprbm.kinematics import Positions, State
from scene.answer import Array, Ints


@dataclass(frozen=True, slots=True)
class Rows:
    """Contact constraints at one state.

    Attributes:
        values: c (m,), units of length, feasible where ≤ 0.
        joints: joints whose x and y enter (p,); angles: links whose θ enters (a,).
        slopes: ∂c over z = (x of joints, y of joints, θ of angles), (m, 2p + a).
        curvature: λ ↦ ∂²(λ·c)/∂z², (2p + a, 2p + a).
        keys: what each row is, to recognise it again in the next iteration.
        arc: arc length on the contact's first beam where each row acts (m,).
        contact: name of each row's contact.
    """

    values: Array
    joints: Ints
    angles: Ints
    slopes: Array
    curvature: Callable[[Array], Array]
    keys: tuple[tuple[str, int], ...]
    arc: Array
    contact: tuple[str, ...]

    @property
    def size(self) -> int:
        """Number of constraints."""
        return len(self.values)


Formulation = Callable[[State, Positions], Rows]


def no_rows() -> Rows:
    """The constraints of a scene in which nothing touches."""
    none = np.zeros(0, dtype=np.intp)
    return Rows(np.zeros(0), none, none, np.zeros((0, 0)), lambda _: np.zeros((0, 0)), (), np.zeros(0), ())


def together(parts: list[Rows]) -> Rows:
    """The constraints of several contacts as one set, each with local numbers of its own."""
    parts = [part for part in parts if part.size]
    if len(parts) <= 1:
        return parts[0] if parts else no_rows()
    p = sum(len(part.joints) for part in parts)
    a = sum(len(part.angles) for part in parts)
    m = sum(part.size for part in parts)
    slopes = np.zeros((m, 2 * p + a))
    columns: list[Ints] = []
    row = first_p = first_a = 0
    for part in parts:
        np_, na = len(part.joints), len(part.angles)
        where = np.concatenate(
            (
                first_p + np.arange(np_),
                p + first_p + np.arange(np_),
                2 * p + first_a + np.arange(na),
            )
        )
        slopes[row : row + part.size, where] = part.slopes
        columns.append(where)
        row, first_p, first_a = row + part.size, first_p + np_, first_a + na

    def curvature(multipliers: Array) -> Array:
        total = np.zeros((2 * p + a, 2 * p + a))
        start = 0
        for part, where in zip(parts, columns, strict=True):
            total[np.ix_(where, where)] = part.curvature(multipliers[start : start + part.size])
            start += part.size
        return total

    return Rows(
        values=np.concatenate([part.values for part in parts]),
        joints=np.concatenate([part.joints for part in parts]),
        angles=np.concatenate([part.angles for part in parts]),
        slopes=slopes,
        curvature=curvature,
        keys=tuple(key for part in parts for key in part.keys),
        arc=np.concatenate([part.arc for part in parts]),
        contact=tuple(name for part in parts for name in part.contact),
    )
