"""Loads on beams: a direction, a place or a stretch of the beam, and something there that can move."""

from __future__ import annotations

from collections.abc import Iterator

from cprbm_scene.mistakes import Mistake, unknown_name
from cprbm_scene.statement import BeamForce, BeamMoment, DistributedLoad, FreeEnd, PinnedEnd, Scene

SHORTEST_STRETCH = 1e-6  # of the beam's length


def wrong_beam_loads(scene: Scene) -> Iterator[Mistake]:
    """Loads on beams that do not exist, without a direction or a stretch, and at ends that cannot move."""
    for name, load in scene.loads.items():
        if not isinstance(load, BeamForce | BeamMoment | DistributedLoad):
            continue
        key = f"loads.{name}"
        if load.beam not in scene.beams:
            yield unknown_name(f"{key}.beam", load.beam, "beam", scene.beams)
        if not isinstance(load, BeamMoment) and load.direction == (0.0, 0.0):
            yield Mistake(f"{key}.direction", "[0, 0]", "a direction, at least one number not zero")
        if isinstance(load, DistributedLoad):
            begin, end = load.along
            if not end - begin >= SHORTEST_STRETCH:
                found = f"a stretch from {begin:.9g} to {end:.9g}"
                yield Mistake(f"{key}.along", found, "two fractions of the beam's length, the smaller one first")
        elif load.beam in scene.beams and load.at in (0.0, 1.0) and (point := _held_at(scene, load)) is not None:
            found = f"{load.at:g}, an end of {load.beam!r} that is held at {point!r}, a point of a fixed body"
            yield Mistake(f"{key}.at", found, "a place of the beam that can move")


def _held_at(scene: Scene, load: BeamForce | BeamMoment) -> str | None:
    """The point of a fixed body at which the end is held where a force or moment acts; a pin lets the end turn."""
    end = scene.beams[load.beam].start if load.at == 0.0 else scene.beams[load.beam].end
    fixed = {point for body in scene.bodies.values() if body.motion == "fixed" for point in body.points}
    if isinstance(end, FreeEnd) or (isinstance(load, BeamMoment) and isinstance(end, PinnedEnd)):
        return None
    return end.point if end.point in fixed else None
