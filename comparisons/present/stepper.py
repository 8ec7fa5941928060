"""A mechanism station by station on a page: shapes with colours of stress, contacts, forces and values.

The picture has an SVG path for every kind of part, and a station has the data of all paths.  The finite elements' beams
have their true thickness, with colours of the bending stress at the right edge; the CPRBM's are neutral lines.

======  ===========================================================================
symbol  meaning
======  ===========================================================================
X, Y    place in the picture, whose longer side is ``WIDE``; Y grows downwards
ε       largest distance of a drawn line from the line through all points
κ, h    curvature of a line, and distance of kept points: h = √(8 ε/κ)
======  ===========================================================================
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from comparisons.case import Comparison
from comparisons.display_units import display_units, load_text
from comparisons.formats import number, vector
from comparisons.geometry import length, points
from comparisons.present.columns import NOTHING
from comparisons.present.figures import colour_unit
from comparisons.present.picture import LEAST, Arrow, Bounds, Kind, View, bounds_of, view_of
from comparisons.present.row_tables import judged_rows, share
from comparisons.present.strips import Strip
from comparisons.present.table import with_minus
from comparisons.quantities import norm, unit_of
from comparisons.stations import station_of
from comparisons.verdict.rows import ROUND_OFF
from cprbm_scene import Probe, Scene, StationAnswer
from cprbm_scene.answer import Array
from cprbm_scene.statement import STRESSES

WIDE = 1000.0
SHADES = 11
"""Colours of the stress, from the largest pressure to the largest tension."""

HEADERS = ("probe", "CPRBM", "FEA", "error", "word")

_MARGIN = 0.1  # beside the mechanism, over its longer side
_THINNEST = 2.5  # least drawn thickness
_EPSILON = 0.2
_LONGEST, _HEAD, _TURN = 110.0, 11.0, 26.0  # the longest arrow, an arrow's head, radius of a moment's arrow
_MARKS: tuple[Kind, ...] = ("weld", "pin", "pivot")


@dataclass(frozen=True, slots=True)
class Stepper:
    """A picture with a slider and a table.

    Attributes:
        width, height: of the picture.
        still: data of still paths by class.
        moving: classes of the moving paths, in the order of the stations' data.
        points: names beside points.
        names: probes and units of the table's lines.
        stations: label, paths, places of the names, and cells of the table.
        thick: beams drawn thicker than in truth.
        span: the largest stress of the colours with the unit.
    """

    width: float
    height: float
    still: Mapping[str, str]
    moving: tuple[str, ...]
    points: tuple[str, ...]
    names: tuple[tuple[str, str], ...]
    stations: tuple[tuple[str, tuple[str, ...], tuple[str, ...], tuple[tuple[str, ...], ...]], ...]
    thick: tuple[str, ...]
    span: str

    @property
    def data(self) -> str:
        """The stations as JSON for a page; the cells of the table stand in a list."""
        every = [(label, paths, places, sum(cells, ())) for label, paths, places, cells in self.stations]
        return json.dumps(every, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def stepper(compared: Comparison) -> Stepper | None:
    """The common stations of both answers; None without a common station."""
    scene, pairs = compared.scene, list(_pairs(compared))
    if not pairs:
        return None
    views = [view_of(scene, fea) for _, fea in pairs]
    bounds = bounds_of(scene, views, "bending_stress")
    place = _Placing(bounds.low - _MARGIN * bounds.size, bounds.high + _MARGIN * bounds.size)
    probes = [probe for probe in scene.probes if probe.quantity not in STRESSES]
    words = {
        (row.probe.name, *row.where): (
            share(row, row.difference) or NOTHING,
            word.value if word else NOTHING,
            row.scale,
        )
        for row, word, _ in judged_rows(compared)
    }
    units = _units(scene, probes, pairs)
    labels = _labels(views[-1], place)
    stations, moving = [], dict[str, str]()
    for (cprbm, fea), view in zip(pairs, views, strict=True):
        moving = dict(_moving(view, cprbm, bounds, place))
        cells = tuple(_cells(probe, (cprbm, fea), units[probe.name][0], words) for probe in probes)
        spots = tuple("{:g} {:g}".format(*np.round(place(view.points[point][None])[0])) for point in labels.values())
        stations.append((_title(scene, fea), tuple(moving.values()), spots, cells))
    rest = (points(beam.curve, np.linspace(0.0, length(beam.curve), 121)) for beam in scene.beams.values())
    factor, unit = colour_unit(scene, "bending_stress", bounds.most)
    return Stepper(
        float(round(place.size[0])),
        float(round(place.size[1])),
        {"rest": "".join(line(place(each)) for each in rest)},
        tuple(moving),
        tuple(labels),
        tuple((probe.name, units[probe.name][1]) for probe in probes),
        tuple(stations),
        tuple(name for name, beam in scene.beams.items() if beam.thinnest * place.scale < _THINNEST),
        f"{number(bounds.most / factor)} {unit}" if bounds.most else "",
    )


class _Placing:
    """Places (k, 2), m, as places in the picture."""

    def __init__(self, low: Array, high: Array) -> None:
        self.corner = np.array([low[0], high[1]])
        self.scale = WIDE / float(np.max(high - low))
        self.size = (high - low) * self.scale

    def __call__(self, places: Array) -> Array:
        return np.asarray((places - self.corner) * (self.scale, -self.scale))


def _pairs(compared: Comparison) -> Iterator[tuple[StationAnswer, StationAnswer]]:
    for fea in compared.runs.reference.stations:
        try:
            yield station_of(compared.runs.cprbm[0], fea.stage, fea.value), fea
        except KeyError:  # the CPRBM did not reach the station
            continue


def _moving(view: View, cprbm: StationAnswer, bounds: Bounds, place: _Placing) -> Iterator[tuple[str, str]]:
    """Class and data of every moving path at a station."""
    areas = {kind: "".join(line(place(part.points), closed=part.closed) for part in view.of(kind))
             for kind in ("rigid", "edge", "body")}  # fmt: skip
    yield from (("rigid", areas["rigid"]), ("edge", areas["edge"]))
    shades = [shade for strip in view.strips.values() for shade in _shades(strip, bounds, place)]
    for shade in range(SHADES):
        yield f"shade{shade}", "".join(path for found, path in shades if found == shade)
    yield "body", areas["body"]
    yield "pin", "".join(dots(place(part.points)) for part in view.of(*_MARKS))
    lines = (np.stack([shape.x, shape.y], axis=1) for shape in cprbm.shapes.values())
    yield "cprbm", "".join(line(place(each)) for each in lines)
    yield "zone", "".join(dots(place(part.points)) for part in view.of("contact"))
    for kind in ("push", "load"):
        yield kind, "".join(_arrow(each, bounds, place) for each in view.arrows if each.kind == kind)


def _shades(strip: Strip, bounds: Bounds, place: _Placing) -> Iterator[tuple[int, str]]:
    """Areas of a beam by number of the colour."""
    middle, half = place(strip.line), 0.5 * np.maximum(strip.thickness * place.scale, _THINNEST)
    across = half[:, None] * strip.normal * (1.0, -1.0)
    shares = strip.bending_stress / bounds.most if bounds.most else np.zeros(len(strip.s))
    colours = np.rint((1.0 + shares) * (SHADES - 1) / 2.0).astype(int)
    for colour, found in groupby(range(len(colours) - 1), key=lambda piece: colours[piece]):
        pieces = list(found)
        run = slice(pieces[0], pieces[-1] + 2)
        yield int(colour), line(np.concatenate([(middle + across)[run], (middle - across)[run][::-1]]), closed=True)


def _labels(view: View, place: _Placing) -> dict[str, str]:
    """A point by the text beside it; points in one place share a text."""
    found: dict[tuple[float, float], list[str]] = {}
    for name, at in view.points.items():
        x, y = np.round(place(at[None])[0]).tolist()
        found.setdefault((x, y), []).append(name)
    return {", ".join(names): names[0] for names in found.values()}


def _units(
    scene: Scene, probes: Sequence[Probe], pairs: Sequence[tuple[StationAnswer, StationAnswer]]
) -> dict[str, tuple[float, str]]:
    """Displayed unit of every probe, the same for all probes with the same SI unit."""
    last = next(stage for stage in scene.stages if stage.name == pairs[-1][1].stage)
    names = {probe.name: unit_of(scene, probe, last) for probe in probes}
    sizes = (
        (names[probe.name], norm(probe.quantity, at.values[probe.name]))
        for probe in probes
        for pair in pairs
        for at in pair
    )
    units = display_units(scene, sizes)
    return {name: units[unit] for name, unit in names.items()}


def _cells(
    probe: Probe,
    pair: tuple[StationAnswer, StationAnswer],
    factor: float,
    words: Mapping[tuple[str, str, float], tuple[str, str, float]],
) -> tuple[str, ...]:
    """Texts of a probe at a station: both values, difference and word."""
    asked = probe.asked_in(pair[1].stage)
    error, word, scale = words.get((probe.name, pair[1].stage, pair[1].value), (NOTHING, NOTHING, 0.0))
    texts = (vector(at.values[probe.name], factor, ROUND_OFF * scale) if asked else NOTHING for at in pair)
    return (*map(with_minus, texts), error, word)


def _title(scene: Scene, station: StationAnswer) -> str:
    stage = next(each for each in scene.stages if each.name == station.stage)
    return f"{stage.name}, {stage.steps} = {load_text(scene, stage.name, station.value)}"


def line(places: Array, *, closed: bool = False) -> str:
    """Path through places (k, 2) of the picture, without places within a distance of ε."""
    return "M" + "L".join(_pair(*each) for each in thinned(places)) + ("Z" if closed else "") if len(places) else ""


def thinned(places: Array) -> Array:
    """Places (m, 2) of a line within about ε: the distances of the kept places are √(8 ε/κ)."""
    way = np.diff(places, axis=0)
    size = np.hypot(*way.T)
    turn = np.abs(np.diff(np.unwrap(np.arctan2(way[:, 1], way[:, 0]))))
    steps = np.cumsum(np.sqrt(turn * np.maximum(size[1:], size[:-1]) / (8.0 * _EPSILON)))
    kept = np.flatnonzero(np.diff(np.floor(steps), prepend=0.0)) + 1
    return places[[0, *kept.tolist(), len(places) - 1]]


def dots(places: Array) -> str:
    """A dot at every place (k, 2)."""
    return "".join(f"M{_pair(*each)}h0" for each in places)


def _arrow(arrow: Arrow, bounds: Bounds, place: _Placing) -> str:
    """Arrow of a force with the head at the place of action, or round the place for a moment."""
    tip, size, most = place(arrow.place[None])[0], float(np.hypot(*arrow.force)), bounds.force[arrow.kind]
    path = ""
    if size > LEAST * most > 0.0:
        way = _LONGEST / most * arrow.force * (1.0, -1.0)
        path += line(np.stack([tip - way, tip])) + _head(tip, way)
    if arrow.moment:
        angles = np.linspace(-0.75 * np.pi, 0.75 * np.pi, 25) * np.sign(arrow.moment)
        ring = tip + _TURN * np.stack([np.cos(angles), -np.sin(angles)], axis=1)
        path += line(ring) + _head(ring[-1], ring[-1] - ring[-2])
    return path


def _head(tip: Array, way: Array) -> str:
    """Two short lines at the tip of an arrow."""
    along = min(_HEAD, max(0.6 * float(np.hypot(*way)), 4.0)) * way / np.hypot(*way)
    across = 0.45 * np.array([-along[1], along[0]])
    return "M" + "L".join(_pair(*each) for each in (tip - along + across, tip, tip - along - across))


def _pair(x: float, y: float) -> str:
    return f"{round(float(x), 1) + 0.0:g},{round(float(y), 1) + 0.0:g}"
