"""Contact rows as weighted sums over places on two beams, over few local numbers.

==========  ==================================================================================
z           local numbers of a place: x, y of the first joint of its link l, θ_{l−1}, θ_l, θ_{l+1}; of A, then of B
J           of each row and beam, the first link with a place: its joint's x and y are local numbers of the row
ζ           local numbers of a row: x, y of joint J and θ_{J−1}, θ_J, ... of A and of B
c, w        constraint at a place, its weight in the row
==========  ==================================================================================

A row is Σ w c(z(ζ)), where z is linear in ζ but for the positions of further joints, eq. (6):

    p_l = p_J + Σ_{J≤k<l} L_k (cos θ_k, sin θ_k)

    ∂c/∂ζ = Mᵀ ∂c/∂z,    ∂²c/∂ζ² = Mᵀ ∂²c/∂z² M − Σ_{J≤k<l} ∂c/∂p_l · L_k (cos θ_k, sin θ_k)   on θ_k,    M = ∂z/∂ζ
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cprbm.first_contact import Blocks, Group
from cprbm.kinematics import Positions
from cprbm.model import Chain
from cprbm.moving import LOCALS
from cprbm_scene.answer import Array, Flags, Ints


@dataclass(frozen=True)
class Touches:
    """The constraint c at k places, each over local numbers of its own.

    Attributes:
        values: c (k,), units of length.
        slopes: ∂c/∂z (k, 10).
        bent: yields ∂²c/∂z² (j, 10, 10) of places with some numbers (j,), which only what presses needs.
        links: of A and of B in their own numbering, (2, k).
    """

    values: Array
    slopes: Array
    bent: Callable[[Ints], Array]
    links: Ints

    def only(self, these: Flags | Ints | slice) -> Touches:
        """Some of the places."""
        numbers = np.arange(self.values.size)[these]
        values, slopes, links = self.values[these], self.slopes[these], self.links[:, these]
        return Touches(values, slopes, lambda some: self.bent(numbers[some]), links)

    def exchanged(self) -> Touches:
        """The same with the parts of A and B exchanged."""
        turned = (np.arange(2 * LOCALS) + LOCALS) % (2 * LOCALS)
        return Touches(
            values=self.values,
            slopes=self.slopes[:, turned],
            bent=lambda some: self.bent(some)[:, turned[:, None], turned],
            links=self.links[::-1],
        )


# local numbers of a place to those of a row that has no other
ALONE = np.array((0, 5, 1, 6, 2, 3, 4, 7, 8, 9))
POSITIONS = np.array((0, 1, LOCALS, LOCALS + 1))  # x and y of both beams' joints among them
BESIDE = np.arange(3)


def single(name: str, chains: tuple[Chain, Chain], touches: Touches, keys: Ints, arc: Array) -> Group:
    """Rows (m,) of one contact, each of one place; arguments as of :func:`gathered`."""
    joints, angles = np.empty((arc.size, 2), dtype=np.intp), np.empty((arc.size, 6), dtype=np.intp)
    for beam, (chain, on) in enumerate(zip(chains, touches.links, strict=True)):
        joints[:, beam] = chain.first_joint + on
        # beyond a beam's ends the end itself: what is there has no share
        around = np.minimum(np.maximum(on[:, None] + (BESIDE - 1), 0), chain.n)
        angles[:, 3 * beam : 3 * beam + 3] = chain.first_link + around

    def curvature(multipliers: Array) -> Blocks:
        pressing = multipliers.nonzero()[0]
        matrices = touches.bent(pressing)[:, ALONE[:, None], ALONE]
        return Blocks(joints[pressing], angles[pressing], multipliers[pressing, None, None] * matrices)

    return Group(
        contact=name,
        values=touches.values,
        joints=joints,
        angles=angles,
        slopes=touches.slopes[:, ALONE],
        curvature=curvature,
        keys=tuple(keys.tolist()),
        arc=arc,
    )


def gathered(
    name: str,
    chains: tuple[Chain, Chain],
    at: Positions,
    touches: Touches,
    weights: Array,
    keys: Ints,
    arc: Array,
) -> Group:
    """Rows of one contact.

    Args:
        name: of the contact.
        chains: A and B.
        at: the joints.
        touches: at m·q places, row behind row.
        weights: w (m, q).
        keys, arc: of the rows (m,).
    """
    m, q = weights.shape
    links = touches.links.reshape(2, m, q)
    first = np.minimum.reduce(links, axis=2)
    # how many links a place lies behind its row's first
    behind = (links - first[:, :, None]).reshape(2, m * q)
    widths = (np.maximum.reduce(behind, axis=1) + 3).tolist()
    # where a place's local numbers stand among its row's, and those of the links in between
    place, size = np.arange(m * q), 4 + sum(widths)
    row = place // q
    columns, over = np.empty((m * q, 2 * LOCALS), dtype=np.intp), np.empty((m, size - 4), dtype=np.intp)
    columns[:, POSITIONS] = 0, 2, 1, 3
    passed: list[tuple[Ints, int, int, Array, Array]] = []
    column = 4
    for beam, (chain, width) in enumerate(zip(chains, widths, strict=True)):
        x, on = LOCALS * beam, first[beam]
        columns[:, x + 2 : x + LOCALS] = (column + behind[beam])[:, None] + BESIDE
        # beyond a beam's ends the end itself: what is there has no share
        angles = on[:, None] + np.arange(-1, width - 1)
        over[:, column - 4 : column - 4 + width] = chain.first_link + np.minimum(np.maximum(angles, 0), chain.n)
        for k in range(width - 3):
            past = (behind[beam] > k).nonzero()[0]
            crossed = chain.first_link + k + on[row[past]]
            passed.append((past, column + 1 + k, x, -at.dy[crossed], at.dx[crossed]))
        column += width
    share = weights.ravel()
    own = share[:, None] * touches.slopes
    places, parts = [(row[:, None] * size + columns).ravel()], [own.ravel()]
    for past, further, x, along, across in passed:
        places.append(row[past] * size + further)
        parts.append(own[past, x] * along + own[past, x + 1] * across)
    summed = np.bincount(np.concatenate(places), np.concatenate(parts), m * size)
    slopes: Array = np.asarray(summed, dtype=float).reshape(m, size)
    joints = (first + np.array([[chain.first_joint] for chain in chains])).T

    def to_row() -> tuple[Array, Array]:
        """M (m·q, 10, size), and what −∂c/∂p_l · L_k (cos θ_k, sin θ_k) adds to its square (m·q, size)."""
        M, turned = np.zeros((m * q, 2 * LOCALS, size)), np.zeros((m * q, size))
        M[place[:, None], np.arange(2 * LOCALS), columns] = 1.0
        for past, further, x, along, across in passed:
            M[past, x, further], M[past, x + 1, further] = along, across
            turned[past, further] = touches.slopes[past, x + 1] * along - touches.slopes[past, x] * across
        return M, turned

    def curvature(multipliers: Array) -> Blocks:
        pressing = multipliers.nonzero()[0]
        mine = (pressing[:, None] * q + np.arange(q)).ravel()
        M, turned = (each[mine] for each in to_row())
        matrices = M.transpose(0, 2, 1) @ touches.bent(mine) @ M
        diagonal = np.arange(size)
        matrices[:, diagonal, diagonal] += turned
        matrices *= (np.repeat(multipliers[pressing], q) * share[mine])[:, None, None]
        return Blocks(joints[pressing], over[pressing], matrices.reshape(pressing.size, q, size, size).sum(axis=1))

    return Group(
        contact=name,
        values=np.add.reduce(weights * touches.values.reshape(m, q), axis=1),
        joints=joints,
        angles=over,
        slopes=slopes,
        curvature=curvature,
        keys=tuple(keys.tolist()),
        arc=arc,
    )
