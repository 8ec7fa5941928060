"""A straight inextensible cantilever whose section varies along it, with a dead force and a moment at its tip.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
L        length; the undeformed beam runs along +x from the clamp
t, w     thickness and width, given at fractions of the length, straight lines between
EI       E w t³/12 at the place
F, M₁    dead force and moment at the tip, counter-clockwise
M, θ     bending moment and tangent angle at s; ψ = θ(L)
=======  =================================================================================

Statics of the piece between s and the tip: M' = F_x sin θ − F_y cos θ, M(L) = M₁; and θ' = M/(EI), x' = cos θ,
y' = sin θ.  Integrated from the tip with a guess of ψ, piece by piece between the kinks of the section, by the
Runge–Kutta method of order 8; ψ is such that θ(0) = 0.  (Euler's elastica; e.g. Landau and Lifshitz, Theory of
Elasticity, §19.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tests.references.integrated import end_of

Array = NDArray[np.float64]
Sizes = tuple[tuple[float, ...], tuple[float, ...]]  # fractions, and values there
Beam = tuple[float, float, Sizes, Sizes]  # L, E, t, w


@dataclass(frozen=True, slots=True)
class Bent:
    """What the cantilever does, SI: the tip's place and angle, M at ``fractions``, strain energy less work."""

    x: float
    y: float
    angle: float
    moment: Array
    stress: Array
    energy: float


def bent(
    length: float,
    youngs_modulus: float,
    thickness: Sizes,
    width: Sizes,
    force: tuple[float, float],
    moment: float,
    fractions: Array,
) -> Bent:
    """Solve by shooting along a path of growing loads, to about 1e-11.

    Args:
        length, youngs_modulus: L and E.
        thickness, width: t and w.
        force, moment: F and M₁ at the tip.
        fractions: of the length, ascending, at which the moment is wanted, (k,).
    """
    sizes = (length, youngs_modulus, thickness, width)
    nothing = np.zeros(0)
    psi, before = 0.0, 0.0
    for share in np.linspace(0.0, 1.0, 9)[1:]:

        def miss(psi: float, share: float = float(share)) -> float:
            return float(_from_tip(sizes, psi, (share * force[0], share * force[1]), share * moment, nothing)[0][0])

        # the next angle lies near the continued one
        guess, width_of_search = 2.0 * psi - before, 0.05
        while miss(guess - width_of_search) * miss(guess + width_of_search) > 0.0:
            width_of_search *= 2.0
        psi, before = (
            float(brentq(miss, guess - width_of_search, guess + width_of_search, xtol=1e-14, rtol=1e-14)),
            psi,
        )
    return _bent(sizes, psi, force, moment, fractions)


def guided(
    length: float,
    youngs_modulus: float,
    thickness: Sizes,
    width: Sizes,
    force: tuple[float, float],
    fractions: Array,
) -> tuple[Bent, float]:
    """The same where the tip is kept from turning: ψ = 0, and M₁ is such that θ(0) = 0; M₁ is the second answer.

    Arguments as of :func:`bent`.
    """
    sizes = (length, youngs_modulus, thickness, width)
    nothing = np.zeros(0)

    def miss(moment: float) -> float:
        return float(_from_tip(sizes, 0.0, force, moment, nothing)[0][0])

    # of an even beam under a small force M₁ = −F_y L/2; a neck near one end lets it have more or less
    low, high = sorted((0.0, -force[1] * length))
    moment = float(brentq(miss, low, high, xtol=1e-16, rtol=1e-14))
    return _bent(sizes, 0.0, force, moment, fractions), moment


def _section(sizes: Beam, s: Array | float) -> tuple[Array, Array]:
    """t and EI at places s from the clamp."""
    length, youngs_modulus, thickness, width = sizes
    t, w = np.interp(s / length, *thickness), np.interp(s / length, *width)
    return t, youngs_modulus * w * t**3 / 12.0


def _from_tip(sizes: Beam, psi: float, force: tuple[float, float], moment: float, at: Array) -> tuple[Array, Array]:
    """(θ, M, x, y, energy) at the clamp, x and y from the tip; and M at places ``at``."""
    length, _, thickness, width = sizes
    fx, fy = force
    knots = np.union1d(thickness[0], width[0])

    def rates(s: float, z: Array) -> list[float]:
        stiffness = float(_section(sizes, s)[1])
        turn = z[1] / stiffness
        sin, cos = np.sin(z[0]), np.cos(z[0])
        return [turn, fx * sin - fy * cos, cos, sin, 0.5 * z[1] * turn]

    z, found = np.array([psi, moment, 0.0, 0.0, 0.0]), np.empty(len(at))
    scales = np.array([1.0, abs(moment) + np.hypot(*force) * length, length, length, abs(moment) + 1e-30])
    for high, low in zip(knots[:0:-1] * length, knots[-2::-1] * length, strict=True):
        here = (at >= low) & (at <= high)
        if here.any():
            solved = solve_ivp(rates, (high, low), z, "DOP853", rtol=1e-12, atol=1e-13 * scales, dense_output=True)
            found[here] = solved.sol(at[here])[1]
            z = solved.y[:, -1]
        else:
            z = scales * end_of(lambda s, u: np.array(rates(s, scales * u)) / scales, (high, low), z / scales)
    return z, found


def _bent(sizes: Beam, psi: float, force: tuple[float, float], moment: float, fractions: Array) -> Bent:
    length, youngs_modulus, _, _ = sizes
    at = np.asarray(fractions) * length
    clamp, moments = _from_tip(sizes, psi, force, moment, at)
    x, y = -clamp[2], -clamp[3]
    t, stiffness = _section(sizes, at)
    work = force[0] * (x - length) + force[1] * y + moment * psi
    stress = 0.5 * youngs_modulus * t * moments / stiffness
    return Bent(float(x), float(y), psi, moments, stress, float(-clamp[4] - work))


def small_deflection(P: float, L: float, EI: float, taper: float) -> tuple[float, float]:
    """Deflection and rotation of the tip under a small transverse force P, t = t₀ (1 − taper s/L), EI at the clamp.

    With b = 1 − taper: w = P L³/(EI taper³) (−ln b − 3/2 + 2b − b²/2), θ = P L²/(2 EI b).  By integrating
    M/(EI) = P (L − s)/(EI (1 − taper s/L)³) twice with u = 1 − taper s/L (Timoshenko, Strength of Materials I).
    """
    b = 1.0 - taper
    return P * L**3 / (EI * taper**3) * (-np.log(b) - 1.5 + 2.0 * b - 0.5 * b**2), P * L**2 / (2.0 * EI * b)
