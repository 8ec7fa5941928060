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
from functools import cached_property, lru_cache

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.element import Chords
from fea_reference.hermite import Index

_LINE = 7  # unknowns of an element's line
TANGENTS = (2, 5)
"""Positions of the tangent angles among these."""


@dataclass(frozen=True, slots=True, eq=False)
class Span:
    """A beam: the slice ``part`` of all elements, their unknowns ``dofs`` (7, n), and True for ``welded`` ends (2).

    ``slips`` is True for a beam with shear.
    """

    part: slice
    dofs: Index
    welded: tuple[bool, bool]
    slips: bool


def tangent_angles(span: Span, theta: Array, shear: Array) -> Array:
    """ψ (n+1,) of a beam with rotations ``theta`` (n+1,) and shear angles ``shear`` (n,)."""
    if not span.slips:
        return theta
    start, end = (0.0 if welded else 1.0 for welded in span.welded)
    beside = np.empty(theta.size)
    beside[1:-1] = 0.5 * (shear[:-1] + shear[1:])
    beside[0], beside[-1] = start * shear[0], end * shear[-1]
    return np.asarray(theta + beside)


@dataclass(frozen=True, slots=True)
class Lean:
    """Share (k,) of the shear angle of ``elements`` (k,), counted among all, in a tangent angle.

    ``row`` is the tangent angle among a line's unknowns, ``begin`` the first of the element's six rows of M.
    """

    row: int
    begin: int
    elements: Index
    share: Array


@dataclass(frozen=True)
class Chain:
    """Chain rule from the unknowns of element lines, and of a body, to all unknowns, at k places.

    Attributes:
        dofs: unknowns (M, k); the first m belong to the lines' own elements and the body, with θ in place of ψ.
        leans: contributions to the tangent angles ψ among the m.
        shares: line, first of the six rows of M for an element's nodes, and the element (k,) at every place.
        chords: chords of all elements.
    """

    dofs: Index
    leans: tuple[Lean, ...]
    shares: tuple[tuple[int, int, Index], ...]
    chords: Chords

    @cached_property
    def _leans(self) -> list[tuple[int, slice, Array, Lean]]:
        """Tangent angle, rows of M and derivatives (6, k) of every contribution."""
        by = self.chords.shear_by
        return [
            (lean.row, slice(lean.begin, lean.begin + 6), lean.share * by[:, lean.elements], lean)
            for lean in self.leans
        ]

    def gradient(self, local: Array) -> Array:
        """Derivatives (M, k) by all unknowns from derivatives ``local`` (m, k) by the lines' unknowns."""
        total = np.zeros(self.dofs.shape)
        total[: len(local)] = local
        for row, here, by, _ in self._leans:
            total[here] += local[row] * by
        return total

    def hessian(self, local: Array, gradient: Array) -> Array:
        """Second derivatives (M, M, k) by all unknowns, by the chain rule.

        ``local`` (m, m, k) and ``gradient`` (m, k) are second and first derivatives by the lines' unknowns.
        """
        m, size = len(gradient), self.dofs.shape
        half = np.zeros((m, *size))
        half[:, :m] = local
        for row, here, by, _ in self._leans:
            half[:, here] += local[:, row, None] * by
        total = np.zeros((size[0], *size))
        total[:m] = half
        for row, here, by, lean in self._leans:
            total[here] += by[:, None] * half[row]
            total[here, here] += gradient[row] * lean.share * self.chords.shear_by_twice[:, :, lean.elements]
        return total

    def local(self, step: Array, m: int) -> Array:
        """Step (m, k) of the lines' unknowns, with tangent angles for rotations, from a ``step`` (size,) of all."""
        steps = step[self.dofs]
        own = steps[:m].copy()
        for row, here, by, _ in self._leans:
            own[row] += (by * steps[here]).sum(axis=0)
        return own


@lru_cache(maxsize=64)
def places(
    spans: tuple[Span, ...], elements: tuple[bytes, ...], body: tuple[int, ...]
) -> tuple[Index, tuple[Lean, ...], tuple[tuple[int, int, Index], ...]]:
    """Unknowns, leans and shares of a chain of k places on one or two lines and of a ``body`` (0 or 3), in this order.

    ``elements`` are the bytes of the elements (k,) of the places, counted in every line's beam.
    """
    numbers = [np.frombuffer(of_line, dtype=np.int64) for of_line in elements]
    dofs = [span.dofs[:, e] for span, e in zip(spans, numbers, strict=True)]
    dofs.append(np.repeat(np.array(body, dtype=np.int64)[:, None], numbers[0].size, axis=1))
    shares = [(i, _LINE * i, e) for i, e in enumerate(numbers)]
    leans: list[Lean] = []
    row = _LINE * len(spans) + len(body)
    for i, (span, e) in enumerate(zip(spans, numbers, strict=True)):
        if not span.slips:
            continue
        for tangent, neighbour in enumerate((np.maximum(e - 1, 0), np.minimum(e + 1, span.dofs.shape[1] - 1))):
            at_end = neighbour == e
            own = np.where(at_end, 0.0 if span.welded[tangent] else 1.0, 0.5)
            line, angle = _LINE * i, _LINE * i + TANGENTS[tangent]
            beside = Lean(angle, row, span.part.start + neighbour, np.where(at_end, 0.0, 0.5))
            leans += [Lean(angle, line, span.part.start + e, own), beside]
            dofs.append(span.dofs[:6, neighbour])
            shares.append((i, row, neighbour))
            row += 6
    return np.concatenate(dofs), tuple(leans), tuple(shares)
