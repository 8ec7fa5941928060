"""What the harness itself must know of a neutral line: its length, its points and its curvature.

The solvers derive their own; nothing here is handed to them.

======  ===================================================
symbol  meaning
======  ===================================================
s       arc length from the beam's start, m
R       radius of an arc, m
φ       angle that an arc turns through, counter-clockwise
======  ===================================================

Of a polynomial and a spline they are what the scene's own geometry says, :func:`cprbm_scene.curve_records.shape_of`.
"""

from __future__ import annotations

import math
from typing import TypeAlias, assert_never

import numpy as np

from cprbm_scene import Arc, Beam, Line, Polynomial, Scene, Spline
from cprbm_scene.answer import Array
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import (
    Curve,
    EdgeContact,
    EllipseContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    SplineContact,
)

RigidEdge: TypeAlias = EdgeContact | SplineContact | EllipseContact
"""Contacts with a rigid edge that has places along it."""

_SAMPLES = 1001  # along a beam whose thickness varies


def length(curve: Curve) -> float:
    """Arc length of a curve, m."""
    match curve:
        case Line():
            return math.dist(curve.start, curve.end)
        case Arc():
            return radius(curve) * abs(_turn(curve))
        case Polynomial() | Spline():
            return shape_of(curve).length
        case _:
            assert_never(curve)


def longest(scene: Scene) -> float:
    """Length of the longest beam, m."""
    return max(length(beam.curve) for beam in scene.beams.values())


def radius(curve: Curve) -> float:
    """Smallest radius of curvature of a curve, m; infinite for a line."""
    match curve:
        case Line():
            return math.inf
        case Arc():
            return math.dist(curve.start, curve.center)
        case Polynomial() | Spline():
            curvature = shape_of(curve).largest_curvature
            return 1.0 / curvature if curvature > 0.0 else math.inf
        case _:
            assert_never(curve)


def bentness(beam: Beam) -> float:
    """Largest thickness over radius along a beam at rest."""
    if not beam.tapered:
        return beam.thickest / radius(beam.curve)
    u = np.union1d(np.linspace(0.0, 1.0, _SAMPLES), beam.knots)
    return float(np.max(bentness_on(beam, u)))


def bentness_on(beam: Beam, u: Array) -> Array:
    """Thickness over radius at fractions ``u`` of the arc length of a beam at rest, in the same shape."""
    return np.asarray(beam.thickness_at(u) * shape_of(beam.curve).curvature(u))


def points(curve: Curve, s: Array) -> Array:
    """Points (n, 2) of a curve at the arc lengths ``s`` (n,), m."""
    match curve:
        case Line():
            along = np.asarray(s)[:, None] / length(curve)
            return np.asarray((1 - along) * np.array(curve.start) + along * np.array(curve.end))
        case Arc():
            centre = np.array(curve.center)
            first = math.atan2(curve.start[1] - centre[1], curve.start[0] - centre[0])
            angle = first + math.copysign(1.0, _turn(curve)) * np.asarray(s) / radius(curve)
            return np.asarray(centre + radius(curve) * np.stack([np.cos(angle), np.sin(angle)], axis=1))
        case Polynomial() | Spline():
            return shape_of(curve).point(np.asarray(s) / shape_of(curve).length)
        case _:
            assert_never(curve)


def edge_places(contact: RigidEdge, reach: float, count: int) -> Array:
    """Places (k, 2) along a rigid edge as drawn, m.

    Args:
        contact: with the edge.
        reach: length of a half-plane's edge to either side of its point, m.
        count: number of places along a curve.
    """
    match contact:
        case LineContact():
            return np.array(contact.points)
        case HalfPlaneContact():
            n = np.array(contact.normal) / np.hypot(*contact.normal)
            return np.array(contact.point) + np.outer([-reach, reach], [-n[1], n[0]])
        case FunctionContact() | SplineContact() | EllipseContact():
            return points(contact.curve, np.linspace(0.0, length(contact.curve), count))
        case _:
            assert_never(contact)


def is_free_on_the_left(contact: RigidEdge) -> bool:
    """Whether the beam's side of an edge lies on the left of :func:`edge_places`; an ellipse is counter-clockwise."""
    if not isinstance(contact, FunctionContact):
        return not isinstance(contact, HalfPlaneContact) and contact.side in ("left", "inside")
    # the places above a function of x lie on the left of a graph towards larger x
    forward = (contact.range[1] > contact.range[0]) == (contact.axis == "x")
    return forward == (contact.side == "above")


def _turn(arc: Arc) -> float:
    """The angle φ, rad, in (−2π, 2π), that an arc turns through about its centre."""
    first = math.atan2(arc.start[1] - arc.center[1], arc.start[0] - arc.center[0])
    last = math.atan2(arc.end[1] - arc.center[1], arc.end[0] - arc.center[0])
    turn = (last - first) % (2 * math.pi)
    return turn if arc.direction == "counterclockwise" else turn - 2 * math.pi
