"""Gaps as drawn: of ends and their points, stops and limits, a beam and itself, another beam or a rigid shape.

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
"""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import atan2, degrees, dist, pi, tau

import numpy as np

from cprbm_scene.contact_records import Rigid, distance, measures
from cprbm_scene.curve_records import MEETING, SHORTEST, shape_of
from cprbm_scene.curves import Array, least
from cprbm_scene.mistakes import Mistake, broken, first_alone, first_broken, written_place
from cprbm_scene.statement import (
    Arc,
    Beam,
    BeamContact,
    CircleContact,
    PinnedEnd,
    RigidContact,
    Scene,
    Spline,
    Stop,
    TurningBody,
    WeldedEnd,
)

Range = tuple[float, float]

TAUT = 1e-6
"""Share of the length by which a beam must exceed the distance of its points: a taut beam is straight."""
ROUNDED = 1e-6
"""Angle, rad, by which a stop's angle as drawn may exceed a limit: coordinates are rounded."""
STRAIGHT = 1e-9
"""Distance, rad, from −π within which an angle counts as π: rounded coordinates yield both."""
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

    value, place = least(lambda u: nearest(u)[0], samples, refined_below=2.0 * (one.length + two.length) / _SAMPLES)
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
    depth = -beam_gap(first, second, *ranges_apart(scene, beams, JOINED * largest))[0] if contact.thick else 0.0
    if OVERLAP * mean < depth <= TOUCHING * mean:
        depth = -beam_gap(first, second, *ranges_apart(scene, beams, JOINED * largest, SIDE_BY_SIDE * largest))[0]
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
    gap, *places = beam_gap(*beams, *ranges_apart(scene, beams, CROSSING_ANGLE * shortest), thick=False)
    t1, t2 = (shape.tangent(np.array([u]))[0] for shape, u in zip(shapes, places, strict=True))
    crosses = (
        gap <= MEETING * shortest
        and all(1e-6 < u < 1.0 - 1e-6 for u in places)
        and abs(t1[0] * t2[1] - t1[1] * t2[0]) > CROSSING_ANGLE
    )
    return written_place(shapes[0].point(np.array(places[:1]))[0]) if crosses else ""


def ranges_apart(scene: Scene, beams: Sequence[Beam], left_out: float, near: float = 0.0) -> list[Range]:
    """Ranges of u of two beams without ``left_out`` (m) beside ends at the same place.

    Ends that are welded to the same body, up to ``near`` (m) from each other, count as such ends.
    """
    lengths = [shape_of(beam.curve).length for beam in beams]
    cut, owners, meeting = [WHOLE, WHOLE], scene.owners, MEETING * max(lengths)
    for ends in ((one, other) for one in beams[0].ends for other in beams[1].ends):
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
    held = not circle and any(joint.point in scene.bodies[contact.body].points for _, joint, _ in beam.ends)
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


def distant_ends(scene: Scene) -> Iterator[Mistake]:
    """Ends of beams away from their points, unless an assembly brings them together."""
    for name, beam in scene.beams.items():
        for side, joint, place in beam.ends:
            apart, point = _distance(scene, beam, side), str(joint.point)
            yield from broken(
                apart > 0.0
                and not (side == "end" and (is_apart(scene, beam) or scene.lacks("", "assembly")))
                and Mistake(
                    f"beams.{name}.{side}",
                    f"a beam end that meets no body: the curve's {side} is at {written_place(place)} m, the point "
                    f"{point!r} at {written_place(scene.place_of(point))} m, {apart:.3g} m apart",
                    f"at most {MEETING:g} of the beam's length between them",
                )
            )


def is_apart(scene: Scene, beam: Beam) -> bool:
    """True if an assembly brings the beam's end to the point."""
    return scene.assembly is not None and isinstance(beam.end, PinnedEnd) and _distance(scene, beam, "end") > 0.0


def _distance(scene: Scene, beam: Beam, side: str) -> float:
    """Distance of an end from the point, m; zero if the end meets the point or has none."""
    point = getattr(beam, side).point
    apart = dist(getattr(beam.curve, side), scene.place_of(point)) if point in scene.owners else 0.0
    return apart if apart > MEETING * shape_of(beam.curve).length else 0.0


