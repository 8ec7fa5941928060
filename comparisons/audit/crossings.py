"""Undeclared contact: overlaps of two beams, or of a beam and a rigid edge, without a contact of the pair.

======  ===========================================================================
symbol  meaning
======  ===========================================================================
A, B    outlines: the regions of the plane that two shapes cover
d       depth of their overlap, m
t       thickness of a beam, m
e       chord error of a drawn neutral line, m
h, θ    length of a segment of the line, m; turn between two segments, rad
======  ===========================================================================

The outline of a beam holds all places within t/2 of the neutral line; the arc over a segment stands out from the chord
by e = hθ/8.  Where the overlap A ∩ B splits neither shape, d is the largest distance of a place in the overlap from the
border of A or of B.  Where B splits A into parts and A splits B, d is the smaller of two lengths: the second largest
distance of a part of A from B, and the second largest distance of a part of B from A.

No crossing is a pair with a contact, with a common joint, with a touch or an overlap as drawn, or in the scene's
``may_cross``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import shapely
from shapely.affinity import rotate, translate
from shapely.geometry.base import BaseGeometry

from comparisons.audit.contacts import DEEP
from comparisons.geometry import edge_places
from cprbm_scene import Answer, Scene, StationAnswer
from cprbm_scene.geometry import arc_length, points_on
from cprbm_scene.statement import (
    CircleContact,
    EdgeContact,
    FixedBody,
    FreeEnd,
    RigidContact,
)

_LINES = 1.0  # permitted depth beside a beam in a contact of lines: a joint on the line touches with the full thickness
_FRACTIONS = np.linspace(0.0, 1.0, 201)  # of a curve as drawn: in an arc of 90° e is 1e-5 of the length
_FAR = 1e3  # length of the edge of a half-plane, in lengths of the longest beam
_THIN = 1e-6  # thickness of a rigid line, in lengths of the longest beam

Drawn = dict[str, BaseGeometry]
Pair = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Crossing:
    """Overlap of two shapes.

    Attributes:
        one: name of a beam.
        other: name of another beam, or of the first contact with a rigid edge.
        stage: name of the stage of the first station with an overlap.
        value: load or drive of the stage at this station, SI.
        depth: the largest d at any station, m.
    """

    one: str
    other: str
    stage: str
    value: float
    depth: float


def crossings(scene: Scene, answer: Answer) -> tuple[Crossing, ...]:
    """Pairs of shapes with an undeclared overlap at stations of an answer.

    Args:
        scene: the question.
        answer: of any solver.  Without a stated motion of the body, a rigid edge on a moving body is left out.

    Returns:
        One record for each pair, in the order of the first stations.
    """
    rigid = {name: contact for name, contact in scene.contacts.items() if isinstance(contact, RigidContact)}
    edge_of = _edge_names(rigid)
    size = max(arc_length(beam.curve) for beam in scene.beams.values())
    edges = {name: _edge(rigid[name], size) for name in edge_of.values()}
    allowed = _allowed(scene, edge_of)
    resting: Drawn = {name: shapely.LineString(points_on(beam.curve, _FRACTIONS)) for name, beam in scene.beams.items()}
    resting |= edges
    for pair, shallow in _near(scene, resting, allowed):
        if shapely.distance(*(_outline(scene, name, resting) for name in pair)) <= shallow:
            allowed.add(frozenset(pair))
    found: dict[Pair, Crossing] = {}
    for station in answer.stations:
        drawn = _drawn(scene, station, edges, rigid)
        for pair, shallow in _near(scene, drawn, allowed):
            depth = _depth(*(_outline(scene, name, drawn) for name in pair))
            if depth > shallow + sum(_chord_error(drawn[name]) for name in pair if name in scene.beams):
                first = found.setdefault(pair, Crossing(*pair, station.stage, station.value, depth))
                found[pair] = replace(first, depth=max(first.depth, depth))
    return tuple(found.values())


def crossing_sentence(scene: Scene, crossing: Crossing) -> str:
    """A sentence with the pair, the load, the depth, and the two ways to go on."""
    one, other, stage = crossing.one, crossing.other, crossing.stage
    (steps,) = (each.steps for each in scene.stages if each.name == stage)
    return (
        f"{one} and {other} pass through each other by up to {crossing.depth:.3g} m, from {stage} {crossing.value:g} "
        f"on ({steps} = {crossing.value:g}), and no contact names them: add a contact of {one} and {other}, or "
        f'may_cross = [["{one}", "{other}"]] if they lie in different planes.'
    )


def _edge_names(rigid: Mapping[str, RigidContact]) -> dict[str, str]:
    """Names of the first contacts with the same rigid edge, by the names of all contacts with rigid edges."""
    first: dict[str, str] = {}
    exclude = {"beam", "thick", "paper", "side"}
    return {name: first.setdefault(repr(contact.model_dump(exclude=exclude)), name) for name, contact in rigid.items()}


def _allowed(scene: Scene, edge_of: Mapping[str, str]) -> set[frozenset[str]]:
    """Pairs with a contact, a common joint or an entry in ``may_cross``."""
    joined: dict[str, list[str]] = {}
    for name, beam in scene.beams.items():
        for end in (beam.start, beam.end):
            if not isinstance(end, FreeEnd):
                joined.setdefault(end.point, []).append(name)
    allowed = {frozenset(pair) for names in joined.values() for pair in combinations(names, 2)}
    allowed |= {frozenset(edge_of.get(name, name) for name in pair) for pair in scene.may_cross}
    for name, contact in scene.contacts.items():
        allowed.add(frozenset((*contact.beams, edge_of.get(name, contact.beams[0]))))
    return allowed


def _near(scene: Scene, drawn: Drawn, allowed: Set[frozenset[str]]) -> Iterator[tuple[Pair, float]]:
    """Pairs of neighbouring shapes outside the allowed pairs, and the permitted depth, m, as in a contact."""
    names, lines = list(drawn), np.array(list(drawn.values()))
    half = np.array([0.5 * scene.beams[name].thickest if name in scene.beams else 0.0 for name in names])
    thin = {beam for contact in scene.contacts.values() if not contact.thick for beam in contact.beams}
    for i, j in shapely.STRtree(lines).query(lines, predicate="dwithin", distance=half + half.max()).T:
        if i < j and half[i] > 0.0 and frozenset((names[i], names[j])) not in allowed:
            share = DEEP if thin.isdisjoint((names[i], names[j])) else _LINES
            yield (names[i], names[j]), share * (half[i] + half[j])


def _drawn(scene: Scene, station: StationAnswer, edges: Drawn, rigid: Mapping[str, RigidContact]) -> Drawn:
    """Neutral lines of the beams and outlines of the edges at a station, by name, the beams first."""
    shapes = {name: station.shapes[name] for name in scene.beams}
    drawn: Drawn = {name: shapely.LineString(np.stack((at.x, at.y), axis=1)) for name, at in shapes.items()}
    motions = station.bodies
    for name, edge in edges.items():
        body = scene.bodies[rigid[name].body]
        if isinstance(body, FixedBody):
            drawn[name] = edge
        elif rigid[name].body in motions:
            u, v, phi = motions[rigid[name].body]
            drawn[name] = translate(rotate(edge, phi, next(iter(body.points.values())), use_radians=True), u, v)
    return drawn


def _edge(contact: RigidContact, size: float) -> BaseGeometry:
    """Outline of a rigid edge as drawn, a disc or a thin strip along a line, in a scene of a ``size``, m."""
    if isinstance(contact, CircleContact):
        return shapely.Point(contact.center).buffer(contact.radius, quad_segs=64)
    assert isinstance(contact, EdgeContact)
    places = edge_places(contact, _FAR * size, len(_FRACTIONS))
    return shapely.LineString(places).buffer(0.5 * _THIN * size, cap_style="flat")


def _outline(scene: Scene, name: str, drawn: Drawn) -> BaseGeometry:
    """Region of a shape: the segments of a beam, widened by half of the thickness in the middle of the segment."""
    if name not in scene.beams:
        return drawn[name]
    places = shapely.get_coordinates(drawn[name])
    segments = shapely.linestrings(np.stack((places[:-1], places[1:]), axis=1))
    h = shapely.length(segments)
    half = 0.5 * scene.beams[name].thickness_at((np.cumsum(h) - 0.5 * h) / h.sum())
    return shapely.union_all(shapely.buffer(segments, half))


def _chord_error(line: BaseGeometry) -> float:
    """The largest e of a neutral line, m."""
    segments = np.diff(shapely.get_coordinates(line) @ (1.0, 1j))
    turns = np.abs(np.angle(segments[1:] * np.conj(segments[:-1])))
    return float(np.max(np.abs(segments[1:]) * turns, initial=0.0)) / 8.0


def _depth(A: BaseGeometry, B: BaseGeometry) -> float:
    """Depth d by which two outlines overlap, m; zero where they are apart."""
    overlap = A.intersection(B)
    if overlap.is_empty:
        return 0.0
    inside = max(_reach(overlap, A.boundary), _reach(overlap, B.boundary))
    through = (sorted(_reach(part, b) for part in shapely.get_parts(a - b)) for a, b in ((A, B), (B, A)))
    return max(inside, min([0.0, 0.0, *lengths][-2] for lengths in through))


def _reach(part: BaseGeometry, shape: BaseGeometry) -> float:
    """The largest distance of a corner of a part from a shape, m."""
    return float(shapely.distance(shapely.points(shapely.get_coordinates(part)), shape).max())
