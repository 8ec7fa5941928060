"""Neutral lines as curves by arc length: point, tangent and curvature at fractions of the length.

=======  ============================================================
symbol   meaning
=======  ============================================================
u        fraction of the arc length, from 0 to 1
w        parameter of the curve, from 0 to 1
q(w)     point less the origin, divided by the size T
T        size: radius, extent of a graph's range, sum of a spline's chords, m
κ        |q' × q''|/(T |q'|³), absolute curvature, 1/m
=======  ============================================================

Of lines and arcs |q'| is constant, and w = u.  A graph y = f(x) has the parameter w = |x − x₀|/T, so that
q = (± w, (f − f₀)/T).
A spline has two cubic splines of the chord length, q' with respect to chord length over T.  Chord lengths keep a cubic
spline within the fourth power of the points' distance of a smooth curve through the points (M. S. Floater, Chordal
cubic spline interpolation is fourth-order accurate, IMA Journal of Numerical Analysis 26 (2006) 25-33).

Arc length: S(w), with S' = |q'|, is a sum of Gauss-Legendre integrals over panels of w.  Panels are halved until S at
the panels' ends is stationary.  Newton's method, started by linear interpolation in a panel, inverts u = S(w)/S(1).
"""

from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache
from itertools import pairwise
from math import atan2, dist, hypot, tau

import numpy as np
from numpy.polynomial import Polynomial, legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float]

SAMPLES = 2001
"""Samples of a curve, between which extrema are refined: a bend of 1/1000 of the length has two samples."""
_NODES, _WEIGHTS = legendre.leggauss(12)
_MOST_PANELS = 1 << 16
_SETTLED = 1e-14
"""Largest change of S by a halving of all panels, a fraction of the length: a few units of round-off."""
_NEWTON_STEPS = 30
_CLOSE = 1e-10
"""Newton step at which the iteration ends: the next step, by quadratic convergence, is below round-off."""
_REMEMBERED = 24
"""Arrays of fractions with stored places: a solver asks for the same fractions at many stations."""
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


class Curve:
    """Curve ``origin`` + ``size`` q(w), m, with the derivatives ``q(w, order)`` (..., 2) of order 0, 1 and 2.

    ``panels`` are places of w between which q is smooth, None for constant |q'|; ``samples`` are places of w that are
    dense on the curve.
    """

    def __init__(
        self,
        origin: Point,
        size: float,
        q: Callable[[Array, int], Array],
        panels: Array | None = None,
        samples: Array | Sequence[float] = (0.0, 1.0),
    ) -> None:
        self.origin, self._size, self._q = np.array(origin), size, q
        self._panels, self.samples = panels, np.asarray(samples)
        self._inverted = lru_cache(maxsize=_REMEMBERED)(self._inverse)

    def derivative(self, w: Array, order: int) -> Array:
        """Derivatives (n, 2) of the place by the parameter, m, at parameters ``w`` (n,)."""
        return np.asarray(self._size * self._q(w, order))

    def speed(self, w: Array) -> Array:
        """|q'|, a pure number, at parameters of any shape."""
        return np.asarray(np.hypot(*np.moveaxis(self._q(w, 1), -1, 0)))

    def place(self, w: Array) -> Array:
        """Points (n, 2), m, at parameters ``w`` (n,)."""
        return np.asarray(self.origin + self._size * self._q(w, 0))

    @cached_property
    def length(self) -> float:
        """Arc length, m."""
        return float(self._arc[1][-1]) * self._size

    @cached_property
    def largest_curvature(self) -> float:
        """Largest absolute curvature, 1/m."""
        constant = self._panels is None
        return float(self._bend(np.zeros(1))[0]) if constant else -least(lambda w: -self._bend(w), self.samples)[0]

    def point(self, u: Array) -> Array:
        """Points (n, 2), m, at fractions ``u`` (n,) of the arc length."""
        return self.place(self._places(u))

    def tangent(self, u: Array) -> Array:
        """Unit tangents (n, 2), from start to end, at fractions ``u`` (n,) of the arc length."""
        w = self._places(u)
        return np.asarray(self._q(w, 1) / self.speed(w)[:, None])

    def curvature(self, u: Array) -> Array:
        """Absolute curvature (n,), 1/m, at fractions ``u`` (n,) of the arc length."""
        return self._bend(self._places(u))

    def _bend(self, w: Array) -> Array:
        first, second = self._q(w, 1), self._q(w, 2)
        cross = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        return np.asarray(np.abs(cross) / (self.speed(w) ** 3 * self._size))

    @cached_property
    def _arc(self) -> tuple[Array, Array]:
        """Ends w of panels, and the arc lengths S(w)/T there."""
        if self._panels is None:
            return np.array([0.0, 1.0]), np.array([0.0, self.speed(np.zeros(1))[0]])
        w, S = self._panels, self._sums(self._panels)
        while len(w) <= _MOST_PANELS:
            coarse, w = S, np.sort(np.append(w, 0.5 * (w[1:] + w[:-1])))
            S = self._sums(w)
            if np.max(np.abs(S[::2] - coarse)) <= _SETTLED * S[-1]:
                break
        return w, S

    def _sums(self, w: Array) -> Array:
        return np.concatenate(([0.0], np.cumsum(self._integral(w[:-1], w[1:]))))

    def _integral(self, low: Array, high: Array) -> Array:
        """Gauss–Legendre integrals (n,) of the speed from ``low`` (n,) to ``high`` (n,)."""
        half = 0.5 * (high - low)
        return np.asarray(self.speed(low[:, None] + half[:, None] * (1.0 + _NODES)) @ _WEIGHTS * half)

    def _places(self, u: Array) -> Array:
        """Parameters w (n,), read-only, at fractions ``u`` (n,), which are clipped to [0, 1]."""
        return u if self._panels is None else self._inverted(np.asarray(u, dtype=np.float64).tobytes())

    def _inverse(self, fractions: bytes) -> Array:
        ends, sums = self._arc
        S = np.clip(np.frombuffer(fractions), 0.0, 1.0) * sums[-1]
        panel = np.clip(np.searchsorted(sums, S, side="right") - 1, 0, len(ends) - 2)
        low, high, missing = ends[panel], ends[panel + 1], S - sums[panel]
        w = low + (high - low) * missing / (sums[panel + 1] - sums[panel])
        for _ in range(_NEWTON_STEPS):
            step = (missing - self._integral(low, w)) / self.speed(w)
            w = np.clip(w + step, low, high)
            if np.max(np.abs(step), initial=0.0) <= _CLOSE:
                break
        w.flags.writeable = False
        return np.asarray(w)


