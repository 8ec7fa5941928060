"""Contact rows in the linear system of an equilibrium.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
H          Hessian of the Lagrangian without contacts, with its factors
F, λ       force of a closed place; a place adds −F λ to the Lagrangian, :mod:`cprbm.contact.gap`
a          column of the force, minus the derivative of the row's value by the unknowns
V, S       local motions q, e, λ_ξu of a place, and their coefficients: −F V S Vᵀ is the Hessian of −F λ
U, C       all columns a and V, and the block of the border beside them
W          Schur complement C − Uᵀ H⁻¹ U
=========  =====================================================================================

With a variable y for every local motion the second derivatives of a place leave the chains' pattern alone:

    [ H + V R Vᵀ  a ]      [ H    V      a  ]
    [    aᵀ       c ]  =>  [ Vᵀ  −R⁻¹    0  ],    R = −F S,
                           [ aᵀ   0      c  ]

c being minus the derivative of the value by F.  By Sylvester's law the left matrix has as many
negative eigenvalues as the right matrix, less the negative eigenvalues of −R⁻¹ = S⁻¹/F.  Two places with a shared force
have a common column, the sum of both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import ldl

from cprbm.contact import (
    COUPLING,
    GRADIENT,
    LOCAL,
    SHIFT,
    STENCIL,
    TANGENT,
    TURN,
    Geometry,
    Places,
    Row,
    gap_row,
    local_indices,
)
from cprbm.equilibrium.factors import Factors
from cprbm_scene.answer import Array, Flags

Columns = list[tuple[Array, Array]]


@dataclass(frozen=True, eq=False)
class ContactTerms:
    """Terms of the closed places at a state.

    Attributes:
        gradient: of −F λ of all closed places by the unknowns (size,).
        values: of the rows with a force of their own (forces,).
        columns: U (size, forces + motions), the forces' columns first.
        block: C.
        negative: number of negative eigenvalues of the motions' part of C.
    """

    gradient: Array
    values: Array
    columns: Array
    block: Array
    negative: int


def contact_terms(geometry: Geometry, z: Array, places: Places, closed: Flags) -> ContactTerms:
    """Terms of the places marked ``closed``, at least one; sharing places have equal forces."""
    leaders = np.arange(len(closed)) + places.shares
    own = np.flatnonzero(closed & (places.shares == 0))
    number = {int(k): at for at, k in enumerate(own)}
    gradient, values, by_force = np.zeros(len(z)), np.zeros(len(own)), np.zeros(len(own))
    forces, motions, inverses = np.zeros((len(own), len(z))), [], []
    vectors, weights, index = np.empty((5, LOCAL)), np.empty((4, 2, STENCIL)), np.empty(LOCAL, dtype=np.int64)
    for k in np.flatnonzero(closed).tolist():
        row = gap_row(z, geometry.arrays, places, k, vectors, weights)
        local_indices(geometry.arrays, places, k, index)
        spread = np.zeros((5, len(z)))
        for vector, whole in zip(vectors, spread, strict=True):
            np.add.at(whole, index, vector)
        at = number[int(leaders[k])]
        values[at] += row.value
        by_force[at] += row.by_force
        forces[at] -= spread[COUPLING]
        gradient -= places.force[k] * spread[GRADIENT]
        for motion, inverse in _motions(row, spread, places.force[k]):
            motions.append(motion)
            inverses.append(inverse)
    columns = np.vstack([forces, *motions])
    block = np.zeros((len(columns), len(columns)))
    block[: len(own), : len(own)] = -np.diag(by_force)
    begin, negative = len(own), 0
    for inverse in inverses:
        end = begin + len(inverse)
        block[begin:end, begin:end] = inverse
        negative += int(np.sum(np.linalg.eigvalsh(inverse) < 0.0))
        begin = end
    return ContactTerms(gradient, values, columns.T, block, negative)


def _motions(row: Row, spread: Array, force: float) -> Columns:
    """Local motions (k, size) of a place and S⁻¹/F; none without a force."""
    if force == 0.0:
        return []
    found: Columns = []
    if row.ee == row.qe == 0.0:
        if row.qq != 0.0:
            found.append((spread[[TANGENT]], np.array([[1.0 / (force * row.qq)]])))
    else:
        S = np.array([[row.qq, row.qe], [row.qe, row.ee]])
        found.append((spread[[TANGENT, TURN]], np.linalg.inv(S) / force))
    if row.shift != 0.0:
        found.append((spread[[SHIFT]], np.array([[1.0 / (force * row.shift)]])))
    return found


@dataclass(frozen=True, eq=False)
class Touching:
    """Factors of the Hessian with contacts.

    Attributes:
        free: factors without contacts.
        terms: of the closed places.
        solved: H⁻¹ U.
        lost: number of independent directions in which the energy falls while the closed places stay closed.
    """

    free: Factors
    terms: ContactTerms
    solved: Array
    lost: int

    @property
    def schur(self) -> Array:
        """W."""
        return np.asarray(self.terms.block - self.terms.columns.T @ self.solved)

    def solve(self, load: Array, values: Array) -> tuple[Array, Array]:
        """Change of the unknowns and of the forces for a load (size,) and values of the rows (forces,)."""
        first = self.free.solve(load)
        right = np.zeros(len(self.terms.block))
        right[: len(values)] = values
        border = np.asarray(np.linalg.solve(self.schur, right - self.terms.columns.T @ first), dtype=np.float64)
        return first - self.solved @ border, border[: len(values)]


def touching(free: Factors, terms: ContactTerms) -> Touching:
    """Factors with contacts from factors without."""
    solved = np.column_stack([free.solve(column) for column in terms.columns.T])
    _, blocks, _ = ldl(terms.block - terms.columns.T @ solved)
    negative = int(np.sum(np.linalg.eigvalsh(blocks) < 0.0))
    lost = free.lost + negative - terms.negative - len(terms.values)
    return Touching(free, terms, solved, lost)
