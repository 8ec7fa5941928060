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

from __future__ import annotations

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
    """Smallest ``curvature`` κ and the change of all unknowns (size,) along the mode, the largest turn 1 rad."""

    curvature: float
    change: Array


def softest(solved: Solved) -> Mode:
    """Smallest curvature and mode at a state; infinite if no direction is free."""
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh  # scenes that end at once load no ARPACK

    system = solved.system
    root, count = np.sqrt(system.metric), len(system.metric)

    def response(vector: Array) -> Array:
        load = np.zeros(system.size)
        load[system.angles] = root * vector
        return solved.response(load)

    compliance = LinearOperator((count, count), matvec=lambda x: root * response(x.ravel())[system.angles], dtype=float)
    start, largest = root * (1.0 + np.cumsum(system.metric)), "SA" if solved.lost else "LA"
    try:
        found = eigsh(compliance, k=1, which=largest, v0=start, ncv=min(VECTORS, count), tol=ACCURACY)
    except ArpackNoConvergence:
        return Mode(float("nan"), np.zeros(system.size))
    value, vector = float(found[0][0]), found[1][:, 0]
    stiffest = float(np.max(np.maximum(system.metric[:-1], system.metric[1:]))) / float(np.max(system.joints.stiffness))
    if abs(value) <= STIFF * stiffest:
        return Mode(float("inf"), np.zeros(system.size))
    change = response(vector)
    return Mode(1.0 / value, change / float(np.abs(change[system.angles]).max()))
