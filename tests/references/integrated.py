"""Integration of ordinary differential equations to the end of an interval, by compiled code."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import ode

Array = NDArray[np.float64]

MOST_STEPS = 100_000


def end_of(
    slope: Callable[[float, Array], Sequence[float] | Array],
    span: tuple[float, float],
    start: Sequence[float] | Array,
    rtol: float = 1e-12,
    atol: float = 1e-13,
) -> Array:
    """The state (n,) at the end of a ``span``, from the state at its start.

    The method is Dormand and Prince's of eighth order, as ``DOP853`` of ``solve_ivp``, whose steps run in Python.

    Raises:
        RuntimeError: the integration did not reach the end.
    """
    begin, stop = span
    if begin == stop:
        return np.array(start, dtype=float)
    solver = ode(slope).set_integrator("dop853", rtol=rtol, atol=atol, nsteps=MOST_STEPS)
    found = solver.set_initial_value(start, begin).integrate(stop)
    if not solver.successful():
        raise RuntimeError(f"no end was reached from {begin} to {stop}")
    return np.array(found)
