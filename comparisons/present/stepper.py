"""A mechanism station by station on a page: shapes with colours of stress, contacts, forces and values.

The picture has an SVG path for every kind of part, and a station has the data of all paths.  The finite elements' beams
have their true thickness, with colours of the bending stress at the right edge; the CPRBM's are neutral lines.

======  ===========================================================================
symbol  meaning
======  ===========================================================================
X, Y    place in the picture, whose longer side is ``WIDE``; Y grows downwards
ε       largest distance of a drawn line from the line through all points
======  ===========================================================================
"""

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain, groupby
from typing import Any

import numpy as np
import shapely

from comparisons.case import Comparison
from comparisons.formats import number
from comparisons.present.columns import NOTHING, Column, Plain, columns_of
from comparisons.present.figures import colour_unit, view_title
from comparisons.present.picture import Arrow, Bounds, Kind, View, bounds_of, names_by_place, view_of
from comparisons.present.row_tables import BOTH, ERROR, share, value_columns
from comparisons.present.strips import Strip
from comparisons.present.table import with_minus
from comparisons.verdict import SOLVERS
from cprbm_scene import STRESSES, Array, StationAnswer

WIDE = 1000.0
SHADES = 11
"""Colours of the stress, from the largest pressure to the largest tension."""

HEADERS = ("probe", "CPRBM", "FEA", "error", "word")

_MARGIN = 0.1  # beside the mechanism, over its longer side
_THINNEST = 2.5  # least drawn thickness
_EPSILON = 0.2
_HEAD, _TURN = 11.0, 26.0  # an arrow's head, radius of a moment's arrow
_MARKS: tuple[Kind, ...] = ("weld", "pin", "pivot")

Placing = Callable[[Array], Array]
"""Function from places (k, 2), m, to places in the picture."""


