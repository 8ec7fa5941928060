"""The stress-free neutral line of a beam, by arc length.

======  ===========================================================
s       arc length from the beam's start, m
x, y    position, m
θ       tangent angle, rad, continuous along the beam
κ       curvature dθ/ds, 1/m
ℓ       length, m
======  ===========================================================
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import assert_never

import numpy as np

from cprbm.polynomial import Places, PolynomialLine, polynomial_line
from cprbm.spline import SplineLine, spline_line
from cprbm_scene import Arc, Line, Polynomial, Spline
from cprbm_scene.answer import Array
from cprbm_scene.statement import Curve


@dataclass(frozen=True, slots=True)
class EvenLine:
    """A curve of constant curvature: a straight line or a circular arc.

    Attributes:
        x0, y0: position of the start, m.
        theta0: tangent angle at the start, rad.
        curvature: dθ/ds, 1/m; zero for a line.
        length: arc length, m.
    """

    x0: float
    y0: float
    theta0: float
    curvature: float
    length: float

    def angle(self, s: Array) -> Array:
        """Tangent angle θ(s), rad."""
        return self.theta0 + self.curvature * s

    def position(self, s: Array) -> tuple[Array, Array]:
        """Position x(s), y(s), m."""
        here = self.at(s)
        return self.x0 + here.x, self.y0 + here.y

    def at(self, s: Array) -> Places:
        """Places at arc lengths ``s`` (k,), m: chords from the start, of half the turning's direction."""
        half = 0.5 * self.curvature * s
        middle = np.exp(1j * (self.theta0 + half))
        chord = self._chord(s, half)
        tangent = np.exp(1j * (self.theta0 + 2.0 * half))
        return Places(chord * middle.real, chord * middle.imag, tangent, np.full(s.shape, self.curvature))

    def chords(self, s: Array) -> tuple[Array, Array]:
        """Lengths, m, and directions, rad, of the chords between places ``s`` (n,): two arrays (n−1,)."""
        # a chord of constant curvature has its middle's direction
        sizes = s[1:] - s[:-1]
        return self._chord(sizes, 0.5 * self.curvature * sizes), self.angle(0.5 * (s[1:] + s[:-1]))

    def _chord(self, s: Array, half: Array) -> Array:
        """Length of the chord of an arc ``s`` (k,), m, that turns by twice the ``half``: s·sin(half)/half."""
        return s if self.curvature == 0.0 else np.asarray((2.0 / self.curvature) * np.sin(half))


NeutralLine = EvenLine | PolynomialLine | SplineLine


@lru_cache(maxsize=64)
def neutral_line(curve: Curve) -> NeutralLine:
    """Arc-length form of a scene's curve."""
    match curve:
        case Line():
            (xa, ya), (xb, yb) = curve.start, curve.end
            return EvenLine(xa, ya, math.atan2(yb - ya, xb - xa), 0.0, math.hypot(xb - xa, yb - ya))
        case Arc():
            return _arc(curve)
        case Polynomial():
            return polynomial_line(curve)
        case Spline():
            return spline_line(curve)
        case _:
            assert_never(curve)


def _arc(curve: Arc) -> EvenLine:
    (xa, ya), (xb, yb), (xc, yc) = curve.start, curve.end, curve.center
    radius = math.hypot(xa - xc, ya - yc)
    turn = math.atan2(yb - yc, xb - xc) - math.atan2(ya - yc, xa - xc)
    sense = 1.0 if curve.direction == "counterclockwise" else -1.0
    turn = sense * ((sense * turn) % (2.0 * math.pi))
    start_angle = math.atan2(ya - yc, xa - xc) + sense * 0.5 * math.pi
    return EvenLine(xa, ya, start_angle, sense / radius, abs(turn) * radius)
