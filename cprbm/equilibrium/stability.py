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

from cprbm.chain.compiled import compiled
from cprbm.equilibrium.linear import Bordered, Numbers, Work, solve_system
from cprbm.equilibrium.newton import Solved
from cprbm_scene.answer import Array, Flags, Ints

ACCURACY = 1e-6
"""Relative accuracy of a curvature: it judges and extrapolates, and no result contains it."""

STIFF = 1e-3
"""Share of the stiffest spring's compliance below which a compliance is round-off: no direction is free."""

VECTORS = 60
"""Most Lanczos vectors: the softest mode is well apart from the others, and five to ten are enough."""


@dataclass(frozen=True, eq=False)
class Mode:
    """Smallest ``curvature`` κ and the change of all unknowns (size,) along the mode, the largest turn 1 rad."""

    curvature: float
    change: Array


def softest(solved: Solved) -> Mode:
    """Smallest curvature and mode at a state; infinite if no direction is free."""
    system = solved.system
    root = np.sqrt(system.metric)
    start = root * (1.0 + np.cumsum(system.metric))
    sense = -1.0 if solved.lost else 1.0
    value, vector = _largest(*solved.factors.arrays, root, start / np.linalg.norm(start), sense)
    if not np.isfinite(value):
        return Mode(value, np.zeros(system.size))
    stiffest = float(np.max(np.maximum(system.metric[:-1], system.metric[1:]))) / float(np.max(system.joints.stiffness))
    if abs(value) <= STIFF * stiffest:
        return Mode(float("inf"), np.zeros(system.size))
    load = np.zeros(system.size)
    load[system.angles] = root * vector
    change = solved.response(load)
    largest = float(np.abs(change[system.angles]).max())
    return Mode(1.0 / value, change / largest)


@compiled
def _largest(
    m: Numbers,
    work: Work,
    driven: Flags,
    bordered: Bordered,
    factored: Array,
    order: Ints,
    root: Array,
    start: Array,
    sense: float,
) -> tuple[float, Array]:  # pragma: no cover
    """Eigenvalue of √M S √M that is largest in a ``sense``, and eigenvector, by Lanczos's method; nan if not found."""
    most = min(VECTORS, root.size)
    basis, T, x = np.zeros((most + 1, root.size)), np.zeros((most, most)), np.zeros(root.size)
    basis[0] = start
    for k in range(most):
        load = np.zeros(m.rows.first + driven.size)
        for j in range(root.size):
            load[m.angles[j]] = root[j] * basis[k, j]
        solve_system(m, work, driven, bordered, factored, order, np.zeros(0), load)
        for j in range(root.size):
            x[j] = root[j] * load[m.angles[j]]
        T[k, k] = np.sum(basis[k] * x)
        for _ in range(2):
            for i in range(k + 1):
                x -= np.sum(basis[i] * x) * basis[i]
        rest = np.sqrt(np.sum(x * x))
        values, vectors = np.linalg.eigh(T[: k + 1, : k + 1].copy())
        at = k if sense > 0.0 else 0
        if rest * abs(vectors[k, at]) <= ACCURACY * abs(values[at]) or k + 1 == root.size:
            found = np.zeros(root.size)
            for i in range(k + 1):
                found += vectors[i, at] * basis[i]
            return values[at], found
        basis[k + 1] = x / rest
        if k + 1 < most:
            T[k, k + 1], T[k + 1, k] = rest, rest
    return np.nan, x
