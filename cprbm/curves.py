"""The stress-free neutral line of a beam, by arc length.

======  ===========================================================
s       arc length from the beam's start, m
x, y    position, m
θ       tangent angle, rad, continuous along the beam
ℓ       length, m
======  ===========================================================
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from scene import Arc, Line
from scene.answer import Array


@dataclass(frozen=True, slots=True)
class NeutralLine:
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


def neutral_line(curve: Line | Arc) -> NeutralLine:
    """Arc-length form of a scene's curve."""
    (xa, ya), (xb, yb) = curve.start, curve.end
    if isinstance(curve, Line):
        return NeutralLine(xa, ya, math.atan2(yb - ya, xb - xa), 0.0, math.hypot(xb - xa, yb - ya))
    xc, yc = curve.center
    radius = math.hypot(xa - xc, ya - yc)
    turn = math.atan2(yb - yc, xb - xc) - math.atan2(ya - yc, xa - xc)
    sense = 1.0 if curve.direction == "counterclockwise" else -1.0
    turn = sense * ((sense * turn) % (2.0 * math.pi))
    start_angle = math.atan2(ya - yc, xa - xc) + sense * 0.5 * math.pi
    return NeutralLine(xa, ya, start_angle, sense / radius, abs(turn) * radius)
