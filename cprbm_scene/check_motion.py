"""What moves and what holds: supports, loads and stages."""

from __future__ import annotations

from collections.abc import Iterator

from cprbm_scene.freedoms import body_of, guide_rows, has_guide, held, is_named, is_stated, rank, row_of
from cprbm_scene.mistakes import Mistake
from cprbm_scene.names import point_names
from cprbm_scene.statement import BeamForce, BeamMoment, BodyLoad, FreeEnd, Moment, PinnedEnd, Scene, TurningBody

FREEDOMS = 3  # of what is rigid in the plane


def wrong_supports(scene: Scene) -> Iterator[Mistake]:
    """Beams and bodies that nothing holds: no fixed body, and neither guides nor drives enough."""
    if all(body.motion == "free" for body in scene.bodies.values()) and not scene.drives:
        yield Mistake("bodies", "no fixed body", 'at least one body with motion = "fixed"')
        return
    known = set(point_names(scene))
    met: dict[str, set[str]] = {}
    sound = True
    for name, beam in scene.beams.items():
        ends = (beam.start, beam.end)
        joined = [end for end in ends if not isinstance(end, FreeEnd)]
        if not joined:
            yield Mistake(f"beams.{name}", "two free ends", "at least one end that meets a body")
        elif len(joined) == 1 and isinstance(joined[0], PinnedEnd):
            found = "a pin at one end and nothing at the other: the beam turns freely"
            yield Mistake(f"beams.{name}", found, "a weld, or joints at both ends")
        sound = sound and all(end.point in known for end in joined)
        met[name] = {scene.body_of(end.point) for end in joined if end.point in known}
    for name, pin in scene.pins.items():
        sound = sound and all(point in known for point in pin.points)
        met[f"pins.{name}"] = {scene.body_of(point) for point in pin.points if point in known}
    if not sound or not rows_stated(scene):
        return
    for name, body in scene.bodies.items():
        if _holds(scene, _together(name, met)):
            continue
        kind = {"slides": "sliding", "turns": "turning"}.get(body.motion, "free")
        if not any(name in bodies for bodies in met.values()):
            yield Mistake(
                f"bodies.{name}", f"a {kind} body that no beam meets", "a beam's end or a pin at one of its points"
            )
        else:
            allowed = "beams that lead to a fixed body, or slides, pivots and drives that hold it"
            yield Mistake(f"bodies.{name}", f"a {kind} body that no fixed body holds", allowed)


def wrong_loads(scene: Scene) -> Iterator[Mistake]:
    """Loads on bodies that cannot move, and forces without a direction."""
    for name, load in scene.loads.items():
        if isinstance(load, BeamForce | BeamMoment):
            yield from _held_end(scene, name, load)
        if not isinstance(load, BodyLoad):
            continue
        what = "body" if isinstance(load, Moment) else "point"
        if not is_named(scene, load):
            continue
        owner = body_of(scene, load)
        body = scene.bodies[owner]
        if body.motion == "fixed":
            of = f"the fixed body {owner!r}"
            found = f"a moment on {of}" if isinstance(load, Moment) else f"a force at {load.point!r}, a point of {of}"
            a = "a body" if isinstance(load, Moment) else "a point of a body"
            yield Mistake(f"loads.{name}.{what}", found, f"{a} that can move: {_movable(scene)}")
        elif is_stated(scene, load) and has_guide(scene, owner):
            if not held(row_of(scene, load), guide_rows(scene, owner)):
                continue
            if isinstance(load, Moment):
                found = f"a moment on {owner!r}, which slides and does not turn"
                yield Mistake(f"loads.{name}.body", found, "a body that can turn")
            else:
                guide = "towards the pivot" if isinstance(body, TurningBody) else "across the slide"
                found, allowed = f"a force {guide} of {owner!r}", "a direction along which the body can move"
                yield Mistake(f"loads.{name}.direction", found, allowed)


def rows_stated(scene: Scene) -> bool:
    """Whether every guide and every drive says which motion it prescribes."""
    return all(has_guide(scene, name) for name in scene.bodies) and all(
        is_stated(scene, drive) for drive in scene.drives.values()
    )


def _together(body: str, met: dict[str, set[str]]) -> set[str]:
    """Bodies that beams and pins connect to a ``body``, itself among them."""
    reached = {body}
    while True:
        more = {other for bodies in met.values() if bodies & reached for other in bodies} - reached
        if not more:
            return reached
        reached |= more


def _holds(scene: Scene, bodies: set[str]) -> bool:
    """Whether bodies that beams and pins connect cannot all move as one: one is fixed, guides and drives prevent it."""
    if any(scene.bodies[name].motion == "fixed" for name in bodies):
        return True
    rows = [row for name in bodies for row in guide_rows(scene, name)]
    rows += [row_of(scene, drive) for drive in scene.drives.values() if body_of(scene, drive) in bodies]
    return rank(rows) == FREEDOMS


def _held_end(scene: Scene, name: str, load: BeamForce | BeamMoment) -> Iterator[Mistake]:
    """A load at an end of a beam that a fixed body holds; a pin lets the end turn under a moment."""
    if load.beam not in scene.beams or load.at not in (0.0, 1.0):
        return
    end = scene.beams[load.beam].start if load.at == 0.0 else scene.beams[load.beam].end
    fixed = {point for body in scene.bodies.values() if body.motion == "fixed" for point in body.points}
    turns = isinstance(load, BeamMoment) and isinstance(end, PinnedEnd)
    if not isinstance(end, FreeEnd) and not turns and end.point in fixed:
        found = f"{load.at:g}, an end of {load.beam!r} that is held at {end.point!r}, a point of a fixed body"
        yield Mistake(f"loads.{name}.at", found, "a place of the beam that can move")


def _movable(scene: Scene) -> str:
    names = [repr(name) for name, body in scene.bodies.items() if body.motion != "fixed"]
    return ", ".join(names) or "there is none"
