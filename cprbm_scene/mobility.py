"""Mobility of the mechanism: pins, supports, loose bodies, motions held twice, actions without a motion.

=======  ==============================================================================
symbol   meaning
=======  ==============================================================================
A        rows of guides, pins and drives over the freedoms of all bodies
B        the same with every beam as a further rigid body, and rows of the beams' joints
=======  ==============================================================================

The rows of pins and drives must be independent in A: a linkage with a dependent row closes only by chance.  The null
space of B contains the motions without bending: no force resists them.  A load or drive acts on a movable body, along a
motion that no guide and no other drive holds.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from math import dist

import numpy as np

from cprbm_scene.curve_records import MEETING
from cprbm_scene.freedoms import NEGLIGIBLE, Freedoms, Row, independent, unit
from cprbm_scene.mistakes import Mistake, written_place
from cprbm_scene.names import unknown_names
from cprbm_scene.statement import (
    BeamForce,
    BeamMoment,
    BodyLoad,
    Drive,
    Force,
    FreeEnd,
    Moment,
    PinnedEnd,
    RotationDrive,
    Scene,
    TurningBody,
)

FREEDOMS = 3
"""Freedoms of a rigid body in the plane."""

_KINDS = {"slides": "sliding", "turns": "turning"}


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
        keys, rows = zip(*freedoms.constraints(scene.drives), strict=True)
        for key in dict.fromkeys(key for key, free in zip(keys, independent(rows), strict=True) if not free):
            what = "bodies" if key.startswith("pins") else "a motion"
            yield Mistake(
                key,
                f"{what} that guides, pins and drives hold already where it begins",
                "as many pins and drives as there are motions to hold, each for one of its own",
            )
    held_otherwise = scene.contacts or scene.stops or scene.assembly is not None
    if not loose and (scene.pins or not held_otherwise):
        yield from _loose(scene, freedoms)


def _pins(scene: Scene) -> Iterator[Mistake]:
    """Pins within a body, between fixed bodies, or between distant points."""
    owners = scene.owners
    places = {point: scene.bodies[name].points[point] for point, name in owners.items()}
    extent = float(np.ptp(list(places.values()), axis=0).max()) if places else 0.0
    for name, pin in scene.pins.items():
        (p, q), key = pin.points, f"pins.{name}.points"
        if not owners.keys() >= {p, q}:
            continue
        one, other, apart = owners[p], owners[q], dist(places[p], places[q])
        if one == other:
            yield Mistake(key, f"{p!r} and {q!r}, both of the body {one!r}", "points of two different bodies")
        elif scene.bodies[one].motion == scene.bodies[other].motion == "fixed":
            yield Mistake(key, f"points of two fixed bodies, {one!r} and {other!r}", "one that moves")
        elif not apart <= MEETING * extent:
            yield Mistake(
                key,
                f"points {apart:.3g} m apart: {written_place(places[p])} m and {written_place(places[q])} m",
                f"at most {MEETING:g} of the scene's extent between them",
            )


def unsupported(scene: Scene, freedoms: Freedoms | None) -> Iterator[tuple[Mistake, set[str]]]:
    """Scenes without ground or drives, beams without supports, bodies without a way to a support.

    Beside each mistake stand the names of the bodies and beams that move together; without ``freedoms`` of beams only.
    """
    drives = [drive for drive in scene.drives.values() if scene.holds(drive, scene.stages[0].name)]
    if all(body.motion == "free" for body in scene.bodies.values()) and not drives:
        yield Mistake("bodies", "no fixed body", 'at least one body with motion = "fixed"'), set()
        return
    met = {name: list(pin.points) for name, pin in scene.pins.items()}
    for name, beam in scene.beams.items():
        ends = [end for end in (beam.start, beam.end) if not isinstance(end, FreeEnd)]
        met[name] = [end.point for end in ends]
        if not ends:
            allowed = "at least one end that meets a body, or a contact that holds the beam"
            yield Mistake(f"beams.{name}", "two free ends", allowed), {name}
        elif len(ends) == 1 and isinstance(ends[0], PinnedEnd):
            found = "a pin at one end and nothing at the other: the beam turns freely"
            yield Mistake(f"beams.{name}", found, "a weld, joints at both ends, or a contact or a load"), {name}
    if freedoms is None:
        return
    joined = {name: {freedoms.owners[point] for point in points} for name, points in met.items()}
    for name, body in scene.bodies.items():
        together = _connected(name, list(joined.values()))
        rows = [row for each in together for row in freedoms.guide(each)]
        rows += [freedoms.row(drive) for drive in drives if freedoms.owner(drive) in together]
        if sum(independent(rows)) < FREEDOMS:
            kind, reached = _KINDS.get(body.motion, "free"), any(name in bodies for bodies in joined.values())
            mistake = Mistake(
                f"bodies.{name}",
                f"a {kind} body that no {'fixed body holds' if reached else 'beam meets'}",
                "beams that lead to a fixed body, or slides, pivots, drives, contacts and loads that hold it"
                if reached
                else "a beam's end, a pin, a contact or a load on it",
            )
            yield mistake, together | {beam for beam in joined if joined[beam] & together}


def _acted_on(scene: Scene, names: set[str]) -> bool:
    """True if a contact with other parts, a load or a drive may hold the bodies and beams of the ``names``."""
    acting, owners = (*scene.loads.values(), *scene.drives.values()), scene.owners
    moved = {getattr(each, "body", getattr(each, "beam", None)) for each in acting}
    moved |= {owners.get(getattr(each, "point", "")) for each in acting}
    touching = ({*contact.beams, getattr(contact, "body", contact.beams[0])} for contact in scene.contacts.values())
    return bool(names & moved) or any(parts & names and parts - names for parts in touching)


def _connected(body: str, met: Sequence[set[str]]) -> set[str]:
    """Bodies connected to a ``body`` by beams and pins, including the body."""
    reached = {body}
    while more := {other for bodies in met if bodies & reached for other in bodies} - reached:
        reached |= more
    return reached


def _loose(scene: Scene, freedoms: Freedoms) -> Iterator[Mistake]:
    """Bodies with a motion in the null space of B."""
    drives = [name for name, drive in scene.drives.items() if scene.holds(drive, scene.stages[0].name)]
    rows = [*(row for _, row in freedoms.constraints(drives)), *freedoms.joints()]
    _, values, motions = np.linalg.svd(np.array(rows))
    null_space = motions[np.count_nonzero(values > NEGLIGIBLE) :]
    for i, name in enumerate(scene.bodies):
        own = [motion for motion in null_space[:, 3 * i : 3 * i + 3] if np.abs(motion).max() > NEGLIGIBLE]
        if own:
            how = _in_words(freedoms, own[0]) if len(null_space) == 1 else f"move in {sum(independent(own))} ways"
            found = f"a body that can {how} where it is without bending a beam"
            yield Mistake(f"bodies.{name}", found, "pins, guides, drives and beams that hold it")


def _in_words(freedoms: Freedoms, motion: Row) -> str:
    """A small motion (3,) of a body: a turn about a place, or a displacement along a direction."""
    u, v, turn = np.where(np.abs(motion) <= NEGLIGIBLE * np.abs(motion).max(), 0.0, motion)
    if turn == 0.0:
        x, y = unit((float(u), float(v))) * np.sign(u if abs(u) > abs(v) else v)
        return f"move along [{x + 0.0:.4g}, {y + 0.0:.4g}]"
    x, y = freedoms.origin + freedoms.extent * np.array([-v, u]) / turn
    return f"turn about [{x + 0.0:.4g}, {y + 0.0:.4g}] m"


def wrong_actions(scene: Scene) -> Iterator[Mistake]:
    """Loads and drives of fixed bodies or across guides, and motions with two drives or with a drive and a load."""
    if not any(body.points for body in scene.bodies.values()):
        return
    freedoms, driven = Freedoms(scene), defaultdict[str, list[str]](list)
    drives = {f"drives.{name}": drive for name, drive in scene.drives.items()}
    loads = {f"loads.{name}": load for name, load in scene.loads.items() if isinstance(load, BodyLoad)}
    for key, acting in (drives | loads).items():
        turns = isinstance(acting, Moment | RotationDrive)
        if (acting.body in scene.bodies if turns else acting.point in freedoms.owners) and not any(acting.rules()):
            owner = freedoms.owner(acting)
            mistakes = list(_without_motion(freedoms, key, acting, driven[owner]))
            yield from mistakes
            if key in drives and not mistakes and not any(scene.bodies[owner].rules()):
                driven[owner].append(key.removeprefix("drives."))
    fixed = {point for body in scene.bodies.values() if body.motion == "fixed" for point in body.points}
    for name, load in scene.loads.items():
        if isinstance(load, BeamForce | BeamMoment) and load.beam in scene.beams and load.at in (0.0, 1.0):
            end = scene.beams[load.beam].start if load.at == 0.0 else scene.beams[load.beam].end
            turns = isinstance(load, BeamMoment) and isinstance(end, PinnedEnd)
            if end.point in fixed and not turns:
                found = f"{load.at:g}, an end of {load.beam!r} that is held at {end.point!r}, a point of a fixed body"
                yield Mistake(f"loads.{name}.at", found, "a place of the beam that can move")


def _without_motion(freedoms: Freedoms, key: str, acting: BodyLoad | Drive, driven: list[str]) -> Iterator[Mistake]:
    """The mistake of a fixed body, or of a motion that a guide or the ``driven`` motions of the same body hold.

    Loads compete with drives that hold from the start only.
    """
    scene, owner, load = freedoms.scene, freedoms.owner(acting), isinstance(acting, BodyLoad)
    body, turns = scene.bodies[owner], isinstance(acting, Moment | RotationDrive)
    if body.motion == "fixed":
        what = ("a moment on" if turns else "a force at") if load else ("a drive of" if turns else "a drive at")
        of = "" if turns else f" {acting.point!r}, a point of"
        movable = {name: each.points for name, each in scene.bodies.items() if each.motion != "fixed"}
        names = movable if turns else [point for points in movable.values() for point in points]
        place, listed = "body" if turns else "point", ", ".join(map(repr, names)) or "there is none"
        yield Mistake(f"{key}.{place}", f"{what}{of} the fixed body {owner!r}", f"a {place} that can move: {listed}")
    if body.motion == "fixed" or any(body.rules()):
        return
    row, guide = freedoms.row(acting), freedoms.guide(owner)
    drives = {name: scene.drives[name] for name in driven if not load or scene.drives[name].begins is None}
    opposed = [name for name, drive in drives.items() if _opposed(freedoms, acting, drive)]
    first = " and ".join(f"drives.{name}" for name in opposed or drives)
    if not independent([*guide, row])[-1] and turns:
        yield Mistake(
            f"{key}.body", f"the rotation of {owner!r}, which slides and does not turn", "a body that can turn"
        )
    elif not independent([*guide, row])[-1]:
        way = "towards the pivot" if isinstance(body, TurningBody) else "across the slide"
        allowed = "a direction along which the point can move"
        yield Mistake(f"{key}.direction", f"a direction {way} of {owner!r}", allowed)
    elif opposed or not independent([*guide, *map(freedoms.row, drives.values()), row])[-1]:
        found = (
            f"a load on a freedom of {owner!r} that is driven by"
            if load
            else f"a freedom of {owner!r} that is driven already by"
        )
        allowed = "a load or a drive on one freedom, not both" if load else "one drive for each freedom"
        yield Mistake(key, f"{found} {first}", allowed)


def _opposed(freedoms: Freedoms, load: BodyLoad | Drive, drive: Drive) -> bool:
    """True for a force at the place of a driven displacement, with a component along the displacement."""
    if not isinstance(load, Force) or isinstance(drive, RotationDrive):
        return False
    apart = freedoms.places[load.point] - freedoms.places[drive.point]
    component = abs(float(unit(load.direction) @ unit(drive.direction)))
    return float(abs(apart).max()) <= NEGLIGIBLE * freedoms.extent and component > NEGLIGIBLE
