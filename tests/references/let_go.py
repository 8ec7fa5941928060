"""A cantilever column beyond Euler's load that only a circle keeps from falling to the other side: where it lets go.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
L, EI    length, bending stiffness of the inextensible column; both are one here
P, Q     dead forces on its tip, against its first direction (which is x), and along y
ρ, c     radius of the circle and half the thickness together, and the circle's center
σ, N     arc length at which the column touches the circle, and the circle's force on it
M₀       moment in the column at the clamp
n        (sin θ, −cos θ) at σ, unit vector from c to the column
=======  =================================================================================

The circle lies above, the column bends up to it and under it.  From the clamp to σ it carries the force (−P, Q) + N n,
from σ to the tip (−P, Q).  The moment at the tip vanishes, the place at σ is c + ρ n, and n has the angle of the
tangent there: four equations in M₀, σ, that angle, N and Q.  As Q falls, N does, and vanishes at Q*.  What is left
there is an equilibrium of the column alone.  Beyond Euler's load it is the one between the two that are stable, with a
force Q* against the side to which the column bends.  So it is no minimum, and the column jumps.

For small deflections (k² = P/EI, π/2 < k L < π) the column alone is

    y(x) = (Q/P) (sin kx − kx + tan kL (1 − cos kx)) / k                                   (1)

Sources: L. D. Landau and E. M. Lifshitz, Theory of Elasticity, §19; S. P. Timoshenko and J. M. Gere, Theory of Elastic
Stability, chapter 1 (1).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from tests.references.columns import bent
from tests.references.rod import carried, stored

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class State:
    """M₀, σ, the tangent angle there, N and Q, and the column at σ and at the tip: x, y, θ, M."""

    moment: float
    touch: float
    angle: float
    pressing: float
    side_force: float
    touching: Array
    tip: Array


@dataclass(frozen=True)
class Held:
    """The column under P L²/EI and the circle: c and ρ over L."""

    load: float
    center: tuple[float, float]
    radius: float

    def let_go(self) -> State:
        """Where the circle presses no longer."""
        k, x = np.sqrt(self.load), self.center[0]
        rise = (np.sin(k * x) - k * x + np.tan(k) * (1.0 - np.cos(k * x))) / k  # (1)
        Q = self.load * (self.center[1] - self.radius) / rise
        return self._solved([Q / self.load * k * np.tan(k), x, 0.0, Q], lambda N, Q: N)

    def under(self, side_force: float) -> State:
        """The column on the circle under Q."""
        free = self.let_go()
        guess = [free.moment, free.touch, free.angle, free.side_force]
        return self._solved(guess, lambda N, Q: Q - side_force)

    def fallen(self, side_force: float) -> State:
        """The column without the circle, bent to the other side as by its load alone; its σ is half way."""
        # (1) of tests.references.columns: M₀ = P w
        moment = -self.load * bent("cantilever", self.load).deflection

        def excess(X: Array) -> Array:
            return self._carried(X[0], 0.5, 0.0, 0.0, side_force)[1][3:]

        found = root(excess, [moment], tol=1e-13)
        assert found.success, found.message
        touching, tip = self._carried(found.x[0], 0.5, 0.0, 0.0, side_force)
        return State(float(found.x[0]), 0.5, 0.0, 0.0, side_force, touching, tip)

    def energy(self, state: State) -> float:
        """What the column stores less the work of P and Q, for a state in which no circle presses."""
        force = np.array([-self.load, state.side_force])
        bending = stored(np.array([0.0, 0.0, 0.0, state.moment]), force, 1.0)
        return float(bending - force @ [state.tip[0] - 1.0, state.tip[1]])

    def _carried(self, moment: float, touch: float, angle: float, N: float, Q: float) -> tuple[Array, Array]:
        force, n = np.array([-self.load, Q]), np.array([np.sin(angle), -np.cos(angle)])
        touching, _ = carried(np.array([0.0, 0.0, 0.0, moment]), force + N * n, touch, 0.0)
        tip, _ = carried(touching, force, 1.0 - touch, 0.0)
        return touching, tip

    def _solved(self, guess: list[float], given: Callable[[float, float], float]) -> State:
        """The solution near M₀, σ, the angle and Q, N = 0, at which ``given`` of N and Q vanishes."""

        def excess(X: Array) -> Array:
            moment, touch, angle, Q, N = X
            touching, tip = self._carried(moment, touch, angle, N, Q)
            place = self.center + self.radius * np.array([np.sin(angle), -np.cos(angle)])
            return np.array([*(touching[:2] - place), touching[2] - angle, tip[3], given(N, Q)])

        found = root(excess, [*guess, 0.0], tol=1e-13)
        assert found.success, found.message
        moment, touch, angle, Q, N = (float(value) for value in found.x)
        return State(moment, touch, angle, N, Q, *self._carried(moment, touch, angle, N, Q))
