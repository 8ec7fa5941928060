"""A column clamped at both ends beyond Euler's load, one end sliding along its axis: exact.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
L, EI    length, bending stiffness of the inextensible column
P        axial dead force on the sliding end, towards the other
θ, α     tangent angle from the axis, and the largest, at the points of inflection L/4 and 3 L/4
k        sin(α/2), modulus of the elliptic integrals K and E
δ, w     how far the sliding end has come, deflection of the middle
M        moment of the ground on the column at a clamp, of either sign
=======  ====================================================================================

Source: Euler's elastica; S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability, section 2.7, where a column of
length l that is clamped at one end and free at the other bends under an axial force so that

    l √(P/EI) = K(k),    sideways 2 k √(EI/P),    along the axis (2 E(k)/K(k) − 1) l                      (1)

Derivation.  Between two points of inflection, and between one and a clamp, the column is made of four such columns of
length l = L/4, whose free ends are the points of inflection; all carry P and, by symmetry about the middle and about
the points of inflection, no force across.  Hence

    P = 16 K² EI/L²,   δ = 2 (1 − E/K) L,   w = 4 k √(EI/P) = k L/K,   M = 2 k √(P EI)                    (2)

From EI θ'' = −P sin θ and θ' = 0 at the inflection, ½ EI θ'² = P (cos θ − cos α), whose integral is the strain energy

    U = P (L − δ − L cos α)                                                                               (3)
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from tests.references.small import euler_load_clamped


@dataclass(frozen=True, slots=True)
class PostBuckled:
    """Shortening δ and deflection w over L, moment M L/EI and strain energy U L/EI; ``load`` is P L²/EI."""

    load: float
    shortening: float
    deflection: float
    moment: float
    strain_energy: float


def post_buckled(load: float) -> PostBuckled:
    """The column under P L²/EI.

    Raises:
        ValueError: it is not more than Euler's load 4 π², or so large that the column would touch itself.
    """
    least = euler_load_clamped(1.0, 1.0)
    largest = 16.0 * float(ellipk(0.8)) ** 2  # α = 127°; the halves meet where E = K/2, at 131°
    if not least < load <= largest:
        raise ValueError(f"the load must lie between {least:.6g} and {largest:.6g}, not at {load}")
    m = brentq(lambda m: 4.0 * float(ellipk(m)) - sqrt(load), 0.0, 0.8, xtol=1e-16, rtol=1e-15)
    k, K, E = sqrt(m), float(ellipk(m)), float(ellipe(m))
    shortening = 2.0 * (1.0 - E / K)
    return PostBuckled(
        load=load,
        shortening=shortening,
        deflection=k / K,
        moment=2.0 * k * sqrt(load),
        strain_energy=load * (1.0 - shortening - (1.0 - 2.0 * m)),
    )


def small_deflection(load: float) -> float:
    """w/L just beyond Euler's load, from K = (π/2)(1 + k²/4): w = k L/K."""
    return sqrt(4.0 * (sqrt(load) / (2.0 * pi) - 1.0)) * 2.0 / pi
