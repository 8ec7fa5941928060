"""Inextensibility limit: a beam in pure bending kinematics drawn taut.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
F, v    the largest axial force, and the value of the stepped parameter
v_t     value at which the beams are taut
p       F grows like (v_t − v)^−p: larger tension leaves shorter bends
======  =====================================================================================

Without stretch no equilibrium exists beyond v_t, and before v_t forces of any size occur. Three values determine v_t
and p:

    ln(F₂/F₁) / ln(F₃/F₂) = ln((v_t − v₁)/(v_t − v₂)) / ln((v_t − v₂)/(v_t − v₃)),

where the right side increases with v_t from zero at v₃ to (v₂ − v₁)/(v₃ − v₂) at infinity.
"""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import brentq

_GROWN = 2.0  # least growth of F between consecutive values
_MOST = 1e12  # EI/length²: larger forces are round-off of a straight beam
_NEAR, _AFAR = 1e-15, 1.0  # times the last step: range of v_t beyond the last value
_POWERS = (0.25, 4.0)


def taut_at(pulls: Sequence[tuple[float, float]]) -> float | None:
    """v_t from the last of pairs (v, F), in order, and two earlier pairs; None if the pairs do not determine v_t."""
    samples: list[tuple[float, float]] = []
    for pull in reversed(pulls):
        if pull[1] < (_MOST if not samples else samples[-1][1] / _GROWN):
            samples.append(pull)
    if len(samples) < 3:
        return None
    (v3, F3), (v2, F2), (v1, F1) = samples[:3]
    before, step = abs(v2 - v1), abs(v3 - v2)
    if not (F1 > 0.0 and (v2 - v1) * (v3 - v2) > 0.0):
        return None
    ratio = float(np.log(F2 / F1) / np.log(F3 / F2))

    def off(distance: float) -> float:
        return float(np.log1p(before / (distance + step)) / np.log1p(step / distance)) - ratio

    low, high = _NEAR * step, _AFAR * step
    if not off(low) < 0.0 < off(high):
        return None
    distance = float(brentq(off, low, high))
    power = float(np.log1p(step / distance) / np.log(F3 / F2))
    return v3 + float(np.copysign(distance, v3 - v2)) if _POWERS[0] <= power <= _POWERS[1] else None
