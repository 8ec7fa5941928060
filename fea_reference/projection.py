"""Closest points on a smooth neutral line."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fea_reference.hermite import NeutralLine
from scene.answer import Array

_ITERATIONS = 40


def project(line: NeutralLine, points: Array, zeta: Array) -> tuple[Array, NDArray[np.bool_]]:
    """The places on ``line`` closest to ``points`` (2, k), by Newton's method from ``zeta`` (k,).

    Returns:
        The places ζ (k,) where (x − x_m)·x_m' vanishes, and where that was found: a point beyond an end of
        the line has no closest point within it.
    """
    for iteration in range(_ITERATIONS):
        x, x1, x2 = line.at(zeta)
        r = points - x
        f = (r * x1).sum(axis=0)
        speed = (x1 * x1).sum(axis=0)
        slope = speed - (r * x2).sum(axis=0)
        # Beyond the centre of curvature the distance has no minimum: go along the tangent instead.
        step = np.maximum(np.minimum(f / np.where(slope > 0.1 * speed, slope, speed), 1.0), -1.0)
        if iteration > _ITERATIONS // 4:
            step *= 0.5  # a kink of the curvature between two elements can hold Newton's method in a cycle
        moved = np.minimum(np.maximum(zeta + step, 0.0), line.n)
        # The step that was just made leaves an error of the order of its square.
        done = np.abs(moved - zeta).max(initial=0.0) < 1e-8
        zeta = moved
        if done:
            break
    # f is the one before the last, vanishing step; where a step was cut at an end it is not small.
    found = np.abs(f) <= 1e-6 * np.sqrt(speed * ((r * r).sum(axis=0) + speed))
    return zeta, found
