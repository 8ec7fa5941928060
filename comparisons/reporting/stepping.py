"""A mechanism station by station, as the page steps through it: shapes, contacts, forces and values.

The parts of a picture are the same at all stations; of each a station has the data of an SVG path, which is empty
where there is nothing.  The finite elements' beams are drawn as thick as they are, the CPRBM's as their neutral line.
Arrows of one kind (contacts, loads and drives) have one scale for all stations.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from comparisons.case import Comparison
from comparisons.cells import signed
from comparisons.display_units import display_unit, load_text
from comparisons.formats import percent, vector
from comparisons.geometry import edge_places, length, points
from comparisons.quantities import norm, unit_of
from comparisons.reporting.outlines import Frame, arrows, band, circle, dots, frame, line, turned
from comparisons.stations import station_of
from comparisons.viewing.moved import Motion
from cprbm_scene import Beam, CircleContact, Scene, Stage, StationAnswer
from cprbm_scene.answer import Array
from cprbm_scene.freedoms import unit
from cprbm_scene.statement import (
    STRESSES,
    BeamForce,
    BeamMoment,
    Body,
    DisplacementDrive,
    DistributedLoad,
    EdgeContact,
    FixedBody,
    Force,
    Moment,
    Probe,
)

_MARGIN = 0.07
_THINNEST = 2.5
"""Of a beam as drawn, in the picture's units: one that is thinner is not drawn to scale."""

_LONGEST = 110.0
_SHORTEST = 0.03  # of the largest force of its kind, below which none is drawn
_ROUND = 26.0
_CLOSE = 45.0  # in the picture's units: contacts that are nearer to each other have one arrow
_ALONG_BEAM = 121

Kind = Literal["rest", "edge", "body", "pin", "fea", "outline", "cprbm", "zone", "push", "load"]


@dataclass(frozen=True, slots=True)
class Part:
    """One path of the picture.

    Attributes:
        kind: by which it looks as it does.
        width: of its stroke in the picture's units, where that is to scale; else 0.
        last: its data at the last station.
    """

    kind: Kind
    width: float
    last: str


