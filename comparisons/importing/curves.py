"""Record of a curve through points: a line or an arc where the points are exact, otherwise a spline.

======  ==========================================================================
symbol  meaning
======  ==========================================================================
p_k     points along the curve, (n, 2), m
L       length of the polyline through the points, m
c, R    centre and radius of the circle nearest to the points in the least squares, m
δ       largest distance of any p_k from the record
======  ==========================================================================

A line or an arc is exact to round-off: δ is at most EXACT·L.  A spline goes through some of the points, about twice as
many each time until δ is at most the allowed distance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely

from cprbm_scene import Arc, Line, Spline
from cprbm_scene.answer import Array
from cprbm_scene.curve_records import shape_of

EXACT = 1e-9
MOST = 257
"""Points of a spline."""

_DIGITS = 13
_FINE = 8001


@dataclass(frozen=True, slots=True)
class Fit:
    """A ``curve``, and the largest distance of the points from the curve, δ: ``deviation``, m."""

    curve: Line | Arc | Spline
    deviation: float


def fit(p: Array, directions: Array | None, allowed: float) -> Fit | None:
    """The record of points ``p`` (n, 2), m, in order; None if no spline of MOST points is near enough.

    Args:
        p: along the curve, both ends among them.
        directions: unit tangents (2, 2) at the ends; None without known tangents.
        allowed: δ of a spline, m.
    """
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(p, axis=0).T))])
    off = _distance(p, p[[0, -1]])
    # a line that turns back on itself is longer than the distance of the ends
    if max(off, s[-1] - float(np.hypot(*(p[-1] - p[0])))) <= EXACT * s[-1]:
        return Fit(Line(kind="line", start=_point(p[0], s[-1]), end=_point(p[-1], s[-1])), off)
    return _arc(p, s[-1]) or _spline(p, s, directions, allowed)


def _point(place: Array, L: float) -> tuple[float, float]:
    """A place to as many digits as its file has: 0.05 and not 0.05000000000000001."""
    x, y = (round(float(each), _DIGITS - math.ceil(math.log10(L))) + 0.0 for each in place)
    return x, y


def _arc(p: Array, L: float) -> Fit | None:
    """The arc through all points; None without such an arc."""
    # |q|² = 2 c·q + (R² − |c|²), about the mean so that nothing cancels
    q = p - p.mean(axis=0)
    c, rest = np.split(np.linalg.lstsq(np.column_stack([2.0 * q, np.ones(len(q))]), np.sum(q**2, axis=1))[0], [2])
    x, y = (q - c).T
    off = float(np.max(np.abs(np.hypot(x, y) - math.sqrt(max(rest[0] + c @ c, 0.0)))))
    turn = np.diff(np.unwrap(np.arctan2(y, x)))
    if len(p) < 4 or off > EXACT * L or abs(np.sum(np.sign(turn))) < len(turn):
        return None
    start, end, centre = (_point(place, L) for place in (p[0], p[-1], p.mean(axis=0) + c))
    way = "counterclockwise" if turn[0] > 0.0 else "clockwise"
    return Fit(Arc(kind="arc", center=centre, start=start, end=end, direction=way), off)  # type: ignore[arg-type]


def _spline(p: Array, s: Array, directions: Array | None, allowed: float) -> Fit | None:
    """The spline through the fewest points; ``s`` are the lengths of the polyline up to the points, m."""
    first, last = [None, None] if directions is None else [(float(x), float(y)) for x, y in directions]
    for count in 2 ** np.arange(2, math.log2(MOST)).astype(int) + 1:
        chosen = np.unique(np.abs(s[:, None] - np.linspace(0.0, s[-1], count)).argmin(axis=0))
        points = tuple(_point(place, s[-1]) for place in p[chosen])
        # few points may leave no smooth curve, and a curve with a mistake is still one to edit
        spline = Spline.model_construct(kind="spline", points=points, start_direction=first, end_direction=last)
        deviation = _distance(p, shape_of(spline).point(np.linspace(0.0, 1.0, _FINE)))
        if deviation <= allowed:
            return Fit(spline, deviation)
        if len(chosen) == len(p):
            break
    return None


def _distance(p: Array, line: Array) -> float:
    """Largest distance of points (n, 2) from a polyline (m, 2)."""
    return float(np.max(shapely.distance(shapely.points(p), shapely.LineString(line))))
