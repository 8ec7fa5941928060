"""Equilibrium to round-off where penalties are so stiff that what gaps are rounded to is felt as a force.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
g, k    gap at a point of a contact, and its stiffness
λ       push of the point
======  =====================================================================================

A gap is rounded to some units of the lengths of which it is the difference, and −k g to k times that, anew in every
state.  Taken once for what they are, pushes that go on as λ − k ∂g δz with the steps δz that are left are free of it:
λ = −k g holds as well as gaps are known, and forces balance as well as elements tell.
"""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.advance import advance
from fea_reference.model import Model
from fea_reference.system import System, pushed

_STEPS = 4
_FAR = 1e-9  # of lengths over the longest beam, and of angles: a state that is as near has the same contacts
_BETTER = 0.1  # of what was unbalanced


def poised(model: Model, values: Array, system: System, accepted: float) -> System:
    """An equilibrium under ``values`` with no more than is ``accepted`` unbalanced, beside one that has more.

    The same if none is found.
    """
    found, z = system, system.z
    pushes = {one.pair: one.pushes for one in system.touches}
    for _ in range(_STEPS):
        step = found.solve(-found.residual)
        if step is None or not float(np.abs(step[model.moving]).max()) <= _FAR:
            return system
        pushes = {one.pair: one.foreseen(step) for one in found.touches}
        z = advance(model, z, step)
        found = pushed(model, system, values, z, pushes)
        if float(np.abs(found.residual).max()) <= accepted:
            return found
    better = float(np.abs(found.residual).max()) <= _BETTER * float(np.abs(system.residual).max())
    return found if better else system
