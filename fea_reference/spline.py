"""A spline through points as neutral line, by fractions of its arc length.

=======  =============================================================================
symbol   meaning
=======  =============================================================================
v        parameter: at the points their accumulated distances, m
P        position minus start, m: a cubic of v between the points
m        P' at the points
h, d     length of a piece in v, and increment of P over h
S(v)     arc length, m, S' = |P'|, :mod:`fea_reference.pieces`
=======  =============================================================================

The slopes m make P'' continuous at the points (C. de Boor, A Practical Guide to Splines, ch. IV):

    h_k m_{k−1} + 2 (h_{k−1} + h_k) m_k + h_{k−1} m_{k+1} = 3 (h_k d_{k−1} + h_{k−1} d_k)

At an end with a direction m is the unit vector of the direction. At an end without, the third derivative is
continuous at the next point (not-a-knot):

    h₁ m₀ + (h₀ + h₁) m₁ = ((h₀ + 2 (h₀ + h₁)) h₁ d₀ + h₀² d₁)/(h₀ + h₁)

For three points without directions both end conditions coincide; the curve is then a parabola.
"""

import math
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import Point, Spline
from fea_reference.hermite import shape_slopes, shapes
from fea_reference.pieces import pieces_of, places, total

_STEPS = 64  # steps per piece, with less than half a turn of the tangent in between


@dataclass(frozen=True, slots=True)
class _Cubics:
    """``v`` (k+1,), P (k+1, 2) and m (k+1, 2) at the points."""

    v: Array
    P: Array
    m: Array

    def at(self, v: Array) -> tuple[Array, Array]:
        """P and P' (n, 2) at places (n,)."""
        piece = np.clip(np.searchsorted(self.v, v, side="right") - 1, 0, self.v.size - 2)
        h = np.diff(self.v)[piece]
        xi = (v - self.v[piece]) / h
        ends = np.stack([self.P[piece], h[:, None] * self.m[piece], self.P[piece + 1], h[:, None] * self.m[piece + 1]])
        place = np.einsum("in,inj->nj", shapes(xi), ends)
        return place, np.einsum("in,inj->nj", shape_slopes(xi), ends) / h[:, None]

    def speed(self, v: Array) -> Array:
        """S'."""
        return np.asarray(np.hypot(*self.at(v)[1].T))


def length(curve: Spline) -> float:
    """Arc length, m."""
    cubics = _cubics(curve)
    return total(pieces_of(cubics.speed, cubics.v.tolist()))


def sample(curve: Spline, fractions: Array) -> tuple[Array, Array]:
    """Positions (n, 2) in m and tangent angles (n,) in rad, continuous, at ``fractions`` (n,) of the arc length."""
    cubics = _cubics(curve)
    v = places(cubics.speed, pieces_of(cubics.speed, cubics.v.tolist()), fractions)
    number = np.arange(cubics.v.size)
    fine = np.union1d(np.interp(np.arange(_STEPS * number[-1] + 1) / _STEPS, number, cubics.v), v)
    dx, dy = cubics.at(fine)[1].T
    angle = np.unwrap(np.arctan2(dy, dx))
    return cubics.at(v)[0] + np.array(curve.start), np.asarray(angle[np.searchsorted(fine, v)])


def _cubics(curve: Spline) -> _Cubics:
    P = np.array(curve.points) - np.array(curve.start)
    steps = np.diff(P, axis=0)
    h = np.hypot(steps[:, 0], steps[:, 1])
    d, n = steps / h[:, None], len(P)
    A, b = np.zeros((n, n)), np.zeros((n, 2))
    for k in range(1, n - 1):
        A[k, k - 1 : k + 2] = h[k], 2.0 * (h[k - 1] + h[k]), h[k - 1]
        b[k] = 3.0 * (h[k] * d[k - 1] + h[k - 1] * d[k])
    A[0, :2], b[0] = _end(curve.start_direction, h[0], h[1], d[0], d[1])
    A[-1, :-3:-1], b[-1] = _end(curve.end_direction, h[-1], h[-2], d[-1], d[-2])
    if n == 3 and curve.start_direction is None and curve.end_direction is None:
        # the slope of a parabola is linear over every piece
        A[-1], b[-1] = (0.0, 1.0, 1.0), 2.0 * d[1]
    return _Cubics(np.concatenate(([0.0], np.cumsum(h))), P, np.asarray(np.linalg.solve(A, b), dtype=np.float64))


def _end(direction: Point | None, h0: float, h1: float, d0: Array, d1: Array) -> tuple[tuple[float, float], Array]:
    """Equation of an end: coefficients of m at the end and at the next point, and the right-hand side."""
    if direction is not None:
        return (1.0, 0.0), np.array(direction) / math.hypot(*direction)
    both = h0 + h1
    return (h1, both), ((h0 + 2.0 * both) * h1 * d0 + h0 * h0 * d1) / both
