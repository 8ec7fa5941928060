"""Drives and guides: each has a direction, a pivot or a pin, drives what can move, and has its freedom to itself."""

from __future__ import annotations

from collections.abc import Iterator

from cprbm_scene.freedoms import Row, body_of, can_turn, guide_rows, has_guide, held, is_stated, row_of, same_point
from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import BodyLoad, Drive, RotationDrive, Scene, TurningBody


def wrong_drives(scene: Scene) -> Iterator[Mistake]:
    """Drives without a direction, of what cannot move that way, or of what another drive or a load has."""
    taken: dict[str, dict[str, Row]] = {}
    for name, drive in scene.drives.items():
        if not is_stated(scene, drive):
            continue
        owner = body_of(scene, drive)
        body = scene.bodies[owner]
        what = "body" if isinstance(drive, RotationDrive) else "point"
        if body.motion == "fixed":
            found = f"a drive of {_what(drive)} of the fixed body {owner!r}"
            yield Mistake(f"drives.{name}.{what}", found, f"a {what} that can move: {_movable(scene, what)}")
            continue
        if not has_guide(scene, owner):
            continue
        guide, row, others = guide_rows(scene, owner), row_of(scene, drive), taken.setdefault(owner, {})
        if held(row, guide):
            if isinstance(drive, RotationDrive):
                found, allowed = f"the rotation of {owner!r}, which slides", "a free body's rotation"
                yield Mistake(f"drives.{name}.body", found, allowed)
            else:
                guide_of = "towards the pivot" if isinstance(body, TurningBody) else "across the slide"
                found = f"a direction {guide_of} of {owner!r}"
                allowed = "a direction along which the point can move"
                yield Mistake(f"drives.{name}.direction", found, allowed)
            continue
        if held(row, [*guide, *others.values()]):
            found = f"a freedom of {owner!r} that is driven already by {_listed(others)}"
            yield Mistake(f"drives.{name}", found, "one drive for each freedom")
        others[name] = row
    yield from _loads_on_driven(scene, taken)


def _loads_on_driven(scene: Scene, taken: dict[str, dict[str, Row]]) -> Iterator[Mistake]:
    """Loads on freedoms that drives prescribe: they would do nothing but change the drive's reaction."""
    for name, load in scene.loads.items():
        if not isinstance(load, BodyLoad) or not is_stated(scene, load) or body_of(scene, load) not in taken:
            continue
        owner = body_of(scene, load)
        drives = taken[owner]
        there = [each for each in drives if same_point(scene, load, scene.drives[each])]
        row, guide = row_of(scene, load), guide_rows(scene, owner)
        if there or (held(row, [*guide, *drives.values()]) and not held(row, guide)):
            found = f"a load on a freedom of {owner!r} that is driven by {_listed(there or drives)}"
            yield Mistake(f"loads.{name}", found, "a load or a drive on one freedom, not both")


def _what(drive: Drive) -> str:
    return "the rotation" if isinstance(drive, RotationDrive) else f"{drive.point!r}, a point"


def _listed(names: list[str] | dict[str, Row]) -> str:
    return " and ".join(f"drives.{name}" for name in names)


def _movable(scene: Scene, what: str) -> str:
    moving = {name: body for name, body in scene.bodies.items() if body.motion != "fixed"}
    if what == "body":
        names = [name for name, body in moving.items() if can_turn(body)]
    else:
        names = [point for body in moving.values() for point in body.points]
    return ", ".join(map(repr, names)) or "there is none"
