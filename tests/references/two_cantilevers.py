"""Two cantilevers, the tip of the upper one resting under load on the lower one: exact, by shooting.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
upper    clamped at (0, h), runs along +x, length L1; a dead force F along −y acts at its tip
lower    clamped at (a, 0), runs along −x, length L2; the upper beam's tip rests on it
h        initial distance of the neutral lines; contact as lines, without thickness
EI       bending stiffness of both
P, σ     contact force, and the arc length from the lower clamp at which the tip touches
e        unit normal of the lower beam at σ, on the upper beam's side
m, θ     bending moment, tangent angle; F the internal force, what lies beyond s on what lies before
=======  ====================================================================================

Source: Euler's elastica; the equations (1) of :mod:`tests.references.hinge` with κ0 = 0.

The upper beam's tip is free of moment and carries (0, −F) + P e.  The lower beam carries −P e at σ, and is
straight and free beyond.  Frictionless contact of a tip with a line acts along the line's normal.

Unknowns, without dimension (lengths over L1, forces over EI/L1²): tip angle ψ of the upper beam, the lower
beam's angle χ at σ, P and σ.  Both beams are integrated backwards from where they are free of moment:

    x' = cos θ,  y' = sin θ,  θ' = m,  m' = Fx sin θ − Fy cos θ,   m = 0 at the contact                  (1)

Conditions: both beams' clamps have their tangent angles (2), and with both shapes placed at their clamps
the upper beam's tip lies on the lower beam's point at σ (2).
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
class TwoCantilevers:
    """Shape of the pair over L1 (``gap`` h, ``reach`` a, ``lower_length`` L2) and ``force`` F L1²/EI."""

    gap: float
    reach: float
    lower_length: float
    force: float


@dataclass(frozen=True, slots=True)
class TipContact:
    """Equilibrium without dimension: tip of the upper beam (2,), ψ, χ, P, σ, and m at both clamps."""

    tip: Array
    rotation: float
    lower_angle: float
    contact_force: float
    contact_arc_length: float
    upper_moment: float
    lower_moment: float


def solve(pair: TwoCantilevers) -> TipContact:
    """Equilibrium of the pair, on the branch that starts at first touch.

    Raises:
        ValueError: the force leaves the gap open, the branch is lost, or the tip slides off the beam.
    """
    touch = 3.0 * pair.gap  # of straight beams under small loads: F L³/(3 EI) = h
    if pair.force <= touch:
        raise ValueError(f"the force must be more than about {touch}, where the gap closes, not {pair.force}")
    sigma = pair.reach - 1.0
    unknowns = np.array([-1.5 * pair.gap, np.pi, 0.0, sigma])
    for force in touch + (pair.force - touch) * np.linspace(0.05, 1.0, 20):
        unknowns = root(_conditions, unknowns, args=(pair, force), tol=1e-13).x
        if not np.abs(_conditions(unknowns, pair, force)).max() < 1e-10:
            raise ValueError(f"the branch is lost at a force of {force}")
    if not (unknowns[2] > 0.0 and 0.0 < unknowns[3] <= pair.lower_length):
        raise ValueError(f"the tip is off the lower beam or pulls on it: P = {unknowns[2]}, σ = {unknowns[3]}")
    return _answer(unknowns, pair)


def _backwards(angle: float, force: Array, length: float) -> Array:
    """(x, y, θ, m) at the clamp, of a beam free of moment at its far end (0, 0) with tangent ``angle``."""

    def slope(_: float, z: Array) -> list[float]:
        c, s = cos(z[2]), sin(z[2])
        return [-c, -s, -z[3], -(force[0] * s - force[1] * c)]

    start = [0.0, 0.0, angle, 0.0]
    return end_of(slope, (0.0, length), start, rtol=1e-13, atol=1e-14)


def _clamps(unknowns: Array, force: float) -> tuple[Array, Array]:
    psi, chi, P, sigma = unknowns
    # the lower beam runs towards −x: its right-hand side is up
    e = np.array([np.sin(chi), -np.cos(chi)])
    upper = _backwards(psi, np.array([0.0, -force]) + P * e, 1.0)
    return upper, _backwards(chi, -P * e, sigma)


def _conditions(unknowns: Array, pair: TwoCantilevers, force: float) -> Array:
    upper, lower = _clamps(unknowns, force)
    tip = np.array([0.0, pair.gap]) - upper[:2]
    touched = np.array([pair.reach, 0.0]) - lower[:2]
    return np.array([upper[2], lower[2] - np.pi, *(tip - touched)])


def _answer(unknowns: Array, pair: TwoCantilevers) -> TipContact:
    upper, lower = _clamps(unknowns, pair.force)
    return TipContact(
        tip=np.array([0.0, pair.gap]) - upper[:2],
        rotation=float(unknowns[0]),
        lower_angle=float(unknowns[1]),
        contact_force=float(unknowns[2]),
        contact_arc_length=float(unknowns[3]),
        upper_moment=float(upper[3]),
        lower_moment=float(lower[3]),
    )
