"""Clearance as drawn: between two beams, of a beam from itself, and of a beam from a rigid shape.

=======  ================================================================
symbol   meaning
=======  ================================================================
u        fraction of a beam's arc length
T        half of the thickness at a place, m; zero for a beam as a line
D(p)     distance of a place p from the other body, m, negative inside
L        length of a beam, m
r        size of a rigid shape, m
κ, Δs    largest curvature, 1/m; arc length between two places of a beam
=======  ================================================================

A beam fills the circles of radius T about its neutral line.  The gap is the least D(p(u)) - T(u).  Of a second beam,
D(p) is the least distance from the neutral line less its T: at the foot of p, or at a kink of the thickness.

Contact of a beam with itself.  By Schur's comparison theorem the distance of two places is at least (2/κ) sin(κ Δs/2)
for Δs ≤ 2π/κ.  With 2 T κ < 1, places closer than 2 T are therefore either neighbours, or have Δs > 10 T.  Lines and
graphs have no places of the second kind: with enough rotation of the tangent, by the angle φ, a graph extends along the
axis by ∫ cos φ dφ/κ > 3.8 T.

Bounds on rigid shapes are dimensionless: 1e-6 ≤ r/L ≤ 1e6, and L ≥ 1e-6 of all coordinates; larger or farther shapes
leave a gap without digits.

A place is behind a rigid line if the nearest place of the line is no end of the line and the place lies opposite to the
line's normal towards the free side.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache
from itertools import product
from math import dist
from typing import NamedTuple

import numpy as np

from cprbm_scene.contact_records import measures
from cprbm_scene.curve_records import MEETING, SHORTEST, shape_of
from cprbm_scene.curves import Array, Curve, least, unit_vector
from cprbm_scene.mistakes import Mistake, broken, written_place
from cprbm_scene.statement import (
    Arc,
    Beam,
    BeamContact,
    CircleContact,
    EllipseContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    RigidContact,
    Scene,
    Spline,
    SplineContact,
    WeldedEnd,
)

Range = tuple[float, float]

OVERLAP = 1e-6
"""Overlap that counts as round-off, of the mean thickness where both beams are thinnest."""
TOUCHING = 1e-3
"""Overlap of beams of constant thickness that counts as touching, of their mean: coordinates are rounded.

Of other beams so much may overlap beside ends that are welded side by side to one body.
"""
CROSSING_ANGLE = 1e-3
"""Angle, rad, below which two lines that meet are tangent."""
JOINED = 5.0
"""Mean thicknesses beside a shared end in which beams overlap by their nature."""
SIDE_BY_SIDE = 2.0
"""Mean thicknesses between ends that lie side by side on one body."""
NEIGHBOURS = 5.0
"""Thicknesses along a beam between places that are no neighbours."""
WHOLE: Range = (0.0, 1.0)
_SAMPLES = 1001
_FEET = 8
"""Steps to the foot of a perpendicular; a step leaves an error of κ times the distance of the error before."""
_SLOPE = 1e-7
"""Half of the stretch of u over which the slope of a thickness is taken."""


class Gap(NamedTuple):
    """Least ``gap``, m, negative for an overlap, with the places ``u1`` and ``u2`` on both beams."""

    gap: float
    u1: float
    u2: float


def _half(beam: Beam, u: Array, *, thick: bool) -> Array:
    return 0.5 * beam.thickness_at(u) if thick else np.zeros(len(u))


@lru_cache(maxsize=512)
def beam_gap(first: Beam, second: Beam, range1: Range = WHOLE, range2: Range = WHOLE, *, thick: bool = True) -> Gap:
    """Least gap of two beams within ranges of u; a gap far above the samples' distance is not refined."""
    from scipy.spatial import cKDTree  # scenes without contact of beams need no SciPy

    one, two = shape_of(first.curve), shape_of(second.curve)
    samples, kinks = np.union1d(np.linspace(*range1, _SAMPLES), _kinks(first, range1)), _kinks(second, range2)
    known = np.union1d(np.linspace(*range2, _SAMPLES), kinks)
    tree = cKDTree(two.point(known))

    def foot(u: Array) -> Array:
        p = one.point(u)
        v = known[tree.query(p)[1]]
        for _ in range(_FEET):
            away = p - two.point(v)
            step = (away * two.tangent(v)).sum(axis=1)
            if thick and second.tapered:
                steeper = second.thickness_at(v + _SLOPE) - second.thickness_at(v - _SLOPE)
                step += np.hypot(*away.T) * steeper / (4.0 * _SLOPE * two.length)
            v = np.clip(v + step / two.length, *range2)
        places = np.vstack((v, np.tile(kinks[:, None], len(u))))
        gaps = [np.hypot(*(p - two.point(v)).T) - _half(second, v, thick=thick) for v in places]
        return np.asarray(places[np.argmin(gaps, axis=0), np.arange(len(u))])

    def gap(u: Array) -> Array:
        v = foot(u)
        return np.asarray(
            np.hypot(*(one.point(u) - two.point(v)).T) - _half(first, u, thick=thick) - _half(second, v, thick=thick)
        )

    value, place = least(gap, samples, refined_below=2.0 * (one.length + two.length) / _SAMPLES)
    return Gap(value, place, float(foot(np.array([place]))[0]))


