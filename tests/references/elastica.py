"""The inextensible elastica cantilever: a transverse dead force at the tip, and roll-up by an end moment.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
L, EI    length, bending stiffness
P        dead force at the tip along +y; the undeformed beam runs along +x from the clamp
α        P L² / (EI), the load without dimension
s, θ     arc length from the clamp, tangent angle; ψ = θ(L)
k, m     modulus of the elliptic integrals, m = k² = (1 + sin ψ)/2; p = 1 − m
φ0       arcsin(1 / (k √2)), the amplitude at the clamp
K, F     complete and incomplete elliptic integrals of the first kind; E of the second
κ        M L / (EI), the turning of the tip under an end moment M
=======  =================================================================================

Source: K. E. Bisshopp and D. C. Drucker, Large deflection of cantilever beams, Quarterly of Applied
Mathematics 3 (1945) 272-275.

Derivation.  Bending moment at s: EI θ' = P (x(L) − x(s)), hence EI θ'' = −P cos θ.  One integration with
θ'(L) = 0 gives ½ EI θ'² = P (sin ψ − sin θ).  Put 1 + sin θ = 2 k² sin² φ, 2 k² = 1 + sin ψ; then
ds = √(EI/P) dφ / √(1 − k² sin² φ) and

    √α = K(k) − F(φ0, k)                                                       (1)
    x(L) = L √(2 sin ψ / α)           (from EI θ'(0) = P x(L))                 (2)
    y(L) = L (1 − 2 (E(k) − E(φ0, k)) / √α)                                    (3)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipkinc, ellipkm1


@dataclass(frozen=True, slots=True)
class Tip:
    """Position of the tip over the beam's length, and its rotation in radians."""

    x: float
    y: float
    rotation: float


def cantilever_under_tip_force(alpha: float) -> Tip:
    """Tip of a cantilever along +x under a dead force along +y.

    Args:
        alpha: P L²/(EI), of either sign, |α| ≤ 400; held to about 1e-12 up to 10, to about 1e-9 at 100.

    Returns:
        Position over L and rotation; the load's sign is the sign of ``y`` and of the rotation.

    Raises:
        ValueError: ``alpha`` lies outside the range or is not finite.
    """
    if not abs(alpha) <= 400.0:
        raise ValueError(f"alpha must lie within ±400, not {alpha}")
    if alpha == 0.0:
        return Tip(1.0, 0.0, 0.0)
    root = np.sqrt(abs(alpha))

    def excess(log_p: float) -> float:
        p = np.exp(log_p)
        return float(ellipkm1(p) - ellipkinc(_clamp_amplitude(p), 1.0 - p) - root)

    p = float(np.exp(brentq(excess, -60.0, np.log(0.5), xtol=1e-15, rtol=1e-15)))  # (1)
    m, phi0 = 1.0 - p, _clamp_amplitude(p)
    sine = 1.0 - 2.0 * p
    x = np.sqrt(2.0 * sine / abs(alpha))  # (2)
    y = 1.0 - 2.0 * (ellipe(m) - ellipeinc(phi0, m)) / root  # (3)
    # arcsin(1 − 2p) loses digits where p is small, arccos-like forms do not
    rotation = np.pi / 2.0 - 2.0 * np.arcsin(np.sqrt(p))
    sign = np.sign(alpha)
    return Tip(float(x), float(sign * y), float(sign * rotation))


def roll_up(kappa: float) -> Tip:
    """Tip of a cantilever along +x bent by an end moment: an arc of the circle of radius L/κ.

    Args:
        kappa: M L/(EI); 2π closes the circle, more goes round again.

    Returns:
        Position over L and rotation κ, counted through full turns.
    """
    # θ = κ s / L, x = ∫ cos θ ds, y = ∫ sin θ ds; np.sinc(z) = sin(πz)/(πz)
    half = 0.5 * kappa
    chord = float(np.sinc(half / np.pi))
    return Tip(chord * float(np.cos(half)), chord * float(np.sin(half)), kappa)


def _clamp_amplitude(p: float) -> float:
    return float(np.arcsin(np.sqrt(0.5 / (1.0 - p))))
