"""Distance of places from the rigid shape of a contact.

======  ===================================================================
symbol  meaning
======  ===================================================================
n       normal of a rigid line towards the free side
d       distance of a place from the solid, negative behind the edge, m
======  ===================================================================

A place is behind a line if the nearest place of the line is no end of the line and the place lies opposite to n.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

import numpy as np

from cprbm_scene.contact_records import (
    CircleContact,
    EllipseContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    RigidContact,
    SplineContact,
)
from cprbm_scene.curve_records import shape_of
from cprbm_scene.curves import Array, Curve, unit_vector

_ON_EDGE = 257
"""Samples of a curve, from the nearest of which Newton's method starts."""
_NEWTON_STEPS = 20


def distance_from(contact: RigidContact) -> Callable[[Array], Array]:
    """The distance d (k,), m, as a function of places (k, 2), m."""
    sign = 1.0 if getattr(contact, "side", "") in ("outside", "left") else -1.0
    match contact:
        case CircleContact():
            return lambda p: np.asarray(sign * (np.hypot(*(p - np.array(contact.center)).T) - contact.radius))
        case LineContact():
            return lambda p: _from_line(np.array(contact.points), sign, p, closed=contact.closed)
        case HalfPlaneContact():
            return lambda p: np.asarray((p - np.array(contact.point)) @ unit_vector(contact.normal))
        case EllipseContact():
            sign = -sign  # the curve runs counter-clockwise, with the inside on the left
        case FunctionContact():
            upwards = (contact.side == "above") == (contact.range[0] < contact.range[1])
            sign = 1.0 if upwards == (contact.axis == "x") else -1.0
    assert isinstance(contact, FunctionContact | SplineContact | EllipseContact)
    curve, closed = cast(Curve, shape_of(contact.curve)), isinstance(contact, EllipseContact)
    return lambda p: _from_curve(curve, sign, p, closed=closed)


def _from_line(points: Array, sign: float, p: Array, *, closed: bool) -> Array:
    along = np.diff(points, axis=0)
    length = np.hypot(*along.T)
    tau = along / length[:, None]
    n = sign * np.column_stack((-tau[:, 1], tau[:, 0]))
    r = p[:, None, :] - points[None, :-1]
    t = np.clip((r * tau).sum(axis=2), 0.0, length)
    away = r - t[:, :, None] * tau
    nearest = np.hypot(away[:, :, 0], away[:, :, 1]).argmin(axis=1)
    every = np.arange(len(p))
    away, t = away[every, nearest], t[every, nearest]
    # at a corner the normals of both pieces decide the side
    other = np.where(t <= 0.0, nearest - 1, np.where(t >= length[nearest], nearest + 1, nearest))
    other = other % len(tau) if closed else other
    beyond = (other < 0) | (other >= len(tau))
    towards = n[nearest] + n[np.clip(other, 0, len(tau) - 1)]
    behind = ~beyond & ((away * towards).sum(axis=1) < 0.0)
    return np.asarray(np.where(behind, -1.0, 1.0) * np.hypot(*away.T))


def _from_curve(curve: Curve, sign: float, p: Array, *, closed: bool) -> Array:
    samples = curve.samples[:: max(1, len(curve.samples) // _ON_EDGE)]
    samples = samples if closed else np.append(samples, 1.0)
    places = curve.place(samples)
    w = samples[((places[:, 0] - p[:, :1]) ** 2 + (places[:, 1] - p[:, 1:]) ** 2).argmin(axis=1)]
    for _ in range(_NEWTON_STEPS):
        away, along = curve.place(w) - p, curve.derivative(w, 1)
        slope, bent = (away * along).sum(axis=1), (along**2 + away * curve.derivative(w, 2)).sum(axis=1)
        # beyond the centre of curvature the distance has a maximum: the sample stays
        w = w - np.where(bent > 0.0, slope / np.where(bent > 0.0, bent, 1.0), 0.0)
        w = w % 1.0 if closed else np.clip(w, 0.0, 1.0)
    away, along = p - curve.place(w), curve.derivative(w, 1)
    slope, side = (away * along).sum(axis=1), sign * (along[:, 0] * away[:, 1] - along[:, 1] * away[:, 0])
    beyond = ((w <= 0.0) & (slope < 0.0)) | ((w >= 1.0) & (slope > 0.0))
    return np.asarray(np.where((beyond & (not closed)) | (side >= 0.0), 1.0, -1.0) * np.hypot(*away.T))