def _kinks(beam: Beam, span: Range) -> Array:
    return beam.knots[(beam.knots > span[0]) & (beam.knots < span[1])]


def wrong_clearance(scene: Scene) -> Iterator[Mistake]:
    """Beams that overlap themselves, another beam of a contact, or a rigid shape of a contact as drawn."""
    for name, beam in scene.beams.items():
        if isinstance(beam.curve, Arc | Spline):
            yield from _itself(f"beams.{name}.curve", beam)
    for name, contact in scene.contacts.items():
        if isinstance(contact, BeamContact):
            yield from (_too_deep if contact.thick else _crossing)(scene, f"contacts.{name}", contact)
        elif isinstance(contact, RigidContact):
            yield from _rigid(scene, f"contacts.{name}", contact)


def overlap_at_rest(scene: Scene, contact: BeamContact) -> float:
    """Overlap of thick beams as drawn, m; 0 for round-off, for lines, and for an overlap only beside shared ends.

    Beside ends welded side by side to the same body an overlap up to :data:`TOUCHING` is left out.  Solvers subtract
    the overlap from the distance at which the beams touch.
    """
    first, second = (scene.beams[beam] for beam in contact.between)
    mean, largest = 0.5 * (first.thinnest + second.thinnest), 0.5 * (first.thickest + second.thickest)
    ranges = _apart_from_shared(first, second, JOINED * largest)
    depth = -beam_gap(first, second, *ranges).gap if contact.thick and _left(ranges) else 0.0
    if OVERLAP * mean < depth <= TOUCHING * mean:
        beside = _apart_from_held(scene, (first, second), largest, ranges)
        depth = -beam_gap(first, second, *beside).gap if _left(beside) else 0.0
    return depth if depth > OVERLAP * mean else 0.0


def _left(ranges: list[Range]) -> bool:
    return all(low < high for low, high in ranges)


def _too_deep(scene: Scene, key: str, contact: BeamContact) -> Iterator[Mistake]:
    """Thick beams with an overlap beyond touching."""
    first, second = (scene.beams[beam] for beam in contact.between)
    depth, mean = overlap_at_rest(scene, contact), 0.5 * (first.thinnest + second.thinnest)
    most = OVERLAP if first.tapered or second.tapered else TOUCHING
    return broken(
        depth > most * mean
        and Mistake(
            key,
            f"{contact.between[0]!r} and {contact.between[1]!r} that overlap at the start by {depth:.3g} m, "
            f"{depth / mean:.3g} of their mean thickness",
            f"beams that touch or are apart (overlap at most {most:g} of the mean thickness)",
        )
    )


def _crossing(scene: Scene, key: str, contact: BeamContact) -> Iterator[Mistake]:
    """Beams as lines that cross."""
    first, second = (scene.beams[beam] for beam in contact.between)
    shapes = shape_of(first.curve), shape_of(second.curve)
    shortest = min(shape.length for shape in shapes)
    ranges = _apart_from_shared(first, second, CROSSING_ANGLE * shortest)
    if not _left(ranges):
        return iter(())
    gap, *places = beam_gap(first, second, *ranges, thick=False)
    t1, t2 = (shape.tangent(np.array([u]))[0] for shape, u in zip(shapes, places, strict=True))
    return broken(
        gap <= MEETING * shortest
        and all(1e-6 < u < 1.0 - 1e-6 for u in places)
        and abs(t1[0] * t2[1] - t1[1] * t2[0]) > CROSSING_ANGLE
        and Mistake(
            key,
            f"{contact.between[0]!r} and {contact.between[1]!r} that cross at the start, at "
            f"{written_place(shapes[0].point(np.array(places[:1]))[0])} m",
            "neutral lines that touch or are apart",
        )
    )


