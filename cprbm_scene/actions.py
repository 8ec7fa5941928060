"""Loads and drives: each acts on a movable body, along a motion that no guide and no other drive holds."""

from __future__ import annotations

from collections.abc import Iterator

from cprbm_scene.freedoms import NEGLIGIBLE, Freedoms, Row, held, unit
from cprbm_scene.mistakes import Mistake
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
    SlidingBody,
    TurningBody,
)


def wrong_actions(scene: Scene) -> Iterator[Mistake]:
    """Loads and drives of fixed bodies or across guides, and motions with two drives or with a drive and a load."""
    if not any(body.points for body in scene.bodies.values()):
        return
    freedoms = Freedoms(scene)
    driven: dict[str, dict[str, Row]] = {}
    for name, drive in scene.drives.items():
        yield from _drive(scene, freedoms, name, drive, driven)
    for name, load in scene.loads.items():
        if isinstance(load, BodyLoad):
            yield from _body_load(scene, freedoms, name, load, driven)
        elif isinstance(load, BeamForce | BeamMoment):
            yield from _held_end(scene, name, load)


def _drive(
    scene: Scene, freedoms: Freedoms, name: str, drive: Drive, driven: dict[str, dict[str, Row]]
) -> Iterator[Mistake]:
    turns = isinstance(drive, RotationDrive)
    if not _named(freedoms, drive) or any(drive.rules()):
        return
    owner, what = freedoms.owner(drive), "body" if turns else "point"
    if scene.bodies[owner].motion == "fixed":
        of = "the rotation" if isinstance(drive, RotationDrive) else f"{drive.point!r}, a point"
        found, allowed = f"a drive of {of} of the fixed body {owner!r}", f"a {what} that can move: "
        movable = [
            each
            for each_name, body in scene.bodies.items()
            if body.motion != "fixed"
            for each in ([each_name] if turns and _can_turn(scene, each_name) else [] if turns else body.points)
        ]
        yield Mistake(f"drives.{name}.{what}", found, allowed + _listed(movable))
    elif not any(scene.bodies[owner].rules()):
        guide, row, others = freedoms.guide(owner), freedoms.row(drive), driven.setdefault(owner, {})
        if held(row, guide) and turns:
            yield Mistake(f"drives.{name}.body", f"the rotation of {owner!r}, which slides", "a free body's rotation")
        elif held(row, guide):
            found, allowed = f"a direction {_across(scene, owner)}", "a direction along which the point can move"
            yield Mistake(f"drives.{name}.direction", found, allowed)
        elif held(row, [*guide, *others.values()]):
            first = " and ".join(f"drives.{other}" for other in others)
            found = f"a freedom of {owner!r} that is driven already by {first}"
            yield Mistake(f"drives.{name}", found, "one drive for each freedom")
        else:
            others[name] = row


def _body_load(
    scene: Scene, freedoms: Freedoms, name: str, load: BodyLoad, driven: dict[str, dict[str, Row]]
) -> Iterator[Mistake]:
    if not _named(freedoms, load):
        return
    owner = freedoms.owner(load)
    if scene.bodies[owner].motion == "fixed":
        of, movable = f"the fixed body {owner!r}", [n for n, body in scene.bodies.items() if body.motion != "fixed"]
        if isinstance(load, Moment):
            found, what, key = f"a moment on {of}", "a body", "body"
        else:
            found, what, key = f"a force at {load.point!r}, a point of {of}", "a point of a body", "point"
        yield Mistake(f"loads.{name}.{key}", found, f"{what} that can move: {_listed(movable)}")
    elif not any(load.rules()) and not any(scene.bodies[owner].rules()):
        guide, row = freedoms.guide(owner), freedoms.row(load)
        drives = {name: each for name, each in driven.get(owner, {}).items() if scene.drives[name].begins is None}
        if held(row, guide):
            if isinstance(load, Moment):
                found = f"a moment on {owner!r}, which slides and does not turn"
                yield Mistake(f"loads.{name}.body", found, "a body that can turn")
            else:
                found, allowed = f"a force {_across(scene, owner)}", "a direction along which the body can move"
                yield Mistake(f"loads.{name}.direction", found, allowed)
            return
        opposed = [other for other in drives if _opposed(freedoms, load, scene.drives[other])]
        if opposed or held(row, [*guide, *drives.values()]):
            first = " and ".join(f"drives.{other}" for other in opposed or drives)
            found = f"a load on a freedom of {owner!r} that is driven by {first}"
            yield Mistake(f"loads.{name}", found, "a load or a drive on one freedom, not both")


def _held_end(scene: Scene, name: str, load: BeamForce | BeamMoment) -> Iterator[Mistake]:
    """A load at an end of a beam on a fixed body; under a moment a pinned end turns."""
    if load.beam not in scene.beams or load.at not in (0.0, 1.0):
        return
    end = scene.beams[load.beam].start if load.at == 0.0 else scene.beams[load.beam].end
    fixed = {point for body in scene.bodies.values() if body.motion == "fixed" for point in body.points}
    turns = isinstance(load, BeamMoment) and isinstance(end, PinnedEnd)
    if not isinstance(end, FreeEnd) and not turns and end.point in fixed:
        found = f"{load.at:g}, an end of {load.beam!r} that is held at {end.point!r}, a point of a fixed body"
        yield Mistake(f"loads.{name}.at", found, "a place of the beam that can move")


def _named(freedoms: Freedoms, acting: BodyLoad | Drive) -> bool:
    if isinstance(acting, Moment | RotationDrive):
        return acting.body in freedoms.scene.bodies
    return acting.point in freedoms.owners


def _opposed(freedoms: Freedoms, load: BodyLoad, drive: Drive) -> bool:
    """True for a force at the place of a driven displacement, with a component along the displacement."""
    if not isinstance(load, Force) or isinstance(drive, RotationDrive):
        return False
    apart = freedoms.places[load.point] - freedoms.places[drive.point]
    component = abs(float(unit(load.direction) @ unit(drive.direction)))
    return float(abs(apart).max()) <= NEGLIGIBLE * freedoms.extent and component > NEGLIGIBLE


def _can_turn(scene: Scene, name: str) -> bool:
    body = scene.bodies[name]
    return body.motion in ("free", "turns") or (isinstance(body, SlidingBody) and body.turns)


def _across(scene: Scene, owner: str) -> str:
    guide = "towards the pivot" if isinstance(scene.bodies[owner], TurningBody) else "across the slide"
    return f"{guide} of {owner!r}"


def _listed(names: list[str]) -> str:
    return ", ".join(map(repr, names)) or "there is none"
