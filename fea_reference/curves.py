"""Points and tangents of a scene's curve, by arc length.

======  =============================================
symbol  meaning
======  =============================================
s       arc length from the curve's start, m
x, y    position, m
ψ       tangent angle, continuous along the curve, rad
======  =============================================
"""

import math

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import Arc, Curve, Line, Polynomial, Spline
from fea_reference import polynomial, spline


def length(curve: Curve) -> float:
    """Arc length, m."""
    match curve:
        case Line():
            return math.dist(curve.start, curve.end)
        case Arc():
            return math.dist(curve.center, curve.start) * abs(_turning(curve))
        case Polynomial():
            return polynomial.length(curve)
        case Spline():
            return spline.length(curve)


def sample(curve: Curve, fractions: Array) -> tuple[Array, Array]:
    """Positions (n, 2) in m and tangent angles (n,) in rad at ``fractions`` (n,) of the arc length."""
    start = np.array(curve.start)
    match curve:
        case Line():
            end = np.array(curve.end)
            points = start + fractions[:, None] * (end - start)
            return points, np.full(fractions.shape, math.atan2(end[1] - start[1], end[0] - start[0]))
        case Arc():
            turning = _turning(curve)
            centre = np.array(curve.center)
            radius = math.dist(curve.center, curve.start)
            polar = math.atan2(start[1] - centre[1], start[0] - centre[0]) + turning * fractions
            points = centre + radius * np.stack([np.cos(polar), np.sin(polar)], axis=1)
            return points, polar + math.copysign(math.pi / 2, turning)
        case Polynomial():
            return polynomial.sample(curve, fractions)
        case Spline():
            return spline.sample(curve, fractions)


def _turning(arc: Arc) -> float:
    """Angle from start to end about the centre, positive counter-clockwise, less than a full turn."""
    (cx, cy), (ax, ay), (bx, by) = arc.center, arc.start, arc.end
    swept = (math.atan2(by - cy, bx - cx) - math.atan2(ay - cy, ax - cx)) % (2 * math.pi)
    return swept if arc.direction == "counterclockwise" else swept - 2 * math.pi
