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
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from cprbm_scene.check_overlaps import OVERLAP
from cprbm_scene.closest import half_thickness
from cprbm_scene.curve_records import MEETING, SHORTEST, shape_of
from cprbm_scene.curves import least, unit_vector
from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import (
    CircleContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    Point,
    Polynomial,
    RigidContact,
    Scene,
)

Array = NDArray[np.float64]
_SAMPLES = 2001
_ON_EDGE = 257
"""Samples of a function, from the nearest of which Newton's method starts."""
_NEWTON_STEPS = 20


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
            side = "circle from outside" if circle else "edge from the free side"
            allowed = f"a beam that touches the {side} or is apart (overlap at most {OVERLAP:g} of {of})"
            yield Mistake(f"contacts.{name}", f"the beam {contact.beam!r} {what}", allowed)


def _proportions(key: str, contact: RigidContact, length: float) -> Iterator[Mistake]:
    """Mistakes of sizes and coordinates beside the beam's ``length``, m; the first counts."""
    places, key_of_places = tuple[Point, ...](), key
    match contact:
        case CircleContact(center=center, radius=radius):
            places, key_of_places = (center,), f"{key}.center"
            if not SHORTEST * length <= radius <= length / SHORTEST:
                found = f"{radius:g} m, which is {radius / length:.3g} of the beam's length"
                allowed = f"a radius between {SHORTEST:g} and {1.0 / SHORTEST:g} of the beam's length"
                yield Mistake(f"{key}.radius", found, allowed)
        case LineContact(points=points):
            places = points
            for i, (one, other) in enumerate(pairwise(points), start=1):
                if not dist(one, other) >= SHORTEST * length:
                    found = f"a point {dist(one, other):.3g} m from the one before"
                    allowed = f"at least {SHORTEST:g} of the beam's length between them"
                    yield Mistake(f"{key}.points[{i}]", found, allowed)
        case HalfPlaneContact(point=point):
            places = (point,)
        case FunctionContact(curve=curve):
            places = (curve.start, curve.end)
            extent = shape_of(curve).length
            if not SHORTEST * length <= extent:
                found = f"an edge of {extent:.3g} m, which is {extent / length:.3g} of the beam's length"
                yield Mistake(f"{key}.range", found, f"at least {SHORTEST:g} of the beam's length")
    largest = max(abs(coordinate) for place in places for coordinate in place)
    if not SHORTEST * largest <= length:
        found = f"coordinates up to {largest:.3g} m beside a beam of {length:.3g} m"
        yield Mistake(key_of_places, found, f"coordinates of which the beam's length is at least {SHORTEST:g}")


def distance_from(contact: RigidContact) -> Callable[[Array], Array]:
    """The distance d (k,), m, as a function of places (k, 2), m."""
    match contact:
        case CircleContact():
            return lambda p: np.asarray(np.hypot(*(p - np.array(contact.center)).T) - contact.radius)
        case LineContact():
            sign = 1.0 if contact.side == "left" else -1.0
            return lambda p: _from_line(np.array(contact.points), sign, p, closed=contact.closed)
        case HalfPlaneContact():
            return lambda p: np.asarray((p - np.array(contact.point)) @ unit_vector(contact.normal))
        case FunctionContact():
            return lambda p: _from_function(contact.curve, 1.0 if contact.side == "above" else -1.0, p)
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


def _from_function(curve: Polynomial, sign: float, p: Array) -> Array:
    f = np.array(curve.coefficients)
    f1 = polynomial.polyder(f)
    f2 = polynomial.polyder(f1)
    low, high = sorted(curve.range)
    v, w = (p[:, 0], p[:, 1]) if curve.axis == "x" else (p[:, 1], p[:, 0])
    samples = np.linspace(low, high, _ON_EDGE)
    squares = (samples - v[:, None]) ** 2 + (polynomial.polyval(samples, f) - w[:, None]) ** 2
    at = samples[squares.argmin(axis=1)]
    for _ in range(_NEWTON_STEPS):
        slope, rest = polynomial.polyval(at, f1), polynomial.polyval(at, f) - w
        bent = 1.0 + slope**2 + rest * polynomial.polyval(at, f2)
        # beyond the centre of curvature the distance has a maximum: the sample stays
        step = np.where(bent > 0.0, (at - v + rest * slope) / np.where(bent > 0.0, bent, 1.0), 0.0)
        at = np.clip(at - step, low, high)
    slope, rest = polynomial.polyval(at, f1), w - polynomial.polyval(at, f)
    side = sign * (rest - slope * (v - at))
    beyond = ((at <= low) & (v - at + rest * slope < 0.0)) | ((at >= high) & (v - at + rest * slope > 0.0))
    return np.asarray(np.where(beyond | (side >= 0.0), 1.0, -1.0) * np.hypot(v - at, rest))