@dataclass(frozen=True, slots=True)
class Station:
    """One step: its label, the data of every part that moves, where each name stands, and the table's texts."""

    label: str
    paths: tuple[str, ...]
    places: tuple[tuple[float, float], ...]
    cells: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class Stepper:
    """A picture that steps, and its table.

    Attributes:
        width, height: of the picture.
        still: parts that do not move.
        moving: parts that do, in the order of :attr:`Station.paths`.
        points: names beside points, in the order of :attr:`Station.places`.
        headers, names: of the table; of each of its lines what is asked, and the unit.
        stations: in order.
        thinner: beams that are drawn thicker than they are, so that they can be seen.
    """

    width: float
    height: float
    still: tuple[Part, ...]
    moving: tuple[Part, ...]
    points: tuple[str, ...]
    headers: tuple[str, ...]
    names: tuple[tuple[str, str], ...]
    stations: tuple[Station, ...]
    thinner: tuple[str, ...]

    @property
    def data(self) -> str:
        """The stations as JSON for a page: label, paths, places, and the texts of the table in a list."""
        every = [
            (each.label, each.paths, each.places, [text for row in each.cells for text in row])
            for each in self.stations
        ]
        return json.dumps(every, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


@dataclass(frozen=True, slots=True)
class _Arrow:
    """A force on its way from or to a ``place``, N, or a moment about it, N·m; of the ``kind`` that has one scale."""

    kind: Literal["push", "load"]
    place: Array
    force: Array
    moment: float = 0.0


_Both = tuple[Stage, StationAnswer, StationAnswer]
"""A stage, and the answers of the CPRBM and of the finite elements at one of its stations."""


def stepper(compared: Comparison) -> Stepper | None:
    """The stations that both answers have; None where there is none."""
    scene = compared.scene
    reached = list(_reached(compared))
    if not reached:
        return None
    seen = _frame(scene, reached)
    acting = [list(_gathered(list(_arrows(scene, stage, fea)), seen)) for stage, _, fea in reached]
    largest = {
        kind: max((float(np.hypot(*each.force)) for all_ in acting for each in all_ if each.kind == kind), default=0.0)
        for kind in ("push", "load")
    }
    shown = [probe for probe in scene.probes if probe.quantity not in STRESSES]
    units = {probe.name: _unit(scene, probe, reached) for probe in shown}
    words = _words(compared)
    named = _named(scene, seen, reached[-1][-1])
    stations = tuple(
        Station(
            _label(scene, stage, fea.value),
            tuple(_moving(scene, seen, cprbm, fea, arrow, largest)),
            tuple(_beside(seen, place, fea, scene) for place in named.values()),
            tuple(_cells(scene, probe, stage, cprbm, fea, units[probe.name][0], words) for probe in shown),
        )
        for (stage, cprbm, fea), arrow in zip(reached, acting, strict=True)
    )
    widths = {name: _width(beam, seen) for name, beam in scene.beams.items()}
    kinds: list[tuple[Kind, float]] = [("edge", 0.0) for _ in _edges(scene)]
    kinds += [("outline", 0.0) if beam.tapered else ("fea", widths[name]) for name, beam in scene.beams.items()]
    kinds += [("body", 0.0), ("pin", 0.0)]
    kinds += [("cprbm", 0.0) for _ in scene.beams]
    kinds += [("zone", 0.0), ("push", 0.0), ("load", 0.0)]
    return Stepper(
        round(seen.width),
        round(seen.height),
        tuple(Part("rest", 0.0, line(seen.of(_at_rest(beam)))) for beam in scene.beams.values()),
        tuple(Part(*kind, path) for kind, path in zip(kinds, stations[-1].paths, strict=True)),
        tuple(named),
        ("probe", "CPRBM", "FEA", "difference", "says"),
        tuple((probe.name, units[probe.name][1]) for probe in shown),
        stations,
        tuple(name for name, beam in scene.beams.items() if beam.thinnest * seen.scale < _THINNEST),
    )


def _reached(compared: Comparison) -> Iterator[_Both]:
    stages = {stage.name: stage for stage in compared.scene.stages}
    for fea in compared.runs.reference.stations:
        try:
            yield stages[fea.stage], station_of(compared.runs.cprbm[0], fea.stage, fea.value), fea
        except KeyError:  # the CPRBM did not come so far
            continue


def _frame(scene: Scene, reached: list[_Both]) -> Frame:
    """The part of the plane that the beams need at all stations, and the bodies as drawn."""
    shapes = (each.shapes.values() for _, cprbm, fea in reached for each in (cprbm, fea))
    lines = [np.stack([shape.x, shape.y], axis=1) for of_station in shapes for shape in of_station]
    lines += [_at_rest(beam) for beam in scene.beams.values()]
    lines += [np.array([*body.points.values()]) for body in scene.bodies.values()]
    lines += [_at(scene, name, fea) for _, _, fea in reached for name in scene.bodies]
    return frame(np.concatenate(lines), _MARGIN)


def _moving(
    scene: Scene,
    seen: Frame,
    cprbm: StationAnswer,
    fea: StationAnswer,
    acting: list[_Arrow],
    largest: Mapping[str, float],
) -> Iterator[str]:
    """The data of all parts that move, at one station."""
    for name, edge in _edges(scene).items():
        yield _edge(scene, seen, name, edge, fea)
    for name, beam in scene.beams.items():
        places = seen.of(_places(fea, name))
        thick = seen.scale * beam.thickness_at(fea.shapes[name].s / fea.shapes[name].s[-1])
        yield band(places, np.maximum(thick, _THINNEST)) if beam.tapered else line(places)
    bodies = {name: seen.of(_at(scene, name, fea)) for name in scene.bodies}
    yield "".join(
        line(np.concatenate([at, at[:1]]) if len(at) > 2 else at)
        for name, at in bodies.items()
        if not isinstance(scene.bodies[name], FixedBody)
    )
    yield dots(np.concatenate(list(bodies.values()))) if bodies else ""
    for name in scene.beams:
        yield line(seen.of(_places(cprbm, name)))
    yield dots(np.concatenate([np.zeros((0, 2)), *(seen.of(spots) for spots in fea.touching.values())]))
    for kind in ("push", "load"):
        mine = [each for each in acting if each.kind == kind]
        yield arrows(_ends(seen, each, largest[kind]) for each in mine) + "".join(
            turned(seen.of(each.place)[0], _ROUND, counterclockwise=each.moment > 0.0)
            for each in mine
            if each.moment != 0.0
        )


def _named(scene: Scene, seen: Frame, last: StationAnswer) -> dict[str, str]:
    """By names as they are written the point that they stand beside; points in one place at the end share them."""
    found: dict[tuple[float, float], list[str]] = {}
    for body in scene.bodies.values():
        for point in body.points:
            found.setdefault(_beside(seen, point, last, scene), []).append(point)
    return {", ".join(names): names[0] for names in found.values()}


def _beside(seen: Frame, point: str, station: StationAnswer, scene: Scene) -> tuple[float, float]:
    x, y = seen.of(_point(scene, point, station))[0]
    return float(round(x)), float(round(y))


def _gathered(acting: list[_Arrow], seen: Frame) -> Iterator[_Arrow]:
    """Forces of contacts, of which those that follow each other closely are one at their middle."""
    pushes = [each for each in acting if each.kind == "push"]
    while pushes:
        near = [each for each in pushes if np.hypot(*(each.place - pushes[0].place)) * seen.scale < _CLOSE]
        force = np.sum([each.force for each in near], axis=0)
        sizes = np.array([np.hypot(*each.force) for each in near])
        if sizes.sum() > 0.0:
            yield _Arrow("push", sizes @ np.array([each.place for each in near]) / sizes.sum(), force)
        pushes = [each for each in pushes if not any(each is one for one in near)]
    yield from (each for each in acting if each.kind != "push")


def _ends(seen: Frame, each: _Arrow, largest: float) -> tuple[Array, Array]:
    """Of an arrow that ends where its force acts; both in one place where it is too small to be seen."""
    tip = seen.of(each.place)[0]
    size = float(np.hypot(*each.force))
    if largest == 0.0 or size < _SHORTEST * largest:
        return tip, tip
    return tip - _LONGEST / largest * each.force * (1.0, -1.0), tip


def _arrows(scene: Scene, stage: Stage, station: StationAnswer) -> Iterator[_Arrow]:
    """Contacts on their first beam, the drives, and the scene's loads."""
    first = {name: contact.beams[0] for name, contact in scene.contacts.items()}
    for acting in station.forces:
        if first.get(acting.source) == acting.target:
            yield _Arrow("push", acting.place, acting.force)
        elif acting.source in scene.drives:
            turns = not isinstance(scene.drives[acting.source], DisplacementDrive)
            yield _Arrow("load", acting.place, acting.force, float(acting.moment) if turns else 0.0)
    for name, load in scene.loads.items():
        value = _value(scene, name, stage, station.value)
        if value == 0.0:
            continue
        match load:
            case Moment():
                yield _Arrow("load", _at(scene, load.body, station).mean(axis=0), np.zeros(2), value)
            case Force():
                yield _Arrow("load", _point(scene, load.point, station), value * unit(load.direction)[:2])
            case BeamForce():
                yield _Arrow("load", _along(station, load.beam, load.at), value * unit(load.direction)[:2])
            case BeamMoment():
                yield _Arrow("load", _along(station, load.beam, load.at), np.zeros(2), value)
            case DistributedLoad():
                whole = value * (load.along[1] - load.along[0]) * length(scene.beams[load.beam].curve)
                for share in np.linspace(*load.along, 7):
                    yield _Arrow("load", _along(station, load.beam, share), whole / 7.0 * unit(load.direction)[:2])


def _value(scene: Scene, name: str, now: Stage, value: float) -> float:
    """Of a load as a stage is at a value: its own, that of the last stage that stepped it, or zero."""
    found = 0.0
    for stage in scene.stages:
        if stage.name == now.name:
            return value if stage.steps == name else found
        if stage.steps == name:
            found = stage.stations[-1]
    return found


def _at(scene: Scene, name: str, station: StationAnswer) -> Array:
    """Where a body's points are, (k, 2), m."""
    return _carried(scene.bodies[name], np.array([*scene.bodies[name].points.values()]), name, station)


def _carried(body: Body, places: Array, name: str, station: StationAnswer) -> Array:
    """Where a body has carried ``places`` (k, 2), m; where a station does not say they are as drawn."""
    if name not in station.bodies:
        return places
    x, y, angle = station.bodies[name]
    return Motion(np.array(next(iter(body.points.values()))), np.array([x, y]), angle).carried(places)


def _point(scene: Scene, point: str, station: StationAnswer) -> Array:
    name = scene.body_of(point)
    return np.asarray(_carried(scene.bodies[name], np.array([scene.place_of(point)]), name, station)[0])


def _along(station: StationAnswer, beam: str, share: float) -> Array:
    shape = station.shapes[beam]
    return np.array([np.interp(share * shape.s[-1], shape.s, each) for each in (shape.x, shape.y)])


def _places(station: StationAnswer, beam: str) -> Array:
    return np.stack([station.shapes[beam].x, station.shapes[beam].y], axis=1)


def _at_rest(beam: Beam) -> Array:
    return points(beam.curve, np.linspace(0.0, length(beam.curve), _ALONG_BEAM))


def _width(beam: Beam, seen: Frame) -> float:
    return round(max(beam.thickest * seen.scale, _THINNEST), 1)


def _edges(scene: Scene) -> dict[str, CircleContact | EdgeContact]:
    """What beams may touch that is rigid, each but once."""
    found: dict[str, CircleContact | EdgeContact] = {}
    for name, contact in scene.contacts.items():
        if isinstance(contact, CircleContact | EdgeContact) and not any(_same(contact, one) for one in found.values()):
            found[name] = contact
    return found


def _same(one: CircleContact | EdgeContact, other: CircleContact | EdgeContact) -> bool:
    """Whether two contacts are with the same rigid thing."""
    return one.model_copy(update={"beam": other.beam, "thick": other.thick, "paper": other.paper}) == other


def _edge(scene: Scene, seen: Frame, name: str, edge: CircleContact | EdgeContact, station: StationAnswer) -> str:
    body = scene.bodies[edge.body]
    if isinstance(edge, CircleContact):
        centre = _carried(body, np.array([edge.center]), edge.body, station)
        return circle(seen.of(centre)[0], edge.radius * seen.scale)
    places = edge_places(edge, 2.0 * max(seen.width, seen.height) / seen.scale, _ALONG_BEAM)
    return line(seen.of(_carried(body, places, edge.body, station)))


def _label(scene: Scene, stage: Stage, value: float) -> str:
    return f"{stage.name}, {stage.steps} = {load_text(scene, stage.name, value)}"


def _unit(scene: Scene, probe: Probe, reached: list[_Both]) -> tuple[float, str]:
    """The power of a thousand in which the largest value of all stations reads best, and the unit with its prefix."""
    sizes = [norm(probe.quantity, each.values[probe.name]) for _, *both in reached for each in both]
    return display_unit(scene, unit_of(scene, probe, reached[-1][0]), max(sizes))


def _words(compared: Comparison) -> dict[tuple[str, str, float], tuple[str, str]]:
    """By probe, stage and station the difference and what the row says."""
    words = compared.verdict.words if compared.rows else ()
    return {
        (row.probe.name, row.stage, row.station): (
            percent(row.fraction(row.difference)),
            "–" if word is None else word.value,
        )
        for row, word in zip(compared.rows, words, strict=True)
    }


def _cells(
    scene: Scene,
    probe: Probe,
    stage: Stage,
    cprbm: StationAnswer,
    fea: StationAnswer,
    factor: float,
    words: Mapping[tuple[str, str, float], tuple[str, str]],
) -> tuple[str, ...]:
    said = words.get((probe.name, stage.name, fea.value), ("–", "–"))
    both = (
        signed(vector(each.values[probe.name], factor)) if probe.asked_in(stage.name) else "–" for each in (cprbm, fea)
    )
    return (*both, *said)
