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

from cprbm.polynomial import PolynomialLine, polynomial_line
from cprbm.spline import SplineLine, spline_line
from scene import Arc, Line, Polynomial, Spline
from scene.answer import Array
from scene.statement import Curve


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
        """Position x(s), y(s), m: s·sinc of half the turning, along the chord's direction."""
        half = 0.5 * self.curvature * s
        chord = s * np.sinc(half / np.pi)
        return self.x0 + chord * np.cos(self.theta0 + half), self.y0 + chord * np.sin(self.theta0 + half)

    def chords(self, s: Array) -> tuple[Array, Array]:
        """Lengths, m, and directions, rad, of the chords between places ``s`` (n,): two arrays (n−1,)."""
        x, y = self.position(s)
        # a chord of constant curvature has its middle's direction
        return np.hypot(np.diff(x), np.diff(y)), self.angle(0.5 * (s[1:] + s[:-1]))


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
