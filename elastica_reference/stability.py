"""Stability of an equilibrium: least curvature of the energy.

=======  ==========================================================================================================
symbol   meaning
=======  ==========================================================================================================
q        couples at knots along the beams, and forces and moments on moving bodies
η        rotations of knots and motions of bodies due to q
J        derivative of the equations with further knots in every piece; R, Z the rows of q and the positions of η
         among the unknowns
Φ        η = Φ q, the flexibility
w        length of a knot; 1 for a body
=======  ==========================================================================================================

    J dz = −R q,    Φ = −Z J⁻¹ R,    Φᵀ = Φ                                                                      (1)

With all knots held against rotation, and all bodies held, every piece is shorter than a column that buckles in
between: the energy is minimal. After release the energy decreases in as many directions as Φ has negative eigenvalues
(E. V. Haynsworth, Determination of the inertia of a partitioned Hermitian matrix, Linear Algebra and its Applications
1 (1968) 73-81). The least curvature of the energy over Σ w η² is the reciprocal of the largest eigenvalue of √w Φ √w.

Closed contacts count as held along their normals, which requires compression.
"""

from dataclasses import replace
from math import ceil, hypot, pi, sqrt

import numpy as np

from cprbm_scene.frozendict import frozendict
from elastica_reference.newton import LostError, linearised
from elastica_reference.state import State, start_of
from elastica_reference.structure import Structure

_KNOTS = 8  # least number per beam
_SHARE = 0.4  # times the buckling length of a piece held against rotation at both ends
_NOISE = 1e-9  # times the largest eigenvalue


def least_curvature(state: State) -> float:
    """Least curvature of the energy, dimensionless; positive at a minimum.

    Raises:
        LostError: the equations are singular, or places along a beam are out of order.
    """
    structure, spacing = _with_further_knots(state)
    equations = replace(state.equations, structure=structure)
    z = start_of(equations, state, {**state.places, **state.forces})
    evaluation, _, J = linearised(equations, z, state.lam, state)
    free = sum(state.equations.model.moving.values())  # bodies come first among the unknowns, and last among the rows
    n = len(z)
    index = [*range(free), *(place for place, _ in evaluation.turnings.values())]
    rows = [*range(n - free, n), *(row for _, row in evaluation.turnings.values())]
    weights = np.concatenate([np.ones(free), [spacing[key] for key in evaluation.turnings]])
    if not weights.min() >= 0.0:
        raise LostError  # places have passed each other
    root = np.sqrt(weights)
    forces = np.zeros((n, len(rows)))
    forces[rows, np.arange(len(rows))] = -root
    try:
        flexibility = root[:, None] * np.linalg.solve(J, forces)[index]
        eigenvalues = np.linalg.eigvalsh(0.5 * (flexibility + flexibility.T))
    except np.linalg.LinAlgError as error:  # a nearly singular matrix has no computable eigenvalues
        raise LostError from error
    least, largest = float(eigenvalues[0]), float(eigenvalues[-1])
    return 1.0 / least if least < -_NOISE * abs(largest) else 1.0 / largest


def _with_further_knots(state: State) -> tuple[Structure, dict[tuple[str, float], float]]:
    """The structure with further knots in every piece, and the length of every knot."""
    order, spacing = {}, {}
    for beam, strip in state.equations.model.strips.items():
        places = state.equations.places_of(beam, state.z)
        items = list(zip(places, state.structure.order[beam], strict=True))
        for part in state.evaluation.parts[beam]:
            a, b = float(part.a[0]), float(part.b[0])
            compliance = float(np.max(strip.compliance(np.linspace(a, b, 9))))
            largest = max(hypot(*part.force[:, 0]), hypot(*part.end_force[:, 0]))
            buckling = pi / sqrt(compliance * largest + 1e-6)
            n = ceil((b - a) / min(_SHARE * buckling, strip.length / _KNOTS)) if b > a else 1
            if a in strip.knots:
                spacing[beam, a] = (b - a) / n
            for k in range(1, n):
                knot = a + (b - a) * k / n
                items.append((knot, knot))
                spacing[beam, knot] = (b - a) / n
        order[beam] = tuple(item for _, item in sorted(items, key=lambda item: item[0]))
    return Structure(state.structure.touches, frozendict(order)), spacing
