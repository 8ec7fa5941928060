"""The drawing list: all drawable parts of a mechanism at a station, for figures, pages, animations, VTU and PyVista."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import atan2, cos, hypot, sin
from typing import Literal, NamedTuple

import numpy as np

from comparisons.geometry import edge_places, is_free_on_the_left, longest
from comparisons.present.strips import Coloured, Strip, left_of, strip_of
from cprbm_scene import Answer, FreeEnd, PinnedEnd, Scene, Stage, StationAnswer
from cprbm_scene.answer import Array
from cprbm_scene.freedoms import unit
from cprbm_scene.statement import (
    BeamForce,
    BeamMoment,
    CircleContact,
    DisplacementDrive,
    DistributedLoad,
    EdgeContact,
    FixedBody,
    Force,
    HalfPlaneContact,
    LineContact,
    Moment,
    RigidContact,
    SelfContact,
    TurningBody,
)  # fmt: skip

Kind = Literal["rest", "rigid", "edge", "beam", "body", "weld", "pin", "pivot", "stop", "contact"]

ARROW = 0.13
"""Length of the largest force's arrow over the longer side of the picture."""

LEAST = 0.02
"""Share of the largest force below which a force has no arrow."""

DEPTH = 0.02
"""Depth of the drawn rigid side of an edge over the longest beam."""

_ROUND = 120  # pieces of a circle or of a curved edge
_LARGE = 0.6  # radius over the longest beam up to which a picture shows a whole circle
_RAY = 0.15  # length over the longest beam of the rays at the limits of a stop


class Part(NamedTuple):
    """A drawable part: a line or an area through ``points`` (k, 2), m, or marks at the points."""

    kind: Kind
    name: str
    points: Array
    closed: bool = False


class Obstacle(NamedTuple):
    """Rigid edge that a beam may touch: its ``outline`` (k, 2), m, and the ``solid`` side (k, 2) behind the outline.

    The solid side of a ``closed`` outline is its middle; ``width``, m, is the width of the beam.
    """

    name: str
    outline: Array
    solid: Array
    closed: bool
    width: float


@dataclass(frozen=True, slots=True)
class Push:
    """Forces (k, 2), N, of one contact ``on`` a beam or body at ``places`` (k, 2), m, of the pressed edge."""

    contact: str
    on: str
    places: Array
    forces: Array

    @property
    def resultant(self) -> Array:
        """Sum (2,) of the forces, N."""
        return np.asarray(self.forces.sum(axis=0))

    @property
    def middle(self) -> Array:
        """The place (2,), m, nearest to the weighted mean of all places."""
        weight = np.hypot(*self.forces.T)
        return np.asarray(self.places[np.argmin(np.hypot(*(self.places - weight @ self.places / weight.sum()).T))])


class Arrow(NamedTuple):
    """A force (2,), N, or a moment, N·m, at a place (2,), m, of the ``push`` of a contact or of a ``load``."""

    kind: Literal["push", "load"]
    name: str
    place: Array
    force: Array
    moment: float = 0.0


@dataclass(frozen=True, slots=True)
class View:
    """A mechanism at a station.

    Attributes:
        station: the station.
        points: places of the bodies' points, m.
        strips: beams; obstacles: rigid edges; pushes: contact forces.
        arrows: forces of contacts on their first beams, and of loads and drives.
        parts: all other drawable parts.
    """

    station: StationAnswer
    points: Mapping[str, Array]
    strips: Mapping[str, Strip]
    obstacles: Sequence[Obstacle]
    pushes: Sequence[Push]
    arrows: Sequence[Arrow]
    parts: Sequence[Part]

    def of(self, *kinds: Kind) -> list[Part]:
        """Parts of some kinds."""
        return [part for part in self.parts if part.kind in kinds]


