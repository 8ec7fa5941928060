"""Continuation beyond a straightened linkage, where two branches of minima meet a third.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
z, λ    state, and value of the stepped parameter
K, f    tangent, and −∂R/∂λ of the unbalanced forces R
φ       motions that turn the linkage, (size,); K φ = 0 in the straight position
τ       dλ/ds by the arc length of the branch
r       dz/dλ of the continuing branch
======  =====================================================================================

A linkage without beams carries no load and stands on either side. Both sides meet in the straight position, where the
branch runs along φ with τ = 0. All its states are minima, as nothing resists the linkage. No force-free branch leads
further. On the continuing branch the linkage stays straight and its force grows from zero: f has no component along
φ, and K r = f has a solution without component along φ.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import splu

from cprbm_scene.answer import Array
from fea_reference.branch import Branch, BranchPoint, bordered, sign_change
from fea_reference.march import March
from fea_reference.system import load_direction

_PREDICTED = 0.1  # rad (and lengths): largest predicted motion of the step beyond
_CUTS = 6  # cuts of a step, to a quarter


@dataclass(frozen=True, slots=True)
class TurningPoint:
    """A turning point on a branch of minima, within an arc ``length`` from the point ``before``.

    τ has the opposite sign at the end of the arc.
    """

    branch: Branch
    before: BranchPoint
    length: float


def continue_beyond(march: March, turn: TurningPoint, target: float) -> bool:
    """Step on beyond a turning point; True on success, else the state is unchanged."""
    branch, sense = turn.branch, np.sign(turn.before.rate)
    # the point with τ = 0
    there = sign_change(branch, turn.before, turn.length, lambda there: float(sense * there.rate))
    rate = None if there is None else _tangent_beyond(branch, there)
    if there is None or rate is None:
        return False
    saved, load = march.saved(), branch.load
    march.values, march.system = branch.at(there.value), there.system
    remaining = target - there.value
    size = min(abs(remaining), _PREDICTED / max(float(np.abs(rate[march.model.moving]).max()), 1e-300))
    for _ in range(_CUTS):
        value = target if size >= abs(remaining) else float(there.value + np.copysign(size, remaining))
        if march.step(load, value, march.path_tangent(load, rate, target)) is None and march.is_minimum:
            return True
        march.restore(saved)
        march.values, march.system = branch.at(there.value), there.system
        size *= 0.25
    march.restore(saved)
    return False


def _tangent_beyond(branch: Branch, there: BranchPoint) -> Array | None:
    """r without component along φ; None if a motion other than φ is free."""
    f = load_direction(branch.model, branch.load, there.system.z, there.system.acting)
    along = branch.weights * there.way
    try:
        solution = splu(bordered(there.system.tangent.matrix, along, along, 0.0)).solve(np.append(f, 0.0))
    except RuntimeError:  # exactly singular
        return None
    return solution[:-1] if np.isfinite(solution).all() else None