def _apart_from_shared(first: Beam, second: Beam, left_out: float) -> list[Range]:
    """Ranges of u without ``left_out`` (m) beside shared ends; an empty range if nothing is left."""
    ends = [(beam.curve.start, beam.curve.end) for beam in (first, second)]
    lengths = [shape_of(beam.curve).length for beam in (first, second)]
    shared = [
        [any(dist(place, other) <= MEETING * max(lengths) for other in ends[1 - i]) for place in ends[i]]
        for i in range(2)
    ]
    return [
        (left_out / length if start else 0.0, 1.0 - left_out / length if end else 1.0)
        for length, (start, end) in zip(lengths, shared, strict=True)
    ]


def _apart_from_held(scene: Scene, beams: tuple[Beam, Beam], mean: float, ranges: list[Range]) -> list[Range]:
    """The ranges of u without stretches beside ends welded side by side to the same body."""
    cut, owners = list(ranges), scene.owners
    for ends in product(*(beam.ends for beam in beams)):
        bodies = [owners[joint.point] for _, joint, _ in ends if isinstance(joint, WeldedEnd)]
        if len(bodies) == len(ends) and len(set(bodies)) == 1 and dist(ends[0][2], ends[1][2]) <= SIDE_BY_SIDE * mean:
            for i, (beam, (side, _, _)) in enumerate(zip(beams, ends, strict=True)):
                share = JOINED * mean / shape_of(beam.curve).length
                low, high = (share, 1.0) if side == "start" else (0.0, 1.0 - share)
                cut[i] = max(cut[i][0], low), min(cut[i][1], high)
    return cut


