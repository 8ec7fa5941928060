"""Stops: of a pinned end, towards another place of the body it is pinned to, with limits that hold as it is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, degrees, pi, tau

import numpy as np

from cprbm_scene.check_shapes import is_apart, is_beam
from cprbm_scene.geometry import distance, tangents_on
from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import PinnedEnd, Scene, Stop

ROUNDED = 1e-6  # rad, by which an angle as drawn may be beyond a limit
STRAIGHT = 1e-9  # rad: an angle so close to −π is π, which coordinates that are rounded may turn into either


def wrong_stops(scene: Scene) -> Iterator[Mistake]:
    """Stops of what is no pin, without limits, or that the shape as drawn is beyond of."""
    taken: dict[tuple[str, str], str] = {}
    for name, stop in scene.stops.items():
        key = f"stops.{name}"
        first = taken.setdefault((stop.beam, stop.end), name)
        if first != name:
            yield Mistake(key, f"the {stop.end} of {stop.beam!r}, which stops.{first} limits", "one stop for each end")
        if stop.least is None and stop.most is None:
            yield Mistake(key, "neither 'least' nor 'most'", "at least one of the two, rad")
        elif stop.least is not None and stop.most is not None and not stop.least < stop.most:
            found = f"least = {stop.least:g} rad and most = {stop.most:g} rad"
            yield Mistake(key, found, "a least angle that is less than the most")
        if stop.beam not in scene.beams:
            continue
        end = getattr(scene.beams[stop.beam], stop.end)
        if not isinstance(end, PinnedEnd):
            found = f"the {stop.end} of {stop.beam!r}, whose joint is {end.joint!r}"
            yield Mistake(f"{key}.end", found, "an end whose joint is 'pin'")
            continue
        owners = {point: body for body, each in scene.bodies.items() for point in each.points}
        if end.point not in owners or stop.towards not in owners:
            continue
        if owners[stop.towards] != owners[end.point]:
            found = f"{stop.towards!r}, a point of {owners[stop.towards]!r}"
            yield Mistake(f"{key}.towards", found, f"a point of {owners[end.point]!r}, to which the end is pinned")
            continue
        if distance(scene.place_of(stop.towards), scene.place_of(end.point)) == 0.0:
            yield Mistake(f"{key}.towards", f"{stop.towards!r}, which is where the pin is", "a point away from the pin")
            continue
        yield from _beyond_as_drawn(scene, name, stop)


def drawn_angle(scene: Scene, stop: Stop) -> float:
    """The stop's angle as drawn, rad, in (−π, π] but for rounding; of an end that is apart with its direction there."""
    beam = scene.beams[stop.beam]
    end = getattr(beam, stop.end)
    (tx, ty), sign = (
        (tangents_on(beam.curve, np.array([0.0]))[0], 1.0)
        if stop.end == "start"
        else (tangents_on(beam.curve, np.array([1.0]))[0], -1.0)
    )
    (px, py), (qx, qy) = scene.place_of(end.point), scene.place_of(stop.towards)
    angle = (atan2(sign * ty, sign * tx) - atan2(qy - py, qx - px)) % tau
    return angle - tau if angle > pi + STRAIGHT else angle


def _beyond_as_drawn(scene: Scene, name: str, stop: Stop) -> Iterator[Mistake]:
    beam = scene.beams[stop.beam]
    if not is_beam(beam) or (stop.end == "end" and is_apart(scene, beam)):
        return
    angle = drawn_angle(scene, stop)
    for key, limit, sign in (("least", stop.least, -1.0), ("most", stop.most, 1.0)):
        if limit is not None and sign * (angle - limit) > ROUNDED:
            found = f"{limit:g} rad, where the beam as drawn stands at {angle:.6g} rad ({degrees(angle):.4g} degrees)"
            yield Mistake(f"stops.{name}.{key}", found, "limits between which the beam stands as it is drawn")