@dataclass(frozen=True, slots=True)
class Bounds:
    """Common limits of several views.

    Attributes:
        low, high: corners (2,) of the picture, m.
        least, most: of the colouring quantity, SI.
        force: the largest force with an arrow, N, by kind.
    """

    low: Array
    high: Array
    least: float
    most: float
    force: Mapping[str, float]

    @property
    def size(self) -> float:
        """The longer side, m."""
        return float(np.max(self.high - self.low))


def views_of(scene: Scene, answer: Answer) -> list[View]:
    """A view of every station."""
    return [view_of(scene, station) for station in answer.stations]


def view_of(scene: Scene, station: StationAnswer) -> View:
    """The drawable parts of a station."""
    strips = {name: strip_of(name, beam, station) for name, beam in scene.beams.items()}
    places = _points(scene, station)
    found = _pushes(scene, station, strips)
    obstacles = [_obstacle(scene, station, name, contact) for name, contact in _edges(scene).items()]
    first = {name: contact.beams[0] for name, contact in scene.contacts.items()}
    arrows = [
        Arrow("push", push.contact, push.middle, push.resultant) for push in found if first[push.contact] == push.on
    ]
    parts = (*_parts(scene, station, places), *_shapes(strips, obstacles))
    return View(station, places, strips, obstacles, found, [*arrows, *_loads(scene, station, strips)], parts)


def bounds_of(scene: Scene, views: Sequence[View], quantity: Coloured) -> Bounds:
    """Limits that hold for all views; circles and edges larger than the beams do not count."""
    reach, force, corners = longest(scene), {"push": 0.0, "load": 0.0}, []
    largest = 0.0
    for view in views:
        corners += [part.points for part in view.parts if part.kind not in ("rigid", "edge", "stop")]
        corners += [each.outline for each in view.obstacles
                    if each.closed and np.ptp(each.outline, axis=0).max() <= 2.0 * _LARGE * reach]  # fmt: skip
        for arrow in view.arrows:
            force[arrow.kind] = max(force[arrow.kind], hypot(*arrow.force))
        largest = max(largest, *(float(np.abs(getattr(strip, quantity)).max()) for strip in view.strips.values()))
    both = np.concatenate(corners)
    return Bounds(
        both.min(axis=0), both.max(axis=0), 0.0 if quantity == "combined_stress" else -largest, largest, force
    )


def carried(scene: Scene, station: StationAnswer, body: str, places: Array) -> Array:
    """Places (k, 2), m, that a body carries along; as drawn where the answer does not state the body's motion."""
    if body not in station.bodies:
        return places
    first, (x, y, angle) = np.array(next(iter(scene.bodies[body].points.values()))), station.bodies[body]
    turn = np.array([[cos(angle), sin(angle)], [-sin(angle), cos(angle)]])
    return np.asarray(first + (x, y) + (places - first) @ turn)


def _points(scene: Scene, station: StationAnswer) -> dict[str, Array]:
    """Places of all bodies' points; ends of beams say where points of bodies without a stated motion are."""
    found = {
        point: carried(scene, station, name, np.array([at]))[0]
        for name, body in scene.bodies.items()
        for point, at in body.points.items()
    }
    for beam, end, place in joined_ends(scene):
        if scene.body_of(end.point) not in station.bodies:
            shape = station.shapes[beam]
            found[end.point] = np.array([shape.x[place], shape.y[place]])
    return found


def joined_ends(scene: Scene) -> Iterator[tuple[str, PinnedEnd, Literal[0, -1]]]:
    """Every beam's end at a body: name of the beam, end, and index in the beam's shape."""
    for name, beam in scene.beams.items():
        for end, place in ((beam.start, 0), (beam.end, -1)):
            if not isinstance(end, FreeEnd):
                yield name, end, place  # type: ignore[misc]


def _shapes(strips: Mapping[str, Strip], obstacles: Sequence[Obstacle]) -> Iterator[Part]:
    """Areas of the beams at rest and at the station, and rigid edges with their solid sides."""
    for each in obstacles:
        area = each.outline if each.closed else np.concatenate([each.outline, each.solid[::-1]])
        yield Part("rigid", each.name, area, closed=True)
        yield Part("edge", each.name, each.outline, each.closed)
    for name, strip in strips.items():
        yield Part("rest", name, strip.outline(rest=True), closed=True)
        yield Part("beam", name, strip.outline(), closed=True)


