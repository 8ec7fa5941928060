"""Lengths, points and curvature of neutral lines and rigid edges, and exact offset curves, from the scene.

======  =============================================================================
symbol  meaning
======  =============================================================================
s       arc length from the beam's start, m
u       fraction of the arc length
p, n    point of a curve and its left normal at u
q(u)    offset curve p(u) + t n(u), t positive to the left
a, o    coordinates of q on the axis over which q is a graph, and on the other axis
======  =============================================================================

o at a given a needs the u with a(u) = a.  A table of a brackets u, and u ← u − (a(u) − a)/m, with the slope m of the
bracket, gains the relative change of the slope in the bracket (about the table's step) in every turn.

The solvers derive their own geometry and hand over none of it.
"""

from typing import TypeAlias, assert_never

import numpy as np

from cprbm_scene import (
    Array,
    Beam,
    Curve,
    EdgeContact,
    EllipseContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    Scene,
    SplineContact,
)
from cprbm_scene.curve_records import shape_of

RigidEdge: TypeAlias = EdgeContact | SplineContact | EllipseContact
"""Contacts with a rigid edge that has places along it."""

SHEAR_FACTOR = 5.0 / 6.0
"""Of a rectangle: shear area over area (Timoshenko)."""

_SAMPLES = 1001  # along a beam
_TABLE = 2001  # places u in the table of an offset curve
_TURNS = 5
_REACHED = 1e-12  # largest distance from a, over the size of the offset curve


def length(curve: Curve) -> float:
    """Arc length of a curve, m."""
    return shape_of(curve).length


def longest(scene: Scene) -> float:
    """Length of the longest beam, m."""
    return max(length(beam.curve) for beam in scene.beams.values())


def bentness(beam: Beam) -> float:
    """Largest thickness over radius along a beam at rest."""
    return float(np.max(bentness_on(beam, np.union1d(np.linspace(0.0, 1.0, _SAMPLES), beam.knots))))


def bentness_on(beam: Beam, u: Array) -> Array:
    """Thickness over radius at fractions ``u`` of the arc length of a beam at rest, in the same shape."""
    return np.asarray(beam.thickness_at(u) * shape_of(beam.curve).curvature(u))


def points(curve: Curve, s: Array) -> Array:
    """Points (n, 2) of a curve at the arc lengths ``s`` (n,), m."""
    return shape_of(curve).point(np.asarray(s) / length(curve))


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
            return shape_of(contact).point(np.linspace(0.0, 1.0, count))
        case _:
            assert_never(contact)


def is_free_on_the_left(contact: RigidEdge) -> bool:
    """Whether the beam's side of an edge lies on the left of :func:`edge_places`; an ellipse is counter-clockwise."""
    if not isinstance(contact, FunctionContact):
        return not isinstance(contact, HalfPlaneContact) and contact.side in ("left", "inside")
    # the places above a function of x lie on the left of a graph towards larger x
    forward = (contact.range[1] > contact.range[0]) == (contact.axis == "x")
    return forward == (contact.side == "above")


def offset_curve(curve: Curve, u: Array, distance: Array | float) -> Array:
    """q (n, 2), m, at fractions ``u`` (n,), with signed distances t (n,) or a common distance."""
    tangents = shape_of(curve).tangent(u)
    normals = np.column_stack((-tangents[:, 1], tangents[:, 0]))
    return shape_of(curve).point(u) + np.reshape(distance, (-1, 1)) * normals


def ordinates(curve: Curve, at: Array, distance: float, *, along_x: bool) -> Array:
    """o (n,), m, of the exact offset curve where a is ``at`` (n,); NaN beyond the ends.

    The checks of a question ensure that the offset curve is a graph over the axis of a, which is x where ``along_x``.
    """
    graph, across = (0, 1) if along_x else (1, 0)
    table = np.linspace(0.0, 1.0, _TABLE)
    a = offset_curve(curve, table, distance)[:, graph]
    rising = 1.0 if a[-1] > a[0] else -1.0
    right = np.clip(np.searchsorted(rising * a, rising * at), 1, _TABLE - 1)
    slope = (a[right] - a[right - 1]) * (_TABLE - 1)
    u = table[right - 1] + (at - a[right - 1]) / slope
    for _ in range(_TURNS):
        u = np.clip(u - (offset_curve(curve, u, distance)[:, graph] - at) / slope, 0.0, 1.0)
    q = offset_curve(curve, u, distance)
    size = np.max(np.abs(q)) + abs(distance) + shape_of(curve).length
    return np.where(np.abs(q[:, graph] - at) <= _REACHED * size, q[:, across], np.nan)
