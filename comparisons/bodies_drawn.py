"""Bodies as a figure shows them: links between beams' ends and pivots, and the limits of stops.

======  ==================================================================================
symbol  meaning
======  ==================================================================================
p_i     places of a body's points as drawn, m, those of which a station tells the new ones
q_i     their new places
φ       the body's rotation: of Σ (p_i − p̄)ᵀ R(φ)ᵀ (q_i − q̄) the largest, so that with the
        sums c of the scalar and s of the vector products tan φ = s/c (Procrustes)
======  ==================================================================================
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import atan2
from typing import TYPE_CHECKING, Literal

import numpy as np

from comparisons.geometry import edge_places, longest
from cprbm_scene import PinnedEnd, Scene, StationAnswer, WeldedEnd
from cprbm_scene.answer import Array
from cprbm_scene.statement import (
    EdgeContact,
    FixedBody,
    FreeEnd,
    Point,
    TurningBody,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GRAPH = 100  # places of a function's graph
RAY = 0.15  # of the longest beam: how far the limits of a stop are drawn
CLOSE = 0.05  # of the longest beam: nearer points have their names on different sides
SAME = 1e-3  # of that: points nearer than this are in one place

Places = Mapping[str, Point]
"""By the name of a body's point where it is, m."""


def joined_ends(scene: Scene) -> Iterator[tuple[str, PinnedEnd | WeldedEnd, Literal[0, -1]]]:
    """Every beam's end that meets a body: the beam, the end, and its place in the beam's shape."""
    for name, beam in scene.beams.items():
        if not isinstance(beam.start, FreeEnd):
            yield name, beam.start, 0
        if not isinstance(beam.end, FreeEnd):
            yield name, beam.end, -1


def places_at(scene: Scene, station: StationAnswer) -> dict[str, Point]:
    """Where a station has the points at which beams end, the pivots, and what is pinned to either."""
    found = {body.about: body.points[body.about] for body in scene.bodies.values() if isinstance(body, TurningBody)}
    for beam, end, place in joined_ends(scene):
        shape = station.shapes[beam]
        found[end.point] = (float(shape.x[place]), float(shape.y[place]))
    ground = [body for body in scene.bodies.values() if isinstance(body, FixedBody)]
    known = {point: at for body in ground for point, at in body.points.items()}
    for _ in scene.pins:
        for pin in scene.pins.values():
            for one, other in (pin.points, pin.points[::-1]):
                if one in found or one in known:
                    found.setdefault(other, found[one] if one in found else known[one])
    return found


def draw_bodies(axes: Axes, scene: Scene, places: Places, style: str, colour: str) -> None:
    """Bodies as lines between their places, closed round three and more; of the ground the places alone.

    Squares are welds, rings pins, and a larger ring round a dot a pivot.
    """
    pins = {end.point for _, end, _ in joined_ends(scene) if isinstance(end, PinnedEnd)}
    for body in scene.bodies.values():
        mine = [point for point in body.points if point in places]
        if not mine:
            continue
        x, y = np.array([places[point] for point in (*mine, mine[0])]).T
        if not isinstance(body, FixedBody):
            axes.plot(x, y, linestyle=style, color=colour, linewidth=1.2)
        for point in mine:
            at = [places[point][0]], [places[point][1]]
            if isinstance(body, TurningBody) and point == body.about:
                axes.plot(*at, "o", color=colour, markersize=8, markerfacecolor="none")
                axes.plot(*at, ".", color=colour, markersize=3)
            elif point in pins:
                axes.plot(*at, "o", color=colour, markersize=5, markerfacecolor="white", zorder=3)
            else:
                axes.plot(*at, "s", color=colour, markersize=4)


def draw_stops(axes: Axes, scene: Scene, places: Places) -> None:
    """The limits of stops as rays from their pins; none of a body whose rotation is not known."""
    ray = RAY * longest(scene)
    for stop in scene.stops.values():
        end = scene.beams[stop.beam].start if stop.end == "start" else scene.beams[stop.beam].end
        assert isinstance(end, PinnedEnd)
        turned = rotation(scene, scene.body_of(end.point), places)
        if turned is None:
            continue
        pin, towards = np.array(scene.place_of(end.point)), np.array(scene.place_of(stop.towards))
        base = atan2(*(towards - pin)[::-1]) + turned
        x, y = np.array(places[end.point])
        for limit in (stop.least, stop.most):
            if limit is not None:
                way = base + limit
                axes.plot([x, x + ray * np.cos(way)], [y, y + ray * np.sin(way)], "-.", color="black", linewidth=0.8)


def draw_edges(axes: Axes, scene: Scene, places: Places, colour: str) -> None:
    """Lines, half-planes and functions that beams may touch; dashed where they began, if no more is known."""
    reach = longest(scene)
    for contact in scene.contacts.values():
        if not isinstance(contact, EdgeContact):
            continue
        body = scene.bodies[contact.body]
        edge, turned = edge_places(contact, reach, GRAPH), rotation(scene, contact.body, places)
        if turned is not None and not isinstance(body, FixedBody):
            known = next(point for point in body.points if point in places)
            cos, sin = np.cos(turned), np.sin(turned)
            edge = (edge - body.points[known]) @ np.array([[cos, sin], [-sin, cos]]) + places[known]
        axes.plot(*edge.T, "--" if turned is None else "-", color=colour, linewidth=0.9, zorder=0)


def draw_names(axes: Axes, scene: Scene) -> None:
    """The names of all points as drawn: at the left of each, or at the right where another point is close there.

    Points in one place, as pins join them, share a name.
    """
    close = CLOSE * longest(scene)
    named: list[tuple[Array, list[str]]] = []
    for body in scene.bodies.values():
        for name, point in body.points.items():
            place = np.array(point)
            for known, names in named:
                if np.hypot(*(place - known)) < SAME * close:
                    names.append(name)
                    break
            else:
                named.append((place, [name]))
    for place, names in named:
        beside = (place - other for other, _ in named)
        crowded = any(0.0 < x < close and abs(y) < close for x, y in beside)
        axes.annotate(
            ", ".join(names),
            tuple(place),
            textcoords="offset points",
            xytext=(4 if crowded else -4, 7),
            ha="left" if crowded else "right",
        )


def rotation(scene: Scene, body: str, places: Places) -> float | None:
    """φ of a body, rad, from two places or more; None where there are fewer."""
    if isinstance(scene.bodies[body], FixedBody):
        return 0.0
    known = [point for point in scene.bodies[body].points if point in places]
    if len(known) < 2:
        return None
    p, q = (_centred(np.array(each)) for each in zip(*((scene.place_of(k), places[k]) for k in known), strict=True))
    return atan2(float(np.sum(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0])), float(np.sum(p * q)))


def _centred(places: Array) -> Array:
    return np.asarray(places - places.mean(axis=0))
