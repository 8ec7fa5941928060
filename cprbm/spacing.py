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
from scene.answer import Array


def spaced(line: NeutralLine, n: int, axis: Literal["x", "y"]) -> tuple[Array, Array]:
    """Arc lengths, m, of the borders (n+1,) and the springs (n,) of ``n`` elements that are even along an axis.

    Args:
        line: the neutral line, which runs one way along the axis.
        n: how many elements.
        axis: along which.
    """

    def along(s: Array) -> Array:
        return line.position(s)[0 if axis == "x" else 1]

    ends = along(np.array([0.0, line.length]))
    share = np.arange(1, 2 * n) / (2 * n)
    wanted = ends[0] + share * (ends[1] - ends[0])
    begin, end = np.zeros(2 * n - 1), np.full(2 * n - 1, line.length)
    from scipy.optimize import elementwise  # loaded when a beam is cut along an axis

    inner = elementwise.find_root(lambda s, target: along(s) - target, (begin, end), args=(wanted,)).x
    places = np.concatenate(([0.0], inner, [line.length]))
    return places[::2], places[1::2]
