"""Where a linkage of bodies is drawn into one line, and two branches of minima meet in one that goes on.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
z, λ    state, and value of the stepped load or drive
K, f    tangent, and −∂R/∂λ of the unbalanced forces R
φ       motions that turn the linkage, (size,); K φ = 0 where it lies in line
τ       dλ/ds by the arc length of the branch
r       dz/dλ of the branch that goes on
======  =====================================================================================

A linkage that no beam holds carries nothing, and stands to one side or to the other.  In line, both are one state, and
the branch goes there along φ with τ = 0, from the one side to the other: all of it are minima, as nothing keeps the
linkage from where its ends lead it.  Farther no branch without force goes.  There is one on which it stays in line and
its force grows from nothing, and it begins there: f has no part along φ, and K r = f is solved by the other motions and
forces.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import splu

from cprbm_scene.answer import Array
from fea_reference.branch import Branch, Place, bordered, sought
from fea_reference.march import March
from fea_reference.system import load_direction

_PREDICTED = 0.1  # rad (and lengths): the most that the step beyond may be predicted to move anything
_CUTS = 6  # each to a quarter


@dataclass(frozen=True, slots=True)
class Turn:
    """A branch turns back without ceasing to be one of minima: the last place ``before``, and a ``length`` of arc
    after which τ has the other sign.
    """

    branch: Branch
    before: Place
    length: float


def beyond(march: March, turn: Turn, target: float) -> bool:
    """Whether the branch goes on beyond a turn, with what the motions there hold; then the march has stepped on."""
    branch, there = turn.branch, _turned(turn)
    rate = None if there is None else _rate(branch, there)
    if there is None or rate is None:
        return False
    saved, load = march.saved(), branch.load
    march.values, march.system = branch.at(there.value), there.system
    way = target - there.value
    size = min(abs(way), _PREDICTED / max(float(np.abs(rate[march.model.moving]).max()), 1e-300))
    for _ in range(_CUTS):
        value = target if size >= abs(way) else float(there.value + np.copysign(size, way))
        if march.step(load, value, march.onward(load, rate, target)) is None and march.minimum:
            return True
        march.restore(saved)
        march.values, march.system = branch.at(there.value), there.system
        size *= 0.25
    march.restore(saved)
    return False


def _turned(turn: Turn) -> Place | None:
    """The place at which τ is as good as zero."""
    sense = np.sign(turn.before.rate)
    return sought(turn.branch, turn.before, turn.length, lambda there: float(sense * there.rate))


def _rate(branch: Branch, there: Place) -> Array | None:
    """r with no part along φ; None where nothing holds the motions φ alone."""
    f = load_direction(branch.model, branch.load, there.system.z, there.system.acting)
    along = branch.weights * there.way
    try:
        solution = splu(bordered(there.system.tangent, along, along, 0.0)).solve(np.append(f, 0.0))
    except RuntimeError:  # exactly singular
        return None
    return solution[:-1] if np.isfinite(solution).all() else None
