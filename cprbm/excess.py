"""By what a beam of varying curvature lies off the arcs of its elements, at rest.

==========  ===========================================================================================
s, off      arc length, and the way from the border of the half of an element, negative before it
d, u        way from the border to the spring at the half's other end, and off/d
κ, ψ        stress-free curvature, and its tangent's angle against that at the border
Θ⁰/h        turning of the element, evenly
E           stress-free line less the arc, a + i·w from the border along its tangent
==========  ===========================================================================================

Both begin at the border with one tangent, so E = E′ = 0 there, and

    E″ = i κ e^{iψ} − i (Θ⁰/h) e^{iΘ⁰off/h}.

A link carries E along as it moves: it is the same in every state.  Within half an element it is smooth, and a
polynomial of u through Chebyshev's points is E″ up to round-off, which its integrals are E′ and E by.  Where it is not,
as where two cubics of a spline meet, the stress-free line itself is asked each time.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cprbm.pieces import CurvePieces
from cprbm.polynomial import ComplexArray
from cprbm_scene.answer import Array, Ints

POINTS = (6, 8, 11, 15)  # of the polynomial; the first that is enough
ENOUGH = 1e-15  # of E″ times d: by so much the tangent is off


@dataclass(frozen=True, slots=True)
class Halves:
    """The halves of the elements of a beam: what is theirs, (2N,) each, and the ``pieces`` that the links carry.

    Attributes:
        pieces: of the neutral line.
        unit_length: ℓ, m.
        border, end: arc lengths where each half begins, at the border, and ends, at the spring.
        link, begin: on which it lies, and where that begins.
        at, lean: border and tangent there as numbers in the link's frame.
        rate: Θ⁰/h.
    """

    pieces: CurvePieces
    unit_length: float
    border: Array
    end: Array
    link: Ints
    begin: Array
    at: ComplexArray
    lean: ComplexArray
    rate: Array

    def exactly(self, half: Ints, off: Array) -> ComplexArray:
        """E″, E′ and E at some places (k,): (3, k)."""
        link, against, turned = self.link[half], self.lean[half].conj(), self.rate[half] * off
        s = self.border[half] + off
        piece = self.pieces.seen(link, s, s - self.begin[half], self.unit_length)
        tangent = np.exp(1j * turned)
        chord = off * np.sinc(turned / (2.0 * np.pi)) * np.exp(0.5j * turned)
        return np.array(
            (
                piece.second * against - 1j * self.rate[half] * tangent,
                piece.first * against - tangent,
                (piece.at - self.at[half]) * against - chord,
            )
        )


class Excess(Protocol):
    """E of a beam."""

    def seen(self, half: Ints, off: Array) -> ComplexArray:
        """E″, E′ and E at places ``off`` (k,) in halves of elements (k,): (3, k)."""


@dataclass(frozen=True, slots=True)
class Asked:
    """E as the stress-free line says each time."""

    halves: Halves

    def seen(self, half: Ints, off: Array) -> ComplexArray:
        """E″, E′ and E at places ``off`` (k,) in halves of elements (k,): (3, k)."""
        return self.halves.exactly(half, off)


@dataclass(frozen=True, slots=True)
class Tabulated:
    """E by polynomials of off.

    Attributes:
        coefficients: lowest power first, of real and imaginary parts of E″, E′/off and E/off², of all halves
            (2N, points, 6).
    """

    coefficients: Array

    def seen(self, half: Ints, off: Array) -> ComplexArray:
        """E″, E′ and E at places ``off`` (k,) in halves of elements (k,): (3, k)."""
        mine = self.coefficients.take(half, axis=0)
        powers = np.empty((half.size, 1, mine.shape[1]))
        powers[:, 0, 0], powers[:, 0, 1:] = 1.0, off[:, None]
        found: ComplexArray = (np.multiply.accumulate(powers, axis=2, out=powers) @ mine)[:, 0].view(complex).T
        found[1] *= off
        found[2] *= off * off
        return found


def excess(halves: Halves) -> Excess:
    """E, by polynomials where these are E."""
    for points in POINTS:
        found = _through(halves, points)
        # at the ends and in the middle, between two points of the polynomial, where it is farthest off
        u = 0.5 - 0.5 * np.cos(np.pi * np.array((0, points // 2, points)) / points)
        half, off = _places(halves, u)
        missed = (found.seen(half, off) - halves.exactly(half, off))[0]
        if float((np.abs(missed) * np.abs(halves.end - halves.border)[half]).max()) <= ENOUGH:
            return found
    return Asked(halves)


def _places(halves: Halves, u: Array) -> tuple[Ints, Array]:
    """All places ``u`` (p,) of all halves, half behind half: number of the half, and off (2N·p,)."""
    size = halves.end - halves.border
    return np.repeat(np.arange(len(size)), len(u)), (size[:, None] * u).ravel()


def _through(halves: Halves, points: int) -> Tabulated:
    u = 0.5 - 0.5 * np.cos(np.pi * (np.arange(points) + 0.5) / points)
    half, off = _places(halves, u)
    second = halves.exactly(half, off)[0].reshape(-1, points)
    powers = np.arange(points)
    coefficients = np.linalg.solve(u[:, None] ** powers, second.T).T / (halves.end - halves.border)[:, None] ** powers
    once = 1.0 / (powers + 1.0)
    each = np.array((np.ones(points), once, once / (powers + 2.0))).T
    # real and imaginary parts beside each other: powers are real
    return Tabulated(np.ascontiguousarray(coefficients[:, :, None] * each).view(float))
