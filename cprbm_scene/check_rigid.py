"""Rigid shapes that are out of proportion to their beam, and beams that overlap a rigid shape as drawn.

======  ===============================================================================
symbol  meaning
======  ===============================================================================
n       normal of a rigid line towards the free side
d       distance of a place from the solid, negative behind the edge, m
t       thickness of the beam at the place, m; zero for a beam that touches as a line
r, L    radius of a circle and length of the beam, m
======  ===============================================================================

The beam is on the free side where d ≥ t/2.  A place is behind a line if the nearest place of the line is no end of the
line and the place lies opposite to n.  Bounds are on dimensionless numbers: 1e-6 ≤ r/L ≤ 1e6, and L ≥ 1e-6 of all
coordinates; larger or farther shapes leave a gap without digits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import dist

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.check_overlaps import OVERLAP
from cprbm_scene.closest import half_thickness
from cprbm_scene.curve_records import MEETING, SHORTEST, shape_of
from cprbm_scene.curves import ParametricCurve, least, unit_vector
from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import (
    CircleContact,
    EllipseContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    Point,
    RigidContact,
    Scene,
    SplineContact,
)

Array = NDArray[np.float64]
_SAMPLES = 2001
_ON_EDGE = 257
"""Samples of a function, from the nearest of which Newton's method starts."""
_NEWTON_STEPS = 20
_SIZED_BY = {"beam-function": "range", "beam-spline": "points", "beam-ellipse": "semi_axes"}
"""Keys of the extents of curves by the kinds of contacts."""


def overlapping_rigid_shapes(scene: Scene) -> Iterator[Mistake]:
    """Shapes out of proportion to their beam; beams that overlap a shape or lie behind an edge as drawn."""
    for name, contact in scene.contacts.items():
        beam = scene.beams.get(contact.beams[0])
        if not isinstance(contact, RigidContact) or beam is None or not beam.sound or any(contact.shape_rules()):
            continue
        shape = shape_of(beam.curve)
        mistake = next(_proportions(f"contacts.{name}", contact, shape.length), None)
        if mistake is not None:
            yield mistake
            continue
        away, thick = distance_from(contact), contact.thick

        def gap(u: Array) -> Array:
            return np.asarray(away(shape.point(u)) - half_thickness(beam, u, thick=thick))  # noqa: B023 - used at once

        depth = -least(gap, np.union1d(np.linspace(0.0, 1.0, _SAMPLES), beam.knots))
        measure, of = (beam.thinnest, "its thickness") if thick else (shape.length, "its length")
        points = scene.bodies[contact.body].points if contact.body in scene.bodies else {}
        held = any(getattr(end, "point", None) in points for end in (beam.start, beam.end))
        circle = isinstance(contact, CircleContact)
        if depth > max(OVERLAP * measure, MEETING * shape.length if held and not circle else 0.0):
            by = f"at the start by {depth:.3g} m, {depth / measure:.3g} of {of}"
            what = (
                f"that overlaps the circle {by}"
                if circle
                else f"on the wrong side of what it may touch, or overlapping it, {by}"
            )
            side = f"circle from {contact.side}" if isinstance(contact, CircleContact) else "edge from the free side"
            allowed = f"a beam that touches the {side} or is apart (overlap at most {OVERLAP:g} of {of})"
            yield Mistake(f"contacts.{name}", f"the beam {contact.beam!r} {what}", allowed)


def _proportions(key: str, contact: RigidContact, length: float) -> Iterator[Mistake]:
    """Mistakes of sizes and coordinates beside the beam's ``length``, m; the first counts."""
    places, sizes, where = tuple[Point, ...](), list[tuple[str, float]](), key
    match contact:
        case CircleContact(center=center, radius=radius):
            places, sizes, where = (center,), [("radius", radius)], f"{key}.center"
        case LineContact(points=places):
            sizes = [(f"points[{i}]", dist(*ends)) for i, ends in enumerate(pairwise(places), start=1)]
        case HalfPlaneContact(point=point):
            places = (point,)
        case FunctionContact(curve=curve) | SplineContact(curve=curve) | EllipseContact(curve=curve):
            places, sizes = (curve.start, curve.end), [(_SIZED_BY[contact.kind], shape_of(curve).length)]
    for part, size in sizes:
        if not SHORTEST * length <= size <= length / SHORTEST:
            found = f"{size:.3g} m, which is {size / length:.3g} of the beam's length"
            allowed = f"between {SHORTEST:g} and {1.0 / SHORTEST:g} of the beam's length"
            yield Mistake(f"{key}.{part}", found, allowed)
    largest = max(abs(coordinate) for place in places for coordinate in place)
    if not SHORTEST * largest <= length:
        found = f"coordinates up to {largest:.3g} m beside a beam of {length:.3g} m"
        yield Mistake(where, found, f"coordinates of which the beam's length is at least {SHORTEST:g}")


def distance_from(contact: RigidContact) -> Callable[[Array], Array]:
    """The distance d (k,), m, as a function of places (k, 2), m."""
    match contact:
        case CircleContact():
            sign = 1.0 if contact.side == "outside" else -1.0
            return lambda p: np.asarray(sign * (np.hypot(*(p - np.array(contact.center)).T) - contact.radius))
        case LineContact():
            sign = 1.0 if contact.side == "left" else -1.0
            return lambda p: _from_line(np.array(contact.points), sign, p, closed=contact.closed)
        case HalfPlaneContact():
            return lambda p: np.asarray((p - np.array(contact.point)) @ unit_vector(contact.normal))
        case FunctionContact() | SplineContact() | EllipseContact():
            curve, left = shape_of(contact.curve), contact.side in ("left", "inside")
            if isinstance(contact, FunctionContact):
                left = ((contact.side == "above") == (contact.range[0] < contact.range[1])) == (contact.axis == "x")
            assert isinstance(curve, ParametricCurve)
            return lambda p: _from_curve(curve, 1.0 if left else -1.0, p, closed=isinstance(contact, EllipseContact))
        case _:
            raise TypeError(type(contact))


def _from_line(points: Array, sign: float, p: Array, *, closed: bool) -> Array:
    along = np.diff(points, axis=0)
    length = np.hypot(along[:, 0], along[:, 1])
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
    return np.asarray(np.where(behind, -1.0, 1.0) * np.hypot(away[:, 0], away[:, 1]))


def _from_curve(curve: ParametricCurve, sign: float, p: Array, *, closed: bool) -> Array:
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
    return np.asarray(np.where((beyond & (not closed)) | (side >= 0.0), 1.0, -1.0) * np.hypot(away[:, 0], away[:, 1]))