def wrong_assembly(scene: Scene) -> Iterator[Mistake]:
    """An assembly without distant ends, moments on other ends, beams too short for their points."""
    apart = [name for name, beam in scene.beams.items() if is_apart(scene, beam)]
    moments = scene.assembly.moments if scene.assembly is not None and apart else ()
    yield from broken(
        scene.assembly is not None
        and not apart
        and scene.whole()
        and Mistake(
            "assembly",
            "no beam with an end to be brought to its point",
            "a beam whose pinned end is drawn apart from its point, or no assembly",
        ),
        *(
            name not in apart
            and Mistake(
                f"assembly.moments.{name}",
                f"a moment on {name!r}, whose end is where it belongs",
                f"a beam whose end is drawn apart: {', '.join(map(repr, apart))}",
            )
            for name in moments
        ),
    )
    for name in apart:
        beam = scene.beams[name]
        point, length = str(beam.end.point), shape_of(beam.curve).length
        reach = dist(beam.curve.start, scene.place_of(point))
        yield from broken(
            not isinstance(beam.start, WeldedEnd)
            and Mistake(
                f"beams.{name}.start",
                f"a {beam.start.joint!r} at the start of a beam whose end is to be brought to its point",
                "a weld: the beam has to stand by itself before it is assembled",
            ),
            isinstance(beam.start, WeldedEnd)
            and _stays(scene, beam.start.point)
            and _stays(scene, point)
            and reach >= (1.0 - TAUT) * length
            and Mistake(
                f"beams.{name}.end",
                f"a beam too short to reach {point!r}: {length:.6g} m long, on a way of {reach:.6g} m",
                "a beam that is longer than the way between its two points",
            ),
        )


def _stays(scene: Scene, point: str | None) -> bool:
    """True if a point is at rest without loads and with all drives at zero."""
    name = scene.body_of(str(point))
    body, turned = scene.bodies[name], [getattr(drive, "body", None) for drive in scene.drives.values()]
    return body.motion == "fixed" or (isinstance(body, TurningBody) and (body.about == point or name in turned))


def wrong_stops(scene: Scene) -> Iterator[Mistake]:
    """Stops of an end without pin or with another stop, without direction, or with limits exceeded in the drawing."""
    taken, owners = dict[tuple[str, str], str](), scene.owners
    for name, stop in scene.stops.items():
        key, first = f"stops.{name}", taken.setdefault((stop.beam, stop.end), name)
        joint = getattr(scene.beams[stop.beam], stop.end)
        body, other = owners.get(joint.point), owners[stop.towards]
        yield from broken(
            first != name
            and Mistake(key, f"the {stop.end} of {stop.beam!r}, which stops.{first} limits", "one stop for each end")
        )
        mistakes = first_broken(
            not isinstance(joint, PinnedEnd)
            and Mistake(
                f"{key}.end",
                f"the {stop.end} of {stop.beam!r}, whose joint is {joint.joint!r}",
                "an end whose joint is 'pin'",
            ),
            body != other
            and Mistake(
                f"{key}.towards",
                f"{stop.towards!r}, a point of {other!r}",
                f"a point of {body!r}, to which the end is pinned",
            ),
            body == other
            and scene.place_of(stop.towards) == scene.place_of(joint.point)
            and Mistake(f"{key}.towards", f"{stop.towards!r}, which is where the pin is", "a point away from it"),
        )
        drawn = stop.end == "start" or not is_apart(scene, scene.beams[stop.beam])
        yield from list(mistakes) or (_exceeded_as_drawn(scene, key, stop) if drawn else ())


def _exceeded_as_drawn(scene: Scene, key: str, stop: Stop) -> Iterator[Mistake]:
    """Limits that the angle of a drawn end exceeds."""
    beam, sense = scene.beams[stop.beam], 1.0 if stop.end == "start" else -1.0
    tangent = sense * shape_of(beam.curve).tangent(np.array([float(stop.end == "end")]))[0]
    line = np.subtract(scene.place_of(stop.towards), scene.place_of(getattr(beam, stop.end).point))
    angle = (atan2(*tangent[::-1]) - atan2(*line[::-1])) % tau
    angle -= tau if angle > pi + STRAIGHT else 0.0
    stands = f"rad, where the beam as drawn stands at {angle:.6g} rad ({degrees(angle):.4g} degrees)"
    allowed = "limits between which the beam stands as it is drawn"
    return broken(
        stop.least is not None
        and stop.least - angle > ROUNDED
        and Mistake(f"{key}.least", f"{stop.least:g} {stands}", allowed),
        stop.most is not None
        and angle - stop.most > ROUNDED
        and Mistake(f"{key}.most", f"{stop.most:g} {stands}", allowed),
    )
