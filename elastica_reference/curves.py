"""Stress-free neutral lines by arc length.

=======  ==========================================================================
symbol   meaning
=======  ==========================================================================
s        arc length from the beam's start, in units of length
θ, κ     tangent angle; curvature dθ/ds; κ', κ'' its derivatives
u        variable of a graph y = f(u) or x = f(u), f its value; σ = ±1, its direction
v        √(1 + f'²) = ds/|du|
R, φ     radius of an arc and its initial angle
=======  ==========================================================================

A graph's κ = ±σ f''/v³ and dκ/ds = ±(f'''/v³ − 3 f' f''²/v⁵)/v, with + for y = f(x); its arc length is integrated by
Gauss's rule on panels and inverted by Newton's method.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Protocol

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import Arc, Curve, Line, Polynomial, Spline
from elastica_reference.spline import Interpolated

_PANELS, _NODES = 64, 16
_INVERSIONS = 8
_KEPT = 512  # remembered sets of arc lengths: iterations evaluate angle, κ and derivatives at the same places


class NeutralLine(Protocol):
    """A line by arc length; functions map arc lengths (n,) to values (n,), and ``place`` to (2, n).

    ``kinks`` are inner arc lengths with a kink of the curvature.
    """

    @property
    def kinks(self) -> tuple[float, ...]: ...  # noqa: D102
    @property
    def length(self) -> float: ...  # noqa: D102
    def angle(self, s: Array) -> Array: ...  # noqa: D102
    def curvature(self, s: Array) -> Array: ...  # noqa: D102
    def curvature_slope(self, s: Array) -> Array: ...  # noqa: D102
    def curvature_second(self, s: Array) -> Array: ...  # noqa: D102
    def place(self, s: Array) -> Array: ...  # noqa: D102


def neutral_line(curve: Curve, unit: float) -> NeutralLine:
    """The line of a ``curve``, in units of ``unit`` metres."""
    match curve:
        case Line():
            return Straight(np.array(curve.start) / unit, np.array(curve.end) / unit)
        case Arc():
            return Circular.of(curve, unit)
        case Polynomial():
            return Graph(curve, unit)
        case Spline():
            return Interpolated(curve, unit)


@dataclass(frozen=True)
class Straight:
    """A straight line from ``start`` (2,) to ``end`` (2,)."""

    start: Array
    end: Array
    kinks = ()

    @cached_property
    def length(self) -> float:
        """Length of the line."""
        return float(np.hypot(*(self.end - self.start)))

    def angle(self, s: Array) -> Array:
        """θ."""
        return np.full(np.shape(s), math.atan2(*(self.end - self.start)[::-1]))

    def curvature(self, s: Array) -> Array:
        """κ."""
        return np.zeros(np.shape(s))

    def curvature_slope(self, s: Array) -> Array:
        """κ'."""
        return np.zeros(np.shape(s))

    def curvature_second(self, s: Array) -> Array:
        """κ''."""
        return np.zeros(np.shape(s))

    def place(self, s: Array) -> Array:
        """Points (2, n)."""
        return self.start[:, None] + np.multiply.outer((self.end - self.start) / self.length, s)


@dataclass(frozen=True)
class Circular:
    """An arc about ``center`` (2,) with ``radius`` R from the angle ``begin`` φ over ``sweep``.

    The sweep is positive counter-clockwise.
    """

    center: Array
    radius: float
    begin: float
    sweep: float
    kinks = ()

    @staticmethod
    def of(arc: Arc, unit: float) -> Circular:
        """An arc in units of ``unit`` metres."""
        center = np.array(arc.center)
        begin, end = (math.atan2(*(np.array(point) - center)[::-1]) for point in (arc.start, arc.end))
        turn = (end - begin) % math.tau
        sweep = turn if arc.direction == "counterclockwise" else turn - math.tau
        return Circular(center / unit, math.dist(arc.center, arc.start) / unit, begin, sweep)

    @property
    def length(self) -> float:
        """R times the sweep."""
        return self.radius * abs(self.sweep)

    def angle(self, s: Array) -> Array:
        """θ."""
        sense = math.copysign(1.0, self.sweep)
        return self.begin + sense * (0.5 * math.pi + np.asarray(s) / self.radius)

    def curvature(self, s: Array) -> Array:
        """κ."""
        return np.full(np.shape(s), math.copysign(1.0 / self.radius, self.sweep))

    def curvature_slope(self, s: Array) -> Array:
        """κ'."""
        return np.zeros(np.shape(s))

    def curvature_second(self, s: Array) -> Array:
        """κ''."""
        return np.zeros(np.shape(s))

    def place(self, s: Array) -> Array:
        """Points (2, n)."""
        at = self.begin + math.copysign(1.0, self.sweep) * np.asarray(s) / self.radius
        return self.center[:, None] + self.radius * np.stack([np.cos(at), np.sin(at)])


