"""Smallest curvature of the potential energy on the feasible directions, and the mode.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
S        block of the angles in the inverse of the Hessian of the Lagrangian
M        lengths of the links: the metric is ∫ dθ² ds
κ, φ     √M S √M x = x/κ, φ = x/√M
=======  ====================================================================================

S vanishes on infeasible directions.  The largest eigenvalue belongs to the smallest curvature of a minimum.  At other
states the most negative eigenvalue belongs to the negative curvature nearest to zero.  κ is in EI/ℓ².
"""

from dataclasses import dataclass

import numpy as np

from cprbm.equilibrium.solving import Solved
from cprbm_scene.answer import Array

ACCURACY = 1e-6
"""Relative accuracy of a curvature: it judges and extrapolates, and no result contains it."""

STIFF = 1e-3
"""Share of the stiffest spring's compliance below which a compliance is round-off: no direction is free."""

VECTORS = 6
"""Lanczos vectors before a restart: the softest mode is well apart from the others."""


@dataclass(frozen=True, eq=False)
class Mode:
    """Smallest ``curvature`` κ and the turns φ (links,) of the mode."""

    curvature: float
    turns: Array


def softest(solved: Solved) -> Mode:
    """Smallest curvature and mode at a state; infinite if no direction is free."""
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh  # scenes that end at once load no ARPACK

    system = solved.system
    root, count = np.sqrt(system.metric), len(system.metric)

    def turned(x: Array) -> Array:
        load = np.zeros(system.size)
        load[system.angles] = root * x.ravel()
        return np.asarray(root * solved.response(load)[system.angles])

    compliance = LinearOperator((count, count), matvec=turned, dtype=float)
    start, largest = root * (1.0 + np.cumsum(system.metric)), "SA" if solved.lost else "LA"
    try:
        found = eigsh(compliance, k=1, which=largest, v0=start, ncv=min(VECTORS, count), tol=ACCURACY)
    except ArpackNoConvergence:
        return Mode(float("nan"), np.zeros(count))
    value, vector = float(found[0][0]), found[1][:, 0]
    stiffest = float(np.max(np.maximum(system.metric[:-1], system.metric[1:]))) / float(np.max(system.joints.stiffness))
    if abs(value) <= STIFF * stiffest:
        return Mode(float("inf"), np.zeros(count))
    return Mode(1.0 / value, vector / root)
