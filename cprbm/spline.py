"""The stress-free neutral line through points, by arc length.

======  ===========================================================================================
t       parameter: distances between the points, summed, m; t_k at the points
x, y    cubics of t between the points, from the line's start, m
θ       tangent angle, continuous: from one panel's end to a place it turns by less than half a turn
κ       (x'y'' − y'x'')/(x'² + y'²)^(3/2), 1/m; continuous, with kinks at the points
======  ===========================================================================================
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cprbm.panels import Panels, panelled
from cprbm.polynomial import Places
from cprbm_scene import Spline
from cprbm_scene.answer import Array
from cprbm_scene.statement import Point

PANELS = 8  # of a piece, to begin with
CUBIC = 3

Function = Callable[[Array], Array]
"""(x, y) or a derivative, (..., 2), at t of any shape."""


@dataclass(frozen=True, slots=True)
class SplineLine:
    """A curve through points.

    Attributes:
        x0, y0: position of the start, m.
        curves: (x, y) and its first and second derivatives, by t.
        panels: t and arc length, m.
        angles: θ at the panels' ends.
    """

    x0: float
    y0: float
    curves: tuple[Function, Function, Function]
    panels: Panels
    angles: Array

    @property
    def length(self) -> float:
        """Arc length, m."""
        return self.panels.length

    def angle(self, s: Array) -> Array:
        """Tangent angle θ(s), rad."""
        t = self.panels.inverted(s)
        x1, y1 = self.curves[1](t).T
        panel = np.minimum(np.searchsorted(self.panels.v, t, side="right") - 1, len(self.angles) - 2)
        begin = self.angles[panel]
        cos, sin = np.cos(begin), np.sin(begin)
        return np.asarray(begin + np.arctan2(y1 * cos - x1 * sin, x1 * cos + y1 * sin))

    def position(self, s: Array) -> tuple[Array, Array]:
        """Position x(s), y(s), m."""
        here = self.at(s)
        return self.x0 + here.x, self.y0 + here.y

    def chords(self, s: Array) -> tuple[Array, Array]:
        """Lengths, m, and directions, rad, of the chords between places ``s`` (n,): two arrays (n−1,)."""
        here = self.at(s)
        dx, dy = np.diff(here.x), np.diff(here.y)
        between = self.angle(0.5 * (s[1:] + s[:-1]))
        cos, sin = np.cos(between), np.sin(between)
        return np.hypot(dx, dy), between + np.arctan2(dy * cos - dx * sin, dx * cos + dy * sin)

    def at(self, s: Array) -> Places:
        """Places at arc lengths ``s`` (k,), m; beyond the ends the end itself."""
        t = self.panels.inverted(s)
        (x, y), (x1, y1), (x2, y2) = (curve(t).T for curve in self.curves)
        speed = np.hypot(x1, y1)
        return Places(x=x, y=y, tangent=(x1 + 1j * y1) / speed, curvature=(x1 * y2 - y1 * x2) / speed**3)


def spline_line(curve: Spline) -> SplineLine:
    """Arc-length form of a scene's spline."""
    places = np.array(curve.points) - np.array(curve.start)
    t = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))))
    position, first, second = _interpolated(t, places, curve.start_direction, curve.end_direction)

    def speed(at: Array) -> Array:
        along = first(at)
        return np.hypot(along[..., 0], along[..., 1])

    shares = np.arange(PANELS) / PANELS
    ends = np.append((t[:-1, None] + np.diff(t)[:, None] * shares).ravel(), t[-1])
    panels = panelled(speed, ends)
    along = first(panels.v)
    angles = np.unwrap(np.arctan2(along[:, 1], along[:, 0]))
    return SplineLine(*curve.start, (position, first, second), panels, angles)


def _interpolated(t: Array, places: Array, start: Point | None, end: Point | None) -> list[Function]:
    """Cubics through ``places`` (k, 2), with unit derivatives at the ends that have a direction, and two derivatives.

    An end without one has no knot at the point next to it: the outer two pieces are one cubic.
    """
    from scipy.interpolate import make_interp_spline  # loaded when a beam is a spline

    given = [start is not None, end is not None]
    degree = min(CUBIC, len(t) - 1 + sum(given))
    inner = t[(1 if given[0] else 2) : len(t) - (1 if given[1] else 2)]
    knots = np.concatenate((np.full(degree + 1, t[0]), inner, np.full(degree + 1, t[-1])))
    conditions = [
        None if direction is None else [(1, np.array(direction) / np.hypot(*direction))] for direction in (start, end)
    ]
    found = make_interp_spline(t, places, k=degree, t=knots, bc_type=tuple(conditions))
    return [found, found.derivative(1), found.derivative(2)]
