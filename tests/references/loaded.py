"""The inextensible cantilever under dead loads along it, by shooting.

=======  =================================================================================
symbol   meaning (lengths over the beam's, forces over EI/L², distributed ones over EI/L³)
=======  =================================================================================
θ, m     tangent angle and bending moment by arc length; κ⁰ stress-free curvature
F        what the part beyond s bears: forces beyond it and distributed loads beyond it
=======  =================================================================================

    dθ/ds = κ⁰ + m,   dm/ds = F_x sin θ − F_y cos θ,   dx/ds = cos θ,   dy/ds = sin θ,   m(1) = 0

S. S. Antman, Nonlinear Problems of Elasticity, ch. IV.  Integrated from end to end in pieces between the loads.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import simpson, solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from tests.references.integrated import end_of

POINTS = 801  # of a piece between loads


@dataclass(frozen=True, slots=True)
class Loaded:
    """Of the bent beam: the tip's place and angle, what the clamp bears, the energy, and the moment by arc length."""

    tip: np.ndarray
    angle: float
    clamp_force: np.ndarray
    clamp_moment: float
    energy: float
    places: np.ndarray
    moments: np.ndarray

    def moment(self, s):
        """m at arc lengths; where it has a kink, at a force, it is known."""
        found = np.interp(s, self.places, self.moments)
        for piece in np.split(np.arange(self.places.size), np.flatnonzero(np.diff(self.places) == 0.0) + 1):
            inside = (s >= self.places[piece[0]]) & (s <= self.places[piece[-1]])
            found[inside] = CubicSpline(self.places[piece], self.moments[piece])(s[inside])
        return found


def loaded(
    forces: Sequence[tuple[float, float, float]] = (),
    distributed: Sequence[tuple[float, float, float, float]] = (),
    curvature: float = 0.0,
) -> Loaded:
    """The state reached from rest.

    Args:
        forces: (s, F_x, F_y) each; distributed: (from, to, q_x, q_y) each.
        curvature: κ⁰, even; the beam begins along x.
    """
    fence = sorted({0.0, 1.0, *(s for s, *_ in forces), *(s for b, e, *_ in distributed for s in (b, e))})

    def beyond(s):
        F = sum((np.array([x, y]) for at, x, y in forces if at > s), np.zeros(2))
        for begin, end, x, y in distributed:
            F = F + max(0.0, end - max(s, begin)) * np.array([x, y])
        return F

    def rates(s, state, begin, low, slope):
        theta, m = state[:2]
        F = low - slope * (s - begin)
        cos, sin = math.cos(theta), math.sin(theta)
        return [curvature + m, F[0] * sin - F[1] * cos, cos, sin, 0.5 * m * m]

    def stretches(share):
        for begin, end in pairwise(fence):
            low, high = beyond(begin + 1e-12 * (end - begin)), beyond(0.5 * (begin + end))
            yield begin, end, (begin, share * low, share * (low - high) / (0.5 * (end - begin)))

    def end_moment(moment, share):
        state = np.array([0.0, moment, 0.0, 0.0, 0.0])
        for begin, end, args in stretches(share):
            state = end_of(lambda s, state, args=args: rates(s, state, *args), (begin, end), state)
        return state[1]

    def shot(moment):
        state, pieces = np.array([0.0, moment, 0.0, 0.0, 0.0]), []
        for begin, end, args in stretches(1.0):
            s = np.linspace(begin, end, POINTS)
            found = solve_ivp(rates, (begin, end), state, "DOP853", s, args=args, rtol=1e-12, atol=1e-13)
            state = found.y[:, -1]
            pieces.append((s, found.y))
        return state, pieces

    moment = last = 0.0
    for share in np.arange(1, 21) / 20.0:
        # the root that is next to the one before
        guess, step = 2.0 * moment - last, 0.02
        last = moment

        def missing(m, share=share):
            return end_moment(m, share)

        while missing(guess - step) * missing(guess + step) > 0.0:
            step *= 1.5
        moment = brentq(missing, guess - step, guess + step, xtol=1e-14, rtol=1e-14)
    end, pieces = shot(moment)
    work = 0.0
    for s, y in pieces:
        half = 0.5 * curvature * s
        moved = y[2:4] - s * np.sinc(half / np.pi) * np.stack([np.cos(half), np.sin(half)])
        work += sum(fx * moved[0, -1] + fy * moved[1, -1] for at, fx, fy in forces if at == s[-1])
        for begin, stop, qx, qy in distributed:
            if begin <= s[0] and s[-1] <= stop:
                work += simpson(qx * moved[0] + qy * moved[1], x=s)
    s, m = np.concatenate([s for s, _ in pieces]), np.concatenate([y[1] for _, y in pieces])
    return Loaded(
        tip=end[2:4],
        angle=float(end[0]),
        clamp_force=-beyond(-1e-12),
        clamp_moment=-float(moment),
        energy=float(end[4]) - work,
        places=s,
        moments=m,
    )
