"""Cantilever clamped tangent on a rigid circle under a dead tip force F across the clamp's tangent; E I = L = 1.

On the wrap the neutral line has the radius ρ, up to the angle θc = c/ρ.  Beyond, dθ/ds = √(2 F (sin θt - sin θ)) with
the tip's angle θt.  At lift-off 1/ρ² = 2 F (sin θt - sin θc); the length beyond is 1 - c.  Source: the elastica,
with the closed form of the wrap.  Integrals over θ are over u with θ = θt - u², where they are regular.
"""

from math import asin, cos, sin, sqrt

from scipy.integrate import quad
from scipy.optimize import brentq


def drop(radius, force):
    """Deflection of the tip along the force, for a neutral line of ``radius`` on the wrap."""

    def tip_angle(lift_off):
        return asin(sin(lift_off) + 1.0 / (2.0 * force * radius**2))

    def beyond(lift_off, weight):
        tip = tip_angle(lift_off)

        def integrand(u):
            # sin θt - sin θ = 2 cos(θt - u²/2) sin(u²/2)
            return weight(tip - u * u) * 2.0 * u / sqrt(4.0 * force * cos(tip - u * u / 2.0) * sin(u * u / 2.0))

        return quad(integrand, 0.0, sqrt(tip - lift_off), epsabs=1e-13, epsrel=1e-13)[0]

    def length(lift_off):
        return radius * lift_off + beyond(lift_off, lambda angle: 1.0) - 1.0

    last = asin(1.0 - 1.0 / (2.0 * force * radius**2)) - 1e-9
    lift_off = brentq(length, 0.0, min(last, 1.0 / radius), xtol=1e-14)
    return radius * (1.0 - cos(lift_off)) + beyond(lift_off, sin)


def radius_of(fall, force):
    """Radius of the neutral line on the wrap at which the tip drops by ``fall``."""
    return brentq(lambda radius: drop(radius, force) - fall, 0.75, 3.0, xtol=1e-13)
