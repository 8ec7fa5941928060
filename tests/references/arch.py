"""Symmetric inextensible circular arches with a vertical force or displacement at the crown: where their branch ends.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
R, a     radius and half the opening angle of the arch
P, w     dead force downwards at the crown, and the way the crown has come down
F        force of the right support on the right half: F_x, and F_y = P/2
κ⁰       −1/R: the right half is run through from the crown, clockwise
=======  =================================================================================

Within this module half the arch is the unit of length and EI/(a R)² that of force.  The right half begins at the
crown with x = θ = 0 and ends at the support with three rows E: x, y and the tangent angle (clamped) or moment (pinned).
Those are three equations in M, F_x and y of the crown and P.  A small change of an equilibrium that costs nothing is
symmetric about the crown, or antisymmetric; then x and θ of the crown change, and the share of P that the right half
carries, but not M and F_x, y nor P:

    symmetric, P given:     det ∂E/∂(M, F_x, y) = 0, a fold of the force                            (1)
    symmetric, w given:     det ∂E/∂(M, F_x, F_y) = 0, a fold of the displacement                   (2)
    antisymmetric:          det ∂E/∂(x, θ, F_y) = 0, a bifurcation under either                     (3)

The first of (1) or (2) and (3) on the way from the unloaded arch ends the stable branch.

Sources: S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability, chapter 7 (arches deflect sideways);
J. V. Huddleston, Finite deflections and snap-through of high circular arches, Journal of Applied Mechanics 35 (1968)
763-769; D. A. DaDeppo and R. Schmidt, Sidesway buckling of deep circular arches under a concentrated load, ibid. 36
(1969) 325-327.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tests.references.branch import Wanted, vanishing
from tests.references.rod import TIGHT, carried

Array = NDArray[np.float64]
Support = Literal["clamped", "pinned"]


@dataclass(frozen=True, slots=True)
class State:
    """An equilibrium of the symmetric branch: P R²/EI, w/R, the left support's F_x R²/EI and moment M R/EI.

    ``unknowns`` are M, F_x, y and P in the units of half the arch.
    """

    force: float
    displacement: float
    thrust: float
    moment: float
    unknowns: Array


@dataclass(frozen=True)
class Arch:
    """An arch by half its opening angle, rad, and what both ends stand on."""

    half_angle: float
    support: Support

    def end(self, X: Array, tolerance: float = TIGHT) -> tuple[Array, Array]:
        """E (3,) less what the support prescribes, and its derivatives (3, 6) by x, y, θ, M, F_x and F_y."""
        M, Fx, y, P = X
        a = self.half_angle
        end, D = carried(np.array([0.0, y, 0.0, M]), np.array([Fx, 0.5 * P]), 1.0, -a, tolerance)
        row, value = (2, -a) if self.support == "clamped" else (3, 0.0)
        return end[[0, 1, row]] - [np.sin(a) / a, np.cos(a) / a, value], D[[0, 1, row]]

    def equations(self, X: Array, tolerance: float) -> tuple[Array, Array]:
        """The three equations of the symmetric branch in M, F_x, y and P, and their derivatives (3, 4)."""
        E, D = self.end(X, tolerance)
        return E, np.column_stack((D[:, [3, 4, 1]], 0.5 * D[:, 5]))

    @cached_property
    def force_fold(self) -> State:
        """The first maximum of P on the symmetric branch (1)."""
        return self._first([3, 4, 1])

    @cached_property
    def displacement_fold(self) -> State:
        """The first maximum of w on the symmetric branch (2)."""
        return self._first([3, 4, 5])

    @cached_property
    def bifurcation(self) -> State:
        """Where the symmetric branch first meets another (3)."""
        return self._first([0, 2, 5])

    def _first(self, columns: list[int]) -> State:
        def wanted(X: Array, tolerance: float) -> float:
            return float(np.linalg.det(self.end(X, tolerance)[1][:, columns]))

        return self.state(self._vanishing(wanted))

    def at(self, force: float) -> State:
        """The first state of the symmetric branch with P R²/EI, of no more than the fold's."""
        return self.state(self._vanishing(lambda X, _: X[3] - force * self.half_angle**2))

    def _vanishing(self, wanted: Wanted) -> Array:
        start = np.array([0.0, 0.0, 1.0 / self.half_angle, 0.0])
        return vanishing(self.equations, wanted, start, np.array([0.0, 0.0, 0.0, 1.0]), 0.5, 200)

    def state(self, X: Array) -> State:
        """What X says, in units of R."""
        M, Fx, y, P = X
        a = self.half_angle
        end, _ = carried(np.array([0.0, y, 0.0, M]), np.array([Fx, 0.5 * P]), 1.0, -a)
        return State(P / a**2, 1.0 - a * y, -Fx / a**2, end[3] / a, X)
