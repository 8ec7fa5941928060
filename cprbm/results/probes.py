"""Values of the scene's probes at a state; meanings in :mod:`cprbm_scene.answer`."""

from __future__ import annotations

from typing import assert_never

import numpy as np

from cprbm.chain import stop_angle
from cprbm.chain.form import X_AXIS, Y_AXIS
from cprbm.results.contacts import contact_centre, contact_force, contact_moment
from cprbm.results.forces import all_forces, stop_moment
from cprbm.results.statics import bending_stress, combined_stress
from cprbm.results.view import View
from cprbm.results.zones import contact_ends
from cprbm_scene import Probe
from cprbm_scene.answer import Array, frozen_array
from cprbm_scene.statement import DisplacementDrive


def probe_values(view: View, stage: str) -> dict[str, Array]:
    """Values by the probes' names, SI; empty for a probe that is not asked in the stage."""
    return {
        probe.name: frozen_array(np.ravel(_value(view, probe) if probe.asked_in(stage) else []))
        for probe in view.scene.probes
    }


def displacement(view: View, point: str) -> Array:
    """Displacement (2,) of a named point, m."""
    forms = (view.mechanism.displacement(point, direction) for direction in (X_AXIS, Y_AXIS))
    return np.array([form.value(view.z) for form in forms]) * view.mechanism.units.length


def _value(view: View, probe: Probe) -> Array | float:
    units, of = view.mechanism.units, probe.of
    match probe.quantity:
        case "displacement":
            return displacement(view, of)
        case "rotation":
            return view.mechanism.rotation(of).value(view.z)
        case "bending_stress":
            return bending_stress(view, of, probe.points)
        case "combined_stress":
            return combined_stress(view, of, probe.points)
        case "reaction":
            return _reaction(view, of)[0] * units.force
        case "reaction_moment":
            return _reaction(view, of)[1] * units.moment
        case "potential_energy":
            return view.potential_energy
        case "angle":
            return stop_angle(view.mechanism, of).value(view.z)
        case "moment":
            moment = contact_moment(view, of) if of in view.scene.contacts else stop_moment(view, of)
            return abs(moment) * units.moment
        case "force":
            return contact_force(view, of) * units.force
        case "centre":
            return np.array(contact_centre(view, of)) * units.length
        case "ends":
            return np.array(contact_ends(view, of)) * units.length
        case "closing_load":
            closed = of in view.closing and contact_force(view, of) > 0.0
            return np.array([view.closing[of]] if closed else [])
        case _:
            assert_never(probe.quantity)


def _reaction(view: View, of: str) -> tuple[Array, float]:
    """Force and moment of the ground at a point or on a sliding body, or of the drives of a point or body."""
    sources = {of}
    for name, drive in view.scene.drives.items():
        if of == (drive.point if isinstance(drive, DisplacementDrive) else drive.body):
            sources.add(name)
    force, moment = np.zeros(2), 0.0
    for each in all_forces(view):
        if each.source in sources and _from_ground(view, each.source, each.target):
            force, moment = force + each.force, moment + each.moment
        elif each.source in view.scene.pins and of in view.scene.pins[each.source].points:
            # a pin between the ground and a body
            fixed = view.scene.body_of(of) not in view.mechanism.bodies
            if fixed and each.target in view.mechanism.bodies:
                force = force + each.force
    slides = of in view.scene.bodies and not sources - {of}
    return force, 0.0 if slides else moment


def _from_ground(view: View, source: str, target: str) -> bool:
    """True if a force of a source on a target is one of the ground: a held beam, a guide, or a drive."""
    scene, moving = view.scene, view.mechanism.bodies
    if source in scene.drives or source == target:
        return True
    if target in scene.beams:
        return source in scene.owners and scene.body_of(source) not in moving
    return (
        target in moving and getattr(scene.bodies[target], "about", None) == source and target == scene.body_of(source)
    )
