"""Stress-free neutral lines through points, by arc length.

=======  ==========================================================================
symbol   meaning
=======  ==========================================================================
t        accumulated chords between the points; P(t) cubic between the points
v        |P'| = ds/dt
c        P' × P'', so that κ = c/v³;  c' = P' × P''',  c'' = P'' × P'''
=======  ==========================================================================

κ is smooth between the points and has a kink at every point, where a beam is divided into pieces.
"""

from typing import Literal

import numpy as np

from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import Point, Spline

_NODES, _INVERSIONS = 20, 10
_CUTS = 8  # parts of a piece, for arc length and angle


class Interpolated:
    """A line through points; functions map arc lengths (n,), in units of length, to values (n,)."""

    def __init__(self, curve: Spline, unit: float) -> None:
        from scipy.interpolate import CubicSpline  # imported for splines only

        points = np.array(curve.points) / unit
        t = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))))
        ends = (_condition(curve.start_direction), _condition(curve.end_direction))
        self._P = CubicSpline(t, points, bc_type=ends)
        x, w = np.polynomial.legendre.leggauss(_NODES)
        self._x, self._w = 0.5 * (x + 1.0), 0.5 * w
        self._t = np.interp(np.arange(_CUTS * (len(t) - 1) + 1) / _CUTS, np.arange(len(t)), t)
        self._s = np.concatenate(([0.0], np.cumsum(self._arc(self._t[:-1], self._t[1:]))))
        dx, dy = self._P(self._t, 1).T
        self._angle = np.unwrap(np.arctan2(dy, dx))
        inner = self._s[_CUTS:-1:_CUTS]
        smooth = (curve.start_direction is None, curve.end_direction is None)
        self.kinks = tuple(map(float, inner[smooth[0] : len(inner) - smooth[1]]))

    @property
    def length(self) -> float:
        """Arc length of the line."""
        return float(self._s[-1])

    def _speed(self, t: Array) -> Array:
        return np.asarray(np.linalg.norm(self._P(t, 1), axis=-1))

    def _arc(self, begin: Array, end: Array) -> Array:
        across = end - begin
        return np.asarray(across * (self._speed(begin[..., None] + across[..., None] * self._x) @ self._w))

    def _variable(self, s: Array) -> tuple[Array, Ints]:
        """t and its part of a piece; the line continues beyond its ends."""
        s = np.asarray(s, dtype=float)
        cut = np.clip(np.searchsorted(self._s, s, side="right") - 1, 0, len(self._t) - 2)
        begin, rest = self._t[cut], s - self._s[cut]
        t = begin + rest / self._speed(begin)
        for _ in range(_INVERSIONS):
            step = (rest - self._arc(begin, t)) / self._speed(t)
            t = t + step
            if np.max(np.abs(step), initial=0.0) < 1e-15 * self.length:
                break
        return np.asarray(t), cut

    def angle(self, s: Array) -> Array:
        """θ."""
        t, cut = self._variable(s)
        dx, dy = self._P(t, 1).T
        cos, sin = np.cos(self._angle[cut]), np.sin(self._angle[cut])
        return np.asarray(self._angle[cut] + np.arctan2(cos * dy - sin * dx, cos * dx + sin * dy))

    def curvature(self, s: Array) -> Array:
        """κ."""
        t, _ = self._variable(s)
        return np.asarray(_cross(self._P(t, 1), self._P(t, 2)) / self._speed(t) ** 3)

    def curvature_slope(self, s: Array) -> Array:
        """κ'."""
        rate, _, v, _ = self._rates(s)
        return np.asarray(rate / v)

    def curvature_second(self, s: Array) -> Array:
        """κ''."""
        rate, second, v, v1 = self._rates(s)
        return np.asarray((second - rate * v1 / v) / v**2)

    def place(self, s: Array) -> Array:
        """Points (2, n)."""
        return np.asarray(np.moveaxis(self._P(self._variable(s)[0]), -1, 0))

    def _rates(self, s: Array) -> tuple[Array, Array, Array, Array]:
        """dκ/dt, d²κ/dt², v and dv/dt."""
        t, _ = self._variable(s)
        P1, P2, P3 = (self._P(t, order) for order in (1, 2, 3))
        v = self._speed(t)
        v1 = np.sum(P1 * P2, axis=-1) / v
        v2 = (np.sum(P2 * P2 + P1 * P3, axis=-1) - v1**2) / v
        c, c1, c2 = _cross(P1, P2), _cross(P1, P3), _cross(P2, P3)
        rate = c1 / v**3 - 3.0 * c * v1 / v**4
        second = c2 / v**3 - (6.0 * c1 * v1 + 3.0 * c * v2) / v**4 + 12.0 * c * v1**2 / v**5
        return rate, second, v, v1


def _condition(direction: Point | None) -> Literal["not-a-knot"] | tuple[int, Array]:
    return "not-a-knot" if direction is None else (1, np.array(direction) / np.hypot(*direction))


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
