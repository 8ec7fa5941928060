"""Values of the scene's probes at a state; meanings in :mod:`cprbm_scene.answer`."""

from __future__ import annotations

from typing import assert_never

import numpy as np

from cprbm.chain import stop_angle
from cprbm.results.contacts import contact_centre, contact_ends, contact_force, contact_moment
from cprbm.results.forces import stop_moment
from cprbm.results.statics import Statics
from cprbm.results.view import View
from cprbm_scene import Probe
from cprbm_scene.answer import Array, frozen_array
from cprbm_scene.statement import DisplacementDrive


def probe_values(statics: Statics, stage: str) -> dict[str, Array]:
    """Values by the probes' names, SI; empty for a probe that is not asked in the stage."""
    return {
        probe.name: frozen_array(np.ravel(_value(statics, probe) if probe.asked_in(stage) else []))
        for probe in statics.view.scene.probes
    }


def _value(statics: Statics, probe: Probe) -> Array | float:
    view, units, of = statics.view, statics.view.mechanism.units, probe.of
    match probe.quantity:
        case "displacement":
            return view.displacement(of) * units.length
        case "rotation":
            return view.rotation(of)
        case "bending_stress":
            return statics.bending_stress(of, probe.points)
        case "combined_stress":
            return statics.combined_stress(of, probe.points)
        case "reaction":
            return _reaction(statics, of)[0] * units.force
        case "reaction_moment":
            return _reaction(statics, of)[1] * units.moment
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


def _reaction(statics: Statics, of: str) -> tuple[Array, float]:
    """Force and moment of the ground at a point or on a sliding body, or of the drives of a point or body."""
    view, sources = statics.view, {of}
    for name, drive in view.scene.drives.items():
        if of == (drive.point if isinstance(drive, DisplacementDrive) else drive.body):
            sources.add(name)
    force, moment = np.zeros(2), 0.0
    for each in statics.forces:
        if each.source in sources and _from_ground(view, each.source, each.target):
            force, moment = force + each.force, moment + each.moment
        elif each.source in view.scene.pins and of in view.scene.pins[each.source].points:
            # a pin between the ground and a body
            fixed = view.plan.owners[of] not in view.mechanism.bodies
            if fixed and each.target in view.mechanism.bodies:
                force = force + each.force
    slides = of in view.scene.bodies and not sources - {of}
    return force, 0.0 if slides else moment


def _from_ground(view: View, source: str, target: str) -> bool:
    """True if a force of a source on a target is one of the ground: a held beam, a guide, or a drive."""
    scene, moving, owners = view.scene, view.mechanism.bodies, view.plan.owners
    if source in scene.drives or source == target:
        return True
    if target in scene.beams:
        return source in owners and owners[source] not in moving
    return target in moving and getattr(scene.bodies[target], "about", None) == source and target == owners[source]
