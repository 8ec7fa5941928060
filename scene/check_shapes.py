"""Shapes: curves that exist, sections that are beams, ends that meet bodies, beams that do not overlap.

Bounds stand on dimensionless numbers only.  With thickness t, arc length L, curvature κ:

* 1e-5 ≤ t/L ≤ 0.2: above, no beam theory holds; below, EI/L³ leaves nothing above round-off;
* t κ / 2 < 0.5: the inner edge keeps at least half of the neutral line's length; where t varies, place by place;
* L ≥ 1e-6 of the largest coordinate: nearer to nothing, positions lose the digits the other checks ask for;
  and of a polynomial's largest term, for the same reason;
* |f'| ≤ 1e3 and degree ≤ 20 of a polynomial f: beyond, it is no good way to write the curve.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import hypot, inf, isfinite
from typing import Literal

import numpy as np

from scene import polynomial
from scene.check_profiles import has_sizes
from scene.geometry import arc_length, closest_pair, curvature_on, largest_curvature, points_on, scaled, tangents_on
from scene.mistakes import Mistake
from scene.statement import Arc, Beam, BeamContact, BeamEnd, Curve, FreeEnd, Point, Polynomial, Scene, WeldedEnd

Side = Literal["start", "end"]

THINNEST, THICKEST = 1e-5, 0.2
MOST_CURVED = 0.5
SHORTEST = 1e-6
STEEPEST = 1e3
HIGHEST_DEGREE = 20
MEETING = 1e-6  # of the beam's length, or of the arc's radius
OVERLAP = 1e-6  # of the mean thickness
HELD_OVERLAP = 1e-3  # of the mean thickness, beside ends that one body holds: coordinates that were rounded
CROSSING_ANGLE = 1e-3  # rad; lines that meet at less are taken as tangent
_SAMPLES = 2001  # of a beam whose thickness varies
JOINED = 5.0  # mean thicknesses beside a shared end in which an overlap is no mistake
SIDE_BY_SIDE = 2.0  # mean thicknesses between ends that one body holds beside each other


def wrong_curves(scene: Scene) -> Iterator[Mistake]:
    """Curves without length, arcs whose ends lie on no common circle, polynomials that state no curve."""
    for name, beam in scene.beams.items():
        mistake = wrong_curve(f"beams.{name}.curve", beam.curve)
        if mistake is not None:
            yield mistake


def wrong_sections(scene: Scene) -> Iterator[Mistake]:
    """Thicknesses out of proportion to the beam's length or curvature."""
    for name, beam in scene.beams.items():
        if _has_shape(beam.curve) and has_sizes(beam) and (mistake := _wrong_section(name, beam)) is not None:
            yield mistake


def wrong_ends(scene: Scene) -> Iterator[Mistake]:
    """Ends of beams that meet no body where they are said to."""
    places = {name: place for body in scene.bodies.values() for name, place in body.points.items()}
    for name, beam in scene.beams.items():
        if not _has_shape(beam.curve):
            continue
        for side, end, at in (
            ("start", beam.start, beam.curve.start),
            ("end", beam.end, beam.curve.end),
        ):
            if isinstance(end, FreeEnd) or end.point not in places:
                continue
            place = places[end.point]
            apart = _distance(at, place)
            if not apart <= MEETING * arc_length(beam.curve):
                yield Mistake(
                    f"beams.{name}.{side}",
                    f"a beam end that meets no body: the curve's {side} is at {_at(at)} m, "
                    f"the point {end.point!r} at {_at(place)} m, {apart:.3g} m apart",
                    f"at most {MEETING:g} of the beam's length between them",
                )


def wrong_contacts(scene: Scene) -> Iterator[Mistake]:
    """Contacts of a beam with itself, and pairs named twice."""
    seen: dict[frozenset[str], str] = {}
    for name, contact in scene.contacts.items():
        if not isinstance(contact, BeamContact):
            continue
        key = f"contacts.{name}"
        pair = frozenset(contact.between)
        if len(pair) == 1:
            yield Mistake(f"{key}.between", f"{contact.between[0]!r} twice", "two different beams")
        elif pair in seen:
            yield Mistake(f"{key}.between", f"the pair of contacts.{seen[pair]} again", "each pair of beams once")
        seen.setdefault(pair, name)


