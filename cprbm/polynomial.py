"""The stress-free neutral line y = f(x) or x = f(y), by arc length.

======  ==========================================================================================
s, ℓ    arc length from the beam's start; length, m
v       distance from the start along the variable's axis, in the sense in which the beam runs, m
g(v)    f − f(start), m: position across that axis
a, b    unit vectors along the axis, in the beam's sense, and of the other axis; ε = a × b = ±1
θ       angle of a + ε·arctan g'
κ       ε g''/(1 + g'²)^(3/2), 1/m
======  ==========================================================================================

ds/dv = √(1 + g'²) is integrated over panels of v by Gauss's rule, which are halved until their ends' arc
lengths settle.  v(s) is Newton's: it begins at the cubic through its panel's ends with the slopes there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from scene import Polynomial
from scene.answer import Array

ABSCISSAE, WEIGHTS = (0.5 * part for part in np.polynomial.legendre.leggauss(8))  # on [−½, ½]
FEWEST_PANELS, MOST_PANELS = 64, 1 << 15
SETTLED = 1e-14  # of the length: eight points err by 2⁻¹⁶ of this after a further halving
NEWTON_ITERATIONS = 20
CLOSE = 1e-9  # of the length: a step whose square is nothing


@dataclass(frozen=True, slots=True)
class Places:
    """Some places of a line, arrays (k,): ``x``, ``y`` from the line's start, m, ``angle`` θ and ``curvature`` κ."""

    x: Array
    y: Array
    angle: Array
    curvature: Array


@dataclass(frozen=True, slots=True)
class PolynomialLine:
    """A curve of varying curvature.

    Attributes:
        x0, y0: position of the start, m.
        along: a as (cos, sin); across: b.
        slope: coefficients of g', lowest power first.
        v, s: ends of the panels and arc length there, m.
    """

    x0: float
    y0: float
    along: tuple[float, float]
    across: tuple[float, float]
    slope: Array
    v: Array
    s: Array

    @property
    def length(self) -> float:
        """ℓ, m."""
        return float(self.s[-1])

    def angle(self, s: Array) -> Array:
        """Tangent angle θ(s), rad."""
        return self.at(s).angle

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
        v = self._inverted(s)
        # g, g' and g'' in one go of Horner's rule, from the coefficients of g' = Σ c_k v^k
        g = g1 = g2 = np.zeros_like(v)
        for k in range(len(self.slope) - 1, -1, -1):
            g2 = g2 * v + g1
            g1 = g1 * v + self.slope[k]
            g = g * v + self.slope[k] / (k + 1)
        g = g * v
        return Places(
            x=v * self.along[0] + g * self.across[0],
            y=v * self.along[1] + g * self.across[1],
            angle=self._turned(np.arctan(g1)),
            curvature=self._sense() * g2 / np.hypot(1.0, g1) ** 3,
        )

    def _sense(self) -> float:
        """ε."""
        return self.along[0] * self.across[1] - self.along[1] * self.across[0]

    def _turned(self, angle: Array) -> Array:
        """Direction of what lies at an ``angle`` from a towards b."""
        return np.asarray(math.atan2(self.along[1], self.along[0]) + self._sense() * angle)

    def _inverted(self, s: Array) -> Array:
        """v(s)."""
        s = np.clip(s, 0.0, self.length)
        panel = np.minimum(np.searchsorted(self.s, s, side="right") - 1, len(self.v) - 2)
        v0, v1, s0, s1 = self.v[panel], self.v[panel + 1], self.s[panel], self.s[panel + 1]
        size = s1 - s0
        t = (s - s0) / size
        d0, d1 = size / speed(self.slope, v0), size / speed(self.slope, v1)
        rise = v1 - v0
        v = v0 + t * (d0 + t * (3.0 * rise - 2.0 * d0 - d1 + t * (d0 + d1 - 2.0 * rise)))
        for _ in range(NEWTON_ITERATIONS):
            v = np.clip(v, v0, v1)
            step = (s - s0 - arc(self.slope, v0, v)) / speed(self.slope, v)
            v = v + step
            if np.max(np.abs(step), initial=0.0) <= CLOSE * self.length:
                break
        return np.asarray(v)


def speed(slope: Array, v: Array) -> Array:
    """ds/dv = √(1 + g'²)."""
    g1 = np.full_like(v, slope[-1])
    for coefficient in slope[-2::-1]:
        g1 = g1 * v + coefficient
    return np.hypot(1.0, g1)


def arc(slope: Array, v0: Array, v1: Array) -> Array:
    """Arc lengths (k,) between places v (k,) of one panel."""
    points = 0.5 * (v0 + v1)[:, None] + (v1 - v0)[:, None] * ABSCISSAE
    return np.asarray((v1 - v0) * (speed(slope, points) @ WEIGHTS))


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
    v, s = _panels(np.array(slope), abs(end - begin))
    x0, y0 = curve.start
    return PolynomialLine(x0, y0, along, across, np.array(slope), v, s)


def _panels(slope: Array, extent: float) -> tuple[Array, Array]:
    """Ends of the panels and the arc length there."""
    panels = FEWEST_PANELS
    v, s = _summed(slope, extent, panels)
    while panels < MOST_PANELS:
        panels *= 2
        before = s
        v, s = _summed(slope, extent, panels)
        if np.max(np.abs(s[::2] - before)) <= SETTLED * s[-1]:
            break
    return v, s


def _summed(slope: Array, extent: float, panels: int) -> tuple[Array, Array]:
    v = extent * np.linspace(0.0, 1.0, panels + 1)
    return v, np.concatenate(([0.0], np.cumsum(arc(slope, v[:-1], v[1:]))))