def straight_line(start: Point, end: Point) -> Curve:
    """Straight line between two points, m."""
    way = np.array(end) - np.array(start)
    return Curve(start, 1.0, lambda w, order: np.multiply.outer((w, np.ones_like(w), np.zeros_like(w))[order], way))


def circular_arc(center: Point, start: Point, end: Point, *, clockwise: bool) -> Curve:
    """Circular arc about ``center`` from ``start`` towards ``end``, m, with the radius of ``start``."""
    first, last = (atan2(place[1] - center[1], place[0] - center[0]) for place in (start, end))
    turn = -((first - last) % tau or tau) if clockwise else (last - first) % tau or tau

    def q(w: Array, order: int) -> Array:
        z = (1j * turn) ** order * np.exp(1j * (first + turn * w))
        return np.stack((z.real, z.imag), axis=-1)

    return Curve(center, dist(start, center), q)


def graph(coefficients: Sequence[float], first: float, last: float, *, along: int) -> Curve:
    """Graph y = f(x), or x = f(y) with ``along`` = 1, over a range from ``first`` to ``last``, m.

    ``coefficients`` are those of f, lowest power first, in metres for a variable in metres.
    """
    extent, sense = abs(last - first), float(np.sign(last - first))
    with np.errstate(over="ignore", invalid="ignore"):
        by_w = np.asarray(Polynomial(coefficients).convert(domain=[first, last], window=[0.0, 1.0]).coef, float)
        g = Polynomial([0.0, *by_w[1:] / extent])
        slope = g.deriv().trim(_NEGLIGIBLE * np.max(np.abs(g.deriv().coef)))
        # a steep graph has its sharpest bend where the graph is level
        level = slope.roots() if np.all(np.isfinite(g.coef)) else np.zeros(0)
        value = float(Polynomial(coefficients)(first))
        axes = [(each, each.deriv(), each.deriv(2)) for each in (Polynomial([0.0, sense]), g)]
    level = level.real[(np.abs(level.imag) < _REAL) & (level.real > 0.0) & (level.real < 1.0)]

    def q(w: Array, order: int) -> Array:
        return np.stack([np.asarray(each[order](w), dtype=np.float64) for each in axes[:: -1 if along else 1]], axis=-1)

    samples = np.union1d(np.linspace(0.0, 1.0, SAMPLES), level)
    return Curve((value, first) if along else (first, value), extent, q, np.linspace(0.0, 1.0, _PANELS + 1), samples)


def spline(points: Sequence[Point], directions: tuple[Point | None, Point | None]) -> Curve:
    """Cubic spline of the chord length through ``points`` (at least three), m.

    At an end with a direction the derivative is its unit vector; at an end without direction (None) the outer
    two pieces are the same cubic.
    """
    from scipy.interpolate import CubicSpline  # scenes without splines need no SciPy

    t = np.concatenate(([0.0], np.cumsum([dist(*pair) for pair in pairwise(points)])))
    w, size = t / t[-1], float(t[-1])
    ends = tuple("not-a-knot" if each is None else (1, unit_vector(each)) for each in directions)
    q = CubicSpline(w, (np.array(points) - np.array(points[0])) / size, bc_type=ends)
    of_piece = max(_FEWEST_OF_PIECE, min(_MOST_OF_PIECE, _MOST_OF_SPLINE // (len(w) - 1)))
    return Curve(points[0], size, q, _divided(w, _PANELS_OF_PIECE), _divided(w, of_piece - 1))


def _divided(w: Array, parts: int) -> Array:
    """The intervals between ``w`` (k+1,) cut into equal ``parts``: places (k·parts + 1,)."""
    return np.append(np.concatenate([np.linspace(*ends, parts, endpoint=False) for ends in pairwise(w)]), w[-1])


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
    minima = np.flatnonzero((values <= fence[:-2]) & (values <= fence[2:]) & (values.min() <= refined_below))
    found = [(float(values.min()), float(samples[values.argmin()]))]
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
