"""Tangents of the neutral line with shear, and their derivatives.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
θ       rotation of the section at a node
γ       shear angle, one per element: γ = −c·Δ, see :mod:`fea_reference.element`
ψ       tangent angle of the neutral line at a node, θ + γ̄
γ̄       mean γ of the elements at a node; at a free or pinned end γ of the end element, at a welded end zero
u       unknowns of an element's line: (x₁, y₁, ψ₁, x₂, y₂, ψ₂, N)
======  =====================================================================================

A line tangent to the sections' normals would oscillate about the chords by 0.1 γ L in every element. Its slope would
deviate by γ at the nodes and by γ/2, of opposite sign, between them. A place of contact would then be wrong by γ over
the curvature, alternately along every element, on any mesh. A single tangent per node, between the tangents of both
elements, keeps the line smooth. The elements' tangents differ by the change of shear force.

At a welded end the section's rotation is prescribed, and so is the line's tangent. The moment of a pressure beside
the clamp then acts on the clamp. If the tangent followed the end element's shear, the moment would become a force
between clamp and contact. The error would be of first order in the element. The same holds for an end pinned to its
contact surface.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.element import Elements, shear, shear_angle
from fea_reference.hermite import Index
from fea_reference.state import State

_LINE = 7  # unknowns of an element's line
_TANGENTS = (2, 5)  # positions of the tangent angles among these


@dataclass(frozen=True, slots=True)
class Span:
    """A beam: the slice ``part`` of all elements, their unknowns ``dofs`` (7, n), and True for ``welded`` ends (2)."""

    part: slice
    dofs: Index
    welded: tuple[bool, bool]


def tangent_angles(elements: Elements, span: Span, z: State) -> Array:
    """ψ (n+1,) of a beam."""
    dofs = span.dofs
    theta = np.append(z[dofs[2]], z[dofs[5, -1:]])
    if not elements.slip[:, span.part].any():
        return theta
    gamma = shear_angle(elements, span.part, dofs, z)
    start, end = (0.0 if welded else 1.0 for welded in span.welded)
    beside = np.append(start * gamma[:1], gamma) + np.append(gamma, end * gamma[-1:])
    beside[[0, -1]] *= start, end
    return np.asarray(theta + 0.5 * beside)


@dataclass(frozen=True, slots=True)
class Chain:
    """Chain rule from the unknowns of element lines, and of a body, to all unknowns, at k places.

    Attributes:
        dofs: unknowns (M, k); the first m belong to the lines' own elements and the body, with θ in place of ψ.
        rows: which of the m are tangent angles ψ.
        by: derivatives (rows, M, k) of γ̄ for every such row; twice: second derivatives (rows, M, M, k).
        shares: line, first of the six rows of M for an element's nodes, and the element (k,) at every place.
    """

    dofs: Index
    rows: tuple[int, ...]
    by: Array
    twice: Array
    shares: tuple[tuple[int, int, Index], ...]

    def gradient(self, local: Array) -> Array:
        """Derivatives (M, k) by all unknowns from derivatives ``local`` (m, k) by the lines' unknowns."""
        total = np.zeros(self.dofs.shape)
        total[: len(local)] = local
        for row, by in zip(self.rows, self.by, strict=True):
            total += local[row] * by
        return total

    def hessian(self, local: Array, gradient: Array) -> Array:
        """Second derivatives (M, M, k) by all unknowns, by the chain rule.

        ``local`` (m, m, k) and ``gradient`` (m, k) are second and first derivatives by the lines' unknowns.
        """
        m, size = len(gradient), self.dofs.shape
        half = np.zeros((m, *size))
        half[:, :m] = local
        for row, by in zip(self.rows, self.by, strict=True):
            half += local[:, row, None] * by
        total = np.zeros((size[0], *size))
        total[:m] = half
        for row, by, twice in zip(self.rows, self.by, self.twice, strict=True):
            total += by[:, None] * half[row] + gradient[row] * twice
        return total

    def local(self, step: Array, m: int) -> Array:
        """Step (m, k) of the lines' unknowns, with tangent angles for rotations, from a ``step`` (size,) of all."""
        steps = step[self.dofs]
        own = steps[:m].copy()
        for row, by in zip(self.rows, self.by, strict=True):
            own[row] += (by * steps).sum(axis=0)
        return own


def chain(elements: Elements, lines: tuple[tuple[Span, Index], ...], body: Index, z: State) -> Chain:
    """Chain rule of k places on one or two lines and a body's unknowns ``body`` (0 or 3, k), in this order.

    Args:
        elements: of all beams.
        lines: beam, and element (k,) of every place counted in the beam, per line.
        body: may be empty.
        z: the state.
    """
    own = np.concatenate([*(span.dofs[:, e] for span, e in lines), body])
    shares = [(i, _LINE * i, e) for i, (_, e) in enumerate(lines)]
    leaning = [(i, line) for i, line in enumerate(lines) if elements.slip[:, line[0].part].any()]
    if not leaning:
        return _plain_chain(own, tuple(shares))
    size, k = len(own) + 12 * len(leaning), own.shape[1]
    rows, beside = [], [own]
    by, twice = np.zeros((2 * len(leaning), size, k)), np.zeros((2 * len(leaning), size, size, k))
    for number, (i, (span, e)) in enumerate(leaning):
        last = span.dofs.shape[1] - 1
        near = np.clip(np.stack([e - 1, e, e + 1]), 0, last)
        slip = shear(elements, span.part.start + near.ravel(), span.dofs[:, near.ravel()], z)
        slip_by, slip_twice = slip.by.reshape(6, 3, k), slip.by_twice.reshape(6, 6, 3, k)
        for tangent in (0, 1):
            number_of_tangent = 2 * number + tangent
            rows.append(_LINE * i + _TANGENTS[tangent])
            neighbour = near[2 * tangent]
            share = np.where(neighbour == e, 0.0, 0.5)
            own_share = np.where(neighbour == e, 0.0 if span.welded[tangent] else 1.0, 0.5)
            row = len(own) + 12 * number + 6 * tangent
            beside.append(span.dofs[:6, neighbour])
            shares.append((i, row, neighbour))
            for begin, where, weight in ((_LINE * i, 1, own_share), (row, 2 * tangent, share)):
                here = slice(begin, begin + 6)
                by[number_of_tangent, here] = weight * slip_by[:, where]
                twice[number_of_tangent, here, here] = weight * slip_twice[:, :, where]
    return Chain(np.concatenate(beside), tuple(rows), by, twice, tuple(shares))


def own_chain(span: Span, e: Index) -> Chain:
    """Chain rule of elements (k,) of a beam with the sections' rotations as tangents."""
    return _plain_chain(span.dofs[:, e], ((0, 0, e),))


def sheared_chain(elements: Elements, span: Span, e: Index, z: State) -> Chain:
    """Chain rule of separate elements (k,) of a beam, tangent at both ends by their own shear angle."""
    own = span.dofs[:, e]
    if not elements.slip[:, span.part].any():
        return _plain_chain(own, ((0, 0, e),))
    slip = shear(elements, span.part.start + e, own, z)
    by, twice = np.zeros(own.shape), np.zeros((_LINE, *own.shape))
    by[:6], twice[:6, :6] = slip.by, slip.by_twice
    return Chain(own, _TANGENTS, np.stack([by, by]), np.stack([twice, twice]), ((0, 0, e),))


def _plain_chain(own: Index, shares: tuple[tuple[int, int, Index], ...]) -> Chain:
    return Chain(own, (), np.empty((0, *own.shape)), np.empty((0, len(own), *own.shape)), shares)
