"""Two cantilevers from opposite sides: the free ends press the opposite sides at once, at an angle of half a radian.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
c       the middle: a half turn about c maps the beams to each other
s_Q, n  place of the other beam's end, from the root, and the normal there
F       contact force of either end
M       bending moment; θ tangent angle, κ⁰ curvature of the drawn line
======  =====================================================================================

A beam carries F n at s_Q from the opposite end.  The half turn maps the reaction on the opposite beam to the same force
F n at the beam's own end.  Hence the elastica

    θ' = κ⁰ + M/EI,     M' = −t × n k F,     k = 2 before s_Q and 1 behind it,     M(L) = 0,

with x(L) = 2 c − x(s_Q) + T n.  SciPy integrates it, and solves for M(0), F, s_Q and the angle of n.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

from tests.references.integrated import end_of

SPAN, REACH, RISE, BEND = 0.15, 0.1, 0.6, 6.0  # the upper is y = RISE x − BEND x² from 0 to REACH
START, LIFT = 0.0128, 0.006
THICKNESS, WIDTH, E = 0.001, 0.01, 2.0e11
EI = E * WIDTH * THICKNESS**3 / 12.0


@dataclass(frozen=True)
class Pressed:
    """Force of an end, N; place of the force and length of the beam, m; angle between end and side, rad."""

    force: float
    place: float
    length: float
    angle: float


def _length_to(slope: float) -> float:
    return (slope * np.hypot(1.0, slope) + np.arcsinh(slope)) / 2.0


def pressed() -> Pressed:
    """The state after the lift, with residuals below 1e-10."""
    length = (_length_to(RISE) - _length_to(RISE - 2.0 * BEND * REACH)) / (2.0 * BEND)
    middle = 0.5 * np.array([SPAN, START + LIFT])

    def shot(unknowns):
        moment, force, place, angle = unknowns[0], unknowns[1], unknowns[2] * length, unknowns[3]
        n = np.array([-np.sin(angle), np.cos(angle)])

        def rates(state, times):
            theta, M, drawn = state[2], state[3], state[4]  # drawn: tangent of the drawn line's angle
            curvature = -2.0 * BEND / (1.0 + drawn**2) ** 1.5
            turning = np.cos(theta) * n[1] - np.sin(theta) * n[0]
            return [
                np.cos(theta),
                np.sin(theta),
                curvature + M / EI,
                -times * force * turning,
                -2.0 * BEND / np.hypot(1.0, drawn),
            ]

        start = [0.0, 0.0, np.arctan(RISE), moment, RISE]
        there = end_of(lambda _, state: rates(state, 2.0), (0.0, place), start, rtol=1e-11, atol=1e-14)
        end = end_of(lambda _, state: rates(state, 1.0), (place, length), there, rtol=1e-11, atol=1e-14)
        off = end[:2] - (2.0 * middle - there[:2] + THICKNESS * n)
        return [*(off / REACH), there[2] - angle, end[3] * REACH / EI], end[2] - there[2]

    found = root(lambda unknowns: shot(unknowns)[0], [0.1, 1.0, 0.55, 0.0], tol=1e-13)
    residuals, angle = shot(found.x)
    if np.abs(residuals).max() > 1e-10:
        raise ArithmeticError(f"the elastica of both ends was not found: {found.message}")
    return Pressed(float(found.x[1]), float(found.x[2] * length), float(length), float(angle))
