"""Joints of an answer: ends at their points, welds at their angles, guides, pivots, pins and drives."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from comparisons.audit.state import StationState, unit
from cprbm_scene.statement import DisplacementDrive, FreeEnd, SlidingBody, TurningBody, WeldedEnd

CLOSED = 1e-8
"""Largest error of a joint, over the longest beam, or rad."""

DRAWN = 1e-6
"""Largest distance of a drawn shape from the stated places, over the longest beam: rounding of arc lengths."""


def joints(state: StationState) -> Iterator[str]:
    """Every joint, guide or drive that is off by more than CLOSED."""
    for joint, off, unit_ in _errors(state):
        if not abs(off) <= CLOSED * (state.longest if unit_ == "m" else 1.0):
            yield f"{joint} is {abs(off):.2g} {unit_} off"
    for name, beam in state.beams.items():
        shape = state.station.shapes[name]
        x, y = (np.interp(beam.state.s, shape.s, drawn) for drawn in (shape.x, shape.y))
        off = np.abs(x + 1j * y - beam.places).max()
        if not off <= DRAWN * state.longest:
            yield f"the shape of {name} is {off:.2g} m off the stated places"


def _errors(state: StationState) -> Iterator[tuple[str, float, str]]:
    """Joints, their errors, and the units."""
    scene = state.scene
    for name, beam in state.beams.items():
        for end, i in ((beam.beam.start, 0), (beam.beam.end, -1)):
            if not isinstance(end, FreeEnd):
                yield f"the end of {name} at {end.point}", abs(beam.places[i] - state.point(end.point)), "m"
            if isinstance(end, WeldedEnd):
                off = np.angle(np.exp(1j * (beam.turned[i] - state.rotation(scene.body_of(end.point)))))
                yield f"the weld of {name} at {end.point}", float(off), "rad"
    for name, body in scene.bodies.items():
        if isinstance(body, SlidingBody):
            moved = state.moved(body.pin or next(iter(body.points)))
            yield f"the slide of {name}", (moved * np.conj(unit(body.along))).imag, "m"
            yield f"the slide of {name}", state.rotation(name) if body.pin is None else 0.0, "rad"
        elif isinstance(body, TurningBody):
            yield f"the pivot {body.about}", abs(state.moved(body.about)), "m"
    for name, pin in scene.pins.items():
        yield f"the pin {name}", abs(state.point(pin.points[0]) - state.point(pin.points[1])), "m"
    for name, drive in scene.drives.items():
        if isinstance(drive, DisplacementDrive):
            moved = (state.moved(drive.point) * np.conj(unit(drive.direction))).real
            yield f"the drive {name}", moved - state.values[name], "m"
        else:
            yield f"the drive {name}", state.rotation(drive.body) - state.values[name], "rad"