def overlaps(scene: Scene) -> Iterator[Mistake]:
    """Beams of a contact that overlap (thick) or cross (lines) where they start.

    Where the two beams share an end, they overlap there by their nature: a stretch of a few thicknesses
    beside the shared end is left out of the check.  Where one body holds two ends side by side, no motion changes
    the gap between them: there an overlap may be as large as rounded coordinates make it.
    """
    for name, contact in scene.contacts.items():
        if not isinstance(contact, BeamContact):
            continue
        first, second = (scene.beams.get(beam) for beam in contact.between)
        if first is None or second is None or contact.between[0] == contact.between[1]:
            continue
        if not (is_beam(first) and is_beam(second)) or (contact.thick and (first.tapered or second.tapered)):
            continue
        found = _overlap(first, second, _welded_to(scene, first, second), thick=contact.thick)
        if found is not None:
            beams = f"{contact.between[0]!r} and {contact.between[1]!r}"
            yield Mistake(f"contacts.{name}", f"{beams} {found[0]}", found[1])


def is_beam(beam: Beam) -> bool:
    """Whether a beam's curve exists, its sizes are stated all along, and its thickness is in proportion to it."""
    return _has_shape(beam.curve) and has_sizes(beam) and _wrong_section("", beam) is None


def wrong_curve(key: str, curve: Curve) -> Mistake | None:
    """What is wrong with the curve at ``key``, if anything is."""
    if isinstance(curve, Polynomial) and (mistake := _wrong_polynomial(key, curve)) is not None:
        return mistake
    if curve.start == curve.end:
        return Mistake(key, f"a start and an end at the same place {_at(curve.start)} m", "two different places")
    if isinstance(curve, Arc):
        radii = _distance(curve.start, curve.center), _distance(curve.end, curve.center)
        if min(radii) == 0.0:
            return Mistake(key, "an end at the arc's own center", "ends on a circle about the center")
        if not abs(radii[1] - radii[0]) <= MEETING * radii[0]:
            return Mistake(
                key,
                f"ends that lie on no common circle: the start is {radii[0]:.9g} m from the center, "
                f"the end {radii[1]:.9g} m",
                f"distances that differ by at most {MEETING:g} of the radius",
            )
    length, largest = arc_length(curve), _largest_coordinate(curve)
    if not SHORTEST * largest <= length < float("inf"):
        return Mistake(
            key,
            f"a length of {length:.3g} m at coordinates up to {largest:.3g} m",
            f"a length of at least {SHORTEST:g} of the largest coordinate",
        )
    if isinstance(curve, Polynomial) and not SHORTEST * polynomial.terms(curve) <= length:
        return Mistake(
            f"{key}.coefficients",
            f"a term of {polynomial.terms(curve):.3g} m in a curve of {length:.3g} m",
            f"a length of at least {SHORTEST:g} of the largest term",
        )
    return None


def _wrong_polynomial(key: str, curve: Polynomial) -> Mistake | None:
    """What is wrong with a polynomial before its length can be asked."""
    degree = len(curve.coefficients) - 1
    if degree > HIGHEST_DEGREE:
        allowed = f"at most {HIGHEST_DEGREE + 1} of them"
        return Mistake(f"{key}.coefficients", f"{degree + 1} coefficients", allowed)
    first, last = curve.range
    if first == last:
        found = f"a range from {first:g} m to the same {last:g} m"
        return Mistake(f"{key}.range", found, "two different values")
    slope = polynomial.steepest(curve) if isfinite(polynomial.terms(curve)) and isfinite(last - first) else inf
    if not slope <= STEEPEST:
        other = {"x": "y", "y": "x"}[curve.axis]
        return Mistake(
            f"{key}.coefficients",
            f"a slope of up to {slope:.3g} in the range",
            f"a slope of at most {STEEPEST:g} (a steeper curve may be a function of {other})",
        )
    return None


def _has_shape(curve: Curve) -> bool:
    return wrong_curve("", curve) is None


def _wrong_section(name: str, beam: Beam) -> Mistake | None:
    key, length = f"beams.{name}.thickness", arc_length(beam.curve)
    for thickness in (beam.thinnest, beam.thickest):
        if not THINNEST <= thickness / length <= THICKEST:
            return Mistake(
                key,
                f"{thickness:g} m, which is {thickness / length:.3g} of the beam's length",
                f"a thickness between {THINNEST:g} and {THICKEST:g} of the beam's length",
            )
    thickness, curvature = beam.thickest, largest_curvature(beam.curve)
    if beam.tapered and 0.5 * thickness * curvature >= MOST_CURVED:
        u = np.union1d(np.linspace(0.0, 1.0, _SAMPLES), beam.knots)
        bend = beam.thickness_at(u) * curvature_on(beam.curve, u)
        worst = u[[bend.argmax()]]
        thickness, curvature = float(beam.thickness_at(worst)[0]), float(curvature_on(beam.curve, worst)[0])
    bentness = 0.5 * thickness * curvature
    if bentness >= MOST_CURVED:
        return Mistake(
            key,
            f"{thickness:g} m, half of which is {bentness:.3g} of the radius of curvature",
            f"half a thickness less than {MOST_CURVED:g} of the radius of curvature",
        )
    return None


