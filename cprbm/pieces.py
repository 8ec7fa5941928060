"""The pieces of a curved stress-free neutral line that the links carry.

==========  ==============================================================================
s, t        arc length from the beam's start and from the start of link i
e_i, n_i    direction of link i and its left normal
a⁰, w⁰      coordinates of a point of the piece along e_i and n_i from joint i; together the number a⁰ + i·w⁰
==========  ==============================================================================

They are at rest: a link carries its piece along as it moves.  Arc lengths and coordinates are over the unit of
length ℓ, what is kept of the neutral line is in metres.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cprbm.curves import EvenLine, NeutralLine
from cprbm.polynomial import ComplexArray, PolynomialLine
from cprbm.spline import SplineLine
from cprbm_scene.answer import Array, Ints


class Piece(NamedTuple):
    """Points a⁰ + i·w⁰ ``at`` some places and their first and second derivatives over s, (k,) each."""

    at: ComplexArray
    first: ComplexArray
    second: ComplexArray


@dataclass(frozen=True, slots=True)
class ArcPieces:
    """Of a circular arc: ``curvature`` in 1/m, and the tangent against every link at its ``start`` (N+1,)."""

    curvature: float
    start: Array

    def seen(self, link: Ints, s: Array, t: Array, unit_length: float) -> Piece:
        """Points at arc lengths ``s`` (k,), on links ``link``, ``t`` from their starts."""
        curvature = self.curvature * unit_length
        first, half = self.start[link], 0.5 * curvature * t
        along = np.exp(1j * (first + 2.0 * half))
        return Piece(t * np.sinc(half / np.pi) * np.exp(1j * (first + half)), along, 1j * curvature * along)


@dataclass(frozen=True, slots=True)
class CurvePieces:
    """Of a ``line`` of varying curvature.

    Attributes:
        line: the neutral line.
        start: where the links begin, from its start, x + i·y, m (N+1,).
        direction: e_i of the links, as numbers (N+1,).
    """

    line: PolynomialLine | SplineLine
    start: ComplexArray
    direction: ComplexArray

    def seen(self, link: Ints, s: Array, t: Array, unit_length: float) -> Piece:
        """Points at arc lengths ``s`` (k,), on links ``link``, ``t`` from their starts."""
        here = self.line.at(s * unit_length)
        against = self.direction[link].conj()
        off = here.x + 1j * here.y
        off -= self.start[link]
        along = here.tangent * against
        return Piece(off * (against / unit_length), along, (1j * unit_length) * here.curvature * along)


Pieces = ArcPieces | CurvePieces


def pieces(line: NeutralLine, s: Array, angle: Array) -> Pieces | None:
    """What links carry whose joints lie at ``s`` (N+2,), m, with stress-free angles (N+1,); None of a straight line."""
    if isinstance(line, EvenLine):
        if line.curvature == 0.0:
            return None
        return ArcPieces(line.curvature, line.angle(s[:-1]) - angle)
    joints = line.at(s[:-1])
    return CurvePieces(line, joints.x + 1j * joints.y, np.exp(1j * angle))
