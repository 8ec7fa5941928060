"""Ends of beams and their points, assembly, stops: checks of the drawn places of joints."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, degrees, dist, pi, tau

import numpy as np

from cprbm_scene.curve_records import MEETING, shape_of
from cprbm_scene.mistakes import Mistake, written_place
from cprbm_scene.statement import Beam, FreeEnd, PinnedEnd, Scene, Stop, TurningBody, WeldedEnd

TAUT = 1e-6
"""Share of the length by which a beam must exceed the distance of its points: a taut beam is straight."""
ROUNDED = 1e-6
"""Angle, rad, by which a stop's angle as drawn may exceed a limit: coordinates are rounded."""
STRAIGHT = 1e-9
"""Distance, rad, from −π within which an angle counts as π: rounded coordinates yield both."""


def distant_ends(scene: Scene) -> Iterator[Mistake]:
    """Ends of beams away from their points, unless an assembly brings them together."""
    for name, beam in scene.beams.items():
        for side in ("start", "end"):
            apart = _distance(scene, beam, side)
            if apart is not None and not (side == "end" and _may_be_apart(scene, beam)):
                joint, at = getattr(beam, side), getattr(beam.curve, side)
                found = f"a beam end that meets no body: the curve's {side} is at {written_place(at)} m, the point "
                found += f"{joint.point!r} at {written_place(scene.place_of(joint.point))} m, {apart:.3g} m apart"
                yield Mistake(f"beams.{name}.{side}", found, f"at most {MEETING:g} of the beam's length between them")


def is_apart(scene: Scene, beam: Beam) -> bool:
    """True if an assembly brings the beam's end to the point; False if the curve or the point does not exist."""
    return _may_be_apart(scene, beam) and _distance(scene, beam, "end") is not None


def _may_be_apart(scene: Scene, beam: Beam) -> bool:
    return scene.assembly is not None and isinstance(beam.end, PinnedEnd)


def _distance(scene: Scene, beam: Beam, side: str) -> float | None:
    """Distance of an end from the point, m; None if the end meets the point, or either does not exist."""
    point = getattr(beam, side).point
    if point not in scene.owners or any(beam.curve.rules()):
        return None
    apart = dist(getattr(beam.curve, side), scene.place_of(point))
    return None if apart <= MEETING * shape_of(beam.curve).length else apart


def wrong_assembly(scene: Scene) -> Iterator[Mistake]:
    """An assembly without distant ends, moments on other ends, beams too short for their points."""
    owners = scene.owners
    joints = [joint for beam in scene.beams.values() for joint in (beam.start, beam.end)]
    if scene.assembly is None or not all(isinstance(joint, FreeEnd) or joint.point in owners for joint in joints):
        return
    apart = [name for name, beam in scene.beams.items() if is_apart(scene, beam)]
    if not apart:
        allowed = "a beam whose pinned end is drawn apart from its point, or no assembly"
        yield Mistake("assembly", "no beam with an end to be brought to its point", allowed)
    for name in scene.assembly.moments if apart else ():
        if name in scene.beams and name not in apart:
            found = f"a moment on {name!r}, whose end is where it belongs"
            allowed = f"a beam whose end is drawn apart: {', '.join(map(repr, apart))}"
            yield Mistake(f"assembly.moments.{name}", found, allowed)
    for name in apart:
        beam = scene.beams[name]
        assert not isinstance(beam.end, FreeEnd)
        if not isinstance(beam.start, WeldedEnd):
            found = f"a {beam.start.joint!r} at the start of a beam whose end is to be brought to its point"
            allowed = "a weld: the beam has to stand by itself before it is assembled"
            yield Mistake(f"beams.{name}.start", found, allowed)
        elif _stays(scene, beam.start.point) and _stays(scene, beam.end.point):
            length, reach = shape_of(beam.curve).length, dist(beam.curve.start, scene.place_of(beam.end.point))
            if reach >= (1.0 - TAUT) * length:
                found = f"a beam too short to reach {beam.end.point!r}: {length:.6g} m long, on a way of {reach:.6g} m"
                yield Mistake(f"beams.{name}.end", found, "a beam that is longer than the way between its two points")


def _stays(scene: Scene, point: str) -> bool:
    """True if a point is at rest without loads and with all drives at zero."""
    name, turned = scene.body_of(point), {getattr(drive, "body", None) for drive in scene.drives.values()}
    body = scene.bodies[name]
    return body.motion == "fixed" or (isinstance(body, TurningBody) and (body.about == point or name in turned))


def wrong_stops(scene: Scene) -> Iterator[Mistake]:
    """Stops of an end without pin or with another stop, without direction, or with limits exceeded in the drawing."""
    taken: dict[tuple[str, str], str] = {}
    for name, stop in scene.stops.items():
        key = f"stops.{name}"
        first = taken.setdefault((stop.beam, stop.end), name)
        if first != name:
            yield Mistake(key, f"the {stop.end} of {stop.beam!r}, which stops.{first} limits", "one stop for each end")
        if stop.beam not in scene.beams:
            continue
        owners, joint = scene.owners, getattr(scene.beams[stop.beam], stop.end)
        if not isinstance(joint, PinnedEnd):
            found = f"the {stop.end} of {stop.beam!r}, whose joint is {joint.joint!r}"
            yield Mistake(f"{key}.end", found, "an end whose joint is 'pin'")
        elif joint.point not in owners or stop.towards not in owners:
            continue
        elif owners[stop.towards] != owners[joint.point]:
            found = f"{stop.towards!r}, a point of {owners[stop.towards]!r}"
            yield Mistake(f"{key}.towards", found, f"a point of {owners[joint.point]!r}, to which the end is pinned")
        elif scene.place_of(stop.towards) == scene.place_of(joint.point):
            yield Mistake(f"{key}.towards", f"{stop.towards!r}, which is where the pin is", "a point away from the pin")
        else:
            yield from _exceeded_as_drawn(scene, name, stop)


def _exceeded_as_drawn(scene: Scene, name: str, stop: Stop) -> Iterator[Mistake]:
    beam = scene.beams[stop.beam]
    if not beam.sound or (stop.end == "end" and is_apart(scene, beam)):
        return
    u, sign = (0.0, 1.0) if stop.end == "start" else (1.0, -1.0)
    tx, ty = sign * shape_of(beam.curve).tangent(np.array([u]))[0]
    (px, py), (qx, qy) = scene.place_of(getattr(beam, stop.end).point), scene.place_of(stop.towards)
    angle = (atan2(ty, tx) - atan2(qy - py, qx - px)) % tau
    angle -= tau if angle > pi + STRAIGHT else 0.0
    for key, limit, sign in (("least", stop.least, -1.0), ("most", stop.most, 1.0)):
        if limit is not None and sign * (angle - limit) > ROUNDED:
            found = f"{limit:g} rad, where the beam as drawn stands at {angle:.6g} rad ({degrees(angle):.4g} degrees)"
            yield Mistake(f"stops.{name}.{key}", found, "limits between which the beam stands as it is drawn")
