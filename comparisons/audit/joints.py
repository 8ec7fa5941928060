"""Whether beams are where their joints hold them, and bodies where slides, pivots, drives and pins do."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from comparisons.audit.seen import Seen
from cprbm_scene.statement import DisplacementDrive, FreeEnd, SlidingBody, TurningBody, WeldedEnd

APART = 1e-8  # of the longest beam, rad


def held(seen: Seen) -> Iterator[str]:
    """What is not where it should be."""
    scene, close = seen.scene, APART * seen.longest
    for name, beam in seen.beams.items():
        acting = seen.acting[name]
        off = beam.misplaced(acting.s[(acting.s > 0.0) & (acting.s < beam.rest.length)])
        if not off <= max(100.0 * close, 1e-6 * beam.rest.length):
            yield f"the shape of {name} is {off:.2g} m from the line that its angles make, or stretched by that"
        for end, (place, turned) in zip((beam.rest.beam.start, beam.rest.beam.end), beam.ends, strict=True):
            if isinstance(end, FreeEnd):
                continue
            if not abs(place - seen.point(end.point)) <= close:
                yield f"{name} is {abs(place - seen.point(end.point)):.2g} m away from {end.point}"
            against = turned - seen.motion(scene.body_of(end.point))[2]
            against -= 2.0 * np.pi * np.round(against / (2.0 * np.pi))
            if isinstance(end, WeldedEnd) and not abs(against) <= APART:
                yield f"{name} is turned by {against:.2g} rad against its weld at {end.point}"
    for name, body in scene.bodies.items():
        _, moved, phi = seen.motion(name)
        if isinstance(body, SlidingBody):
            along = complex(*body.along) / abs(complex(*body.along))
            if body.pin is not None:
                moved = seen.point(body.pin) - complex(*scene.place_of(body.pin))
            elif not abs(phi) <= APART:
                yield f"{name} slides and is turned by {phi:.2g} rad"
            if not abs((moved * np.conj(along)).imag) <= close:
                yield f"{name} is {abs((moved * np.conj(along)).imag):.2g} m off its slide"
        elif isinstance(body, TurningBody):
            off = abs(seen.point(body.about) - complex(*scene.place_of(body.about)))
            if not off <= close:
                yield f"the pivot {body.about} has moved by {off:.2g} m"
    for name, pin in scene.pins.items():
        one, other = (seen.point(point) for point in pin.points)
        if not abs(one - other) <= close:
            yield f"the points of the pin {name} are {abs(one - other):.2g} m apart"
    for name, drive in scene.drives.items():
        if isinstance(drive, DisplacementDrive):
            along = complex(*drive.direction) / abs(complex(*drive.direction))
            moved = seen.point(drive.point) - complex(*scene.place_of(drive.point))
            gone, allowed = float((moved * np.conj(along)).real), close
        else:
            gone, allowed = seen.motion(drive.body)[2], APART
        if not abs(gone - seen.values[name]) <= allowed:
            yield f"the drive {name} has gone {gone:.6g} where {seen.values[name]:.6g} is prescribed"
