"""Shapes: curves that exist, sections that are beams, ends that meet bodies.

Bounds stand on dimensionless numbers only.  With thickness t, arc length L, curvature κ:

* 1e-5 ≤ t/L ≤ 0.2: above, no beam theory holds; below, EI/L³ leaves nothing above round-off;
* t κ / 2 < 0.5: the inner edge keeps at least half of the neutral line's length; where t varies, place by place;
* L ≥ 1e-6 of the largest coordinate: nearer to nothing, positions lose the digits the other checks ask for;
  and of a polynomial's largest term, for the same reason;
* |f'| ≤ 1e3 and degree ≤ 20 of a polynomial f: beyond, it is no good way to write the curve;
* a spline's points, at most 1001, lie at least 1e-6 of all their distances from the one before, and its speed against
  them is at least 0.1: nearer to nothing it has a cusp.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, isfinite

import numpy as np

from cprbm_scene import polynomial, spline
from cprbm_scene.check_profiles import has_sizes
from cprbm_scene.geometry import arc_length, curvature_on, distance, largest_coordinate, largest_curvature
from cprbm_scene.mistakes import Mistake, written_place
from cprbm_scene.statement import Arc, Beam, Curve, FreeEnd, PinnedEnd, Polynomial, Scene, Spline

THINNEST, THICKEST = 1e-5, 0.2
MOST_CURVED = 0.5
SHORTEST = 1e-6
STEEPEST = 1e3
HIGHEST_DEGREE = 20
MOST_POINTS = 1001
SLOWEST = 0.1
MEETING = 1e-6  # of the beam's length, or of the arc's radius
_SAMPLES = 2001  # of a beam whose thickness varies


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
            apart = distance(at, place)
            if not apart <= MEETING * arc_length(beam.curve) and not (side == "end" and may_be_apart(scene, beam)):
                yield Mistake(
                    f"beams.{name}.{side}",
                    f"a beam end that meets no body: the curve's {side} is at {written_place(at)} m, "
                    f"the point {end.point!r} at {written_place(place)} m, {apart:.3g} m apart",
                    f"at most {MEETING:g} of the beam's length between them",
                )


def may_be_apart(scene: Scene, beam: Beam) -> bool:
    """Whether the beam's end may be drawn apart from its point, to be brought there by an assembly."""
    return scene.assembly is not None and isinstance(beam.end, PinnedEnd)


def is_apart(scene: Scene, beam: Beam) -> bool:
    """Whether the beam's end is to be brought to its point, which exists and its curve too."""
    if not (may_be_apart(scene, beam) and _has_shape(beam.curve)) or isinstance(beam.end, FreeEnd):
        return False
    place = scene.place_of(beam.end.point)
    return not distance(beam.curve.end, place) <= MEETING * arc_length(beam.curve)


def is_beam(beam: Beam) -> bool:
    """Whether a beam's curve exists, its sizes are stated all along, and its thickness is in proportion to it."""
    return _has_shape(beam.curve) and has_sizes(beam) and _wrong_section("", beam) is None


def wrong_curve(key: str, curve: Curve) -> Mistake | None:
    """What is wrong with the curve at ``key``, if anything is."""
    if isinstance(curve, Polynomial) and (mistake := wrong_polynomial(key, curve)) is not None:
        return mistake
    if isinstance(curve, Spline) and (mistake := _wrong_spline(key, curve)) is not None:
        return mistake
    if curve.start == curve.end:
        return Mistake(
            key, f"a start and an end at the same place {written_place(curve.start)} m", "two different places"
        )
    if isinstance(curve, Arc):
        radii = distance(curve.start, curve.center), distance(curve.end, curve.center)
        if min(radii) == 0.0:
            return Mistake(key, "an end at the arc's own center", "ends on a circle about the center")
        if not abs(radii[1] - radii[0]) <= MEETING * radii[0]:
            return Mistake(
                key,
                f"ends that lie on no common circle: the start is {radii[0]:.9g} m from the center, "
                f"the end {radii[1]:.9g} m",
                f"distances that differ by at most {MEETING:g} of the radius",
            )
    length, largest = arc_length(curve), largest_coordinate(curve)
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


def wrong_polynomial(key: str, curve: Polynomial) -> Mistake | None:
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


def _wrong_spline(key: str, curve: Spline) -> Mistake | None:
    """What is wrong with a spline before its length can be asked."""
    if len(curve.points) > MOST_POINTS:
        return Mistake(f"{key}.points", f"{len(curve.points)} points", f"at most {MOST_POINTS} of them")
    for name in ("start_direction", "end_direction"):
        if getattr(curve, name) == (0.0, 0.0):
            return Mistake(f"{key}.{name}", "[0, 0]", "a direction, at least one number not zero")
    chords = spline.chords(curve)
    for i, chord in enumerate(chords, start=1):
        if not SHORTEST * sum(chords) <= chord < inf:
            return Mistake(
                f"{key}.points[{i}]",
                f"{written_place(curve.points[i])} m, {chord:.3g} m from the point before",
                f"a point at least {SHORTEST:g} of all the distances between the points away from the one before",
            )
    slowest, place = spline.slowest(curve)
    if not slowest >= SLOWEST:
        return Mistake(
            f"{key}.points",
            f"points through which a smooth line has to turn back on the spot, near {written_place(place)} m",
            "points (and directions) that a smooth line follows; more of them where it turns sharply",
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
