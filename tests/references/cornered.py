"""A cantilever that a dead force at its tip presses over a corner, by shooting.

======  ==========================================================================================
a, b    place of the corner, the clamp at the origin and the beam along x
w       half of the beam's thickness, zero for a line
s       arc length of the neutral line's place that is w from the corner, along its normal
θ, M    tangent angle and bending moment; EI = L = 1
P, N    the force at the tip, downwards, and that of the corner, along the normal n = (−sin θ, cos θ)
F       force on what follows: (0, −P) beyond the corner, and N n more before it
======  ==========================================================================================

    θ' = M,    M' = F_x sin θ − F_y cos θ,    (x, y)' = (cos θ, sin θ),    w' = M²/2

from θ = x = y = 0 with M(0), N and s such that (x, y) − w n is the corner at s and M vanishes at the tip.

Source: L. D. Landau and E. M. Lifshitz, Theory of Elasticity, §19.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import fsolve

from tests.references.integrated import end_of

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Cornered:
    """The beam over a ``corner`` (a, b), half of whose thickness is ``half``, under P = ``force``."""

    force: float
    corner: tuple[float, float]
    half: float = 0.0

    @property
    def place(self) -> float:
        """s."""
        return float(self._found[0])

    @property
    def pressed(self) -> float:
        """N."""
        return float(self._found[1])

    @property
    def leaning(self) -> float:
        """θ(s)."""
        return float(self._found[3])

    @property
    def tip(self) -> Array:
        """Its place (2,)."""
        return self._marched(self._found)[1][2:4]

    @property
    def potential_energy(self) -> float:
        """Strain energy less what P does from the straight beam on."""
        before, tip = self._marched(self._found)
        return float(before[4] + tip[4]) + self.force * float(tip[3])

    def _marched(self, guess: Array) -> tuple[Array, Array]:
        s, N, M, theta = guess
        after = np.array([0.0, -self.force])
        push = N * np.array([-np.sin(theta), np.cos(theta)])
        before = _carried(after + push, (0.0, s), np.array([0.0, M, 0.0, 0.0, 0.0]))
        return before, _carried(after, (s, 1.0), np.array([*before[:4], 0.0]))

    @cached_property
    def _found(self) -> Array:
        """s, N, M(0) and θ(s)."""

        def missed(guess: Array) -> list[float]:
            at, tip = self._marched(guess)
            theta = guess[3]
            x, y = at[2] + self.half * np.sin(theta), at[3] - self.half * np.cos(theta)
            return [x - self.corner[0], y - self.corner[1], tip[1], at[0] - theta]

        found, _, _, said = fsolve(missed, [self.corner[0], 2.0 * self.force, -0.5, -0.3], full_output=True, xtol=1e-13)
        assert np.max(np.abs(missed(found))) < 1e-9, said
        return np.asarray(found)


def _carried(force: Array, span: tuple[float, float], start: Array) -> Array:
    def slopes(_: float, v: Array) -> list[float]:
        theta, M = v[:2]
        cos, sin = np.cos(theta), np.sin(theta)
        return [M, force[0] * sin - force[1] * cos, cos, sin, 0.5 * M**2]

    return end_of(slopes, span, start)
