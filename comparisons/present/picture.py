"""The drawing list: all drawable parts of a mechanism at a station, for figures, pages, animations, VTU and PyVista."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import atan2, cos, sin
from typing import Literal, NamedTuple

import numpy as np

from comparisons.geometry import edge_places, is_free_on_the_left, longest
from comparisons.present.strips import Coloured, Strip, left_of, strip_of
from cprbm_scene import (
    Array,
    BeamMoment,
    CircleContact,
    DisplacementDrive,
    DistributedLoad,
    EdgeContact,
    FixedBody,
    Force,
    FreeEnd,
    LineContact,
    Load,
    Moment,
    PinnedEnd,
    RigidContact,
    Scene,
    SelfContact,
    StationAnswer,
    TurningBody,
)
from cprbm_scene.curves import unit_vector as unit

Kind = Literal["edge", "rest", "beam", "body", "weld", "pin", "pivot", "stop", "contact"]

ARROW = 0.13
"""Length of the largest force's arrow over the longer side of the picture."""

LEAST = 0.02
"""Share of the largest force below which a force has no arrow."""

DEPTH = 0.02
"""Depth of the drawn rigid side of an edge over the longest beam."""

_ROUND = 120  # pieces of a circle or of a curved edge
_LARGE = 1.2  # diameter over the longest beam up to which a picture shows a whole circle
_LOADED = 7  # arrows of a distributed load
_RAY = 0.15  # length over the longest beam of the rays at the limits of a stop


class Part(NamedTuple):
    """A drawable part: a line or an area through ``points`` (k, 2), m, or marks at the points.

    The ``solid`` side (k, 2) of a rigid edge lies behind the points; of a ``closed`` edge it is the middle.
    """

    kind: Kind
    name: str
    points: Array
    closed: bool = False
    solid: Array = np.empty((0, 2))

    @property
    def area(self) -> Array:
        """Corners (k, 2) of the area, m."""
        return self.points if self.closed else np.concatenate([self.points, self.solid[::-1]])

    @property
    def line(self) -> Array:
        """Places (k, 2) of the line, m, of a closed line with the first place at the end."""
        return np.concatenate([self.points, self.points[:1]]) if self.closed else self.points


class Arrow(NamedTuple):
    """Forces (k, 2), N, and a moment, N·m, of a contact (``push``), or of a load or drive."""

    kind: Literal["push", "load"]
    name: str
    places: Array
    forces: Array
    moment: float = 0.0

    @property
    def resultant(self) -> Array:
        """Sum (2,) of the forces, N."""
        return np.asarray(self.forces.sum(axis=0))

    @property
    def size(self) -> float:
        """Magnitude of the resultant, N."""
        return float(np.hypot(*self.resultant))

    @property
    def middle(self) -> Array:
        """The place (2,), m, nearest to the mean of all places by the magnitudes of the forces."""
        weight = np.hypot(*self.forces.T)
        mean = weight @ self.places / weight.sum() if weight.any() else self.places[0]
        return np.asarray(self.places[np.argmin(np.hypot(*(self.places - mean).T))])


class View(NamedTuple):
    """A mechanism at a station: ``points`` of bodies by name, m, ``strips`` of beams, ``arrows``, and all ``parts``."""

    station: StationAnswer
    points: Mapping[str, Array]
    strips: Mapping[str, Strip]
    arrows: Sequence[Arrow]
    parts: Sequence[Part]

    def of(self, *kinds: Kind) -> list[Part]:
        """Parts of some kinds."""
        return [part for part in self.parts if part.kind in kinds]

    def arrows_of(self, kind: str) -> list[Arrow]:
        """Arrows of contacts (``push``), or of loads and drives (``load``)."""
        return [arrow for arrow in self.arrows if arrow.kind == kind]


class Bounds(NamedTuple):
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

    def arrow(self, arrow: Arrow) -> Array | None:
        """Vector (2,), m, from the tail to the head of a drawn arrow; None for a force without an arrow."""
        most = self.force[arrow.kind]
        return ARROW * self.size / most * arrow.resultant if arrow.size > LEAST * most > 0.0 else None

    def around(self, arrows: Iterable[Arrow]) -> "Bounds":
        """The limits with room for arrows."""
        tails = [arrow.middle - vector for arrow in arrows if (vector := self.arrow(arrow)) is not None]
        corners = np.array([self.low, self.high, *tails])
        return self._replace(low=corners.min(axis=0), high=corners.max(axis=0))


