"""Pins between bodies, each motion held once; and of any mechanism, nothing left that moves by itself.

=======  ==================================================================================
symbol   meaning
=======  ==================================================================================
A        one row for each motion that guides, pins and drives prevent or prescribe, over the freedoms of all bodies
B        the same with every beam as one more rigid body, and its joints as further rows
=======  ==================================================================================

Rows of pins and drives must be independent in A: a linkage that is held twice has no solution but by chance.  A motion
that B leaves is one that bends no beam, and nothing resists it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import dist

import numpy as np

from cprbm_scene.check_motion import rows_stated, wrong_supports
from cprbm_scene.curve_records import MEETING
from cprbm_scene.freedoms import (
    NEGLIGIBLE,
    Row,
    body_of,
    frame,
    guide_rows,
    pin_rows,
    rank,
    row_of,
    unit,
)
from cprbm_scene.mistakes import Mistake, written_place
from cprbm_scene.names import point_names
from cprbm_scene.statement import BodyPin, FreeEnd, Scene, WeldedEnd


def wrong_pins(scene: Scene) -> Iterator[Mistake]:
    """Pins of one body with itself, of the ground with the ground, of points that are apart, or that close too much."""
    size = _extent(scene)
    for name, pin in scene.pins.items():
        if not _named(scene, pin):
            continue
        one, other = (scene.body_of(point) for point in pin.points)
        places = [scene.place_of(point) for point in pin.points]
        apart = dist(*places)
        if one == other:
            found = f"{pin.points[0]!r} and {pin.points[1]!r}, both of the body {one!r}"
            yield Mistake(f"pins.{name}.points", found, "points of two different bodies")
        elif scene.bodies[one].motion == scene.bodies[other].motion == "fixed":
            yield Mistake(f"pins.{name}.points", f"points of two fixed bodies, {one!r} and {other!r}", "one that moves")
        elif not apart <= MEETING * size:
            found = f"points {apart:.3g} m apart: {' and '.join(f'{written_place(place)} m' for place in places)}"
            allowed = f"at most {MEETING:g} of the scene's extent between them"
            yield Mistake(f"pins.{name}.points", found, allowed)
    yield from _held_twice(scene)


def loose_bodies(scene: Scene) -> Iterator[Mistake]:
    """Bodies that can move, at least a little, without bending a beam; of scenes without pins only where nothing else,
    a contact, a stop or an assembly, may hold them.
    """
    held_otherwise = scene.contacts or scene.stops or scene.assembly is not None
    if (held_otherwise and not scene.pins) or not _sound(scene) or any(wrong_supports(scene)):
        return
    columns = {key: i for i, key in enumerate((*_keys("body", scene.bodies), *_keys("beam", scene.beams)))}
    rows = _rigid_rows(scene, columns)
    rows += [_spread(columns, {("body", body_of(scene, each)): row_of(scene, each)}) for each in scene.drives.values()]
    for name, beam in scene.beams.items():
        for end in (beam.start, beam.end):
            if isinstance(end, FreeEnd):
                continue
            here, there = ("beam", name), ("body", scene.body_of(end.point))
            if isinstance(end, WeldedEnd):
                rows += [_spread(columns, {here: unit, there: -unit}) for unit in np.eye(3)]
            else:
                body = scene.body_of(end.point)
                for row in pin_rows(scene, BodyPin(points=(end.point, end.point)))[body]:
                    rows.append(_spread(columns, {here: row, there: -row}))
    matrix = np.array([row / np.linalg.norm(row) for row in rows])
    _, values, motions = np.linalg.svd(matrix)
    left = motions[np.count_nonzero(values > NEGLIGIBLE) :]
    for (kind, name), i in columns.items():
        own = left[:, 3 * i : 3 * i + 3]
        if kind == "body" and np.abs(own).max(initial=0.0) > NEGLIGIBLE:
            how = _motion(scene, own[0]) if len(own) == 1 else f"move in {rank(list(own))} ways"
            found = f"a body that can {how} where it is without bending a beam"
            yield Mistake(f"bodies.{name}", found, "pins, guides, drives and beams that hold it")


def _motion(scene: Scene, motion: Row) -> str:
    """What a small motion (3,) of a body is, in words: a turn about a place, or a way along a direction."""
    u, v, turn = motion
    if abs(turn) <= NEGLIGIBLE * np.hypot(u, v):
        e = unit((float(u), float(v))) * np.sign(u if abs(u) > abs(v) else v)
        e = np.where(np.abs(e) <= NEGLIGIBLE, 0.0, e)
        return f"move along [{e[0]:.4g}, {e[1]:.4g}]"
    origin, extent = frame(scene)
    away = np.array([-v, u]) / turn
    pole = origin + extent * np.where(np.abs(away) <= NEGLIGIBLE, 0.0, away)
    return f"turn about [{pole[0]:.4g}, {pole[1]:.4g}] m"


def _held_twice(scene: Scene) -> Iterator[Mistake]:
    """Pins and drives of what is held already."""
    if not scene.pins or not _sound(scene):
        return
    columns = {key: i for i, key in enumerate(_keys("body", scene.bodies))}
    known = _rigid_rows(scene, columns, pins=False)
    closing = {
        f"pins.{name}": [
            _spread(columns, {("body", body): parts[i] for body, parts in pin_rows(scene, pin).items()}) for i in (0, 1)
        ]
        for name, pin in scene.pins.items()
    }
    for name, drive in scene.drives.items():
        closing[f"drives.{name}"] = [_spread(columns, {("body", body_of(scene, drive)): row_of(scene, drive)})]
    for key, rows in closing.items():
        rows = [row / np.linalg.norm(row) for row in rows]
        if rank([*known, *rows]) < rank(known) + len(rows):
            what = "bodies" if key.startswith("pins") else "a motion"
            found = f"{what} that guides, pins and drives hold already where it begins"
            yield Mistake(key, found, "as many pins and drives as there are motions to hold, each for one of its own")
        known += rows


def _rigid_rows(scene: Scene, columns: Mapping[tuple[str, str], int], *, pins: bool = True) -> list[Row]:
    """Those of the ground, of guides and of ``pins``."""
    rows = []
    for name, body in scene.bodies.items():
        own = list(np.eye(3)) if body.motion == "fixed" else guide_rows(scene, name)
        rows += [_spread(columns, {("body", name): row}) for row in own]
    for pin in scene.pins.values() if pins else ():
        parts = pin_rows(scene, pin)
        rows += [_spread(columns, {("body", body): both[i] for body, both in parts.items()}) for i in (0, 1)]
    return rows


def _spread(columns: Mapping[tuple[str, str], int], parts: Mapping[tuple[str, str], Row]) -> Row:
    """A row over all freedoms, from its parts."""
    row = np.zeros(3 * len(columns))
    for key, part in parts.items():
        row[3 * columns[key] : 3 * columns[key] + 3] += part
    return row


def _keys(kind: str, names: Mapping[str, object]) -> list[tuple[str, str]]:
    return [(kind, name) for name in names]


def _named(scene: Scene, pin: BodyPin) -> bool:
    return all(point in point_names(scene) for point in pin.points)


def _sound(scene: Scene) -> bool:
    """Whether everything that holds names what there is, and pins are between two bodies."""
    known = point_names(scene)
    ends = [end for beam in scene.beams.values() for end in (beam.start, beam.end)]
    return (
        all(isinstance(end, FreeEnd) or end.point in known for end in ends)
        and all(_named(scene, pin) for pin in scene.pins.values())
        and all(scene.body_of(pin.points[0]) != scene.body_of(pin.points[1]) for pin in scene.pins.values())
        and rows_stated(scene)
    )


def _extent(scene: Scene) -> float:
    """The largest coordinate of a body's point less the first one's, m."""
    places = np.array([place for body in scene.bodies.values() for place in body.points.values()])
    return float(np.abs(places - places[0]).max())
