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
    TurningBody,
)


def wrong_actions(scene: Scene) -> Iterator[Mistake]:
    """Loads and drives of fixed bodies or across guides, and motions with two drives or with a drive and a load."""
    if not any(body.points for body in scene.bodies.values()):
        return
    freedoms = Freedoms(scene)
    driven: dict[str, dict[str, Row]] = {}
    actions = {f"drives.{name}": drive for name, drive in scene.drives.items()}
    loads = {f"loads.{name}": load for name, load in scene.loads.items() if isinstance(load, BodyLoad)}
    for key, acting in (actions | loads).items():
        if not _named(freedoms, acting) or any(acting.rules()):
            continue
        owner, row = freedoms.owner(acting), freedoms.row(acting)
        mistake = _without_freedom(freedoms, key, acting)
        if mistake is None and not any(scene.bodies[owner].rules()):
            mistake = _driven_already(freedoms, key, acting, driven.setdefault(owner, {}))
            if mistake is None and key in actions:
                driven[owner][key] = row
        if mistake is not None:
            yield mistake
    for name, load in scene.loads.items():
        if isinstance(load, BeamForce | BeamMoment):
            yield from _held_end(scene, name, load)


def _without_freedom(freedoms: Freedoms, key: str, acting: BodyLoad | Drive) -> Mistake | None:
    """The mistake of a fixed body, or of a motion that a guide holds."""
    scene, owner = freedoms.scene, freedoms.owner(acting)
    body = scene.bodies[owner]
    if isinstance(acting, Moment | RotationDrive):
        what, place, direction = "a moment on" if isinstance(acting, Moment) else "a drive of", "body", "body"
        across, allowed = f"the rotation of {owner!r}, which slides and does not turn", "a body that can turn"
    else:
        what = f"{'a force' if isinstance(acting, Force) else 'a drive'} at {acting.point!r}, a point of"
        guide = "towards the pivot" if isinstance(body, TurningBody) else "across the slide"
        across, allowed = f"a direction {guide} of {owner!r}", "a direction along which the point can move"
        place, direction = "point", "direction"
    if body.motion == "fixed":
        movable = {name: each.points for name, each in scene.bodies.items() if each.motion != "fixed"}
        names = movable if place == "body" else [point for points in movable.values() for point in points]
        can_move = ", ".join(map(repr, names)) or "there is none"
        found = f"{what} the fixed body {owner!r}"
        return Mistake(f"{key}.{place}", found, f"a {place} that can move: {can_move}")
    if not any(body.rules()) and held(freedoms.row(acting), freedoms.guide(owner)):
        return Mistake(f"{key}.{direction}", across, allowed)
    return None


def _driven_already(freedoms: Freedoms, key: str, acting: BodyLoad | Drive, driven: dict[str, Row]) -> Mistake | None:
    """The mistake of a motion that earlier drives of the body hold, of loads only by drives from the start on."""
    row, owner = freedoms.row(acting), freedoms.owner(acting)
    drives = {name: freedoms.scene.drives[name.removeprefix("drives.")] for name in driven}
    if isinstance(acting, BodyLoad):
        drives = {name: drive for name, drive in drives.items() if drive.begins is None}
    opposed = [name for name, drive in drives.items() if _opposed(freedoms, acting, drive)]
    if not opposed and not held(row, [*freedoms.guide(owner), *(driven[name] for name in drives)]):
        return None
    first = " and ".join(opposed or drives)
    if isinstance(acting, BodyLoad):
        found = f"a load on a freedom of {owner!r} that is driven by {first}"
        return Mistake(key, found, "a load or a drive on one freedom, not both")
    return Mistake(key, f"a freedom of {owner!r} that is driven already by {first}", "one drive for each freedom")


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


def _opposed(freedoms: Freedoms, load: BodyLoad | Drive, drive: Drive) -> bool:
    """True for a force at the place of a driven displacement, with a component along the displacement."""
    if not isinstance(load, Force) or isinstance(drive, RotationDrive):
        return False
    apart = freedoms.places[load.point] - freedoms.places[drive.point]
    component = abs(float(unit(load.direction) @ unit(drive.direction)))
    return float(abs(apart).max()) <= NEGLIGIBLE * freedoms.extent and component > NEGLIGIBLE
