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

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import product
from math import dist

import numpy as np

from cprbm_scene.contact_records import Rigid, measures
from cprbm_scene.curve_records import MEETING, SHORTEST, shape_of
from cprbm_scene.curves import Array, Curve, least, unit_vector
from cprbm_scene.mistakes import Mistake, broken, first_alone, written_place
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
"""Thicknesses along a beam beside a shared end, or between neighbours, in which beams overlap by their nature."""
SIDE_BY_SIDE = 2.0
"""Mean thicknesses between ends that lie side by side on one body."""
WHOLE: Range = (0.0, 1.0)
_SAMPLES = 1001
_FEET = 8
"""Steps to the foot of a perpendicular; a step leaves an error of κ times the distance of the error before."""
_SLOPE = 1e-7
"""Half of the stretch of u over which the slope of a thickness is taken."""


def _half(beam: Beam, u: Array, *, thick: bool) -> Array:
    return 0.5 * beam.thickness_at(u) if thick else np.zeros(len(u))


@lru_cache(maxsize=512)
def beam_gap(
    first: Beam, second: Beam, range1: Range = WHOLE, range2: Range = WHOLE, *, thick: bool = True
) -> tuple[float, float, float]:
    """Least gap of two beams within ranges of u, m, and the places u on both beams.

    The gap is negative for an overlap, and infinite for an empty range; a gap far above the samples' distance is not
    refined.
    """
    from scipy.spatial import cKDTree  # scenes without contact of beams need no SciPy

    if range1[0] >= range1[1] or range2[0] >= range2[1]:
        return np.inf, 0.0, 0.0
    one, two = shape_of(first.curve), shape_of(second.curve)
    samples, known = (
        np.union1d(np.linspace(*span, _SAMPLES), np.clip(beam.knots, *span))
        for beam, span in ((first, range1), (second, range2))
    )
    tree, kinks = cKDTree(two.point(known)), second.knots[(second.knots > range2[0]) & (second.knots < range2[1])]

    def nearest(u: Array) -> tuple[Array, Array]:
        """Gaps at places of the first beam, and the places of the second beam."""
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
        gaps = np.array([np.hypot(*(p - two.point(v)).T) - _half(second, v, thick=thick) for v in places])
        chosen = np.argmin(gaps, axis=0), np.arange(len(u))
        return gaps[chosen] - _half(first, u, thick=thick), places[chosen]

    bound = 2.0 * (one.length + two.length) / _SAMPLES
    value, place = least(lambda u: nearest(u)[0], samples, refined_below=bound)
    return value, place, float(nearest(np.array([place]))[1][0])


def wrong_clearance(scene: Scene) -> Iterator[Mistake]:
    """Beams that overlap themselves, another beam of a contact, or a rigid shape of a contact as drawn."""
    for name, beam in scene.beams.items():
        if isinstance(beam.curve, Arc | Spline):
            yield from _itself(f"beams.{name}.curve", beam)
    for name, contact in scene.contacts.items():
        if isinstance(contact, BeamContact):
            yield from _pair(scene, f"contacts.{name}", contact)
        elif isinstance(contact, RigidContact):
            yield from _rigid(scene, f"contacts.{name}", contact)


def overlap_at_rest(scene: Scene, contact: BeamContact) -> float:
    """Overlap of thick beams as drawn, m; 0 for round-off, for lines, and for an overlap only beside shared ends.

    Beside ends welded side by side to the same body an overlap up to :data:`TOUCHING` is left out.  Solvers subtract
    the overlap from the distance at which the beams touch.
    """
    first, second = beams = [scene.beams[beam] for beam in contact.between]
    mean, largest = 0.5 * (first.thinnest + second.thinnest), 0.5 * (first.thickest + second.thickest)
    depth = -beam_gap(first, second, *_apart(scene, beams, JOINED * largest))[0] if contact.thick else 0.0
    if OVERLAP * mean < depth <= TOUCHING * mean:
        depth = -beam_gap(first, second, *_apart(scene, beams, JOINED * largest, SIDE_BY_SIDE * largest))[0]
    return depth if depth > OVERLAP * mean else 0.0


