"""A piece of an inextensible beam that carries one force along itself, by integration, with exact derivatives.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
s        arc length; x, y place; θ tangent angle
M        bending moment (EI = 1), κ⁰ curvature free of stress, constant along the piece
F        force of what follows on what went before, constant along the piece
η, μ     small changes of θ and M
=======  =================================================================================

    x' = cos θ,    y' = sin θ,    θ' = κ⁰ + M,    M' = F_x sin θ − F_y cos θ                       (1)
    η' = μ,    μ' = (F_x cos θ + F_y sin θ) η + sin θ δF_x − cos θ δF_y                            (2)
    δx' = −sin θ η,    δy' = cos θ η                                                               (3)

(2) and (3) are the derivatives of (1); they are integrated beside it, for the four changes θ(0), M(0), F_x and F_y.

Source: L. D. Landau and E. M. Lifshitz, Theory of Elasticity, §19.
"""

from __future__ import annotations

from math import cos, sin

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from tests.references.integrated import end_of

Array = NDArray[np.float64]
TIGHT, LOOSE = 1e-13, 1e-8
"""Relative tolerances of the integration: for numbers, and for finding one's way."""


def carried(
    start: Array, force: Array, length: float, curvature: float, tolerance: float = TIGHT
) -> tuple[Array, Array]:
    """The piece's end.

    Args:
        start: x, y, θ, M; force: F_x, F_y.

    Returns:
        x, y, θ, M at the end, and their derivatives (4, 6) by ``start`` and ``force``.
    """
    derivative = np.zeros((4, 6))
    derivative[0, 0] = derivative[1, 1] = 1.0
    state = np.concatenate((start, [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0], np.zeros(8)))

    Fx, Fy = float(force[0]), float(force[1])

    def rates(_: float, z: Array) -> list[float]:
        # plain numbers: arrays of four are slower
        _, _, theta, M, _, _, a, ma, _, _, b, mb, _, _, c, mc, _, _, d, md = z.tolist()
        cosine, sine = cos(theta), sin(theta)
        stiff = Fx * cosine + Fy * sine
        changes = (a, ma, 0.0), (b, mb, 0.0), (c, mc, sine), (d, md, -cosine)
        out = [cosine, sine, curvature + M, Fx * sine - Fy * cosine]
        for eta, mu, own in changes:
            out += (-sine * eta, cosine * eta, mu, stiff * eta + own)
        return out

    end = end_of(rates, (0.0, length), state, rtol=tolerance, atol=0.1 * tolerance)
    derivative[:, 2:] = end[4:].reshape(4, 4).T
    return end[:4], derivative


def shape(start: Array, force: Array, length: float, curvature: float, places: Array) -> Array:
    """x, y, θ, M (4, k) at arc lengths ``places`` (k,), ascending in [0, length]."""

    def rates(_: float, z: Array) -> list[float]:
        cosine, sine = cos(z[2]), sin(z[2])
        return [cosine, sine, curvature + z[3], force[0] * sine - force[1] * cosine]

    found = solve_ivp(rates, (0.0, length), start, method="DOP853", rtol=TIGHT, atol=0.1 * TIGHT, dense_output=True)
    assert found.success
    return np.asarray(found.sol(places))


def stored(start: Array, force: Array, length: float, curvature: float = 0.0) -> float:
    """The strain energy ½ ∫ M² ds, by Gauss's quadrature."""
    node, weight = np.polynomial.legendre.leggauss(60)
    places = 0.5 * length * (node + 1.0)
    return float(0.25 * length * weight @ shape(start, force, length, curvature, places)[3] ** 2)
