"""The inextensible cantilever that is free of stress along a graph x = f(y) or y = f(x), by shooting.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
v        variable of the graph, from the clamp to the tip; independent variable throughout
θ⁰, θ    tangent angle of the graph and of the bent beam
ψ        θ − θ⁰, rotation of the section
M        bending moment; F, M_t force and moment at the tip
s        arc length, ds = √(1 + f'²) |dv|
=======  =================================================================================

    dψ/ds = M/EI,   dM/ds = F_x sin θ − F_y cos θ,   dx/ds = cos θ,   dy/ds = sin θ,
    ψ = 0 at the clamp, M = M_t at the tip

No arc length, curvature or discretisation of the code under test is used: the graph enters by f' alone, and the
unknown moment at the clamp is found by the secant method on an integration of eighth order.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root_scalar


@dataclass(frozen=True, slots=True)
class Bent:
    """The tip's displacement and rotation, and the moment at the clamp; as many units as went in."""

    displacement: np.ndarray
    rotation: float
    clamp_moment: float


def bent(
    slope: Callable[[float], float],
    axis: str,
    span: tuple[float, float],
    rigidity: float,
    force: tuple[float, float] = (0.0, 0.0),
    moment: float = 0.0,
    clamp_moment: float | None = None,
) -> Bent:
    """Where the tip goes.

    Args:
        slope: f'; axis: the variable, ``x`` or ``y``; span: its values at the clamp and at the tip.
        rigidity: EI; force, moment: at the tip.
        clamp_moment: where the search for it begins; without it, at the moment of the loads on the unbent beam.

    Returns:
        The tip, held to about 1e-11 of the length.
    """
    sense = np.sign(span[1] - span[0])

    def graph(v):
        along, across = sense, sense * slope(v)
        return (along, across) if axis == "x" else (across, along)

    def derivative(v, state):
        psi, M = state[:2]
        dx0, dy0 = graph(v)
        ds = np.hypot(dx0, dy0)
        theta = np.arctan2(dy0, dx0) + psi
        cos, sin = np.cos(theta), np.sin(theta)
        # displacement rather than place: the undeformed part drops out without round-off
        rates = (M / rigidity * ds, (force[0] * sin - force[1] * cos) * ds, cos * ds - dx0, sin * ds - dy0, dx0, dy0)
        return np.array(rates) * sense

    def shoot(start):
        size = abs(span[1] - span[0])
        scale = np.array([1.0, rigidity / size, size, size, size, size])
        found = solve_ivp(
            derivative, span, [0.0, start, 0.0, 0.0, 0.0, 0.0], method="DOP853", rtol=1e-13, atol=1e-14 * scale
        )
        assert found.success
        return found.y[:, -1]

    unbent = shoot(0.0)[4:]
    guess = moment + force[1] * unbent[0] - force[0] * unbent[1] if clamp_moment is None else clamp_moment
    start = guess
    if force != (0.0, 0.0):
        solved = root_scalar(
            lambda start: shoot(start)[1] - moment, x0=guess, x1=0.97 * guess, method="secant", xtol=1e-15, rtol=1e-13
        )
        assert solved.converged
        start = solved.root
    end = shoot(start)
    assert abs(end[1] - moment) < 1e-10 * max(abs(start), abs(moment))
    return Bent(displacement=end[2:4], rotation=float(end[0]), clamp_moment=float(start))