def _pair(scene: Scene, key: str, contact: BeamContact) -> Iterator[Mistake]:
    """Thick beams with an overlap beyond touching, and beams as lines that cross."""
    first, second = (scene.beams[beam] for beam in contact.between)
    depth, mean = overlap_at_rest(scene, contact), 0.5 * (first.thinnest + second.thinnest)
    most, names = OVERLAP if first.tapered or second.tapered else TOUCHING, " and ".join(map(repr, contact.between))
    place = "" if contact.thick else crossing(scene, *contact.between)
    return broken(
        depth > most * mean
        and Mistake(
            key,
            f"{names} that overlap at the start by {depth:.3g} m, {depth / mean:.3g} of their mean thickness",
            f"beams that touch or are apart (overlap at most {most:g} of the mean thickness)",
        ),
        place
        and Mistake(key, f"{names} that cross at the start, at {place} m", "neutral lines that touch or are apart"),
    )


def crossing(scene: Scene, *names: str) -> str:
    """Place at which the neutral lines of two beams cross, m; empty for beams that touch or are apart."""
    beams = [scene.beams[name] for name in names]
    shapes = [shape_of(beam.curve) for beam in beams]
    shortest = min(shape.length for shape in shapes)
    gap, *places = beam_gap(*beams, *_apart(scene, beams, CROSSING_ANGLE * shortest), thick=False)
    t1, t2 = (shape.tangent(np.array([u]))[0] for shape, u in zip(shapes, places, strict=True))
    crosses = (
        gap <= MEETING * shortest
        and all(1e-6 < u < 1.0 - 1e-6 for u in places)
        and abs(t1[0] * t2[1] - t1[1] * t2[0]) > CROSSING_ANGLE
    )
    return written_place(shapes[0].point(np.array(places[:1]))[0]) if crosses else ""


def _apart(scene: Scene, beams: Sequence[Beam], left_out: float, near: float = 0.0) -> list[Range]:
    """Ranges of u of two beams without ``left_out`` (m) beside ends at the same place.

    Ends that are welded to the same body, up to ``near`` (m) from each other, count as such ends.
    """
    lengths = [shape_of(beam.curve).length for beam in beams]
    cut, owners, meeting = [WHOLE, WHOLE], scene.owners, MEETING * max(lengths)
    for ends in product(*(beam.ends for beam in beams)):
        bodies = {owners[joint.point] if isinstance(joint, WeldedEnd) else joint for _, joint, _ in ends}
        welded = len(bodies) == 1 and isinstance(ends[0][1], WeldedEnd)
        if dist(ends[0][2], ends[1][2]) <= (max(meeting, near) if welded else meeting):
            for i, (length, (side, _, _)) in enumerate(zip(lengths, ends, strict=True)):
                low, high = (left_out / length, 1.0) if side == "start" else (0.0, 1.0 - left_out / length)
                cut[i] = max(cut[i][0], low), min(cut[i][1], high)
    return cut


