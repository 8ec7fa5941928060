"""A clamped arc that a moment presses on a corner, its far end on a slide that does not turn; a line, inextensible.

========  ============================================================================================
symbol    meaning
========  ============================================================================================
θ, κ⁰     tangent angle, and the curvature at rest
M, F      bending moment and force that what lies beyond exerts; m the moment at s_m
s_c, P    where the corner C presses, and how hard, along the line's right normal
========  ============================================================================================

    θ′ = κ⁰ + M/EI,   x′ = t(θ),   M′ = −t × F,

M falls by m behind s_m, F by P times the normal behind s_c.  Five unknowns (M and F at the clamp, s_c, P), five
conditions: the line goes through C there, and ends unturned, on the slide, with no force along it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

from tests.references.integrated import end_of

E, THICKNESS, WIDTH = 1.37e9, 8.65e-4, 0.0409
EI = E * WIDTH * THICKNESS**3 / 12.0
CENTER, END, CORNER = 0.14628449977195304 + 0.023485649664096414j, 0.082445 + 0.157184j, 0.06823 + 0.144699j
ALONG = complex(0.7083, -0.7059) / abs(complex(0.7083, -0.7059))
AT = 0.81
RADIUS = abs(CENTER)
TURN = -float(np.angle((END - CENTER) / -CENTER))  # clockwise
LENGTH = RADIUS * TURN
BEGUN = float(np.angle(1j * CENTER))  # the tangent at the clamp


@dataclass(frozen=True)
class Pressed:
    """How far the end has gone along the slide, m, and the corner's force, N."""

    gone: float
    force: float


def pressed(m: float) -> Pressed:
    """The state under a moment of about −0.208 N·m: the line is taut, and one begins close by or finds nothing.

    Raises:
        RuntimeError: none was found.
    """
    scales = np.array([EI / LENGTH, EI / LENGTH**2, EI / LENGTH**2, LENGTH, EI / LENGTH**2])
    found = root(
        lambda q: _missed(m, *(q * scales))[0], np.array([-0.0396, 1.7, 5.7, 0.1705, 2.95]) / scales, tol=1e-10
    )
    if not found.success:
        raise RuntimeError(found.message)
    q = found.x * scales
    return Pressed(_missed(m, *q)[1], float(q[4]))


def _missed(m: float, M: float, fx: float, fy: float, s_c: float, P: float) -> tuple[np.ndarray, float]:
    """What the conditions miss, without units, and how far the end has gone."""
    y, force, s_m, s = np.array([BEGUN, M, 0.0, 0.0]), complex(fx, fy), AT * LENGTH, 0.0
    at_corner = 0j
    for place in sorted((s_m, s_c, LENGTH)):
        y, s = _onwards(y, force, s, place), place
        if place == s_m:
            y[1] -= m
        elif place == s_c:
            at_corner = complex(y[2], y[3])
            force -= P * -1j * np.exp(1j * y[0]) * _SIDE
    off = at_corner - CORNER
    gone = complex(y[2], y[3]) - END
    along = gone * np.conj(ALONG)
    missed = [
        off.real / LENGTH,
        off.imag / LENGTH,
        y[0] - (BEGUN - TURN),
        along.imag / LENGTH,
        (force * np.conj(ALONG)).real * LENGTH**2 / EI,
    ]
    return np.array(missed), float(along.real)


_SIDE = -1.0  # the corner is on the right of the line and presses it to the left


def _onwards(y: np.ndarray, force: complex, begin: float, end: float) -> np.ndarray:
    def change(_s: float, y: np.ndarray) -> tuple[float, float, float, float]:
        tangent = np.exp(1j * y[0])
        return -1.0 / RADIUS + y[1] / EI, -float((np.conj(tangent) * force).imag), tangent.real, tangent.imag

    return np.array(end_of(change, (begin, end), y, atol=1e-14))
