"""Beams of a contact: two different ones or one and itself, each once, that do not overlap or cross as drawn."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Literal

import numpy as np

from cprbm_scene.check_shapes import MEETING, is_beam
from cprbm_scene.geometry import arc_length, closest_pair, distance, largest_coordinate, points_on, scaled, tangents_on
from cprbm_scene.mistakes import Mistake, written_place
from cprbm_scene.statement import Beam, BeamContact, BeamEnd, Curve, Scene, SelfContact, WeldedEnd
from cprbm_scene.surfaces import Range, surfaces_apart

Side = Literal["start", "end"]

OVERLAP = 1e-6  # of the mean thickness, where both beams are thinnest
HELD_OVERLAP = 1e-3  # of the mean thickness, beside ends that one body holds: coordinates that were rounded
CROSSING_ANGLE = 1e-3  # rad; lines that meet at less are taken as tangent
JOINED = 5.0  # mean thicknesses beside a shared end in which an overlap is no mistake
SIDE_BY_SIDE = 2.0  # mean thicknesses between ends that one body holds beside each other


def wrong_contacts(scene: Scene) -> Iterator[Mistake]:
    """A beam named as its own partner, and pairs or beams that may touch themselves named twice."""
    seen: dict[frozenset[str], str] = {}
    for name, contact in scene.contacts.items():
        if not isinstance(contact, BeamContact | SelfContact):
            continue
        paired = isinstance(contact, BeamContact)
        key = f"contacts.{name}.{'between' if paired else 'beam'}"
        beams = frozenset(contact.beams)
        if paired and len(beams) == 1:
            found = f"{contact.beams[0]!r} twice"
            yield Mistake(key, found, "two different beams; a beam may touch itself in a contact of kind 'beam-self'")
            continue
        if beams in seen:
            what, allowed = ("pair", "each pair of beams once") if paired else ("beam", "each beam once")
            yield Mistake(key, f"the {what} of contacts.{seen[beams]} again", allowed)
        seen.setdefault(beams, name)


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
        if not (is_beam(first) and is_beam(second)):
            continue
        found = _overlap(first, second, _welded_to(scene, first, second), thick=contact.thick)
        if found is not None:
            beams = f"{contact.between[0]!r} and {contact.between[1]!r}"
            yield Mistake(f"contacts.{name}", f"{beams} {found[0]}", found[1])


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
    size = max(largest_coordinate(first.curve), largest_coordinate(second.curve))
    curve1, curve2 = scaled(first.curve, size), scaled(second.curve, size)
    largest = 0.5 * (first.thickest + second.thickest) / size
    mean = 0.5 * (first.thinnest + second.thinnest) / size
    left_out = JOINED * largest if thick else CROSSING_ANGLE * min(arc_length(curve1), arc_length(curve2))
    range1, range2 = (
        _apart_from_shared(curve1, curve2, left_out),
        _apart_from_shared(curve2, curve1, left_out),
    )
    if range1[0] >= range1[1] or range2[0] >= range2[1]:
        return None

    def depth_in(ranges: tuple[Range, Range]) -> float:
        if first.tapered or second.tapered:
            return -surfaces_apart((first, second), (curve1, curve2), size, ranges)
        return mean - closest_pair(curve1, curve2, *ranges).distance

    if thick:
        depth = depth_in((range1, range2))
        if depth <= OVERLAP * mean:
            return None
        if depth <= HELD_OVERLAP * mean:
            beside = _apart_from_held(curve1, curve2, welded, largest, (range1, range2))
            if not all(low < high for low, high in beside):
                return None
            if beside != (range1, range2) and depth_in(beside) <= OVERLAP * mean:
                return None
        return (
            f"that overlap at the start by {depth * size:.3g} m, {depth / mean:.3g} of their mean thickness",
            f"beams that touch or are apart (overlap at most {OVERLAP:g} of the mean thickness)",
        )
    pair = closest_pair(curve1, curve2, range1, range2)
    t1 = tangents_on(curve1, np.array([pair.u1]))[0]
    t2 = tangents_on(curve2, np.array([pair.u2]))[0]
    inside = all(1e-6 < u < 1.0 - 1e-6 for u in (pair.u1, pair.u2))
    meets = pair.distance <= MEETING * min(arc_length(curve1), arc_length(curve2))
    if not (inside and meets and abs(t1[0] * t2[1] - t1[1] * t2[0]) > CROSSING_ANGLE):
        return None
    place = points_on(curve1, np.array([pair.u1]))[0] * size
    where = written_place((float(place[0]), float(place[1])))
    return f"that cross at the start, at {where} m", "neutral lines that touch or are apart"


def _apart_from_shared(curve: Curve, other: Curve, left_out: float) -> Range:
    """Range of u on ``curve`` without ``left_out`` metres beside an end that is an end of ``other`` too."""
    length = arc_length(curve)
    share = left_out / length
    low, high = 0.0, 1.0
    near = MEETING * max(length, arc_length(other))
    for end in (other.start, other.end):
        if distance(curve.start, end) <= near:
            low = share
        if distance(curve.end, end) <= near:
            high = 1.0 - share
    return low, high


def _apart_from_held(
    curve1: Curve,
    curve2: Curve,
    welded: list[tuple[Side, Side]],
    mean: float,
    ranges: tuple[Range, Range],
) -> tuple[Range, Range]:
    """The ranges of u without the stretches beside ends that one body holds side by side."""
    shares = JOINED * mean / arc_length(curve1), JOINED * mean / arc_length(curve2)
    cut = list(ranges)
    for sides in welded:
        ends = [
            curve.start if side == "start" else curve.end for curve, side in zip((curve1, curve2), sides, strict=True)
        ]
        if distance(*ends) > SIDE_BY_SIDE * mean:
            continue
        for i, (side, share) in enumerate(zip(sides, shares, strict=True)):
            low, high = cut[i]
            cut[i] = (max(low, share), high) if side == "start" else (low, min(high, 1.0 - share))
    return cut[0], cut[1]
