"""The derivative of what is known at stations, and how far off it may be.

==========  ==========================================================================================
symbol      meaning
==========  ==========================================================================================
x_i, f_i    stations (n,) in one stretch, and a function's values there
ε_i         what round-off leaves of f_i
D_k         derivative of the polynomial through the k stations next to the one asked
w_i         its weights: D_k = Σ w_i f_i
==========  ==========================================================================================

D_k of a smooth function is off by a multiple of h^(k−1) with h the distance of the stations.  The value is D_k of as
many stations as there are, nine at most; |D_k − D_(k−2)| is what the lower order is off, which is more than the value
is.  Where the function has a kink it shows that, and bounds nothing.  Round-off leaves Σ |w_i| ε_i.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import KroghInterpolator

from cprbm_scene.answer import Array

MOST = 9
"""Stations that the derivative at one of them takes."""

FEWEST = 4
"""With fewer in a stretch there are no two orders to be compared."""


@dataclass(frozen=True, slots=True)
class Slope:
    """A derivative: its ``value``, how far two orders are apart (``truncation``), what ``round_off`` leaves of it."""

    value: float
    truncation: float
    round_off: float


def slope(x: Array, f: Array, rounding: Array, place: int) -> Slope | None:
    """The derivative of f at a station; None where fewer than :data:`FEWEST` are known.

    Args:
        x: stations (n,), no two alike.
        f: values there (n,).
        rounding: ε (n,), none negative.
        place: index of the station.
    """
    if len(x) < FEWEST:
        return None
    most = min(MOST, len(x))
    w, lower = (_weights(x, place, count) for count in (most, most - 2))
    value = float(w @ f)
    return Slope(value, float(abs(value - lower @ f)), float(np.abs(w) @ rounding))


def _weights(x: Array, place: int, count: int) -> Array:
    """w (n,) of the derivative at a station from ``count`` next to it; zero elsewhere."""
    first = min(max(place - count // 2, 0), len(x) - count)
    near = slice(first, first + count)
    h = float(np.max(np.abs(x[near] - x[place])))
    w = np.zeros(len(x))
    w[near] = KroghInterpolator((x[near] - x[place]) / h, np.eye(count)).derivative(0.0) / h
    return w
