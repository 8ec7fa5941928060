"""Where a beam's elements end and its springs stand, eqs. (2)-(3).

======  ===========================================================
xe_i    borders of the elements along the axis, even; or along y
xs_i    ½(xe_{i−1} + xe_i), springs; ys_i = f(xs_i)
s       arc length of such a place, m
======  ===========================================================

Even in arc length, springs stand at the middle of the arc; even along an axis, at the middle along it.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from cprbm.curves import NeutralLine
from cprbm_scene.answer import Array

ITERATIONS = 60
CLOSE = 1e-9  # of the length: a step whose square is nothing


def spaced(line: NeutralLine, n: int, axis: Literal["x", "y"]) -> tuple[Array, Array]:
    """Arc lengths, m, of the borders (n+1,) and the springs (n,) of ``n`` elements that are even along an axis.

    By Newton's method, kept between even places on the line.

    Args:
        line: the neutral line, which runs one way along the axis.
        n: how many elements.
        axis: along which.
    """

    def along(s: Array) -> tuple[Array, Array]:
        here = line.at(s)
        return (here.x, here.tangent.real) if axis == "x" else (here.y, here.tangent.imag)

    even = np.arange(2 * n + 1) / (2 * n)
    places = line.length * even
    ahead, _ = along(places)
    sense = np.copysign(1.0, ahead[-1])
    wanted = even[1:-1] * ahead[-1]
    behind = np.minimum(np.searchsorted(sense * ahead, sense * wanted, side="right"), 2 * n)
    low, high = places[behind - 1], places[behind]
    s = np.interp(sense * wanted, sense * ahead, places)
    for _ in range(ITERATIONS):
        here, pace = along(s)
        left = wanted - here
        short = sense * left > 0.0
        low, high = np.where(short, s, low), np.where(short, high, s)
        before, s = s, s + left / np.where(pace == 0.0, np.inf, pace)
        inside = (s >= low) & (s <= high)
        if not inside.all():
            s = np.where(inside, s, 0.5 * (low + high))
        if np.abs(s - before).max() <= CLOSE * line.length:
            break
    places[1:-1] = s
    return places[::2], places[1::2]