class Graph:
    """Graph of a polynomial."""

    kinks = ()

    def __init__(self, curve: Polynomial, unit: float) -> None:
        # f(u)/unit of u/unit
        powers = np.arange(len(curve.coefficients))
        self._f = np.polynomial.Polynomial(np.array(curve.coefficients) * unit ** (powers - 1.0))
        self._df, self._ddf, self._dddf = (self._f.deriv(n) for n in (1, 2, 3))
        self._along_x = curve.axis == "x"
        begin, end = np.array(curve.range) / unit
        self._sense = math.copysign(1.0, end - begin)
        self._ends = np.linspace(begin, end, _PANELS + 1)
        x, w = np.polynomial.legendre.leggauss(_NODES)
        self._x, self._w = 0.5 * (x + 1.0), 0.5 * w
        self._sums = np.concatenate(([0.0], np.cumsum(self._arc(self._ends[:-1], self._ends[1:]))))
        self._remembered_variable = lru_cache(maxsize=_KEPT)(self._computed_variable)

    @property
    def length(self) -> float:
        """Arc length of the graph."""
        return float(self._sums[-1])

    def _speed(self, u: Array) -> Array:
        return np.asarray(np.hypot(1.0, self._df(u)))

    def _arc(self, begin: Array, end: Array) -> Array:
        across = np.asarray(end - begin)
        return np.asarray(np.abs(across) * (self._speed(begin[..., None] + across[..., None] * self._x) @ self._w))

    def _variable(self, s: Array) -> Array:
        s = np.asarray(s, dtype=float)
        return self._remembered_variable(s.tobytes(), s.shape)

    def _computed_variable(self, places: bytes, shape: tuple[int, ...]) -> Array:
        s = np.frombuffer(places).reshape(shape)
        # the graph continues beyond its ends, for iterates of Newton's method
        panel = np.clip(np.searchsorted(self._sums, s, side="right") - 1, 0, _PANELS - 1)
        begin, rest = self._ends[panel], s - self._sums[panel]
        u = begin + self._sense * rest / self._speed(begin)
        for _ in range(_INVERSIONS):
            covered = np.sign(self._sense * (u - begin)) * self._arc(begin, u)
            step = (rest - covered) / self._speed(u)
            u = u + self._sense * step
            if np.max(np.abs(step), initial=0.0) < 1e-15 * self.length:
                break
        variables = np.asarray(u)
        variables.setflags(write=False)
        return variables

    def angle(self, s: Array) -> Array:
        """θ."""
        lean = np.arctan(self._df(self._variable(s)))
        if self._along_x:
            return np.asarray(lean + (0.0 if self._sense > 0.0 else math.pi))
        return np.asarray(self._sense * 0.5 * math.pi - lean)

    def curvature(self, s: Array) -> Array:
        """κ."""
        u = self._variable(s)
        kappa = self._sense * self._ddf(u) / self._speed(u) ** 3
        return np.asarray(kappa if self._along_x else -kappa)

    def curvature_slope(self, s: Array) -> Array:
        """κ'."""
        u = self._variable(s)
        v = self._speed(u)
        slope = (self._dddf(u) / v**3 - 3.0 * self._df(u) * self._ddf(u) ** 2 / v**5) / v
        return np.asarray(slope if self._along_x else -slope)

    def curvature_second(self, s: Array) -> Array:
        """Second derivative of κ, from dκ/ds = ±w(u)."""
        u = self._variable(s)
        v, d, dd, ddd = self._speed(u), self._df(u), self._ddf(u), self._dddf(u)
        w = self._f.deriv(4)(u) / v**4 - 10.0 * d * dd * ddd / v**6 - 3.0 * dd**3 / v**6 + 18.0 * d**2 * dd**3 / v**8
        second = self._sense * w / v
        return np.asarray(second if self._along_x else -second)

    def place(self, s: Array) -> Array:
        """Points (2, n)."""
        u = self._variable(s)
        return np.stack([u, self._f(u)]) if self._along_x else np.stack([self._f(u), u])
