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

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.element import Chords
from fea_reference.hermite import Index

LINE = 7
"""Unknowns of an element's line."""

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

    ``row`` is the tangent angle among a line's unknowns, ``line`` the number of the line. ``at`` are the rows of M of
    the element's six unknowns, ``own`` the elements counted in their beam.
    """

    row: int
    line: int
    at: tuple[int, ...]
    own: Index
    elements: Index
    share: Array


@dataclass(frozen=True)
class Chain:
    """Chain rule from the unknowns of element lines, and of a body, to all unknowns, at k places.

    Attributes:
        dofs: unknowns (M, k); the first ``count`` belong to the lines' own elements and the body, with θ in place of
            ψ, the others to nodes beside the elements.
        count: number m of the former.
        leans: contributions to the tangent angles ψ among the m.
        lines: elements (k,) of every line, counted in their beam.
        chords: chords of all elements.
    """

    dofs: Index
    count: int
    leans: tuple[Lean, ...]
    lines: tuple[Index, ...]
    chords: Chords

    @cached_property
    def _by(self) -> Array:
        """Derivatives (k, m, M) of the lines' unknowns by all unknowns."""
        rows, places = self.dofs.shape
        by = np.zeros((places, self.count, rows))
        by[:, range(self.count), range(self.count)] = 1.0
        for lean in self.leans:
            by[:, lean.row, lean.at] += (lean.share * self.chords.shear_by[:, lean.elements]).T
        return by

    def gradient(self, local: Array) -> Array:
        """Derivatives (M, k) by all unknowns from derivatives ``local`` (m, k) by the lines' unknowns."""
        return np.asarray(np.einsum("mk,kma->ak", local, self._by)) if self.leans else local

    def hessian(self, local: Array, gradient: Array) -> Array:
        """Second derivatives (M, M, k) by all unknowns, by the chain rule.

        ``local`` (m, m, k) and ``gradient`` (m, k) are second and first derivatives by the lines' unknowns.
        """
        if not self.leans:
            return local
        total = self._by.transpose(0, 2, 1) @ (np.ascontiguousarray(local.transpose(2, 0, 1)) @ self._by)
        for lean in self.leans:
            twice = gradient[lean.row] * lean.share * self.chords.shear_by_twice[:, :, lean.elements]
            total[:, np.array(lean.at)[:, None], lean.at] += twice.T
        return total.transpose(1, 2, 0)

    def local(self, step: Array) -> Array:
        """Step (m, k) of the lines' unknowns, with tangent angles for rotations, from a ``step`` (size,) of all."""
        steps = step[self.dofs]
        return np.asarray(np.einsum("kma,ak->mk", self._by, steps)) if self.leans else steps

    def on_first_nodes(self, local: Array) -> Iterator[tuple[int, Index, Array]]:
        """Line, elements (k,) and derivatives (3, k) by the elements' first nodes, of every contribution.

        ``local`` (m, k) are derivatives by the lines' unknowns. A lean contributes at the node of its own element.
        """
        for i, own in enumerate(self.lines):
            yield i, own, local[LINE * i : LINE * i + 3]
        for lean in self.leans:
            yield lean.line, lean.own, local[lean.row] * lean.share * self.chords.shear_by[:3, lean.elements]


@lru_cache(maxsize=64)
def places(
    spans: tuple[Span, ...], elements: tuple[bytes, ...], body: tuple[int, ...]
) -> tuple[Index, int, tuple[Lean, ...], tuple[Index, ...]]:
    """Unknowns, their own number, leans and elements of a chain of k places on one or two lines and of a ``body``.

    The ``body`` has 0 or 3 unknowns. ``elements`` are the bytes of the elements (k,) of the places, counted in every
    line's beam.
    """
    numbers = tuple(np.frombuffer(of_line, dtype=np.int64) for of_line in elements)
    dofs = [span.dofs[:, e] for span, e in zip(spans, numbers, strict=True)]
    dofs.append(np.repeat(np.array(body, dtype=np.int64)[:, None], numbers[0].size, axis=1))
    leans: list[Lean] = []
    count = row = LINE * len(spans) + len(body)
    for i, (span, e) in enumerate(zip(spans, numbers, strict=True)):
        if not span.slips:
            continue
        nodes = [tuple(range(begin, begin + 3)) for begin in (LINE * i, LINE * i + 3, row, row + 3)]
        for tangent, neighbour in enumerate((np.maximum(e - 1, 0), np.minimum(e + 1, span.dofs.shape[1] - 1))):
            at_end, angle = neighbour == e, LINE * i + TANGENTS[tangent]
            own = np.where(at_end, 0.0 if span.welded[tangent] else 1.0, 0.5)
            beside = (nodes[1] + nodes[3] if tangent else nodes[2] + nodes[0], neighbour, np.where(at_end, 0.0, 0.5))
            for at, element, share in ((nodes[0] + nodes[1], e, own), beside):
                leans.append(Lean(angle, i, at, element, span.part.start + element, share))
            dofs.append(span.dofs[3 * tangent : 3 * tangent + 3, neighbour])
        row += 6
    return np.concatenate(dofs), count, tuple(leans), numbers