def _parts(scene: Scene, station: StationAnswer, places: Mapping[str, Array]) -> Iterator[Part]:
    """Bodies, joints, limits of stops, and places of contact."""
    pins = {end.point for _, end, _ in joined_ends(scene) if isinstance(end, PinnedEnd)}
    pins |= {point for pin in scene.pins.values() for point in pin.points}
    for name, body in scene.bodies.items():
        corners = np.array([places[point] for point in body.points])
        if not isinstance(body, FixedBody) and len(corners) > 1:
            yield Part("body", name, corners, closed=len(corners) > 2)
        for point in body.points:
            pivot = isinstance(body, TurningBody) and point == body.about
            yield Part("pivot" if pivot else "pin" if point in pins else "weld", point, places[point][None])
    for name, stop in scene.stops.items():
        end = scene.beams[stop.beam].start if stop.end == "start" else scene.beams[stop.beam].end
        assert isinstance(end, PinnedEnd)
        owner = scene.body_of(stop.towards)
        at, towards = carried(
            scene, station, owner, np.array([scene.place_of(end.point), scene.place_of(stop.towards)])
        )
        for limit in (stop.least, stop.most):
            if limit is not None:
                angle = atan2(*(towards - at)[::-1]) + limit
                pin = places[end.point]
                ray = _RAY * longest(scene) * np.array([cos(angle), sin(angle)])
                yield Part("stop", name, np.stack([pin, pin + ray]))
    for name, touched in station.touching.items():
        yield Part("contact", name, touched)


def _edges(scene: Scene) -> dict[str, RigidContact]:
    """Rigid edges of contacts; an edge of several beams stands once."""
    found: dict[str, RigidContact] = {}
    for name, contact in scene.contacts.items():
        if isinstance(contact, RigidContact) and not any(_same_edge(contact, one) for one in found.values()):
            found[name] = contact
    return found


def _same_edge(one: RigidContact, other: RigidContact) -> bool:
    return one.model_copy(update={"beam": other.beam, "thick": other.thick, "paper": other.paper}) == other


def _obstacle(scene: Scene, station: StationAnswer, name: str, contact: RigidContact) -> Obstacle:
    outline, solid, closed = _outline(contact, 4.0 * longest(scene), DEPTH * longest(scene))
    beam = scene.beams[contact.beam]
    width = float(beam.width_at(np.array(beam.knots)).max())
    outline, solid = (carried(scene, station, contact.body, places) for places in (outline, solid))
    return Obstacle(name, outline, solid, closed, width)


def _outline(contact: RigidContact, reach: float, depth: float) -> tuple[Array, Array, bool]:
    """Outline (k, 2) as drawn, places of its solid side, and whether the outline is closed.

    Args:
        contact: with the edge.
        reach: length of a half-plane's edge to either side of its point, m.
        depth: distance of the solid side, m.
    """
    if isinstance(contact, CircleContact):
        angle, centre = np.linspace(0.0, 2.0 * np.pi, _ROUND + 1), np.array(contact.center)
        outline = centre + contact.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return outline, np.broadcast_to(centre, outline.shape), True
    assert isinstance(contact, EdgeContact)
    places, side = edge_places(contact, reach, _ROUND), -1.0 if is_free_on_the_left(contact) else 1.0
    if isinstance(contact, HalfPlaneContact):
        places, side = places[::-1], -1.0
    if isinstance(contact, LineContact) and contact.closed and side * _area(places) > 0.0:
        return places, np.broadcast_to(places[:-1].mean(axis=0), places.shape), True
    return places, places + side * depth * _normals(places), False