def view_of(scene: Scene, station: StationAnswer) -> View:
    """The drawable parts of a station."""
    strips = {name: strip_of(name, beam, station) for name, beam in scene.beams.items()}
    points = _points(scene, station)
    beams = (
        Part(kind, name, strip.outline(rest=kind == "rest"), closed=True)
        for name, strip in strips.items()
        for kind in ("rest", "beam")
    )
    touched = (Part("contact", name, places) for name, places in station.touching.items())
    return View(
        station,
        points,
        strips,
        arrows=(*_pushes(scene, station, strips), *_loads(scene, station, strips)),
        parts=(*_edges(scene, station), *beams, *_bodies(scene, points), *_stops(scene, station, points), *touched),
    )


def bounds_of(scene: Scene, views: Sequence[View], quantity: Coloured) -> Bounds:
    """Limits that hold for all views; circles and edges larger than the beams do not count."""
    room = _LARGE * longest(scene)
    corners = np.concatenate([
        part.points for view in views for part in view.parts
        if part.kind not in ("edge", "stop") or (part.closed and np.ptp(part.points, axis=0).max() <= room)
    ])  # fmt: skip
    largest = max(float(np.abs(getattr(strip, quantity)).max()) for view in views for strip in view.strips.values())
    return Bounds(
        low=corners.min(axis=0),
        high=corners.max(axis=0),
        least=0.0 if quantity == "combined_stress" else -largest,
        most=largest,
        force={
            kind: max((arrow.size for view in views for arrow in view.arrows_of(kind)), default=0.0)
            for kind in ("push", "load")
        },
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
    for name, beam in scene.beams.items():
        for end, place in ((beam.start, 0), (beam.end, -1)):
            if not isinstance(end, FreeEnd) and scene.body_of(end.point) not in station.bodies:
                found[end.point] = np.array([station.shapes[name].x[place], station.shapes[name].y[place]])
    return found


def names_by_place(points: Mapping[str, Array], room: float) -> dict[str, Array]:
    """Places (2,) by the text beside a place; ``points`` in one place, within a square of ``room``, share a text."""
    found: dict[tuple[float, ...], list[str]] = {}
    for name, at in points.items():
        found.setdefault(tuple(np.round(at / room).tolist()), []).append(name)
    return {", ".join(names): points[names[0]] for names in found.values()}


def _bodies(scene: Scene, points: Mapping[str, Array]) -> Iterator[Part]:
    """Bodies and joints."""
    pins = {end.point for beam in scene.beams.values() for end in (beam.start, beam.end) if isinstance(end, PinnedEnd)}
    pins |= {point for pin in scene.pins.values() for point in pin.points}
    for name, body in scene.bodies.items():
        corners = np.array([points[point] for point in body.points])
        if not isinstance(body, FixedBody) and len(corners) > 1:
            yield Part("body", name, corners, closed=len(corners) > 2)
        for point in body.points:
            pivot = isinstance(body, TurningBody) and point == body.about
            yield Part("pivot" if pivot else "pin" if point in pins else "weld", point, points[point][None])


def _stops(scene: Scene, station: StationAnswer, points: Mapping[str, Array]) -> Iterator[Part]:
    """Rays at the limits of stops."""
    for name, stop in scene.stops.items():
        end = scene.beams[stop.beam].start if stop.end == "start" else scene.beams[stop.beam].end
        assert isinstance(end, PinnedEnd)
        drawn = np.array([scene.place_of(end.point), scene.place_of(stop.towards)])
        way = np.diff(carried(scene, station, scene.body_of(stop.towards), drawn), axis=0)[0]
        for limit in (stop.least, stop.most):
            if limit is not None:
                angle = atan2(way[1], way[0]) + limit
                ray = _RAY * longest(scene) * np.array([cos(angle), sin(angle)])
                yield Part("stop", name, np.stack([points[end.point], points[end.point] + ray]))


def _edges(scene: Scene, station: StationAnswer) -> list[Part]:
    """Rigid edges with their solid sides; an edge of several beams stands once."""
    found: dict[bytes, Part] = {}
    for name, contact in scene.contacts.items():
        if isinstance(contact, RigidContact):
            outline, solid, closed = outline_of(contact, 4.0 * longest(scene), DEPTH * longest(scene))
            outline, solid = (carried(scene, station, contact.body, places) for places in (outline, solid))
            found.setdefault(outline.tobytes() + solid.tobytes(), Part("edge", name, outline, closed, solid))
    return [*found.values()]


def outline_of(contact: RigidContact, reach: float, depth: float) -> tuple[Array, Array, bool]:
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
    counter_clockwise = side * float(np.sum(places[:-1, 0] * places[1:, 1] - places[1:, 0] * places[:-1, 1])) > 0.0
    if isinstance(contact, LineContact) and contact.closed and counter_clockwise:
        return places, np.broadcast_to(places[:-1].mean(axis=0), places.shape), True
    return places, places + side * depth * _normals(places), False


def _normals(places: Array) -> Array:
    """Normals (k, 2) to the left of a polyline, at corners so long that both pieces have the same depth."""
    left = left_of(np.diff(places, axis=0))
    first, last = (left[-1:], left[:1]) if np.array_equal(places[0], places[-1]) else (left[:1], left[-1:])
    before, behind = np.concatenate([first, left]), np.concatenate([left, last])
    both = before + behind
    return np.asarray(both / np.maximum(np.sum(both * behind, axis=1), 0.3)[:, None])


def _pushes(scene: Scene, station: StationAnswer, strips: Mapping[str, Strip]) -> Iterator[Arrow]:
    """Contact forces at the pressed edges; none where the answer does not state forces."""
    forces = station.forces
    size, source, target = np.hypot(*forces.force.T), np.array(forces.source), np.array(forces.target)
    for name, contact in scene.contacts.items():
        acting = (source == name) & (size > 0.0)
        for on in dict.fromkeys(target[acting].tolist()):
            mine = np.flatnonzero(acting & (target == on))
            mine = mine[np.argsort(forces.s[mine], kind="stable")]
            places, pressing, groups = forces.place[mine], forces.force[mine], [np.arange(len(mine))]
            if contact.thick and on in strips:  # the answer states places on the neutral line
                t = np.interp(forces.s[mine], strips[on].s, strips[on].thickness)
                places = places - 0.5 * t[:, None] * pressing / size[mine, None]
            if isinstance(contact, SelfContact) and len(mine) > 1:  # two places of one beam
                groups = np.split(groups[0], [int(np.argmax(np.diff(forces.s[mine]))) + 1])
            yield from (Arrow("push", name, places[group], pressing[group]) for group in groups)


def _loads(scene: Scene, station: StationAnswer, strips: Mapping[str, Strip]) -> Iterator[Arrow]:
    """Arrows of drives and of the scene's loads; a load keeps the last value of earlier stages."""
    for at in station.forces:
        if at.source in scene.drives:
            turns = not isinstance(scene.drives[at.source], DisplacementDrive)
            yield Arrow("load", at.source, at.place[None], at.force[None], float(at.moment) if turns else 0.0)
    values = scene.values_at(station.stage, station.value)
    for name, load in scene.loads.items():
        value, places = values[name], _loaded(scene, station, load, strips)
        way = None if isinstance(load, Moment | BeamMoment) else np.array(unit(load.direction))
        force = np.zeros(2) if way is None else value * way
        if isinstance(load, DistributedLoad):
            force *= (load.along[1] - load.along[0]) * float(strips[load.beam].s[-1]) / len(places)
        if value != 0.0:
            yield from (Arrow("load", name, at[None], force[None], value if way is None else 0.0) for at in places)


def _loaded(scene: Scene, station: StationAnswer, load: Load, strips: Mapping[str, Strip]) -> Array:
    """Places (k, 2), m, of a load: of a moment on a body the middle of the points."""
    if isinstance(load, Moment):
        corners = np.array([*scene.bodies[load.body].points.values()])
        return np.asarray(carried(scene, station, load.body, corners).mean(axis=0)[None])
    if isinstance(load, Force):
        return carried(scene, station, scene.body_of(load.point), np.array([scene.place_of(load.point)]))
    u = np.linspace(*load.along, _LOADED) if isinstance(load, DistributedLoad) else np.array([load.at])
    return strips[load.beam].places(u)