def _itself(key: str, beam: Beam) -> Iterator[Mistake]:
    """Places of a beam, neighbours excluded, that are closer than the thickness."""
    from scipy.spatial import cKDTree  # scenes of lines and graphs need no SciPy

    shape, u = shape_of(beam.curve), np.linspace(*WHOLE, 3 * _SAMPLES // 2)
    p, half, step = shape.point(u), _half(beam, u, thick=True), 2.0 / (len(u) - 1)
    pairs = cKDTree(p).query_pairs(beam.thickest + step * shape.length, output_type="ndarray")
    i, j = pairs[(u[pairs[:, 1]] - u[pairs[:, 0]]) * shape.length > JOINED * beam.thickest].T
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


@first_alone
def _rigid(scene: Scene, key: str, contact: Rigid) -> Iterator[Mistake]:
    """A shape out of proportion to the beam, or a beam that overlaps the shape or lies behind the edge."""
    beam, circle, (places, sizes) = scene.beams[contact.beam], isinstance(contact, CircleContact), measures(contact)
    shape, largest = shape_of(beam.curve), max(abs(coordinate) for place in places for coordinate in place)
    yield from broken(
        *(
            not SHORTEST * shape.length <= size <= shape.length / SHORTEST
            and Mistake(
                f"{key}.{part}",
                f"{size:.3g} m, which is {size / shape.length:.3g} of the beam's length",
                f"between {SHORTEST:g} and {1.0 / SHORTEST:g} of the beam's length",
            )
            for part, size in sizes
        ),
        not SHORTEST * largest <= shape.length
        and Mistake(
            f"{key}.center" if circle else key,
            f"coordinates up to {largest:.3g} m beside a beam of {shape.length:.3g} m",
            f"coordinates of which the beam's length is at least {SHORTEST:g}",
        ),
    )
    samples = np.union1d(np.linspace(*WHOLE, 2 * _SAMPLES - 1), beam.knots)
    depth = -least(lambda u: distance(contact, shape.point(u)) - _half(beam, u, thick=contact.thick), samples)[0]
    measure, of = (beam.thinnest, "its thickness") if contact.thick else (shape.length, "its length")
    own = scene.bodies[contact.body].points
    held = not circle and any(joint.point in own for _, joint, _ in beam.ends)
    what = "that overlaps the circle" if circle else "on the wrong side of the edge, or overlapping the edge,"
    side = f"circle from {getattr(contact, 'side', '')}" if circle else "edge from the free side"
    yield from broken(
        depth > max(OVERLAP * measure, MEETING * shape.length if held else 0.0)
        and Mistake(
            key,
            f"the beam {contact.beam!r} {what} at the start by {depth:.3g} m, {depth / measure:.3g} of {of}",
            f"a beam that touches the {side} or is apart (overlap at most {OVERLAP:g} of {of})",
        )
    )


_ON_EDGE = 257
"""Samples of a curve, from the nearest of which Newton's method starts."""
_STEPS = 20


def distance(contact: Rigid, p: Array) -> Array:
    """The distances D (k,), m, of places ``p`` (k, 2), m, from a rigid shape."""
    sign = 1.0 if getattr(contact, "side", "") in ("outside", "left", "above") else -1.0
    match contact:
        case CircleContact():
            return np.asarray(sign * (np.hypot(*(p - np.array(contact.center)).T) - contact.radius))
        case LineContact():
            return _from_line(np.array(contact.points), sign, p, closed=contact.closed)
        case HalfPlaneContact():
            return np.asarray((p - np.array(contact.point)) @ unit_vector(contact.normal))
        case FunctionContact():
            sign *= 1.0 if (contact.range[0] < contact.range[1]) == (contact.axis == "x") else -1.0
        case EllipseContact():
            sign = -sign  # the curve runs counter-clockwise, with the inside on the left
    return _from_curve(shape_of(contact), sign, p, closed=isinstance(contact, EllipseContact))


def _from_line(points: Array, sign: float, p: Array, *, closed: bool) -> Array:
    along = np.diff(points, axis=0)
    length = np.hypot(*along.T)
    tau = along / length[:, None]
    r = p[:, None, :] - points[None, :-1]
    t = np.clip((r * tau).sum(axis=2), 0.0, length)
    away = r - t[:, :, None] * tau
    nearest, every = np.hypot(away[:, :, 0], away[:, :, 1]).argmin(axis=1), np.arange(len(p))
    away, t = away[every, nearest], t[every, nearest]
    # at a corner the directions of both pieces decide the side; no place is behind an end of an open line
    around = np.vstack((tau[-1:], tau, tau[:1])) if closed else np.pad(tau, ((1, 1), (0, 0)), constant_values=np.nan)
    towards = tau[nearest] + around[nearest + 1 + (t >= length[nearest]) - (t <= 0.0)]
    behind = sign * (towards[:, 0] * away[:, 1] - towards[:, 1] * away[:, 0]) < 0.0
    return np.asarray(np.where(behind, -1.0, 1.0) * np.hypot(*away.T))


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