def _itself(key: str, beam: Beam) -> Iterator[Mistake]:
    """Places of a beam, neighbours excluded, that are closer than the thickness."""
    from scipy.spatial import cKDTree  # scenes of lines and graphs need no SciPy

    shape, u = shape_of(beam.curve), np.linspace(*WHOLE, 3 * _SAMPLES // 2)
    p, half, step = shape.point(u), _half(beam, u, thick=True), 2.0 / (len(u) - 1)
    pairs = cKDTree(p).query_pairs(beam.thickest + step * shape.length, output_type="ndarray")
    i, j = pairs[(u[pairs[:, 1]] - u[pairs[:, 0]]) * shape.length > NEIGHBOURS * beam.thickest].T
    if not len(i):
        return iter(())
    k = int(np.argmin(np.hypot(*(p[i] - p[j]).T) - half[i] - half[j]))
    ranges = ((max(0.0, at - step), min(1.0, at + step)) for at in (float(u[i[k]]), float(u[j[k]])))
    gap, *places = beam_gap(beam, beam, *ranges)
    thickness = float(np.mean(beam.thickness_at(np.array(places))))
    return broken(
        -gap > OVERLAP * thickness
        and Mistake(
            key,
            f"a beam that overlaps itself: near {written_place(shape.point(np.array(places[:1]))[0])} m it comes to "
            f"{thickness + gap:.3g} m from itself, and is {thickness:g} m thick",
            "a curve that keeps a thickness away from itself",
        )
    )


def _rigid(scene: Scene, key: str, contact: RigidContact) -> Iterator[Mistake]:
    """A shape out of proportion to the beam, or a beam that overlaps the shape or lies behind the edge."""
    beam, circle = scene.beams[contact.beam], isinstance(contact, CircleContact)
    shape = shape_of(beam.curve)
    if mistakes := list(_proportions(key, contact, shape.length)):
        return iter(mistakes[:1])
    away, samples = distance_from(contact), np.union1d(np.linspace(*WHOLE, 2 * _SAMPLES - 1), beam.knots)
    depth = -least(lambda u: np.asarray(away(shape.point(u)) - _half(beam, u, thick=contact.thick)), samples)[0]
    measure, of = (beam.thinnest, "its thickness") if contact.thick else (shape.length, "its length")
    own = scene.bodies[contact.body].points
    held = not circle and any(joint.point in own for _, joint, _ in beam.ends)
    what = "that overlaps the circle" if circle else "on the wrong side of the edge, or overlapping the edge,"
    side = f"circle from {getattr(contact, 'side', '')}" if circle else "edge from the free side"
    return broken(
        depth > max(OVERLAP * measure, MEETING * shape.length if held else 0.0)
        and Mistake(
            key,
            f"the beam {contact.beam!r} {what} at the start by {depth:.3g} m, {depth / measure:.3g} of {of}",
            f"a beam that touches the {side} or is apart (overlap at most {OVERLAP:g} of {of})",
        )
    )


def _proportions(key: str, contact: RigidContact, length: float) -> Iterator[Mistake]:
    """Mistakes of sizes and coordinates beside the beam's ``length``, m."""
    places, sizes = measures(contact)
    largest = max(abs(coordinate) for place in places for coordinate in place)
    return broken(
        *(
            not SHORTEST * length <= size <= length / SHORTEST
            and Mistake(
                f"{key}.{part}",
                f"{size:.3g} m, which is {size / length:.3g} of the beam's length",
                f"between {SHORTEST:g} and {1.0 / SHORTEST:g} of the beam's length",
            )
            for part, size in sizes
        ),
        not SHORTEST * largest <= length
        and Mistake(
            f"{key}.center" if isinstance(contact, CircleContact) else key,
            f"coordinates up to {largest:.3g} m beside a beam of {length:.3g} m",
            f"coordinates of which the beam's length is at least {SHORTEST:g}",
        ),
    )


_ON_EDGE = 257
"""Samples of a curve, from the nearest of which Newton's method starts."""
_STEPS = 20


def distance_from(contact: RigidContact) -> Callable[[Array], Array]:
    """The distance D (k,), m, as a function of places (k, 2), m."""
    sign = 1.0 if getattr(contact, "side", "") in ("outside", "left") else -1.0
    match contact:
        case CircleContact():
            return lambda p: np.asarray(sign * (np.hypot(*(p - np.array(contact.center)).T) - contact.radius))
        case LineContact():
            return lambda p: _from_line(np.array(contact.points), sign, p, closed=contact.closed)
        case HalfPlaneContact():
            return lambda p: np.asarray((p - np.array(contact.point)) @ unit_vector(contact.normal))
        case EllipseContact():
            # the curve runs counter-clockwise, with the inside on the left
            return lambda p: _from_curve(shape_of(contact.curve), -sign, p, closed=True)
        case FunctionContact():
            upwards = (contact.side == "above") == (contact.range[0] < contact.range[1])
            sign = 1.0 if upwards == (contact.axis == "x") else -1.0
    assert isinstance(contact, FunctionContact | SplineContact)
    return lambda p: _from_curve(shape_of(contact.curve), sign, p, closed=False)


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
    inside = (other >= 0) & (other < len(tau))
    towards = n[nearest] + n[np.clip(other, 0, len(tau) - 1)]
    return np.asarray(np.where(inside & ((away * towards).sum(axis=1) < 0.0), -1.0, 1.0) * np.hypot(*away.T))


def _from_curve(curve: Curve, sign: float, p: Array, *, closed: bool) -> Array:
    samples = curve.samples[:: max(1, len(curve.samples) // _ON_EDGE)]
    samples = samples if closed else np.append(samples, 1.0)
    places = curve.place(samples)
    w = samples[((places[:, 0] - p[:, :1]) ** 2 + (places[:, 1] - p[:, 1:]) ** 2).argmin(axis=1)]
    for _ in range(_STEPS):
        away, along = curve.place(w) - p, curve.derivative(w, 1)
        slope, bent = (away * along).sum(axis=1), (along**2 + away * curve.derivative(w, 2)).sum(axis=1)
        # beyond the centre of curvature the distance has a maximum: the sample stays
        w = w - np.where(bent > 0.0, slope / np.where(bent > 0.0, bent, 1.0), 0.0)
        w = w % 1.0 if closed else np.clip(w, 0.0, 1.0)
    away, along = p - curve.place(w), curve.derivative(w, 1)
    slope, side = (away * along).sum(axis=1), sign * (along[:, 0] * away[:, 1] - along[:, 1] * away[:, 0])
    beyond = ((w <= 0.0) & (slope < 0.0)) | ((w >= 1.0) & (slope > 0.0))
    return np.asarray(np.where((beyond & (not closed)) | (side >= 0.0), 1.0, -1.0) * np.hypot(*away.T))
