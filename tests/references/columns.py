"""Euler's columns, clamped or pinned, under an axial dead force: where the straight branch ends, and the bent one.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
L, EI    length, bending stiffness of the inextensible column
P        axial dead force on the free end of a cantilever, on the sliding end of a pinned column
l        L of a cantilever, L/2 of a pinned column, which is two cantilevers back to back
α        largest tangent angle from the axis: at the tip, at the pins
k        sin(α/2), modulus of the elliptic integrals K and E
δ, w     shortening; deflection of the tip, of the middle
=======  =================================================================================

    l √(P/EI) = K(k),    δ = 2 (1 − E/K) L,    w = 2 k l/K                              (1)

K is least, π/2, at k = 0: the straight branch ends at P = (π/2)² EI/l² in a bifurcation, whose other branch rises,

    P = (π/2)² EI/l² (1 + α²/8 + ...)                                                   (2)

so that it is stable, and the least disturbance leads to it.

Source: S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability, chapter 2.  The column clamped at both
ends is :mod:`tests.references.post_buckled`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, sqrt
from typing import Literal

from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from tests.references.small import euler_load_cantilever, euler_load_pinned

Ends = Literal["cantilever", "pinned"]
_STEEP = 0.8  # of k², α = 127°


@dataclass(frozen=True, slots=True)
class Bent:
    """α, and δ and w over L."""

    angle: float
    shortening: float
    deflection: float


def critical(ends: Ends) -> float:
    """P L²/EI at which the straight column loses its stability."""
    return euler_load_cantilever(1.0, 1.0) if ends == "cantilever" else euler_load_pinned(1.0, 1.0)


def bent(ends: Ends, load: float) -> Bent:
    """The column bent under P L²/EI.

    Raises:
        ValueError: the straight column is stable under it, or α is more than 127°.
    """
    part = 1.0 if ends == "cantilever" else 0.5
    largest = (float(ellipk(_STEEP)) / part) ** 2
    if not critical(ends) < load <= largest:
        raise ValueError(f"the load must lie between {critical(ends):.6g} and {largest:.6g}, not at {load}")
    m = float(brentq(lambda m: float(ellipk(m)) - part * sqrt(load), 0.0, _STEEP, xtol=1e-16, rtol=1e-15))
    K, E, k = float(ellipk(m)), float(ellipe(m)), sqrt(m)
    return Bent(2.0 * asin(k), 2.0 * (1.0 - E / K), 2.0 * k * part / K)
