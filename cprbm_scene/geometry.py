"""Where a beam's neutral line lies, and how near two of them come.

=======  =========================================================
symbol   meaning
=======  =========================================================
u        fraction of a curve's arc length, 0 at its start, 1 at its end
L        arc length, m
p(u)     point of the neutral line, m
d        distance of two neutral lines' points, m
=======  =========================================================

This is the shape that the scene states and nothing else: no bending, no gap function of any solver.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, hypot, tau

import numpy as np
from numpy.typing import NDArray

from cprbm_scene import polynomial, spline
from cprbm_scene.statement import Arc, Curve, Point, Polynomial, Spline

Array = NDArray[np.float64]
_SAMPLES = 1001  # per curve: 1e-3 of the length between neighbours, the rest is refinement
_REFINED = 5


@dataclass(frozen=True, slots=True)
class ClosestPair:
    """The nearest points of two curves: ``distance`` in metres, and where, as fractions ``u``."""

    distance: float
    u1: float
    u2: float


def arc_angle(arc: Arc) -> float:
    """Angle through which the arc runs from start to end, rad, in (0, 2π]; positive counter-clockwise."""
    first, last = _angle(arc, arc.start), _angle(arc, arc.end)
    if arc.direction == "counterclockwise":
        return (last - first) % tau or tau
    return -((first - last) % tau or tau)


def arc_length(curve: Curve) -> float:
    """Arc length L of the neutral line, m."""
    if isinstance(curve, Polynomial):
        return polynomial.length(curve)
    if isinstance(curve, Spline):
        return spline.length(curve)
    if isinstance(curve, Arc):
        return abs(arc_angle(curve)) * _radius(curve)
    return distance(curve.start, curve.end)


def largest_curvature(curve: Curve) -> float:
    """Largest absolute curvature of the neutral line, 1/m."""
    if isinstance(curve, Polynomial):
        return polynomial.largest_curvature(curve)
    if isinstance(curve, Spline):
        return spline.largest_curvature(curve)
    return 1.0 / _radius(curve) if isinstance(curve, Arc) else 0.0


def curvature_on(curve: Curve, u: Array) -> Array:
    """Absolute curvature (n,), 1/m, at the fractions ``u`` (n,)."""
    if isinstance(curve, Polynomial):
        return polynomial.curvature(curve, u)
    if isinstance(curve, Spline):
        return spline.curvature(curve, u)
    return np.full(u.shape, 1.0 / _radius(curve) if isinstance(curve, Arc) else 0.0)


def points_on(curve: Curve, u: Array) -> Array:
    """p(u) (n, 2), m, at the fractions ``u`` (n,)."""
    if isinstance(curve, Polynomial):
        return polynomial.points(curve, u)
    if isinstance(curve, Spline):
        return spline.points(curve, u)
    if isinstance(curve, Arc):
        angle = _angle(curve, curve.start) + arc_angle(curve) * u
        radius = _radius(curve)
        return np.column_stack(
            [
                curve.center[0] + radius * np.cos(angle),
                curve.center[1] + radius * np.sin(angle),
            ]
        )
    start, end = np.array(curve.start), np.array(curve.end)
    return np.asarray(start + u[:, None] * (end - start))


def closest_pair(
    first: Curve,
    second: Curve,
    range1: tuple[float, float] = (0.0, 1.0),
    range2: tuple[float, float] = (0.0, 1.0),
) -> ClosestPair:
    """The nearest points of two curves, each within a range of u: sampled, then refined.

    The refined distance is exact to round-off where the nearest point is a smooth minimum or an end of the
    range; of places equally near it gives one.
    """
    from scipy.spatial import cKDTree  # loaded when two curves are compared, not with every scene

    u1, u2 = np.linspace(*range1, _SAMPLES), np.linspace(*range2, _SAMPLES)
    p1 = points_on(first, u1)
    _, neighbour = cKDTree(points_on(second, u2)).query(p1)
    # one step along the tangent takes the neighbour to the foot of the perpendicular: without it the samples'
    # spacing would hide a shallow crossing
    beside = ((p1 - points_on(second, u2[neighbour])) * tangents_on(second, u2[neighbour])).sum(axis=1)
    foot = np.clip(u2[neighbour] + beside / arc_length(second), *range2)
    distance = np.hypot(*(p1 - points_on(second, foot)).T)
    # a place that looks second best in the samples may be the best: refine the lowest few local minima
    fence = np.pad(distance, 1, constant_values=np.inf)
    minima = np.flatnonzero((distance <= fence[:-2]) & (distance <= fence[2:]))
    lowest = minima[np.argsort(distance[minima], kind="stable")[:_REFINED]]
    pairs = [_refined(first, second, (u1[i], foot[i]), range1, range2) for i in lowest]
    return min(pairs, key=lambda pair: pair.distance)


def _refined(
    first: Curve,
    second: Curve,
    at: tuple[float, float],
    range1: tuple[float, float],
    range2: tuple[float, float],
) -> ClosestPair:
    """The nearest points within a few sample widths of ``at``."""
    from scipy.optimize import minimize

    widths = np.array([np.ptp(range1), np.ptp(range2)]) / _SAMPLES
    # distances over a sample's length: the minimiser sees numbers of order one
    scale = max(arc_length(first), arc_length(second)) / _SAMPLES

    def squared(z: Array) -> float:
        u = at + widths * z
        p, q = points_on(first, u[:1])[0], points_on(second, u[1:])[0]
        return float((((p - q) / scale) ** 2).sum())

    bounds = [
        (max(-3.0, (low - u) / width), min(3.0, (high - u) / width))
        for u, width, (low, high) in zip(at, widths, (range1, range2), strict=True)
    ]
    found = minimize(squared, np.zeros(2), method="L-BFGS-B", bounds=bounds, options={"ftol": 0.0, "gtol": 1e-12})
    best = min((np.zeros(2), found.x), key=squared)
    u = np.clip(at + widths * best, [range1[0], range2[0]], [range1[1], range2[1]])
    return ClosestPair(distance=squared(best) ** 0.5 * scale, u1=float(u[0]), u2=float(u[1]))


def distance(a: Point, b: Point) -> float:
    """Distance of two points, m."""
    return hypot(b[0] - a[0], b[1] - a[1])


def largest_coordinate(curve: Curve) -> float:
    """The largest magnitude of a coordinate among a curve's ends, an arc's center and a spline's points, m."""
    places = [curve.start, curve.end]
    if isinstance(curve, Arc):
        places.append(curve.center)
    elif isinstance(curve, Spline):
        places.extend(curve.points)
    return max(abs(coordinate) for place in places for coordinate in place)