def _area(places: Array) -> float:
    """Area of a closed polygon (k, 2), positive if counter-clockwise."""
    x, y = places.T
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def _normals(places: Array) -> Array:
    """Normals (k, 2) to the left of a polyline, at corners so long that both pieces have the same depth."""
    left = left_of(np.diff(places, axis=0))
    both = np.concatenate([left[:1], left[1:] + left[:-1], left[-1:]])
    if np.array_equal(places[0], places[-1]):
        both[0] = both[-1] = left[0] + left[-1]
    half = np.concatenate([left[:1], left])
    return np.asarray(both / np.maximum(np.sum(both * half, axis=1), 0.3)[:, None])


def _pushes(scene: Scene, station: StationAnswer, strips: Mapping[str, Strip]) -> list[Push]:
    """Contact forces at the pressed edges; none where the answer does not state forces."""
    forces, found = station.forces, []
    size, source, target = np.hypot(*forces.force.T), np.array(forces.source), np.array(forces.target)
    for name, contact in scene.contacts.items():
        acting = (source == name) & (size > 0.0)
        for on in dict.fromkeys(target[acting].tolist()):
            mine = np.flatnonzero(acting & (target == on))
            places, pressing = forces.place[mine], forces.force[mine]
            if contact.thick and on in strips:  # the answer states places on the neutral line
                t = np.interp(forces.s[mine], strips[on].s, strips[on].thickness)
                places = places - 0.5 * t[:, None] * pressing / size[mine, None]
            parts = [np.arange(len(mine))]
            if isinstance(contact, SelfContact) and len(mine) > 1:  # two places of one beam
                along = np.argsort(forces.s[mine], kind="stable")
                parts = np.split(along, [int(np.argmax(np.diff(forces.s[mine][along]))) + 1])
            found += [Push(name, on, places[part], pressing[part]) for part in parts]
    return found


def _loads(scene: Scene, station: StationAnswer, strips: Mapping[str, Strip]) -> Iterator[Arrow]:
    """Arrows of drives and of the scene's loads."""
    for acting in station.forces:
        if acting.source in scene.drives:
            turns = not isinstance(scene.drives[acting.source], DisplacementDrive)
            yield Arrow("load", acting.source, acting.place, acting.force, float(acting.moment) if turns else 0.0)
    for name, load in scene.loads.items():
        value, way, zero = _value(scene, name, station), np.zeros(2), np.zeros(2)
        if not isinstance(load, Moment | BeamMoment):
            way = np.array(unit(load.direction)[:2])
        if value == 0.0:
            continue
        match load:
            case Moment():
                body = scene.bodies[load.body]
                middle = carried(scene, station, load.body, np.array([*body.points.values()])).mean(axis=0)
                yield Arrow("load", name, middle, zero, value)
            case Force():
                place = carried(scene, station, scene.body_of(load.point), np.array([scene.place_of(load.point)]))[0]
                yield Arrow("load", name, place, value * way)
            case BeamForce():
                yield Arrow("load", name, _along(strips[load.beam], load.at), value * way)
            case BeamMoment():
                yield Arrow("load", name, _along(strips[load.beam], load.at), zero, value)
            case DistributedLoad():
                strip, shares = strips[load.beam], np.linspace(*load.along, 7)
                share = value * (load.along[1] - load.along[0]) * float(strip.s[-1]) / 7.0
                yield from (Arrow("load", name, _along(strip, u), share * way) for u in shares)


def _along(strip: Strip, u: float) -> Array:
    """Place (2,), m, at a fraction of a beam's arc length."""
    return np.array([np.interp(u * strip.s[-1], strip.s, each) for each in strip.line.T])


def _value(scene: Scene, load: str, station: StationAnswer) -> float:
    """Value of a load at a station: of the present stage, or else the last value of the stages before."""
    names = [stage.name for stage in scene.stages]
    before: Sequence[Stage] = scene.stages[: names.index(station.stage) + 1]
    if before[-1].steps == load:
        return station.value
    return next((stage.stations[-1] for stage in reversed(before[:-1]) if stage.steps == load), 0.0)
