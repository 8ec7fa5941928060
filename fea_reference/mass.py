"""Lumped mass as a metric of motions: arc length for nodes, one for bodies."""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.model import Model


def lumped_mass(model: Model) -> Array:
    """The diagonal of M, (size,); zero for forces and multipliers."""
    h = model.elements.length
    lumped = np.zeros(model.node_dofs.shape[1])
    for beam in model.beams:
        own = lumped[beam.nodes]
        own[:-1] += 0.5 * h[beam.elements]
        own[1:] += 0.5 * h[beam.elements]
    mass = np.zeros(model.size)
    mass[model.node_dofs] = lumped
    for body in model.bodies:
        if body.dofs is not None:
            mass[body.dofs] = 1.0
    return mass
