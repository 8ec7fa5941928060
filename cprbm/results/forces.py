"""Forces of joints, slides, pivots, drives, pins, stops and contacts, from the multipliers of their rows.

A row of the form f exerts −μ ∂f/∂z.  All forces are in the mechanism's units here.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import nan

import numpy as np

from cprbm.chain.mechanism import AXES
from cprbm.chain.rows import END, ends_of, unit_direction
from cprbm.contact import Geometry
from cprbm.equilibrium.columns import contact_terms
from cprbm.results.view import View
from cprbm_scene import BeamContact, FreeEnd
from cprbm_scene.answer import Array, PointForce
from cprbm_scene.statement import DisplacementDrive, EdgeContact, SlidingBody, TurningBody

NO_FORCE = np.zeros(2)


def all_forces(view: View) -> Iterator[PointForce]:
    """Forces on beams and on bodies, fixed bodies included; loads excluded."""
    for forces in (_joints, _guides, _drives, _pins, _stops, _contacts):
        yield from forces(view)


def stop_moment(view: View, name: str) -> float:
    """Moment of a stop on its beam."""
    return view.multiplier(f"{name}.most") - view.multiplier(f"{name}.least")


def pin_moments(view: View, contact: str) -> Iterator[tuple[str, str, float]]:
    """Moments of a contact on ends pinned on the edge: names of the beam and the end, moment."""
    record = view.scene.contacts[contact]
    if not isinstance(record, EdgeContact) or f"{contact}.pin" not in view.plan.numbers:
        return
    angles = view.mechanism.beam_angles(record.beam)
    first = view.solved.system.rows.first
    for number, row in enumerate(view.mechanism.rows):
        mu = float(view.z[first + number])
        if row.name == f"{contact}.pin" and mu != 0.0:
            turning = dict(row.form.linear)
            for end, index in zip(END, angles[[0, -1]].tolist(), strict=True):
                if index in turning:
                    yield record.beam, end, -mu * turning[index]


def _pull(view: View, row: str) -> Array:
    """Force (2,) on the first part of a joint or a pin, by its rows for x and y."""
    return -np.array([view.multiplier(f"{row}.{axis}") for axis, _ in AXES])


def _joints(view: View) -> Iterator[PointForce]:
    for beam in view.scene.beams:
        for end, record in zip(END, ends_of(view.scene, beam), strict=True):
            if not isinstance(record, FreeEnd):
                joint = f"{beam}@{end}"
                force, moment = _pull(view, joint), -view.multiplier(f"{joint}.turn")
                yield from _at_end(view, record.point, beam, end, force, moment)


def _at_end(view: View, source: str, beam: str, end: str, force: Array, moment: float) -> Iterator[PointForce]:
    """Force and moment on a beam's end, and the same with the opposite sign on the body of the end's point."""
    joint = ends_of(view.scene, beam)[END.index(end)]
    assert not isinstance(joint, FreeEnd)
    s, place = view.end(beam, end)
    yield PointForce(source, beam, s, place, force, moment)
    yield PointForce(source, view.plan.owners[joint.point], nan, place, -force, -moment)


def _guides(view: View) -> Iterator[PointForce]:
    for name, body in view.scene.bodies.items():
        if isinstance(body, TurningBody):
            yield PointForce(body.about, name, nan, view.place(body.about), _pull(view, f"{name}.pivot"), 0.0)
        elif isinstance(body, SlidingBody):
            along = unit_direction(body.along)
            force = -view.multiplier(f"{name}.slide") * np.array([-along[1], along[0]])
            place = view.place(body.pin or next(iter(body.points)))
            yield PointForce(name, name, nan, place, force, -view.multiplier(f"{name}.level"))


def _drives(view: View) -> Iterator[PointForce]:
    for name, drive in view.scene.drives.items():
        if isinstance(drive, DisplacementDrive):
            force = -view.multiplier(name) * np.array(unit_direction(drive.direction))
            yield PointForce(name, view.plan.owners[drive.point], nan, view.place(drive.point), force, 0.0)
        else:
            place = view.place(next(iter(view.scene.bodies[drive.body].points)))
            yield PointForce(name, drive.body, nan, place, NO_FORCE, -view.multiplier(name))


def _pins(view: View) -> Iterator[PointForce]:
    for name, pin in view.scene.pins.items():
        force = _pull(view, name)
        for point, sign in zip(pin.points, (1.0, -1.0), strict=True):
            yield PointForce(name, view.plan.owners[point], nan, view.place(point), sign * force, 0.0)


def _stops(view: View) -> Iterator[PointForce]:
    for name, stop in view.scene.stops.items():
        moment = stop_moment(view, name)
        if moment != 0.0:
            yield from _at_end(view, name, stop.beam, stop.end, NO_FORCE, moment)


def _contacts(view: View) -> Iterator[PointForce]:
    """Forces of all contacts on beams and bodies, and moments at own pins."""
    geometry = view.solved.system.geometry
    for name, contact in view.scene.contacts.items():
        if geometry.law is not None and isinstance(contact, BeamContact):
            yield from _spread_forces(view, name, geometry)
            continue
        targets = (contact.beams[0], getattr(contact, "body", contact.beams[-1]))
        for each in view.pressed[name]:
            for target, s, place, force in zip(targets, each.arcs, each.places, each.forces, strict=True):
                yield PointForce(name, target, s if target in view.scene.beams else nan, place, force, 0.0)
        for beam, end, moment in pin_moments(view, name):
            yield from _at_end(view, name, beam, end, NO_FORCE, moment)


def _spread_forces(view: View, contact: str, geometry: Geometry) -> Iterator[PointForce]:
    """Forces on nodes and moments on links of both beams of a contact that a law measures."""
    contacts = view.solved.state.contacts
    pair = next(k for k, each in enumerate(geometry.pairs) if each.name == contact)
    pull = contact_terms(geometry, view.z, contacts.places, contacts.pressing(pair))[1]
    for beam in view.scene.contacts[contact].beams:
        arcs, places = view.chain(beam).arcs, view.nodes(beam)
        nodes, angles = view.mechanism.beam_nodes(beam), view.mechanism.beam_angles(beam)
        forces = -pull[np.column_stack([nodes, nodes + 1])]
        for node in np.flatnonzero(forces.any(axis=1)).tolist():
            yield PointForce(contact, beam, float(arcs[node]), places[node], forces[node], 0.0)
        for link in np.flatnonzero(pull[angles]).tolist():
            s, place = 0.5 * (arcs[link] + arcs[link + 1]), 0.5 * (places[link] + places[link + 1])
            yield PointForce(contact, beam, float(s), place, NO_FORCE, -float(pull[angles[link]]))
