"""Dimensionless potential energy of a state."""

from itertools import combinations

from cprbm_scene.answer import Array
from fea_reference.beam_loads import beam_load, shared_work
from fea_reference.model import BeamMomentPart, Model, OnBeam
from fea_reference.system import System


def potential_energy(model: Model, system: System, values: Array) -> float:
    """Strain energy minus the work of dead loads; the work of drives is part of the strain energy.

    The energy of contact penalties is excluded.
    """
    z = system.z
    energy = float(system.elements.energy.sum())
    for part, load in zip(model.loads, values[: len(model.loads)], strict=True):
        if isinstance(part, OnBeam):
            energy -= beam_load(model, part, float(load), z).work
            continue
        body = model.bodies[part.body]
        if part.direction is None:
            energy -= float(load * model.body_state(body, z)[2])
        else:
            energy -= float(load * (part.direction @ (model.carried(body, part.arm, z) - (body.centre + part.arm))))
    moments = [(part, float(values[i])) for i, part in enumerate(model.loads) if isinstance(part, BeamMomentPart)]
    for (part, load), (other, its_load) in combinations(moments, 2):
        energy -= load * its_load * shared_work(model, part, other, z)
    return energy


def penalised_energy(model: Model, system: System, values: Array) -> float:
    """Potential energy including the energy of penalties, minimal in an equilibrium."""
    stored = sum(0.5 * float((contact.stiffness * contact.gap**2).sum()) for contact in system.touches)
    return potential_energy(model, system, values) + stored
