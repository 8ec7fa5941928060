"""Assembly: there is something to assemble, moments act on what is assembled, and what is assembled can reach."""

from __future__ import annotations

from collections.abc import Iterator

from cprbm_scene.check_shapes import is_apart
from cprbm_scene.geometry import arc_length, distance
from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import FreeEnd, RotationDrive, Scene, TurningBody, WeldedEnd

TAUT = 1e-6  # of the length: nearer to its whole length apart, no beam has a shape but the straight one


def wrong_assembly(scene: Scene) -> Iterator[Mistake]:
    """An assembly of nothing, moments on ends that are where they belong, beams that are too short."""
    if scene.assembly is None or not _named(scene):
        return
    apart = [name for name, beam in scene.beams.items() if is_apart(scene, beam)]
    if not apart:
        allowed = "a beam whose pinned end is drawn apart from its point, or no assembly"
        yield Mistake("assembly", "no beam with an end to be brought to its point", allowed)
    for name in scene.assembly.moments:
        if name in scene.beams and name not in apart and apart:
            listed = ", ".join(map(repr, apart))
            found = f"a moment on {name!r}, whose end is where it belongs"
            yield Mistake(f"assembly.moments.{name}", found, f"a beam whose end is drawn apart: {listed}")
    for name in apart:
        beam = scene.beams[name]
        assert not isinstance(beam.end, FreeEnd)
        if not isinstance(beam.start, WeldedEnd):
            found = f"a {beam.start.joint!r} at the start of a beam whose end is to be brought to its point"
            yield Mistake(
                f"beams.{name}.start", found, "a weld: the beam has to stand by itself before it is assembled"
            )
            continue
        if not (_stays(scene, beam.start.point) and _stays(scene, beam.end.point)):
            continue
        length = arc_length(beam.curve)
        reach = distance(beam.curve.start, scene.place_of(beam.end.point))
        if reach >= (1.0 - TAUT) * length:
            found = f"a beam too short to reach {beam.end.point!r}: it is {length:.6g} m long, the way is {reach:.6g} m"
            yield Mistake(f"beams.{name}.end", found, "a beam that is longer than the way between its two points")


def _named(scene: Scene) -> bool:
    """Whether every end names a point that there is."""
    points = {point for body in scene.bodies.values() for point in body.points}
    return all(
        isinstance(end, FreeEnd) or end.point in points
        for beam in scene.beams.values()
        for end in (beam.start, beam.end)
    )


def _stays(scene: Scene, point: str) -> bool:
    """Whether a point stays where it is while nothing is driven."""
    name = scene.body_of(point)
    body = scene.bodies[name]
    if isinstance(body, TurningBody):
        turned = any(isinstance(drive, RotationDrive) and drive.body == name for drive in scene.drives.values())
        return turned or body.about == point
    return body.motion == "fixed"
