"""Tip of a cantilever under a dead tip force normal to the undeformed beam, by elliptic integrals.

With α = P L² / (E I), φ the tip's tangent angle, k² = (1 + sin φ) / 2 and θ₁ = arcsin(1 / (k √2)):
√α = K(k) - F(θ₁, k), deflection over length 1 - 2 (E(k) - E(θ₁, k)) / √α, length along the beam
√(2 sin φ / α).  Source: Bisshopp and Drucker, Quarterly of Applied Mathematics 3 (1945) 272-275.
"""

from math import asin, pi, sin, sqrt

from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc


def tip(alpha):
    """Displacement of the tip along and normal to the undeformed beam, over the length."""

    def difference(angle):
        m = (1.0 + sin(angle)) / 2.0
        return ellipk(m) - ellipkinc(asin(1.0 / sqrt(2.0 * m)), m) - sqrt(alpha)

    angle = brentq(difference, 1e-9, pi / 2.0 - 1e-9, xtol=1e-14)
    m = (1.0 + sin(angle)) / 2.0
    deflection = 1.0 - 2.0 * (ellipe(m) - ellipeinc(asin(1.0 / sqrt(2.0 * m)), m)) / sqrt(alpha)
    return sqrt(2.0 * sin(angle) / alpha) - 1.0, deflection
