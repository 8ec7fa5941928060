"""A neutral line through points, by fractions of its arc length.

=======  =====================================================================================
symbol   meaning
=======  =====================================================================================
T        sum of the distances between the points, m
w        t/T, in [0, 1]; w_k at the points
q(w)     place less the start, over T: q' is the derivative by t
S(w)     arc length over T, S' = |q'|
u        fraction of the arc length
κ        |q' × q''|/(T S'³), absolute curvature, 1/m
=======  =====================================================================================

Chords for t are what keeps the line near a smooth one through the points, to the fourth power of their distance, also
where these differ (M. S. Floater, Chordal cubic spline interpolation is fourth-order accurate, IMA Journal of Numerical
Analysis 26 (2006) 25-33).  How S is integrated and inverted stands in :mod:`cprbm_scene.by_arc_length`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import dist

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.by_arc_length import ByArcLength, by_arc_length
from cprbm_scene.sampling import least
from cprbm_scene.statement import Point, Spline

Array = NDArray[np.float64]
_PANELS = 4  # of a piece, to begin with
_SAMPLES = 65  # of a piece; of many pieces fewer in each
_FEWEST, _MOST = 9, 4001


@dataclass(frozen=True, slots=True)
class _Pieces:
    """w_k (k+1,), coefficients of q by w − w_k, highest first (4, k, 2), T, and S(w)."""

    w: Array
    q: Array
    size: float
    arc: ByArcLength


def chords(curve: Spline) -> list[float]:
    """Distances from each point to the next, m."""
    return [dist(first, second) for first, second in pairwise(curve.points)]


def slowest(curve: Spline) -> tuple[float, Point]:
    """The least |q'|, and the place where it is; it has no unit, and is zero at a cusp."""
    pieces = _pieces(curve)
    w = _dense(pieces)
    speed = np.hypot(*_derivative(pieces.w, pieces.q, w, 1).T)
    place = _derivative(pieces.w, pieces.q, w[[np.argmin(speed)]], 0)[0] * pieces.size + np.array(curve.start)
    return float(np.min(speed)), (float(place[0]), float(place[1]))


def length(curve: Spline) -> float:
    """Arc length, m."""
    pieces = _pieces(curve)
    return pieces.arc.whole * pieces.size


def largest_curvature(curve: Spline) -> float:
    """The largest κ, 1/m."""
    pieces = _pieces(curve)
    return -least(lambda w: -_curvature(pieces, w), _dense(pieces)) / pieces.size


def curvature(curve: Spline, u: Array) -> Array:
    """κ (n,), 1/m, at the fractions ``u`` (n,)."""
    pieces = _pieces(curve)
    return _curvature(pieces, pieces.arc.places(u)) / pieces.size


def points(curve: Spline, u: Array) -> Array:
    """Points (n, 2), m, at the fractions ``u`` (n,)."""
    pieces = _pieces(curve)
    q = _derivative(pieces.w, pieces.q, pieces.arc.places(u), 0)
    return np.asarray(np.array(curve.start) + pieces.size * q)


def tangents(curve: Spline, u: Array) -> Array:
    """Unit tangents (n, 2) at the fractions ``u`` (n,), from start to end."""
    pieces = _pieces(curve)
    along = _derivative(pieces.w, pieces.q, pieces.arc.places(u), 1)
    return np.asarray(along / np.hypot(along[:, 0], along[:, 1])[:, None])


def distance_to(curve: Spline, point: Point) -> float:
    """Distance of the nearest point from ``point``, m."""
    pieces = _pieces(curve)
    offset = (np.array(point) - np.array(curve.start)) / pieces.size

    def distance(w: Array) -> Array:
        return np.asarray(np.hypot(*(_derivative(pieces.w, pieces.q, w, 0) - offset).T))

    return least(distance, _dense(pieces)) * pieces.size


def scaled(curve: Spline, size: float) -> Spline:
    """The same curve with every coordinate divided by ``size``."""
    return curve.model_copy(update={"points": tuple((x / size, y / size) for x, y in curve.points)})


@lru_cache(maxsize=128)
def _pieces(curve: Spline) -> _Pieces:
    from scipy.interpolate import CubicSpline  # loaded when a curve is measured, not with every scene

    t = np.concatenate(([0.0], np.cumsum(chords(curve))))
    w, size = t / t[-1], float(t[-1])
    places = (np.array(curve.points) - np.array(curve.start)) / size
    ends = [
        "not-a-knot" if direction is None else (1, np.array(direction) / np.hypot(*direction))
        for direction in (_order_one(curve.start_direction), _order_one(curve.end_direction))
    ]
    q = np.asarray(CubicSpline(w, places, bc_type=tuple(ends)).c, dtype=np.float64)
    panels = np.concatenate([np.linspace(*ends, _PANELS, endpoint=False) for ends in pairwise(w)])
    arc = by_arc_length(lambda at: _speed(w, q, at), np.append(panels, 1.0))
    return _Pieces(w, q, size, arc)


def _order_one(direction: Point | None) -> Point | None:
    """The direction with a larger part of one, so that it may be squared."""
    if direction is None:
        return None
    largest = max(abs(direction[0]), abs(direction[1]))
    return direction[0] / largest, direction[1] / largest


def _dense(pieces: _Pieces) -> Array:
    """Places on all pieces, the points among them."""
    each = max(_FEWEST, min(_SAMPLES, _MOST // (len(pieces.w) - 1)))
    inner = np.concatenate([np.linspace(*ends, each - 1, endpoint=False) for ends in pairwise(pieces.w)])
    return np.append(inner, 1.0)


def _derivative(w: Array, q: Array, at: Array, order: int) -> Array:
    """A derivative of q, (..., 2), at places of any shape."""
    piece = np.clip(np.searchsorted(w, at, side="right") - 1, 0, len(w) - 2)
    v = (at - w[piece])[..., None]
    a, b = q[0, piece], q[1, piece]
    if order == 0:
        return np.asarray(q[3, piece] + v * (q[2, piece] + v * (b + v * a)))
    if order == 1:
        return np.asarray(q[2, piece] + v * (2.0 * b + v * (3.0 * a)))
    return np.asarray(2.0 * b + 6.0 * v * a)


def _speed(w: Array, q: Array, at: Array) -> Array:
    along = _derivative(w, q, at, 1)
    return np.asarray(np.hypot(along[..., 0], along[..., 1]))


def _curvature(pieces: _Pieces, at: Array) -> Array:
    """κ·T."""
    first, second = (_derivative(pieces.w, pieces.q, at, order) for order in (1, 2))
    return np.asarray(
        np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / np.hypot(first[:, 0], first[:, 1]) ** 3
    )
