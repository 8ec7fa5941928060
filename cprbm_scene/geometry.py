"""Neutral lines of a scene by fractions u of their arc length, from 0 at the start to 1 at the end.

The functions state the stress-free geometry of the scene: they contain neither bending nor contact.
"""

from __future__ import annotations

from cprbm_scene.curve_records import NeutralLine, shape_of
from cprbm_scene.curves import Array


def arc_length(curve: NeutralLine) -> float:
    """Arc length, m."""
    return shape_of(curve).length


def largest_curvature(curve: NeutralLine) -> float:
    """Largest absolute curvature, 1/m."""
    return shape_of(curve).largest_curvature


def curvature_on(curve: NeutralLine, u: Array) -> Array:
    """Absolute curvature (n,), 1/m, at the fractions ``u`` (n,)."""
    return shape_of(curve).curvature(u)


def points_on(curve: NeutralLine, u: Array) -> Array:
    """Points (n, 2), m, at the fractions ``u`` (n,)."""
    return shape_of(curve).point(u)


def tangents_on(curve: NeutralLine, u: Array) -> Array:
    """Unit tangents (n, 2), from start to end, at the fractions ``u`` (n,)."""
    return shape_of(curve).tangent(u)
