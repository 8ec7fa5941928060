"""Supports and mobility of the mechanism: loose bodies, and motions with two holders.

=======  ==============================================================================
symbol   meaning
=======  ==============================================================================
A        rows of guides, pins and drives over the freedoms of all bodies
B        the same with every beam as a further rigid body, and rows of the beams' joints
=======  ==============================================================================

The rows of pins and drives must be independent in A: a linkage with a dependent row closes only by chance.  The null
space of B contains the motions without bending: no force resists them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from math import dist

import numpy as np

from cprbm_scene.curve_records import MEETING
from cprbm_scene.freedoms import AXES, NEGLIGIBLE, Freedoms, Row, rank, unit
from cprbm_scene.mistakes import Mistake, broken, written_place
from cprbm_scene.names import unknown_names
from cprbm_scene.statement import BodyPin, FreeEnd, PinnedEnd, Scene, WeldedEnd

FREEDOMS = 3
"""Freedoms of a rigid body in the plane."""

_KINDS = {"slides": "sliding", "turns": "turning"}
Part = tuple[str, str]
"""A body or beam of a mechanism: its table and its name."""
Motion = dict[Part, Row]
"""A row over the freedoms of several parts."""


def wrong_mobility(scene: Scene) -> Iterator[Mistake]:
    """Pins between unsuitable points, missing supports, motions with two holders, loose bodies.

    Checks of the whole mechanism need known points, guides and directions.
    """
    yield from _pins(scene)
    unknown = {mistake.key for mistake in unknown_names(scene)}
    acting = [*scene.bodies.values(), *scene.drives.values()]
    sound = not any(key.startswith(("drives", "pins")) or key.endswith(".point") for key in unknown)
    sound = sound and not any(mistake for record in acting for mistake in record.rules())
    freedoms = Freedoms(scene) if sound else None
    loose = list(unsupported(scene, freedoms))
    yield from (mistake for mistake, names in loose if not _acted_on(scene, names))
    if freedoms is None or any(len({*map(scene.body_of, pin.points)}) == 1 for pin in scene.pins.values()):
        return
    if scene.pins:
        yield from _held_twice(scene, freedoms)
    held_otherwise = scene.contacts or scene.stops or scene.assembly is not None
    if not loose and (scene.pins or not held_otherwise):
        yield from _loose(scene, freedoms)


def _pins(scene: Scene) -> Iterator[Mistake]:
    """Pins within a body, between fixed bodies, or between distant points."""
    owners = scene.owners
    places = {point: scene.place_of(point) for point in owners}
    extent = float(np.ptp(list(places.values()), axis=0).max()) if places else 0.0
    for name, pin in scene.pins.items():
        if not all(point in places for point in pin.points):
            continue
        one, other = (owners[point] for point in pin.points)
        fixed, (a, b) = (
            scene.bodies[one].motion == scene.bodies[other].motion == "fixed",
            map(scene.place_of, pin.points),
        )
        both = f"{pin.points[0]!r} and {pin.points[1]!r}, both of the body {one!r}"
        apart = f"points {dist(a, b):.3g} m apart: {written_place(a)} m and {written_place(b)} m"
        rules = broken(
            (one == other, "", both, "points of two different bodies"),
            (fixed, "", f"points of two fixed bodies, {one!r} and {other!r}", "one that moves"),
            (not dist(a, b) <= MEETING * extent, "", apart, f"at most {MEETING:g} of the scene's extent between them"),
        )
        yield from (replace(each, key=f"pins.{name}.points") for each in islice(rules, 1))


def unsupported(scene: Scene, freedoms: Freedoms | None) -> Iterator[tuple[Mistake, set[str]]]:
    """Scenes without ground or drives, beams without supports, bodies without a way to a support.

    Beside each mistake stand the names of the bodies and beams that move together; without ``freedoms`` of beams only.
    """
    drives = [drive for drive in scene.drives.values() if scene.holds(drive, scene.stages[0].name)]
    if all(body.motion == "free" for body in scene.bodies.values()) and not drives:
        yield Mistake("bodies", "no fixed body", 'at least one body with motion = "fixed"'), set()
        return
    joints = {}
    turns = "a pin at one end and nothing at the other: the beam turns freely"
    for name, beam in scene.beams.items():
        ends = [end for end in (beam.start, beam.end) if not isinstance(end, FreeEnd)]
        joints[name] = [end.point for end in ends]
        pinned = len(ends) == 1 and isinstance(ends[0], PinnedEnd)
        rules = broken(
            (not ends, "", "two free ends", "at least one end that meets a body, or a contact that holds the beam"),
            (pinned, "", turns, "a weld, joints at both ends, or a contact or a load"),
        )
        yield from ((replace(each, key=f"beams.{name}"), {name}) for each in rules)
    if freedoms is None:
        return
    met = {name: {freedoms.owners[point] for point in points} for name, points in joints.items()}
    met |= {name: {freedoms.owners[point] for point in pin.points} for name, pin in scene.pins.items()}
    for name, body in scene.bodies.items():
        together = _connected(name, list(met.values()))
        rows = [row for each in together for row in freedoms.guide(each)]
        rows += [freedoms.row(drive) for drive in drives if freedoms.owner(drive) in together]
        reached = any(name in bodies for bodies in met.values())
        found = f"a {_KINDS.get(body.motion, 'free')} body that no {'fixed body holds' if reached else 'beam meets'}"
        held_by = "beams that lead to a fixed body, or slides, pivots, drives, contacts and loads that hold it"
        allowed = held_by if reached else "a beam's end, a pin, a contact or a load on it"
        if rank(rows) < FREEDOMS:
            yield Mistake(f"bodies.{name}", found, allowed), together | {beam for beam in met if met[beam] & together}


def _acted_on(scene: Scene, names: set[str]) -> bool:
    """True if a contact with other parts, a load or a drive may hold the bodies and beams of the ``names``."""
    acting = (*scene.loads.values(), *scene.drives.values())
    points, owners = {str(getattr(each, "point", None)) for each in acting}, scene.owners
    moved = {getattr(each, "body", getattr(each, "beam", None)) for each in acting}
    moved |= {owners[point] for point in points & owners.keys()}
    touching = ({*contact.beams, getattr(contact, "body", contact.beams[0])} for contact in scene.contacts.values())
    return bool(names & moved) or any(parts & names and parts - names for parts in touching)


def _connected(body: str, met: Sequence[set[str]]) -> set[str]:
    """Bodies connected to a ``body`` by beams and pins, including the body."""
    reached = {body}
    while more := {other for bodies in met if bodies & reached for other in bodies} - reached:
        reached |= more
    return reached


def _held_twice(scene: Scene, freedoms: Freedoms) -> Iterator[Mistake]:
    """Pins and drives with rows that depend on earlier rows of A."""
    parts: list[Part] = [("body", name) for name in scene.bodies]
    rows: list[Motion] = [{("body", name): row} for name in scene.bodies for row in freedoms.guide(name)]
    closing = {f"pins.{name}": _pin_rows(freedoms, pin) for name, pin in scene.pins.items()}
    for name, drive in scene.drives.items():
        closing[f"drives.{name}"] = [{("body", freedoms.owner(drive)): freedoms.row(drive)}]
    for key, more in closing.items():
        if rank(_matrix([*rows, *more], parts)) < rank(_matrix(rows, parts)) + len(more):
            what = "bodies" if key.startswith("pins") else "a motion"
            found = f"{what} that guides, pins and drives hold already where it begins"
            yield Mistake(key, found, "as many pins and drives as there are motions to hold, each for one of its own")
        rows += more


def _loose(scene: Scene, freedoms: Freedoms) -> Iterator[Mistake]:
    """Bodies with a motion in the null space of B."""
    parts: list[Part] = [("body", name) for name in scene.bodies] + [("beam", name) for name in scene.beams]
    rows: list[Motion] = [{("body", name): row} for name in scene.bodies for row in freedoms.guide(name)]
    rows += [row for pin in scene.pins.values() for row in _pin_rows(freedoms, pin)]
    rows += [
        {("body", freedoms.owner(drive)): freedoms.row(drive)}
        for drive in scene.drives.values()
        if scene.holds(drive, scene.stages[0].name)
    ]
    for name, end in ((name, end) for name, beam in scene.beams.items() for end in (beam.start, beam.end)):
        if not isinstance(end, FreeEnd):
            along = [freedoms.along(end.point, axis) for axis in AXES]
            own = list(np.eye(3)) if isinstance(end, WeldedEnd) else along
            rows += [{("beam", name): row, ("body", freedoms.owners[end.point]): -row} for row in own]
    _, values, motions = np.linalg.svd(_matrix(rows, parts))
    null_space = motions[np.count_nonzero(values > NEGLIGIBLE) :]
    for i, name in enumerate(scene.bodies):
        own = list(null_space[:, 3 * i : 3 * i + 3])
        if np.abs(own).max(initial=0.0) > NEGLIGIBLE:
            how = _in_words(freedoms, own[0]) if len(own) == 1 else f"move in {rank(own)} ways"
            found = f"a body that can {how} where it is without bending a beam"
            yield Mistake(f"bodies.{name}", found, "pins, guides, drives and beams that hold it")


def _pin_rows(freedoms: Freedoms, pin: BodyPin) -> list[Motion]:
    """The two relative displacements at a pin."""
    one, other = pin.points
    return [
        {
            ("body", freedoms.owners[one]): freedoms.along(one, axis),
            ("body", freedoms.owners[other]): -freedoms.along(other, axis),
        }
        for axis in AXES
    ]


def _matrix(rows: Sequence[Mapping[Part, Row]], parts: Sequence[Part]) -> Row:
    """Rows as a matrix (rows, 3·parts) with rows of length one."""
    columns, matrix = {part: 3 * i for i, part in enumerate(parts)}, np.zeros((len(rows), 3 * len(parts)))
    for line, row in zip(matrix, rows, strict=True):
        for part, values in row.items():
            line[columns[part] : columns[part] + 3] += values
    return np.asarray(matrix / np.linalg.norm(matrix, axis=1, keepdims=True))


def _in_words(freedoms: Freedoms, motion: Row) -> str:
    """A small motion (3,) of a body: a turn about a place, or a displacement along a direction."""
    u, v, turn = motion
    if abs(turn) <= NEGLIGIBLE * np.hypot(u, v):
        x, y = _rounded(unit((float(u), float(v))) * np.sign(u if abs(u) > abs(v) else v))
        return f"move along [{x:.4g}, {y:.4g}]"
    x, y = freedoms.origin + freedoms.extent * _rounded(np.array([-v, u]) / turn)
    return f"turn about [{x:.4g}, {y:.4g}] m"


def _rounded(values: Row) -> Row:
    return np.where(np.abs(values) <= NEGLIGIBLE, 0.0, values)
