"""The stress-free neutral line y = f(x) or x = f(y), by arc length.

======  ==========================================================================================
s, ℓ    arc length from the beam's start; length, m
v       distance from the start along the variable's axis, in the sense in which the beam runs, m
g(v)    f − f(start), m: position across that axis
a, b    unit vectors along the axis, in the beam's sense, and of the other axis; ε = a × b = ±1
θ       angle of a + ε·arctan g'
κ       ε g''/(1 + g'²)^(3/2), 1/m
======  ==========================================================================================

ds/dv = √(1 + g'²); how it is integrated, and v(s), stand in :mod:`cprbm.panels`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cprbm.panels import Panels, panelled
from cprbm_scene import Polynomial
from cprbm_scene.answer import Array, Ints

ComplexArray = NDArray[np.complex128]

FEWEST_PANELS = 64


@dataclass(frozen=True, slots=True)
class Places:
    """Some places of a line, (k,) each: ``x`` and ``y`` from the line's start, m, and ``curvature`` κ.

    ``tangent`` are unit tangents cos θ + i·sin θ.
    """

    x: Array
    y: Array
    tangent: ComplexArray
    curvature: Array

    def only(self, these: Ints) -> Places:
        """Some of the places."""
        return Places(self.x[these], self.y[these], self.tangent[these], self.curvature[these])


@dataclass(frozen=True, slots=True)
class PolynomialLine:
    """A curve of varying curvature.

    Attributes:
        x0, y0: position of the start, m.
        along: a as (cos, sin); across: b.
        slope: coefficients of g', lowest power first.
        panels: v and arc length, m.
    """

    x0: float
    y0: float
    along: tuple[float, float]
    across: tuple[float, float]
    slope: Array
    panels: Panels

    @property
    def length(self) -> float:
        """ℓ, m."""
        return self.panels.length

    def angle(self, s: Array) -> Array:
        """Tangent angle θ(s), rad."""
        g1 = np.polynomial.polynomial.polyval(self.panels.inverted(s), self.slope)
        return self._turned(np.arctan(g1))

    def position(self, s: Array) -> tuple[Array, Array]:
        """Position x(s), y(s), m."""
        here = self.at(s)
        return self.x0 + here.x, self.y0 + here.y

    def chords(self, s: Array) -> tuple[Array, Array]:
        """Lengths, m, and directions, rad, of the chords between places ``s`` (n,): two arrays (n−1,)."""
        here = self.at(s)
        dx, dy = np.diff(here.x), np.diff(here.y)
        forwards = dx * self.along[0] + dy * self.along[1]
        sideways = dx * self.across[0] + dy * self.across[1]
        return np.hypot(dx, dy), self._turned(np.arctan2(sideways, forwards))

    def at(self, s: Array) -> Places:
        """Places at arc lengths ``s`` (k,), m; beyond the ends the end itself."""
        v = self.panels.inverted(s)
        # g, g' and g'' in one go of Horner's rule, from the coefficients of g' = Σ c_k v^k
        g = g1 = g2 = np.zeros_like(v)
        for k in range(len(self.slope) - 1, -1, -1):
            g2 = g2 * v + g1
            g1 = g1 * v + self.slope[k]
            g = g * v + self.slope[k] / (k + 1)
        g = g * v
        speed = np.sqrt(1.0 + g1 * g1)
        tangent = (complex(*self.along) + complex(*self.across) * g1) / speed
        return Places(
            x=v * self.along[0] + g * self.across[0],
            y=v * self.along[1] + g * self.across[1],
            tangent=tangent,
            curvature=self._sense() * g2 / speed**3,
        )

    def _sense(self) -> float:
        """ε."""
        return self.along[0] * self.across[1] - self.along[1] * self.across[0]

    def _turned(self, angle: Array) -> Array:
        """Direction of what lies at an ``angle`` from a towards b."""
        return np.asarray(math.atan2(self.along[1], self.along[0]) + self._sense() * angle)


def speed(slope: Array, v: Array) -> Array:
    """ds/dv = √(1 + g'²)."""
    g1 = np.full(v.shape, slope[-1])
    for coefficient in slope[-2::-1]:
        g1 *= v
        g1 += coefficient
    g1 *= g1
    g1 += 1.0
    return np.asarray(np.sqrt(g1, out=g1))


def polynomial_line(curve: Polynomial) -> PolynomialLine:
    """Arc-length form of a scene's polynomial."""
    begin, end = curve.range
    sense = math.copysign(1.0, end - begin)
    f = np.polynomial.Polynomial(curve.coefficients)
    # g'(v) = sense · f'(begin + sense·v): its Taylor coefficients from the derivatives of f there
    slope, derivative = [], f.deriv()
    for k in range(len(curve.coefficients) - 1):
        slope.append(sense ** (k + 1) * float(derivative(begin)) / math.factorial(k))
        derivative = derivative.deriv()
    along, across = ((sense, 0.0), (0.0, 1.0)) if curve.axis == "x" else ((0.0, sense), (1.0, 0.0))
    coefficients = np.array(slope)
    ends = abs(end - begin) * np.linspace(0.0, 1.0, FEWEST_PANELS + 1)
    x0, y0 = curve.start
    return PolynomialLine(x0, y0, along, across, coefficients, panelled(lambda v: speed(coefficients, v), ends))