def distance_to(curve: Curve, point: Point) -> float:
    """Distance of the neutral line's nearest point from ``point``, m."""
    if isinstance(curve, Polynomial):
        return polynomial.distance_to(curve, point)
    if isinstance(curve, Spline):
        return spline.distance_to(curve, point)
    ends = min(distance(curve.start, point), distance(curve.end, point))
    if isinstance(curve, Arc):
        turn, towards = arc_angle(curve), _angle(curve, point)
        beyond = (towards - _angle(curve, curve.start)) * (1.0 if turn > 0.0 else -1.0) % tau
        if beyond > abs(turn):
            return ends
        return min(ends, abs(distance(curve.center, point) - _radius(curve)))
    length = arc_length(curve)
    tx, ty = (curve.end[0] - curve.start[0]) / length, (curve.end[1] - curve.start[1]) / length
    rx, ry = point[0] - curve.start[0], point[1] - curve.start[1]
    return abs(tx * ry - ty * rx) if 0.0 < tx * rx + ty * ry < length else ends


def tangents_on(curve: Curve, u: Array) -> Array:
    """Unit tangents (n, 2) at the fractions ``u`` (n,), from start to end."""
    if isinstance(curve, Polynomial):
        return polynomial.tangents(curve, u)
    if isinstance(curve, Spline):
        return spline.tangents(curve, u)
    if isinstance(curve, Arc):
        turn = np.sign(arc_angle(curve))
        angle = _angle(curve, curve.start) + arc_angle(curve) * u
        return np.column_stack([-turn * np.sin(angle), turn * np.cos(angle)])
    along = np.array(curve.end) - np.array(curve.start)
    return np.tile(along / np.hypot(*along), (len(u), 1))


def scaled(curve: Curve, size: float) -> Curve:
    """The same curve with every coordinate divided by ``size``."""
    if isinstance(curve, Polynomial):
        return polynomial.scaled(curve, size)
    if isinstance(curve, Spline):
        return spline.scaled(curve, size)
    lengths = {
        name: (getattr(curve, name)[0] / size, getattr(curve, name)[1] / size)
        for name in (("start", "end", "center") if isinstance(curve, Arc) else ("start", "end"))
    }
    return curve.model_copy(update=lengths)


def _angle(arc: Arc, point: Point) -> float:
    return atan2(point[1] - arc.center[1], point[0] - arc.center[0])


def _radius(arc: Arc) -> float:
    return distance(arc.start, arc.center)
