"""Points along a curve made the record of a scene: a line or an arc where they are one, else a spline.

======  ==========================================================================
symbol  meaning
======  ==========================================================================
p_k     points along the curve, (n, 2), m
L       length of the polyline through them, m
c, R    centre and radius of the circle that is nearest in the least squares, m
δ       largest distance of any p_k from the record
======  ==========================================================================

A line or an arc is one to round-off: δ is at most EXACT·L.  A spline goes through some of the points, about twice as
many each time until δ is at most what is allowed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from cprbm_scene import Arc, Line, Spline
from cprbm_scene.answer import Array
from cprbm_scene.curve_records import shape_of

EXACT = 1e-9
MOST = 257
"""Points of a spline."""

_DIGITS = 13
_FINE = 8001


@dataclass(frozen=True, slots=True)
class Fitted:
    """A ``curve`` and how far the points are from it at most: ``deviation``, m."""

    curve: Line | Arc | Spline
    deviation: float


def fitted(p: Array, directions: Array | None, allowed: float) -> Fitted | None:
    """The record of points ``p`` (n, 2), m, in order.

    Args:
        p: along the curve, both ends among them.
        directions: unit tangents (2, 2) at the ends, or None where they are not known.
        allowed: δ of a spline, m.

    Returns:
        None if no spline of MOST points is near enough.
    """
    L = float(np.hypot(*np.diff(p, axis=0).T).sum())
    line = Line(kind="line", start=_point(p[0], L), end=_point(p[-1], L))
    if (off := _off_line(p)) <= EXACT * L:
        return Fitted(line, off)
    arc = _arc(p, L)
    return arc if arc is not None else _spline(p, directions, allowed, L)


def _point(place: Array, L: float) -> tuple[float, float]:
    """A place to as many digits as its file has: 0.05 and not 0.05000000000000001."""
    digits = _DIGITS - math.ceil(math.log10(L))
    x, y = (round(float(each), digits) + 0.0 for each in place)
    return x, y


def _off_line(p: Array) -> float:
    way = p[-1] - p[0]
    size = float(np.hypot(*way))
    if size == 0.0:
        return math.inf
    away, along = p - p[0], (p - p[0]) @ way / size
    if np.any(np.diff(along) < 0.0):
        return math.inf
    return float(np.max(np.abs(away[:, 0] * way[1] - away[:, 1] * way[0]))) / size


def _arc(p: Array, L: float) -> Fitted | None:
    # |p|² = 2 c·p + (R² − |c|²), about the mean so that nothing cancels
    mean = p.mean(axis=0)
    q = p - mean
    (cx, cy, rest), *_ = np.linalg.lstsq(np.column_stack([2.0 * q, np.ones(len(q))]), np.sum(q**2, axis=1), rcond=None)
    R = math.sqrt(max(rest + cx**2 + cy**2, 0.0))
    off = float(np.max(np.abs(np.hypot(q[:, 0] - cx, q[:, 1] - cy) - R)))
    turn = np.diff(np.unwrap(np.arctan2(q[:, 1] - cy, q[:, 0] - cx)))
    if off > EXACT * L or not (np.all(turn > 0.0) or np.all(turn < 0.0)) or len(p) < 4:
        return None
    way: Literal["counterclockwise", "clockwise"] = "counterclockwise" if turn[0] > 0.0 else "clockwise"
    centre = _point(mean + np.array([cx, cy]), L)
    return Fitted(
        Arc(kind="arc", center=centre, start=_point(p[0], L), end=_point(p[-1], L), direction=way),
        off,
    )  # fmt: skip


def _spline(p: Array, directions: Array | None, allowed: float, L: float) -> Fitted | None:
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(p, axis=0).T))])
    count = 5
    while count <= MOST:
        chosen = np.unique([int(np.argmin(np.abs(s - each))) for each in np.linspace(0.0, L, count)])
        ends = [None, None] if directions is None else [(float(x), float(y)) for x, y in directions]
        spline = Spline(
            kind="spline",
            points=tuple(_point(p[k], L) for k in chosen),
            start_direction=ends[0],
            end_direction=ends[1],
        )
        deviation = _distance(p, shape_of(spline).point(np.linspace(0.0, 1.0, _FINE)))
        if deviation <= allowed:
            return Fitted(spline, deviation)
        if len(chosen) == len(p):
            return None
        count = 2 * count - 1
    return None


def _distance(p: Array, fine: Array) -> float:
    """Largest distance of points (n, 2) from a polyline (m, 2) that is near them all along."""
    from scipy.spatial import KDTree

    _, nearest = KDTree(fine).query(p)
    found = np.full(len(p), np.inf)
    for first in (np.maximum(nearest - 1, 0), np.minimum(nearest, len(fine) - 2)):
        way, away = fine[first + 1] - fine[first], p - fine[first]
        share = np.clip(np.sum(away * way, axis=1) / np.maximum(np.sum(way**2, axis=1), 1e-300), 0.0, 1.0)
        found = np.minimum(found, np.hypot(*(away - share[:, None] * way).T))
    return float(found.max())
