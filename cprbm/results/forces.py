"""Forces of joints, slides, pivots, drives, pins, stops and contacts, from the multipliers of their rows.

A row of the form f exerts −μ ∂f/∂z.  All forces are in the mechanism's units here.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import nan

import numpy as np

from cprbm.chain.rows import END, ends_of, unit_direction
from cprbm.results.contacts import NO_FORCE, forces_of_contacts
from cprbm.results.view import View
from cprbm_scene import FreeEnd
from cprbm_scene.answer import Array, PointForce
from cprbm_scene.statement import DisplacementDrive, SlidingBody, TurningBody


def point_forces(view: View) -> Iterator[PointForce]:
    """Forces on beams and on moving bodies, loads excluded."""
    moving = view.mechanism.bodies
    yield from (force for force in all_forces(view) if force.target in moving or force.target in view.scene.beams)


def all_forces(view: View) -> Iterator[PointForce]:
    """Forces on beams and on bodies, fixed bodies included; loads excluded."""
    yield from _joints(view)
    yield from _guides(view)
    yield from _drives(view)
    yield from _pins(view)
    yield from _stops(view)
    yield from forces_of_contacts(view)


def end_force(view: View, beam: str, end: str) -> tuple[Array, float]:
    """Force (2,) and moment of a joint on a beam's end."""
    x, y, turn = (view.multiplier(f"{beam}@{end}.{part}") for part in ("x", "y", "turn"))
    return np.array([-x, -y]), -turn


def _joints(view: View) -> Iterator[PointForce]:
    for beam in view.scene.beams:
        length = view.chain(beam).length
        for end, s, record in zip(END, (0.0, length), ends_of(view.scene, beam), strict=True):
            if not isinstance(record, FreeEnd):
                force, moment = end_force(view, beam, end)
                place = view.nodes(beam)[0 if end == "start" else -1]
                yield PointForce(record.point, beam, s, place, force, moment)
                yield PointForce(record.point, view.scene.body_of(record.point), nan, place, -force, -moment)


def _guides(view: View) -> Iterator[PointForce]:
    for name, body in view.scene.bodies.items():
        if isinstance(body, TurningBody):
            force = -np.array([view.multiplier(f"{name}.pivot.{axis}") for axis in "xy"])
            yield PointForce(body.about, name, nan, view.place(body.about), force, 0.0)
        elif isinstance(body, SlidingBody):
            along = unit_direction(body.along)
            force = -view.multiplier(f"{name}.slide") * np.array([-along[1], along[0]])
            place = view.place(body.pin or next(iter(body.points)))
            yield PointForce(name, name, nan, place, force, -view.multiplier(f"{name}.level"))


def _drives(view: View) -> Iterator[PointForce]:
    for name, drive in view.scene.drives.items():
        if isinstance(drive, DisplacementDrive):
            force = -view.multiplier(name) * np.array(unit_direction(drive.direction))
            yield PointForce(name, view.scene.body_of(drive.point), nan, view.place(drive.point), force, 0.0)
        else:
            place = view.place(next(iter(view.scene.bodies[drive.body].points)))
            yield PointForce(name, drive.body, nan, place, NO_FORCE, -view.multiplier(name))


def _pins(view: View) -> Iterator[PointForce]:
    for name, pin in view.scene.pins.items():
        force = -np.array([view.multiplier(f"{name}.{axis}") for axis in "xy"])
        for point, sign in zip(pin.points, (1.0, -1.0), strict=True):
            yield PointForce(name, view.scene.body_of(point), nan, view.place(point), sign * force, 0.0)


def _stops(view: View) -> Iterator[PointForce]:
    for name, stop in view.scene.stops.items():
        moment = stop_moment(view, name)
        if moment != 0.0:
            joint = ends_of(view.scene, stop.beam)[END.index(stop.end)]
            assert not isinstance(joint, FreeEnd)
            s, place = view.end(stop.beam, stop.end)
            yield PointForce(name, stop.beam, s, place, NO_FORCE, moment)
            yield PointForce(name, view.scene.body_of(joint.point), nan, place, NO_FORCE, -moment)


def stop_moment(view: View, name: str) -> float:
    """Moment of a stop on its beam."""
    return view.multiplier(f"{name}.most") - view.multiplier(f"{name}.least")
