"""The pieces of a curved stress-free neutral line that the links carry.

==========  ==============================================================================
s, t        arc length from the beam's start and from the start of link i
e_i, n_i    direction of link i and its left normal
a⁰, w⁰      coordinates of a point of the piece along e_i and n_i from joint i
==========  ==============================================================================

They are at rest: a link carries its piece along as it moves.  Arc lengths and coordinates are over the unit of
length ℓ, what is kept of the neutral line is in metres.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cprbm.curves import EvenLine, NeutralLine
from cprbm.polynomial import PolynomialLine
from cprbm.spline import SplineLine
from scene.answer import Array, Ints


class Piece(NamedTuple):
    """a⁰, w⁰ and their first and second derivatives over s, (k,) each."""

    a: Array
    w: Array
    a1: Array
    w1: Array
    a2: Array
    w2: Array


@dataclass(frozen=True, slots=True)
class ArcPieces:
    """Of a circular arc: ``curvature`` in 1/m, and the tangent against every link at its ``start`` (N+1,)."""

    curvature: float
    start: Array

    def seen(self, link: Ints, s: Array, t: Array, unit_length: float) -> Piece:
        """Points at arc lengths ``s`` (k,), on links ``link``, ``t`` from their starts."""
        curvature = self.curvature * unit_length
        first, half = self.start[link], 0.5 * curvature * t
        chord = t * np.sinc(half / np.pi)
        a1, w1 = np.cos(first + 2.0 * half), np.sin(first + 2.0 * half)
        return Piece(
            chord * np.cos(first + half), chord * np.sin(first + half), a1, w1, -curvature * w1, curvature * a1
        )


@dataclass(frozen=True, slots=True)
class CurvePieces:
    """Of a ``line`` of varying curvature.

    Attributes:
        line: the neutral line.
        x, y: where the links begin, from its start, m (N+1,).
        angle: of the links (N+1,).
    """

    line: PolynomialLine | SplineLine
    x: Array
    y: Array
    angle: Array

    def seen(self, link: Ints, s: Array, t: Array, unit_length: float) -> Piece:
        """Points at arc lengths ``s`` (k,), on links ``link``, ``t`` from their starts."""
        here = self.line.at(s * unit_length)
        dx, dy = (here.x - self.x[link]) / unit_length, (here.y - self.y[link]) / unit_length
        angle = self.angle[link]
        cos, sin = np.cos(angle), np.sin(angle)
        a1, w1 = np.cos(here.angle - angle), np.sin(here.angle - angle)
        curvature = here.curvature * unit_length
        return Piece(dx * cos + dy * sin, dy * cos - dx * sin, a1, w1, -curvature * w1, curvature * a1)


Pieces = ArcPieces | CurvePieces


def pieces(line: NeutralLine, s: Array, angle: Array) -> Pieces | None:
    """What links carry whose joints lie at ``s`` (N+2,), m, with stress-free angles (N+1,); None of a straight line."""
    if isinstance(line, EvenLine):
        if line.curvature == 0.0:
            return None
        return ArcPieces(line.curvature, line.angle(s[:-1]) - angle)
    joints = line.at(s[:-1])
    return CurvePieces(line, joints.x, joints.y, angle)
