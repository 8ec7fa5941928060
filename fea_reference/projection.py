"""Closest points on a smooth neutral line."""

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.answer import Array
from fea_reference.hermite import Around, NeutralLine
from fea_reference.state import Complex

_ITERATIONS = 40
_ARRIVED = 1e-8  # elements: the step that was just made leaves an error of the order of its square


def project(line: NeutralLine, points: Array, zeta: Array) -> tuple[Array, NDArray[np.bool_]]:
    """The places on ``line`` closest to ``points`` (2, k), by Newton's method from ``zeta`` (k,).

    Returns:
        The places ζ (k,) where (x − x_m)·x_m' vanishes, and where that was found: a point beyond an end of
        the line has no closest point within it.
    """
    zeta, found, _ = closest(line, points[0] + 1j * points[1], zeta)
    return zeta, found


def closest(line: NeutralLine, points: Complex, zeta: Array) -> tuple[Array, NDArray[np.bool_], Around]:
    """The same of points x + i y (k,), and what there is at the places."""
    n, done = float(line.n), False
    for iteration in range(_ITERATIONS):
        there = line.around(zeta)
        r = points - line.nodes[there.element] - there.way
        back = there.ahead.conj()
        f = (r * back).real
        speed = (there.ahead * back).real
        slope = speed - (r * there.bent.conj()).real
        # Beyond the centre of curvature the distance has no minimum: go along the tangent instead.
        step = np.maximum(np.minimum(f / np.where(slope > 0.1 * speed, slope, speed), 1.0), -1.0)
        if iteration > _ITERATIONS // 4:
            step *= 0.5  # a kink of the curvature between two elements can hold Newton's method in a cycle
        moved = np.minimum(np.maximum(zeta + step, 0.0), n)
        change = moved - zeta
        done = bool(np.abs(change).max(initial=0.0) < _ARRIVED)
        zeta = moved
        if done:
            break
    # f is the one before the last, vanishing step; where a step was cut at an end it is not small.
    found = np.abs(f) <= 1e-6 * np.sqrt(speed * (r.real**2 + r.imag**2 + speed))
    return zeta, found, there.moved(change) if done else line.around(zeta)
