"""Neutral lines as curves by arc length: point, tangent and curvature at fractions of the length.

=======  ============================================================
symbol   meaning
=======  ============================================================
u        fraction of the arc length, from 0 to 1
w        parameter of a curve without a closed form of the arc length
q(w)     point less the start, divided by the size T
T        size: extent of a graph's range, sum of a spline's chords, m
κ        |q' × q''|/(T |q'|³), absolute curvature, 1/m
=======  ============================================================

Lines and arcs have closed forms.  A graph y = f(x) has the parameter w = |x − x₀|/T, so that q = (± w, (f − f₀)/T).
A spline has two cubic splines of the chord length, q' with respect to chord length over T.  Chord lengths keep a cubic
spline within the fourth power of the points' distance of a smooth curve through the points (M. S. Floater, Chordal
cubic spline interpolation is fourth-order accurate, IMA Journal of Numerical Analysis 26 (2006) 25-33).

Arc length: S(w), with S' = |q'|, is a sum of Gauss-Legendre integrals over panels of w.  Panels are halved until S at
the panels' ends is stationary.  Newton's method, started by linear interpolation in a panel, inverts u = S(w)/S(1).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache
from itertools import pairwise
from math import atan2, dist, hypot, tau
from typing import Protocol

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

Array = NDArray[np.float64]
_NODES, _WEIGHTS = leggauss(12)
_MOST_PANELS = 1 << 16
_SETTLED = 1e-14
"""Largest change of S by a halving of all panels, a fraction of the length: a few units of round-off."""
_NEWTON_STEPS = 30
_CLOSE = 1e-10
"""Newton step at which the iteration ends: the next step, by quadratic convergence, is below round-off."""
_REMEMBERED = 24
"""Arrays of fractions with stored places: a solver asks for the same fractions at many stations."""


class ArcLength:
    """Arc length S(w) of a curve with the ``speed`` S', from panels between ``first`` (p+1,), ascending from 0 to 1."""

    def __init__(self, speed: Callable[[Array], Array], first: Array) -> None:
        self._speed, self._w, self._S = speed, first, _sums(speed, first)
        while len(self._w) <= _MOST_PANELS:
            before, self._w = self._S, np.sort(np.append(self._w, 0.5 * (self._w[1:] + self._w[:-1])))
            self._S = _sums(speed, self._w)
            if np.max(np.abs(self._S[::2] - before)) <= _SETTLED * self._S[-1]:
                break
        self.whole = float(self._S[-1])
        self._places = lru_cache(maxsize=_REMEMBERED)(self._inverted)

    def places(self, u: Array) -> Array:
        """Parameters w (n,), read-only, at fractions ``u`` (n,), which are clipped to [0, 1]."""
        return self._places(np.asarray(u, dtype=np.float64).tobytes())

    def _inverted(self, fractions: bytes) -> Array:
        S = np.clip(np.frombuffer(fractions), 0.0, 1.0) * self.whole
        panel = np.clip(np.searchsorted(self._S, S, side="right") - 1, 0, len(self._w) - 2)
        low, high, missing = self._w[panel], self._w[panel + 1], S - self._S[panel]
        w = low + (high - low) * missing / (self._S[panel + 1] - self._S[panel])
        for _ in range(_NEWTON_STEPS):
            step = (missing - _integral(self._speed, low, w)) / self._speed(w)
            w = np.clip(w + step, low, high)
            if np.max(np.abs(step), initial=0.0) <= _CLOSE:
                break
        w.flags.writeable = False
        return w