def stations_json(stations: Iterable[Sequence[Any]]) -> str:
    """The ``stations`` of a stepper as JSON for a page; the cells of the table stand in a list."""
    every = [(label, paths, places, [*chain(*cells)]) for label, paths, places, cells in stations]
    return json.dumps(every, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def stepper(compared: Comparison) -> Plain | None:
    """Data of a picture with a slider and a table for the common stations of both answers; None without a station.

    ==============  ==================================================================
    key             value
    ==============  ==================================================================
    width, height   of the picture
    rest            data of the path of the beams at rest
    moving          classes of the moving paths, in the order of the stations' data
    points          names beside points
    names           probes and units of the table's lines
    stations        label, paths, places of the names, and cells of the table
    thick           beams drawn thicker than in truth
    span            the largest stress of the colours with the unit
    ==============  ==================================================================
    """
    scene, common = compared.scene, compared.runs.reached
    cprbm, fea = (compared.runs.stations[solver] for solver in SOLVERS)
    if not common:
        return None
    views = [view_of(scene, fea[where]) for where in common]
    bounds = bounds_of(scene, views, "bending_stress").around(each for view in views for each in view.arrows)
    margin = _MARGIN * bounds.size
    corner = np.array([bounds.low[0] - margin, bounds.high[1] + margin])
    sides = bounds.high - bounds.low + 2.0 * margin
    scale = WIDE / float(np.max(sides))

    def place(places: Array) -> Array:
        return np.asarray((places - corner) * (scale, -scale))

    names = [probe.name for probe in scene.probes if probe.quantity not in STRESSES]
    rows = {(row.probe.name, *row.where): row for row in compared.rows}
    _, unit_of, *values = value_columns(scene, [*rows.values()], BOTH)
    columns = [*values, *columns_of(share, ERROR), Column("word", "word.value")]
    units = {name: unit_of.cell(at) for (name, *_), at in rows.items()}
    labels = names_by_place(views[-1].points, 1.0 / scale)
    leaders = [text.partition(", ")[0] for text in labels]
    stations, moving = [], dict[str, str]()
    for where, view in zip(common, views, strict=True):
        moving = dict(_moving(view, cprbm[where], bounds, place))
        known = (rows.get((name, *where)) for name in names)
        cells = tuple(tuple(with_minus(column.cell(at)) if at else NOTHING for column in columns) for at in known)
        spots = tuple("{:g} {:g}".format(*np.round(place(view.points[point]))) for point in leaders)
        stations.append((view_title(scene, view), tuple(moving.values()), spots, cells))
    factor, unit = colour_unit(scene, "bending_stress", bounds.most)
    return {
        "width": float(round(sides[0] * scale)),
        "height": float(round(sides[1] * scale)),
        "rest": "".join(line(place(strip.rest_line)) for strip in views[-1].strips.values()),
        "moving": tuple(moving),
        "points": tuple(labels),
        "names": tuple((name, units.get(name, "")) for name in names),
        "stations": tuple(stations),
        "thick": tuple(name for name, beam in scene.beams.items() if beam.thinnest * scale < _THINNEST),
        "span": f"{number(bounds.most / factor)} {unit}" if bounds.most else "",
    }


def _moving(view: View, cprbm: StationAnswer, bounds: Bounds, place: Placing) -> Iterator[tuple[str, str]]:
    """Class and data of every moving path at a station."""
    edges, lines = view.of("edge"), (np.stack([shape.x, shape.y], axis=1) for shape in cprbm.shapes.values())
    shades = [shade for strip in view.strips.values() for shade in _shades(strip, bounds, place)]
    yield "rigid", "".join(line(place(part.area), closed=True) for part in edges)
    yield "edge", "".join(line(place(part.points), closed=part.closed) for part in edges)
    for shade in range(SHADES):
        yield f"shade{shade}", "".join(path for found, path in shades if found == shade)
    yield "body", "".join(line(place(part.points), closed=part.closed) for part in view.of("body"))
    yield "pin", "".join(dots(place(part.points)) for part in view.of(*_MARKS))
    yield "cprbm", "".join(line(place(each)) for each in lines)
    yield "zone", "".join(dots(place(part.points)) for part in view.of("contact"))
    for kind in ("push", "load"):
        yield kind, "".join(_arrow(each, bounds.arrow(each), place) for each in view.arrows_of(kind))


def _shades(strip: Strip, bounds: Bounds, place: Placing) -> Iterator[tuple[int, str]]:
    """Areas of a beam by number of the colour."""
    middle = place(strip.line)
    across = place(strip.layer(1.0)) - middle
    across *= np.maximum(0.5 * _THINNEST / np.hypot(*across.T), 1.0)[:, None]
    edges = middle + across, middle - across
    colours = np.rint((1.0 + strip.bending_stress / (bounds.most or 1.0)) * (SHADES - 1) / 2.0).astype(int)
    for colour, found in groupby(range(len(colours) - 1), key=lambda piece: colours[piece]):
        pieces = list(found)
        run = slice(pieces[0], pieces[-1] + 2)
        yield int(colour), line(np.concatenate([edges[0][run], edges[1][run][::-1]]), closed=True)


def line(places: Array, *, closed: bool = False) -> str:
    """Path through places (k, 2) of the picture, without places within a distance of ε."""
    kept = (
        shapely.get_coordinates(shapely.simplify(shapely.linestrings(places), _EPSILON)) if len(places) > 1 else places
    )
    return "M" + "L".join(_pair(*each) for each in kept) + ("Z" if closed else "") if len(kept) else ""


def dots(places: Array) -> str:
    """A dot at every place (k, 2)."""
    return "".join(f"M{_pair(*each)}h0" for each in places)


def _arrow(arrow: Arrow, vector: Array | None, place: Placing) -> str:
    """Arrow of a force with the head at the place of action, or round the place for a moment."""
    tip, path = place(arrow.middle), ""
    if vector is not None:
        tail = place(arrow.middle - vector)
        path += line(np.stack([tail, tip])) + _head(tip, tip - tail)
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
