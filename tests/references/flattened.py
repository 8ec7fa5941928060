"""An arc that touches a plane at its start and is pressed flat on it from there by a force at its tip.

======  ==========================================================================================
κ₀      stress-free curvature of the arc, away from the plane
c, b    length that lies flat; the rest, c + b = L
F       force at the tip, towards the plane
θ, ξ    tangent angle against the plane along the rest, from where it lifts off
======  ==========================================================================================

Flat, the beam has the moment EI κ₀ everywhere, and so no shear: the plane presses where it ends, with F, and nowhere
else.  Beyond, EI θ″ = F cos θ with θ = θ′ = 0 at the lift-off, up to the tip without moment, θ′ = κ₀.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.integrate import solve_ivp


@dataclass(frozen=True)
class Flattened:
    """The beam, all SI; ``radius`` is 1/κ₀."""

    length: float
    rigidity: float
    radius: float
    force: float

    @cached_property
    def _tip(self) -> tuple[float, float, float, float, float]:
        """b, and θ, x, y and the bending energy at the tip, x and y from the lift-off."""
        kappa, stiffness = 1.0 / self.radius, self.rigidity

        def slope(_: float, z: np.ndarray) -> list[float]:
            theta, bent = z[0], z[1]
            energy = 0.5 * stiffness * (bent - kappa) ** 2
            return [bent, self.force * np.cos(theta) / stiffness, np.cos(theta), np.sin(theta), energy]

        def without_moment(_: float, z: np.ndarray) -> float:
            return float(z[1] - kappa)

        without_moment.terminal = True  # type: ignore[attr-defined]
        found = solve_ivp(slope, (0.0, self.length), np.zeros(5), events=without_moment, rtol=1e-12, atol=1e-15)
        assert found.status == 1, "not flat anywhere"
        z = found.y[:, -1]
        return float(found.t[-1]), float(z[0]), float(z[2]), float(z[3]), float(z[4])

    @property
    def flat(self) -> float:
        """c."""
        return self.length - self._tip[0]

    @property
    def tip(self) -> tuple[float, float]:
        """Place of the tip, x along the plane from the beam's start and y away from it."""
        return self.flat + self._tip[2], self._tip[3]

    @property
    def moment(self) -> float:
        """That which holds the start: EI κ₀, by a stop or a clamp there."""
        return self.rigidity / self.radius

    @property
    def about_start(self) -> float:
        """That of the plane about the start, by statics: what F has there, being all else that acts."""
        return self.force * self.tip[0]

    @property
    def drawn(self) -> tuple[float, float]:
        """Place of the tip of the stress-free arc."""
        turn = self.length / self.radius
        return self.radius * float(np.sin(turn)), self.radius * float(1.0 - np.cos(turn))

    @property
    def energy(self) -> float:
        """Of bending."""
        return float(0.5 * self.rigidity / self.radius**2 * self.flat + self._tip[4])
