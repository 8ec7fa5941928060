"""Equilibrium to round-off with stiff penalties, where the round-off of gaps is a significant force.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
g, k    gap at a point of a contact, and its stiffness
λ       contact force of the point
======  =====================================================================================

A gap is a difference of lengths and has their round-off; −k g has k times this error, different in every state.
Contact forces taken once and continued as λ − k ∂g δz along the remaining steps δz are free of new errors. Then λ =
−k g holds up to the round-off of gaps, and forces balance up to the round-off of elements.
"""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.advance import advance
from fea_reference.model import Model
from fea_reference.system import System, with_point_forces

_STEPS = 4
_FAR = 1e-9  # relative to the longest beam, or rad: states as near as this have the same contacts
_BETTER = 0.1  # times the initial residual


def without_gap_round_off(model: Model, values: Array, system: System, accepted: float) -> System:
    """Equilibrium under ``values`` near ``system``, with a residual of at most ``accepted`` or round-off of elements.

    Without success ``system`` is returned, or the last state if its residual is much smaller.
    """
    corrected, z = system, system.z
    pushes = {contact.pair: contact.pushes for contact in system.touches}
    for _ in range(_STEPS):
        step = corrected.solve(-corrected.residual)
        if step is None or not float(np.abs(step[model.moving]).max()) <= _FAR:
            return system
        pushes = {contact.pair: contact.predicted_forces(step) for contact in corrected.touches}
        z = advance(model, z, step)
        corrected = with_point_forces(model, system, values, z, pushes)
        if float(np.abs(corrected.residual).max()) <= max(accepted, corrected.floor):
            return corrected
    better = float(np.abs(corrected.residual).max()) <= _BETTER * float(np.abs(system.residual).max())
    return corrected if better else system