def _welded_to(scene: Scene, first: Beam, second: Beam) -> list[tuple[Side, Side]]:
    """The ends of two beams, one of each, that are welded to the same body."""
    owners = {point: name for name, body in scene.bodies.items() for point in body.points}
    return [
        (side1, side2)
        for (side1, end1), (side2, end2) in product(_ends(first), _ends(second))
        if isinstance(end1, WeldedEnd)
        and isinstance(end2, WeldedEnd)
        and end1.point in owners
        and owners[end1.point] == owners.get(end2.point)
    ]


def _ends(beam: Beam) -> tuple[tuple[Side, BeamEnd], tuple[Side, BeamEnd]]:
    return ("start", beam.start), ("end", beam.end)


def _overlap(first: Beam, second: Beam, welded: list[tuple[Side, Side]], *, thick: bool) -> tuple[str, str] | None:
    """What is wrong between two beams, and what is allowed; None where nothing is."""
    size = max(_largest_coordinate(first.curve), _largest_coordinate(second.curve))
    curve1, curve2 = scaled(first.curve, size), scaled(second.curve, size)
    mean = 0.5 * (first.thickest + second.thickest) / size
    left_out = JOINED * mean if thick else CROSSING_ANGLE * min(arc_length(curve1), arc_length(curve2))
    range1, range2 = (
        _apart_from_shared(curve1, curve2, left_out),
        _apart_from_shared(curve2, curve1, left_out),
    )
    if range1[0] >= range1[1] or range2[0] >= range2[1]:
        return None
    pair = closest_pair(curve1, curve2, range1, range2)
    if thick:
        depth = mean - pair.distance
        if depth <= OVERLAP * mean:
            return None
        if depth <= HELD_OVERLAP * mean:
            beside = _apart_from_held(curve1, curve2, welded, mean, (range1, range2))
            if not all(low < high for low, high in beside):
                return None
            away = closest_pair(curve1, curve2, *beside)
            if beside != (range1, range2) and mean - away.distance <= OVERLAP * mean:
                return None
        return (
            f"that overlap at the start by {depth * size:.3g} m, {depth / mean:.3g} of their mean thickness",
            f"beams that touch or are apart (overlap at most {OVERLAP:g} of the mean thickness)",
        )
    t1 = tangents_on(curve1, np.array([pair.u1]))[0]
    t2 = tangents_on(curve2, np.array([pair.u2]))[0]
    inside = all(1e-6 < u < 1.0 - 1e-6 for u in (pair.u1, pair.u2))
    meets = pair.distance <= MEETING * min(arc_length(curve1), arc_length(curve2))
    if not (inside and meets and abs(t1[0] * t2[1] - t1[1] * t2[0]) > CROSSING_ANGLE):
        return None
    place = points_on(curve1, np.array([pair.u1]))[0] * size
    where = _at((float(place[0]), float(place[1])))
    return f"that cross at the start, at {where} m", "neutral lines that touch or are apart"


def _apart_from_shared(curve: Curve, other: Curve, left_out: float) -> tuple[float, float]:
    """Range of u on ``curve`` without ``left_out`` metres beside an end that is an end of ``other`` too."""
    length = arc_length(curve)
    share = left_out / length
    low, high = 0.0, 1.0
    near = MEETING * max(length, arc_length(other))
    for end in (other.start, other.end):
        if _distance(curve.start, end) <= near:
            low = share
        if _distance(curve.end, end) <= near:
            high = 1.0 - share
    return low, high


def _apart_from_held(
    curve1: Curve,
    curve2: Curve,
    welded: list[tuple[Side, Side]],
    mean: float,
    ranges: tuple[tuple[float, float], tuple[float, float]],
) -> tuple[tuple[float, float], tuple[float, float]]:
    """The ranges of u without the stretches beside ends that one body holds side by side."""
    shares = JOINED * mean / arc_length(curve1), JOINED * mean / arc_length(curve2)
    cut = list(ranges)
    for sides in welded:
        ends = [
            curve.start if side == "start" else curve.end for curve, side in zip((curve1, curve2), sides, strict=True)
        ]
        if _distance(*ends) > SIDE_BY_SIDE * mean:
            continue
        for i, (side, share) in enumerate(zip(sides, shares, strict=True)):
            low, high = cut[i]
            cut[i] = (max(low, share), high) if side == "start" else (low, min(high, 1.0 - share))
    return cut[0], cut[1]


def _distance(a: Point, b: Point) -> float:
    return hypot(b[0] - a[0], b[1] - a[1])


def _largest_coordinate(curve: Curve) -> float:
    places = [curve.start, curve.end, *([curve.center] if isinstance(curve, Arc) else [])]
    return max(abs(coordinate) for place in places for coordinate in place)


def _at(place: Point) -> str:
    return f"({place[0]:.9g}, {place[1]:.9g})"
