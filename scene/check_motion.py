"""What moves and what holds: supports, loads and stages."""

from __future__ import annotations

from collections.abc import Iterator
from math import isclose

from scene.check_names import point_names
from scene.mistakes import Mistake
from scene.statement import FreeEnd, Moment, PinnedEnd, Scene


def wrong_supports(scene: Scene) -> Iterator[Mistake]:
    """Beams and bodies that nothing holds."""
    fixed = {name for name, body in scene.bodies.items() if body.motion == "fixed"}
    if not fixed:
        yield Mistake("bodies", "no fixed body", 'at least one body with motion = "fixed"')
    known = set(point_names(scene))
    met: dict[str, set[str]] = {}
    sound = True
    for name, beam in scene.beams.items():
        ends = (beam.start, beam.end)
        held = [end for end in ends if not isinstance(end, FreeEnd)]
        if not held:
            yield Mistake(f"beams.{name}", "two free ends", "at least one end that meets a body")
        elif len(held) == 1 and isinstance(held[0], PinnedEnd):
            found = "a pin at one end and nothing at the other: the beam turns freely"
            yield Mistake(f"beams.{name}", found, "a weld, or joints at both ends")
        sound = sound and all(end.point in known for end in held)
        met[name] = {scene.body_of(end.point) for end in held if end.point in known}
    if not sound or not fixed:
        return
    held_bodies = _reached(fixed, met)
    for name, body in scene.bodies.items():
        if body.motion == "fixed":
            continue
        if not any(name in bodies for bodies in met.values()):
            yield Mistake(f"bodies.{name}", "a free body that no beam meets", "a beam's end at one of its points")
        elif name not in held_bodies:
            yield Mistake(f"bodies.{name}", "a free body that no fixed body holds", "beams that lead to a fixed body")


def wrong_loads(scene: Scene) -> Iterator[Mistake]:
    """Loads on what cannot move, and forces without a direction."""
    known = set(point_names(scene))
    for name, load in scene.loads.items():
        if isinstance(load, Moment):
            if load.body in scene.bodies and scene.bodies[load.body].motion == "fixed":
                found = f"a moment on the fixed body {load.body!r}"
                yield Mistake(f"loads.{name}.body", found, f"a body that can move: {_movable(scene)}")
            continue
        if load.point in known and scene.bodies[scene.body_of(load.point)].motion == "fixed":
            found = f"a force at {load.point!r}, a point of the fixed body {scene.body_of(load.point)!r}"
            yield Mistake(f"loads.{name}.point", found, f"a point of a body that can move: {_movable(scene)}")
        if load.direction == (0.0, 0.0):
            yield Mistake(f"loads.{name}.direction", "[0, 0]", "a direction, at least one number not zero")


def wrong_stages(scene: Scene) -> Iterator[Mistake]:
    """Stages with one name, and stations of one stage with one value: answers are told apart by these two."""
    seen: set[str] = set()
    for i, stage in enumerate(scene.stages):
        if stage.name in seen:
            yield Mistake(f"stages[{i}].name", f"{stage.name!r} again", "each stage's name once")
        seen.add(stage.name)
        for j, value in enumerate(stage.stations):
            if any(isclose(value, before, rel_tol=1e-9) for before in stage.stations[:j]):
                allowed = "each value once in a stage; a further stage may go back to it"
                yield Mistake(f"stages[{i}].stations[{j}]", f"{value:g} again", allowed)


def _reached(fixed: set[str], met: dict[str, set[str]]) -> set[str]:
    """Bodies that beams connect to a fixed one."""
    reached = set(fixed)
    while True:
        more = {body for bodies in met.values() if bodies & reached for body in bodies} - reached
        if not more:
            return reached
        reached |= more


def _movable(scene: Scene) -> str:
    names = [repr(name) for name, body in scene.bodies.items() if body.motion != "fixed"]
    return ", ".join(names) or "there is none"
