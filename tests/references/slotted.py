"""The inextensible cantilever whose tip carries a rigid arm with a pin in a slot, by shooting.

=======  =================================================================================
symbol   meaning (lengths over the beam's, forces over EI/L²)
=======  =================================================================================
θ, m     tangent angle and bending moment by arc length, zero angle at the clamp
F        force on the pin: P along the slot, and what the slot exerts across
e, n     direction of the slot and across
r        from the tip to the pin while the beam is straight along x, turned with the tip
=======  =================================================================================

    dθ/ds = m,   dm/ds = F_x sin θ − F_y cos θ,   dx/ds = cos θ,   dy/ds = sin θ,
    m(1) = (R r) × F,   n·(x(1) + R r) = n·((1, 0) + r),   e·F = P
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import fsolve

from tests.references.integrated import end_of


@dataclass(frozen=True, slots=True)
class Slotted:
    """The pin's way along the slot, the tip's rotation, force (2,) on the pin, and the moment at the clamp."""

    way: float
    rotation: float
    force: np.ndarray
    clamp_moment: float


def slotted(slot: float, arm: tuple[float, float], load: float, steps: int = 8) -> Slotted:
    """Where the pin goes under a load P along a slot at an angle, reached from rest in even steps."""
    e, n = np.array([np.cos(slot), np.sin(slot)]), np.array([-np.sin(slot), np.cos(slot)])
    r, rest = np.array(arm), np.array([1.0, 0.0]) + arm

    def shot(unknown, P):
        across, moment = unknown
        F = P * e + across * n

        def rates(_, state):
            theta, m = state[:2]
            cos, sin = np.cos(theta), np.sin(theta)
            return [m, F[0] * sin - F[1] * cos, cos, sin]

        end = end_of(rates, (0.0, 1.0), [0.0, moment, 0.0, 0.0], rtol=1e-13, atol=1e-14)
        cos, sin = np.cos(end[0]), np.sin(end[0])
        turned = np.array([cos * r[0] - sin * r[1], sin * r[0] + cos * r[1]])
        return F, end, end[2:] + turned, turned

    def missing(unknown, P):
        F, end, pin, turned = shot(unknown, P)
        return [end[1] - (turned[0] * F[1] - turned[1] * F[0]), n @ (pin - rest)]

    unknown = np.zeros(2)
    for P in load * np.arange(1, steps + 1) / steps:
        unknown = fsolve(missing, unknown, args=(P,), xtol=1e-13)
    assert np.max(np.abs(missing(unknown, load))) < 1e-11
    F, end, pin, _ = shot(unknown, load)
    return Slotted(float(e @ (pin - rest)), float(end[0]), F, float(unknown[1]))
