"""Joints of an answer: ends at their points, welds at their angles, guides, pivots, pins, drives, and drawn shapes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from comparisons.audit.state import Finding, StationState, unit
from cprbm_scene.statement import DisplacementDrive, FreeEnd, SlidingBody, TurningBody, WeldedEnd

CLOSED = 1e-8
"""Largest error of a joint, over the longest beam, or rad."""


def joints(state: StationState) -> Iterator[Finding]:
    """Errors of joints, guides, drives and drawn shapes beyond CLOSED."""
    for joint, off in _errors(state):
        yield abs(off) - CLOSED * state.longest, f"{joint} is {abs(off):.2g} m off"


def _errors(state: StationState) -> Iterator[tuple[str, float]]:
    """Joints and their errors, m; an angle counts with the longest beam as the arm."""
    scene, arm = state.scene, state.longest
    for name, beam in state.beams.items():
        shape = state.station.shapes[name]
        drawn = np.interp(beam.state.s, shape.s, shape.x + 1j * shape.y)
        yield f"the shape of {name}", float(np.abs(drawn - beam.places).max())
        for end, i in ((beam.beam.start, 0), (beam.beam.end, -1)):
            if not isinstance(end, FreeEnd):
                ahead = np.angle(np.exp(1j * (beam.turned[i] - state.rotation(scene.body_of(end.point)))))
                off = abs(beam.places[i] - state.point(end.point)) + arm * abs(ahead) * isinstance(end, WeldedEnd)
                yield f"the end of {name} at {end.point}", off
    for name, body in scene.bodies.items():
        if isinstance(body, SlidingBody):
            aside = abs((state.moved(body.pin or next(iter(body.points))) * np.conj(unit(body.along))).imag)
            yield f"the slide of {name}", aside + (arm * abs(state.rotation(name)) if body.pin is None else 0.0)
        elif isinstance(body, TurningBody):
            yield f"the pivot {body.about}", abs(state.moved(body.about))
    for name, pin in scene.pins.items():
        yield f"the pin {name}", abs(state.point(pin.points[0]) - state.point(pin.points[1]))
    for name, drive in scene.drives.items():
        if isinstance(drive, DisplacementDrive):
            lever, moved = 1.0, (state.moved(drive.point) * np.conj(unit(drive.direction))).real
        else:
            lever, moved = arm, state.rotation(drive.body)
        yield f"the drive {name}", lever * (moved - state.values.get(name, moved))
