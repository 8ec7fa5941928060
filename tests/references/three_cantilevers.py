"""Three cantilevers, each one's tip on the next, loaded at the uppermost tip: exact, by shooting.

=======  =======================================================================================
symbol   meaning
=======  =======================================================================================
upper    clamped at (0, h), runs along +x, length 1; a dead force F along −y acts at its tip
middle   clamped at (a, 0), runs along −x, length b; the upper beam's tip rests on it at σ1
lower    clamped at (0, −h), runs along +x, length c; the middle beam's tip rests on it at σ2
P1, P2   contact forces, along the normal e of the beam on which a tip rests
ψ, χ, ω  tangent angles of the upper tip, the middle tip, and the lower beam at σ2
m, θ     bending moment, tangent angle; F the internal force, what lies beyond s on what lies before
=======  =======================================================================================

Source: Euler's elastica, equation (1) of :mod:`tests.references.two_cantilevers`, here with a force that jumps where
a beam is touched.  All beams have one EI; without dimension, lengths over the upper beam's, forces over EI/L².
Contact as lines, without thickness and friction.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from tests.references.integrated import end_of

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Stack:
    """Shape without dimension: h, a, b, c, and the ``force`` F."""

    gap: float
    reach: float
    middle: float
    lower: float
    force: float


@dataclass(frozen=True, slots=True)
class Stacked:
    """Equilibrium without dimension: upper tip (2,), its angle, P1 and P2, σ1 and σ2, moments at three clamps."""

    tip: Array
    rotation: float
    forces: tuple[float, float]
    places: tuple[float, float]
    moments: tuple[float, float, float]


def solve(stack: Stack) -> Stacked:
    """Equilibrium with both contacts closed.

    Raises:
        ValueError: the branch is lost, or a tip slides off or pulls.
    """
    # P1 and P2 of straight beams under small loads, then the load grows
    unknowns = np.array([-0.1, 0.3 * stack.force, stack.reach - 1.0, np.pi, 0.05, stack.reach - stack.middle, 0.0])
    for force in np.linspace(0.3, 1.0, 15) * stack.force:
        unknowns = root(_conditions, unknowns, args=(stack, force), tol=1e-13).x
        if not np.abs(_conditions(unknowns, stack, force)).max() < 1e-10:
            raise ValueError(f"the branch is lost at a force of {force}")
    psi, p1, s1, _, p2, s2, _ = unknowns
    if not (p1 > 0.0 and p2 > 0.0 and 0.0 < s1 < stack.middle and 0.0 < s2 < stack.lower):
        raise ValueError(f"a tip is off its beam or pulls: P = {p1}, {p2}, σ = {s1}, {s2}")
    upper, middle, lower, _ = _clamps(unknowns, stack, stack.force)
    return Stacked(
        tip=np.array([0.0, stack.gap]) - upper[:2],
        rotation=float(psi),
        forces=(float(p1), float(p2)),
        places=(float(s1), float(s2)),
        moments=(float(upper[3]), float(middle[3]), float(lower[3])),
    )


def _backwards(state: Array, force: Array, length: float) -> Array:
    """(x, y, θ, m) a ``length`` before ``state``."""

    def slope(_: float, z: Array) -> list[float]:
        c, s = cos(z[2]), sin(z[2])
        return [-c, -s, -z[3], -(force[0] * s - force[1] * c)]

    return end_of(slope, (0.0, length), state)


def _clamps(unknowns: Array, stack: Stack, force: float) -> tuple[Array, Array, Array, Array]:
    """(x, y, θ, m) at the clamps of the three, each from its tip or contact at (0, 0), and of the middle at σ1."""
    psi, p1, s1, chi, p2, s2, omega = unknowns
    below = p2 * np.array([-np.sin(omega), np.cos(omega)])  # the lower beam's upper side, it runs towards +x
    touched = _backwards(np.array([0.0, 0.0, chi, 0.0]), below, stack.middle - s1)
    above = p1 * np.array([np.sin(touched[2]), -np.cos(touched[2])])  # the middle beam runs towards −x
    middle = _backwards(touched, below - above, s1)
    upper = _backwards(np.array([0.0, 0.0, psi, 0.0]), np.array([0.0, -force]) + above, 1.0)
    lower = _backwards(np.array([0.0, 0.0, omega, 0.0]), -below, s2)
    return upper, middle, lower, touched


def _conditions(unknowns: Array, stack: Stack, force: float) -> Array:
    upper, middle, lower, touched = _clamps(unknowns, stack, force)
    tip = np.array([0.0, stack.gap]) - upper[:2]
    middle_tip = np.array([stack.reach, 0.0]) - middle[:2]
    at_second = np.array([0.0, -stack.gap]) - lower[:2]
    return np.array(
        [upper[2], middle[2] - np.pi, lower[2], *(tip - middle_tip - touched[:2]), *(middle_tip - at_second)]
    )
