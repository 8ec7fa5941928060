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
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from cprbm.equilibrium.newton import Solved
from cprbm_scene.answer import Array

ACCURACY = 1e-6
"""Relative accuracy of a curvature: it judges and extrapolates, and no result contains it."""

STIFF = 1e-3
"""Share of the stiffest spring's compliance below which a compliance is round-off: no direction is free."""

VECTORS = 6
"""Lanczos vectors: the softest mode is well apart from the others, and more vectors cost more than new starts."""

DENSE = 12
"""Links up to which all eigenvalues are computed at once."""


@dataclass(frozen=True, eq=False)
class Mode:
    """Smallest ``curvature`` κ and the change of all unknowns (size,) along the mode, the largest turn 1 rad."""

    curvature: float
    change: Array


def softest(solved: Solved) -> Mode:
    """Smallest curvature and mode at a state; infinite if no direction is free."""
    system = solved.system
    root, count = np.sqrt(system.metric), len(system.metric)

    def response(x: Array) -> Array:
        load = np.zeros(system.size)
        load[system.angles] = root * x.ravel()
        return solved.response(load)

    def compliance(x: Array) -> Array:
        return np.asarray(root * response(x)[system.angles])

    which = "SA" if solved.lost else "LA"
    if count <= DENSE:
        matrix = np.array([compliance(column) for column in np.eye(count)])
        values, vectors = np.linalg.eigh(0.5 * (matrix + matrix.T))
        place = 0 if solved.lost else -1
        value, vector = float(values[place]), vectors[:, place]
    else:
        operator = LinearOperator((count, count), matvec=compliance, dtype=np.float64)
        start = root * (1.0 + np.cumsum(system.metric))
        try:
            values, vectors = eigsh(operator, k=1, which=which, v0=start, tol=ACCURACY, ncv=VECTORS)
        except ArpackNoConvergence:
            return Mode(float("nan"), np.zeros(system.size))
        value, vector = float(values[0]), vectors[:, 0]
    stiffest = float(np.max(np.maximum(system.metric[:-1], system.metric[1:]))) / float(np.max(system.joints.stiffness))
    if abs(value) <= STIFF * stiffest:
        return Mode(float("inf"), np.zeros(system.size))
    change = response(vector)
    largest = float(np.abs(change[system.angles]).max())
    return Mode(1.0 / value, change / largest)
