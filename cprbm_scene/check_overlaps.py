"""Overlap of beams with other beams or themselves as drawn, and repeated contacts.

======  ================================================
symbol  meaning
======  ================================================
t       thickness, m
s       arc length, m; Δs between two places of a beam
d       distance of the places in the plane, m
κ       largest curvature, 1/m; t κ < 1 for every beam
======  ================================================

Contact of a beam with itself.  By Schur's comparison theorem d ≥ (2/κ) sin(κ Δs/2) for Δs ≤ 2π/κ.  With t κ < 1, places
of d < t are therefore either neighbours, Δs ≤ 1.05 d, or have Δs > 5 t.  Lines and
graphs have no places of the second kind: with enough rotation of the tangent, by the angle φ, a graph extends along
the axis by ∫ cos φ dφ/κ > 1.9 t.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import dist

import numpy as np

from cprbm_scene.beam_records import Beam, WeldedEnd
from cprbm_scene.closest import WHOLE, ClosestPair, Range, closest_pair
from cprbm_scene.curve_records import MEETING, shape_of
from cprbm_scene.mistakes import Mistake, written_place
from cprbm_scene.statement import Arc, BeamContact, RigidContact, Scene, Spline

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
_SAMPLES = 1501


def repeated_contacts(scene: Scene) -> Iterator[Mistake]:
    """Contacts of the same beams, or of the same beam and rigid shape."""
    seen: dict[object, str] = {}
    for name, contact in scene.contacts.items():
        rigid, paired = isinstance(contact, RigidContact), isinstance(contact, BeamContact)
        shape = tuple(value for field, value in contact if field not in {"thick", "paper"})
        first = seen.setdefault(shape if rigid else frozenset(contact.beams), name)
        if first != name:
            what, part = ("beam and the shape", "") if rigid else ("pair", ".between") if paired else ("beam", ".beam")
            yield Mistake(f"contacts.{name}{part}", f"the {what} of contacts.{first} again", f"each {what} once")


def overlapping_beams(scene: Scene) -> Iterator[Mistake]:
    """Overlap (thick beams) or crossing (lines) of the beams of a contact as drawn; not beside shared ends."""
    for name, contact in scene.contacts.items():
        if not isinstance(contact, BeamContact) or contact.between[0] == contact.between[1]:
            continue
        first, second = (scene.beams.get(beam) for beam in contact.between)
        if first is None or second is None or not (first.sound and second.sound):
            continue
        found = _too_deep(scene, first, second) if contact.thick else _crossing(first, second)
        if found is not None:
            beams = f"{contact.between[0]!r} and {contact.between[1]!r}"
            yield Mistake(f"contacts.{name}", f"{beams} {found[0]}", found[1])


def overlap_at_rest(scene: Scene, contact: BeamContact) -> float:
    """Overlap of thick beams as drawn, m; 0 for round-off, for lines, and for an overlap only beside shared ends.

    Beside ends welded side by side to the same body an overlap up to :data:`TOUCHING` is left out.  Solvers subtract
    the overlap from the distance at which the beams touch.
    """
    first, second = (scene.beams[beam] for beam in contact.between)
    return _overlap(scene, first, second) if contact.thick else 0.0


def _overlap(scene: Scene, first: Beam, second: Beam) -> float:
    mean, largest = 0.5 * (first.thinnest + second.thinnest), 0.5 * (first.thickest + second.thickest)
    ranges = _apart_from_shared(first, second, JOINED * largest)
    depth = 0.0 if ranges is None else -closest_pair(first, second, *ranges).gap
    if ranges is not None and OVERLAP * mean < depth <= TOUCHING * mean:
        beside = _apart_from_held(scene, (first, second), largest, ranges)
        if not all(low < high for low, high in beside):
            return 0.0
        depth = -closest_pair(first, second, *beside).gap
    return depth if depth > OVERLAP * mean else 0.0


def _too_deep(scene: Scene, first: Beam, second: Beam) -> tuple[str, str] | None:
    """Values found and allowed for thick beams; None without an overlap beyond touching."""
    mean, depth = 0.5 * (first.thinnest + second.thinnest), _overlap(scene, first, second)
    allowed = OVERLAP if first.tapered or second.tapered else TOUCHING
    if depth <= allowed * mean:
        return None
    return (
        f"that overlap at the start by {depth:.3g} m, {depth / mean:.3g} of their mean thickness",
        f"beams that touch or are apart (overlap at most {allowed:g} of the mean thickness)",
    )


def _crossing(first: Beam, second: Beam) -> tuple[str, str] | None:
    """Values found and allowed for beams as lines; None without a crossing."""
    shapes = shape_of(first.curve), shape_of(second.curve)
    shortest = min(shape.length for shape in shapes)
    ranges = _apart_from_shared(first, second, CROSSING_ANGLE * shortest)
    if ranges is None:
        return None
    pair = closest_pair(first, second, *ranges, thick=False)
    t1, t2 = (shape.tangent(np.array([u]))[0] for shape, u in zip(shapes, (pair.u1, pair.u2), strict=True))
    inside = all(1e-6 < u < 1.0 - 1e-6 for u in (pair.u1, pair.u2))
    if not (inside and pair.gap <= MEETING * shortest and abs(t1[0] * t2[1] - t1[1] * t2[0]) > CROSSING_ANGLE):
        return None
    x, y = shapes[0].point(np.array([pair.u1]))[0]
    return f"that cross at the start, at {written_place((x, y))} m", "neutral lines that touch or are apart"


def _apart_from_shared(first: Beam, second: Beam, left_out: float) -> tuple[Range, Range] | None:
    """Ranges of u without ``left_out`` (m) beside shared ends; None if nothing is left."""
    lengths = [shape_of(beam.curve).length for beam in (first, second)]
    near, ranges = MEETING * max(lengths), list[Range]()
    for beam, other, length in ((first, second, lengths[0]), (second, first, lengths[1])):
        starts, ends = (
            any(dist(place, end) <= near for end in (other.curve.start, other.curve.end))
            for place in (beam.curve.start, beam.curve.end)
        )
        ranges.append((left_out / length if starts else 0.0, 1.0 - left_out / length if ends else 1.0))
    return (ranges[0], ranges[1]) if all(low < high for low, high in ranges) else None


def _apart_from_held(
    scene: Scene, beams: tuple[Beam, Beam], mean: float, ranges: tuple[Range, Range]
) -> tuple[Range, Range]:
    """The ranges of u without stretches beside ends welded side by side to the same body."""
    owners, cut = scene.owners, list(ranges)
    for sides in product(("start", "end"), repeat=2):
        joints = [getattr(beam, side) for beam, side in zip(beams, sides, strict=True)]
        places = [getattr(beam.curve, side) for beam, side in zip(beams, sides, strict=True)]
        bodies = [owners.get(joint.point) if isinstance(joint, WeldedEnd) else None for joint in joints]
        if bodies[0] is None or bodies[0] != bodies[1] or dist(*places) > SIDE_BY_SIDE * mean:
            continue
        for i, (beam, side) in enumerate(zip(beams, sides, strict=True)):
            (low, high), share = cut[i], JOINED * mean / shape_of(beam.curve).length
            cut[i] = (max(low, share), high) if side == "start" else (low, min(high, 1.0 - share))
    return cut[0], cut[1]


def overlapping_themselves(scene: Scene) -> Iterator[Mistake]:
    """Arcs and splines closer to themselves than their thickness."""
    for name, beam in scene.beams.items():
        pair = _itself(beam) if isinstance(beam.curve, Arc | Spline) and beam.sound else None
        if pair is None:
            continue
        thickness = float(np.mean(beam.thickness_at(np.array([pair.u1, pair.u2]))))
        if -pair.gap > OVERLAP * thickness:
            x, y = shape_of(beam.curve).point(np.array([pair.u1]))[0]
            found = f"a beam that overlaps itself: near {written_place((x, y))} m it comes to "
            found += f"{thickness + pair.gap:.3g} m from itself, and is {thickness:g} m thick"
            yield Mistake(f"beams.{name}.curve", found, "a curve that keeps a thickness away from itself")


def _itself(beam: Beam) -> ClosestPair | None:
    """Closest places of a beam, neighbours excluded; None if all such places are far apart."""
    from scipy.spatial import cKDTree  # scenes of lines and graphs need no SciPy

    shape, u = shape_of(beam.curve), np.linspace(*WHOLE, _SAMPLES)
    step = 2.0 / (_SAMPLES - 1)
    p, half = shape.point(u), 0.5 * beam.thickness_at(u)
    i, j = cKDTree(p).query_pairs(beam.thickest + step * shape.length, output_type="ndarray").T
    far = (u[j] - u[i]) * shape.length > NEIGHBOURS * beam.thickest
    i, j = i[far], j[far]
    if len(i) == 0:
        return None
    k = int(np.argmin(np.hypot(*(p[i] - p[j]).T) - half[i] - half[j]))
    ranges = [(max(0.0, at - step), min(1.0, at + step)) for at in (float(u[i[k]]), float(u[j[k]]))]
    return closest_pair(beam, beam, *ranges)