def _integral(speed: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Gauss–Legendre integrals (n,) of the speed from ``low`` (n,) to ``high`` (n,)."""
    half = 0.5 * (high - low)
    return np.asarray(speed(low[:, None] + half[:, None] * (1.0 + _NODES)) @ _WEIGHTS * half)


def _sums(speed: Callable[[Array], Array], w: Array) -> Array:
    """S at the ends ``w`` (p+1,) of the panels."""
    return np.concatenate(([0.0], np.cumsum(_integral(speed, w[:-1], w[1:]))))


Point = tuple[float, float]

_SAMPLES = 2001
"""Samples of a curve, between which extrema are refined: a bend of 1/1000 of the length has two samples."""
_PANELS = 32
_PANELS_OF_PIECE = 4
_FEWEST_OF_PIECE, _MOST_OF_PIECE, _MOST_OF_SPLINE = 9, 65, 4001
_LOWEST = 5
"""Sampled minima that are refined: the least value may lie beside a sample that is a little higher."""
_PLACE = 1e-12
"""Tolerance of the place of a refined minimum, in the unit of the samples' range."""
_NEGLIGIBLE = 1e-14
"""Coefficient of a highest power, relative to the largest coefficient, that counts as zero: round-off."""
_REAL = 1e-6
"""Imaginary part up to which a root counts as real: a sample more or less is harmless."""


class Curve(Protocol):
    """Geometry of a neutral line by fractions ``u`` (n,) of the arc length."""

    @property
    def length(self) -> float:
        """Arc length, m."""

    @property
    def largest_curvature(self) -> float:
        """Largest absolute curvature, 1/m."""

    def point(self, u: Array) -> Array:
        """Points (n, 2), m."""

    def tangent(self, u: Array) -> Array:
        """Unit tangents (n, 2), from start to end."""

    def curvature(self, u: Array) -> Array:
        """Absolute curvature (n,), 1/m."""


class StraightLine:
    """Straight line between two points, m."""

    largest_curvature = 0.0

    def __init__(self, start: Point, end: Point) -> None:
        self.length = dist(start, end)
        self._start, self._way = np.array(start), np.array(end) - np.array(start)

    def point(self, u: Array) -> Array:
        """Points (n, 2), m."""
        return np.asarray(self._start + u[:, None] * self._way)

    def tangent(self, u: Array) -> Array:
        """Unit tangents (n, 2)."""
        return np.tile(self._way / np.hypot(*self._way), (len(u), 1))

    def curvature(self, u: Array) -> Array:
        """Zeros (n,)."""
        return np.zeros(len(u))


class CircularArc:
    """Circular arc about ``center`` from ``start`` towards ``end``, m, with the radius of ``start``."""

    def __init__(self, center: Point, start: Point, end: Point, *, counterclockwise: bool) -> None:
        first, last = (atan2(place[1] - center[1], place[0] - center[0]) for place in (start, end))
        turn = (last - first) if counterclockwise else (first - last)
        self.turn = (turn % tau or tau) * (1.0 if counterclockwise else -1.0)
        self._radius, self._center, self._first = dist(start, center), np.array(center), first
        self.length, self.largest_curvature = abs(self.turn) * self._radius, 1.0 / self._radius

    def point(self, u: Array) -> Array:
        """Points (n, 2), m."""
        angle = self._first + self.turn * u
        return np.asarray(self._center + self._radius * np.column_stack((np.cos(angle), np.sin(angle))))

    def tangent(self, u: Array) -> Array:
        """Unit tangents (n, 2)."""
        angle = self._first + self.turn * u
        return np.asarray(np.sign(self.turn) * np.column_stack((-np.sin(angle), np.cos(angle))))

    def curvature(self, u: Array) -> Array:
        """The inverse radius (n,), 1/m."""
        return np.full(len(u), self.largest_curvature)


class ParametricCurve:
    """Curve ``start`` + ``size`` q(w), with the derivatives ``q(w, order)`` (..., 2) of order 0, 1 and 2.

    ``panels`` are places of w between which q is smooth; ``samples`` are places of w that are dense on the curve.
    """

    def __init__(
        self, start: Point, size: float, q: Callable[[Array, int], Array], panels: Array, samples: Array
    ) -> None:
        self._start, self._size, self._q, self._panels, self.samples = np.array(start), size, q, panels, samples

    @cached_property
    def _arc(self) -> ArcLength:
        return ArcLength(self.speed, self._panels)

    @cached_property
    def length(self) -> float:
        """Arc length, m."""
        return self._arc.whole * self._size

    @cached_property
    def largest_curvature(self) -> float:
        """Largest absolute curvature, 1/m."""
        return -least(lambda w: -self._bend(w), self.samples)[0]

    def derivative(self, w: Array, order: int) -> Array:
        """Derivatives (n, 2) of the place by the parameter, m, at parameters ``w`` (n,)."""
        return np.asarray(self._size * self._q(w, order))

    def speed(self, w: Array) -> Array:
        """|q'|, a pure number, at parameters of any shape."""
        along = self._q(w, 1)
        return np.asarray(np.hypot(along[..., 0], along[..., 1]))

    def place(self, w: Array) -> Array:
        """Points (n, 2), m, at parameters ``w`` (n,)."""
        return np.asarray(self._start + self._size * self._q(w, 0))

    def point(self, u: Array) -> Array:
        """Points (n, 2), m."""
        return self.place(self._arc.places(u))

    def tangent(self, u: Array) -> Array:
        """Unit tangents (n, 2)."""
        w = self._arc.places(u)
        return np.asarray(self._q(w, 1) / self.speed(w)[:, None])

    def curvature(self, u: Array) -> Array:
        """Absolute curvature (n,), 1/m."""
        return self._bend(self._arc.places(u))

    def _bend(self, w: Array) -> Array:
        first, second = self._q(w, 1), self._q(w, 2)
        cross = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        return np.asarray(np.abs(cross) / (self.speed(w) ** 3 * self._size))


class Graph(ParametricCurve):
    """Graph y = f(x), or x = f(y) with ``along`` = 1, over a range from ``first`` to ``last``, m.

    ``coefficients`` are those of f, lowest power first, in metres for a variable in metres.
    """

    def __init__(self, coefficients: Sequence[float], first: float, last: float, *, along: int) -> None:
        extent, sense = abs(last - first), float(np.sign(last - first))
        # in units of the extent no power of the variable is larger than necessary
        scaled, factor = [0.0], 1.0
        for coefficient in coefficients[1:]:
            scaled.append(coefficient * factor if coefficient else 0.0)
            factor *= extent
        with np.errstate(over="ignore", invalid="ignore"):
            g = Polynomial(scaled)(Polynomial([first / extent, sense]))
            g -= g(0.0)
            self._g = (g, g.deriv(1), g.deriv(2))
            slope = self._g[1].trim(_NEGLIGIBLE * np.max(np.abs(self._g[1].coef)))
            level = slope.roots() if np.all(np.isfinite(g.coef)) else np.zeros(0)
            # a steep graph has its sharpest bend where the graph is level
            value = float(Polynomial(coefficients)(first))
        level = level.real[(np.abs(level.imag) < _REAL) & (level.real > 0.0) & (level.real < 1.0)]
        self._along, self._sense = along, sense
        super().__init__(
            (value, first) if along else (first, value),
            extent,
            self._derivative,
            np.linspace(0.0, 1.0, _PANELS + 1),
            np.union1d(np.linspace(0.0, 1.0, _SAMPLES), level),
        )

    @property
    def steepest(self) -> float:
        """Largest |f'| in the range; not finite beyond the range of floating-point numbers."""
        with np.errstate(over="ignore", invalid="ignore"):
            return float(np.max(np.abs(self._g[1](self.samples))))

    def _derivative(self, w: Array, order: int) -> Array:
        along = (self._sense * w, np.full(np.shape(w), self._sense), np.zeros(np.shape(w)))[order]
        both = (along, np.asarray(self._g[order](w), dtype=np.float64))
        return np.stack(both[::-1] if self._along else both, axis=-1)


class SplineCurve(ParametricCurve):
    """Cubic spline of the chord length through ``points`` (at least three), m.

    At an end with a direction the derivative is its unit vector; at an end without direction (None) the outer
    two pieces are the same cubic.
    """

    def __init__(self, points: Sequence[Point], directions: tuple[Point | None, Point | None]) -> None:
        from scipy.interpolate import CubicSpline  # scenes without splines need no SciPy

        t = np.concatenate(([0.0], np.cumsum([dist(*pair) for pair in pairwise(points)])))
        w, size = t / t[-1], float(t[-1])
        ends = tuple("not-a-knot" if each is None else (1, unit_vector(each)) for each in directions)
        spline = CubicSpline(w, (np.array(points) - np.array(points[0])) / size, bc_type=ends)
        of_piece = max(_FEWEST_OF_PIECE, min(_MOST_OF_PIECE, _MOST_OF_SPLINE // (len(w) - 1)))
        super().__init__(points[0], size, spline, _divided(w, _PANELS_OF_PIECE), _divided(w, of_piece - 1))

    @cached_property
    def slowest(self) -> tuple[float, Point]:
        """The least |q'|, a pure number, zero at a cusp, and the place, m."""
        speed = self.speed(self.samples)
        x, y = self.place(self.samples[[np.argmin(speed)]])[0]
        return float(np.min(speed)), (float(x), float(y))


def unit_vector(direction: Point) -> Array:
    """Unit vector (2,) of a direction other than zero, of any size."""
    e = np.array(direction) / max(abs(direction[0]), abs(direction[1]))
    return np.asarray(e / hypot(*e))


def least(
    function: Callable[[Array], Array], samples: Array, refined_below: float = float("inf")
) -> tuple[float, float]:
    """Least value of a function (n,) -> (n,), and the place, between ``samples`` (n,), ascending.

    The lowest sampled minima are refined if the least is below a bound.
    """
    from scipy.optimize import minimize_scalar  # scenes of lines and arcs alone need no SciPy

    values = function(samples)
    fence = np.pad(values, 1, constant_values=np.inf)
    minima = np.flatnonzero((values <= fence[:-2]) & (values <= fence[2:]))
    found = [(float(np.min(values)), float(samples[np.argmin(values)]))]
    if found[0][0] > refined_below:
        return found[0]
    for i in minima[np.argsort(values[minima], kind="stable")[:_LOWEST]]:
        # the tolerance of the place is a share of the variable: the variable is zero at the sample
        beside = samples[max(i - 1, 0)] - samples[i], samples[min(i + 1, len(samples) - 1)] - samples[i]
        refined = minimize_scalar(
            lambda aside, i=i: float(function(samples[[i]] + aside)[0]),
            bounds=beside,
            method="bounded",
            options={"xatol": _PLACE},
        )
        found.append((float(refined.fun), float(samples[i] + refined.x)))
    return min(found)


def _divided(w: Array, parts: int) -> Array:
    """The intervals between ``w`` (k+1,) cut into equal ``parts``: places (k·parts + 1,)."""
    return np.append(np.concatenate([np.linspace(*ends, parts, endpoint=False) for ends in pairwise(w)]), w[-1])
