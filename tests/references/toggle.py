"""A lever that a bowed beam between two pins holds up: the moment that pushes it over the centre.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
L, EI    length, bending stiffness of the inextensible beam; both are one here
κ⁰       its curvature free of stress, that of a circular arc
b, ℓ     distance of the lever's pivot and the ground's pin, and of the pivot and the lever's pin
ψ        angle at the pivot between those two directions
d        distance of the beam's pins, d² = b² + ℓ² − 2 b ℓ cos ψ
N        thrust in the line of its pins
M        dead moment that turns the lever towards ψ = 0
θ, ε     tangent angle from the line of the pins, from the middle of the beam; ε = θ at a pin
=======  =================================================================================

Only the thrust bends the beam: θ'' = −N sin θ, with θ' = κ⁰ at the pins, where there is no moment.  Hence

    ½ θ'² = ½ κ⁰² + N (cos θ − cos ε) = ½ g(θ)                                             (1)
    ½ = ∫ dθ/√g,    ½ d = ∫ cos θ dθ/√g,    both from 0 to ε                               (2)

(2) gives ε and d for every N, by quadrature of smooth functions (θ = ε t).  The work of M is what the beam stores:

    M = N ∂d/∂ψ = N b ℓ sin ψ / d                                                          (3)

M rises from nothing, where the beam is an arc, and vanishes again at ψ = 0: the branch folds at the largest M.

Source: L. D. Landau and E. M. Lifshitz, Theory of Elasticity, §19, for (1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq


@dataclass(frozen=True, slots=True)
class State:
    """N, ε, d, ψ and M, without dimension."""

    thrust: float
    pin_angle: float
    distance: float
    lever: float
    moment: float


@dataclass(frozen=True)
class Toggle:
    """The beam by the angle κ⁰ L of its arc, rad, and b and ℓ over L."""

    arc: float
    base: float
    arm: float

    def under(self, thrust: float) -> State:
        """The lever held by a beam with N < 4 π²."""
        return self._state(thrust)[0]

    def fold(self) -> State:
        """Where M is largest."""
        centre = self._at_the_centre() * (1.0 - 1e-9)
        largest = brentq(lambda N: self._state(N)[1], 1e-6, centre, xtol=1e-14, rtol=1e-14)
        return self.under(float(largest))

    def beyond(self, moment: float) -> State:
        """The lever on the other side, pulling at the beam: ψ < 0 and N < 0 under M > 0."""
        thrust = brentq(lambda N: self.under(N).moment - moment, -20.0, -1e-9, xtol=1e-14, rtol=1e-14)
        return self.under(float(thrust))

    def _at_the_centre(self) -> float:
        """N at ψ = 0."""
        return float(brentq(lambda N: self._bowed(N)[1] - (self.base - self.arm), 0.0, 4.0 * np.pi**2))

    def _bowed(self, N: float) -> tuple[float, float, float]:
        """ε, d and ∂d/∂N."""
        t, weight = np.polynomial.legendre.leggauss(60)
        t, weight = 0.5 * (t + 1.0), 0.5 * weight

        def arc_and_chord(epsilon: float) -> tuple[float, float, float, float, float, float]:
            """The integrals of (2), and their derivatives by N and by ε."""
            cos, sin = np.cos(epsilon * t), np.sin(epsilon * t)
            g = self.arc**2 + 2.0 * N * (cos - np.cos(epsilon))
            f = epsilon / np.sqrt(g)
            f_N = -(cos - np.cos(epsilon)) * f / g
            f_epsilon = f / epsilon - N * (np.sin(epsilon) - t * sin) * f / g
            chord = (cos * f, cos * f_N, cos * f_epsilon - t * sin * f)
            return tuple(float(weight @ values) for values in (f, f_N, f_epsilon, *chord))  # type: ignore[return-value]

        # g(0) > 0 bounds ε of a beam that is pulled
        most = np.pi if N >= 0.0 else np.arccos(max(-1.0, 1.0 + (1.0 - 1e-6) * self.arc**2 / (2.0 * N)))
        epsilon = float(brentq(lambda e: arc_and_chord(e)[0] - 0.5, 1e-3, most, xtol=1e-15, rtol=1e-15))
        _, a_N, a_epsilon, chord, c_N, c_epsilon = arc_and_chord(epsilon)
        return epsilon, 2.0 * chord, 2.0 * (c_N - c_epsilon * a_N / a_epsilon)

    def _state(self, N: float) -> tuple[State, float]:
        """The lever, and ∂M/∂N."""
        epsilon, d, slope = self._bowed(N)
        product = self.base * self.arm
        psi = float(np.copysign(np.arccos((self.base**2 + self.arm**2 - d**2) / (2.0 * product)), N))
        lever = product * np.sin(psi) / d  # (3), ∂d/∂ψ
        return State(N, epsilon, d, psi, N * lever), lever + N * (1.0 / np.tan(psi) - lever / d) * slope
