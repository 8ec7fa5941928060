"""Closest-point projection on a smooth neutral line."""

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.answer import Array
from fea_reference.hermite import Around, NeutralLine
from fea_reference.state import Complex

_ITERATIONS = 40
_ARRIVED = 1e-8  # elements: last Newton step, with an error of the order of its square


def project(line: NeutralLine, points: Array, zeta: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Closest places of ``line`` to ``points`` (2, k), by Newton's method from ``zeta`` (k,).

    Returns:
        Places ζ (k,) with (x − x_m)·x_m' = 0, and True (k,) where found: a point beyond an end of the line has no
        closest point within.
    """
    zeta, found, _ = closest(line, points[0] + 1j * points[1], zeta)
    return zeta, found


def closest(line: NeutralLine, points: Complex, zeta: Array) -> tuple[Array, NDArray[np.bool_], Around]:
    """Closest places to points x + i y (k,), True (k,) where found, and the line at these places."""
    n, done = float(line.n), False
    for iteration in range(_ITERATIONS):
        there = line.around(zeta)
        r = points - line.nodes[there.element] - there.way
        back = there.ahead.conj()
        f = (r * back).real
        speed = (there.ahead * back).real
        slope = speed - (r * there.bent.conj()).real
        # beyond the centre of curvature the distance has no minimum: follow the tangent
        step = np.maximum(np.minimum(f / np.where(slope > 0.1 * speed, slope, speed), 1.0), -1.0)
        if iteration > _ITERATIONS // 4:
            step *= 0.5  # a curvature jump between two elements may hold Newton's method in a cycle
        moved = np.minimum(np.maximum(zeta + step, 0.0), n)
        change = moved - zeta
        done = bool(np.abs(change).max(initial=0.0) < _ARRIVED)
        zeta = moved
        if done:
            break
    # f belongs to the state before the last, vanishing step; where the step was cut at an end, f is not small
    found = np.abs(f) <= 1e-6 * np.sqrt(speed * (r.real**2 + r.imag**2 + speed))
    return zeta, found, there.moved(change) if done else line.around(zeta)
