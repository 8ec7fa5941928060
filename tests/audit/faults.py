"""Faults planted in an answer's last station: each takes scene, answer and station, and returns the altered station.

A fault that a scene has no place for returns None.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cprbm_scene import FreeEnd, SelfContact
from cprbm_scene.answer import frozen_array


def _forces(station, **columns):
    return replace(station, forces=replace(station.forces, **{k: frozen_array(v) for k, v in columns.items()}))


def _of_contacts(scene, station):
    return np.isin(station.forces.source, list(scene.contacts))


def _value(scene, station, quantity, change):
    values = dict(station.values)
    for probe in scene.probes:
        if probe.quantity == quantity and np.abs(values[probe.name]).max(initial=0.0) > 0.0:
            values[probe.name] = frozen_array(change(values[probe.name], probe))
            return replace(station, values=values)
    return None


def _beam(station, **change):
    name = max(station.beams, key=lambda beam: np.abs(station.beams[beam].Q).max())
    beam = station.beams[name]
    changed = {field: frozen_array(alter(getattr(beam, field))) for field, alter in change.items()}
    return replace(station, beams={**station.beams, name: replace(beam, **changed)})


def _loaded(scene, station):
    mine = _of_contacts(scene, station)
    return mine if np.hypot(*station.forces.force[mine].T).max(initial=0.0) > 0.0 else None


def contact_force_two_per_cent(scene, station):
    """A contact's force is 2 % too large on both sides."""
    mine = _loaded(scene, station)
    factor = None if mine is None else 1.0 + 0.02 * mine
    return None if mine is None else _forces(station, force=station.forces.force * factor[:, None])


def contact_lever_half_a_thickness(scene, station):
    """All contact forces act half a thickness further along their beams."""
    mine = _loaded(scene, station)
    if mine is None or any(isinstance(contact, SelfContact) for contact in scene.contacts.values()):
        return None  # on two laps of one beam the moments of both shifts cancel
    s, place = station.forces.s.copy(), station.forces.place.copy()
    for name, beam in station.beams.items():
        here = mine & (np.array(station.forces.target) == name)
        shift = 0.5 * scene.beams[name].thickest
        angle = np.interp(s[here], beam.s, beam.angle)
        s[here] += shift
        place[here] += shift * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    return _forces(station, s=s, place=place)


def contact_pulls(scene, station):
    """All contact forces have the wrong sign."""
    mine = _loaded(scene, station)
    return None if mine is None else _forces(station, force=np.where(mine, -1.0, 1.0)[:, None] * station.forces.force)


def action_without_reaction(scene, station):
    """The first force of the list is 3 % too small."""
    force = station.forces.force.copy()
    force[int(np.argmax(np.hypot(*force.T)))] *= 0.97
    return _forces(station, force=force)


def reaction_sign(scene, station):
    """A reaction has the wrong sign."""
    return _value(scene, station, "reaction", lambda value, _: -value)


def force_probe(scene, station):
    """A contact's force probe is 0.1 % too large."""
    return _value(scene, station, "force", lambda value, _: 1.001 * value)


def energy(scene, station):
    """The energy is 5 % too large."""
    return _value(scene, station, "potential_energy", lambda value, _: 1.05 * value)


def displacement(scene, station):
    """A displacement is 0.1 % too large."""
    return _value(scene, station, "displacement", lambda value, _: 1.001 * value)


def stress_at_a_held_end(scene, station):
    """The stress within a thickness of a held end is 1.2 times too large."""

    def change(value, probe):
        beam = scene.beams[probe.of]
        s = np.linspace(0.0, station.beams[probe.of].s[-1], probe.points)
        away = s if not isinstance(beam.start, FreeEnd) else s[-1] - s
        return np.where(away <= beam.thickest, 1.2, 1.0) * value

    found = _value(scene, station, "bending_stress", change)
    if found is None:
        return None
    off = max(np.abs(found.values[name] - station.values[name]).max(initial=0.0) for name in station.values)
    largest = max(np.abs(station.values[p.name]).max() for p in scene.probes if p.quantity == "bending_stress")
    return found if off > 0.05 * largest else None  # an end that bears no moment shows nothing


def shear_factor_one(scene, station):
    """Sections shear by the factor 1 instead of 5/6."""
    beams, found = {}, 0.0
    for name, beam in station.beams.items():
        gamma = beam.angle - beam.section_angle
        found = max(found, np.abs(gamma).max())
        beams[name] = replace(beam, section_angle=frozen_array(beam.angle - 5.0 / 6.0 * gamma))
    return replace(station, beams=beams) if found > 1e-4 else None


def stiffness_a_fifth_off(scene, station):
    """Moments are a fifth too large for the shape, with all forces."""
    beams = {}
    for name, beam in station.beams.items():
        beams[name] = replace(beam, **{k: frozen_array(1.2 * getattr(beam, k)) for k in ("N", "Q", "M")})
    return replace(_forces(station, force=1.2 * station.forces.force, moment=1.2 * station.forces.moment), beams=beams)


def moved_bodies(scene, station):
    """Every moving body is 10 µm and 10 µrad off."""
    moved = {name: frozen_array(motion + 1e-5) for name, motion in station.bodies.items()}
    return replace(station, bodies=moved) if moved else None


FAULTS = {
    "contact force": contact_force_two_per_cent,
    "contact lever": contact_lever_half_a_thickness,
    "contact pulls": contact_pulls,
    "action without reaction": action_without_reaction,
    "reaction sign": reaction_sign,
    "force probe": force_probe,
    "energy": energy,
    "displacement": displacement,
    "stress at a held end": stress_at_a_held_end,
    "shear factor": shear_factor_one,
    "stiffness": stiffness_a_fifth_off,
    "bodies": moved_bodies,
    "sign of N": lambda scene, station: _beam(station, N=np.negative),
    "sign of Q": lambda scene, station: _beam(station, Q=np.negative),
    "sign of M": lambda scene, station: _beam(station, M=np.negative),
    "place off": lambda scene, station: _beam(station, x=lambda x: x + 1e-4 * np.ptp(x) * (np.arange(len(x)) == 5)),
    "not a number": lambda scene, station: _beam(station, M=lambda M: np.where(np.arange(len(M)) == 3, np.nan, M)),
    "probe not a number": lambda scene, station: replace(
        station, values={**station.values, scene.probes[0].name: frozen_array([np.nan])}
    ),
}
