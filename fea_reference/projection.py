"""Closest-point projection on a smooth neutral line."""

import math

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.answer import Array
from fea_reference.hermite import Around, NeutralLine
from fea_reference.state import Complex

_ITERATIONS = 40
_FEW = 5  # points: up to this number plain numbers are faster than arrays
_ARRIVED = 1e-8  # elements: last Newton step, with an error of the order of its square


def closest(line: NeutralLine, points: Complex, zeta: Array) -> tuple[Array, NDArray[np.bool_], Around]:
    """Closest places to points x + i y (k,), by Newton's method from ``zeta`` (k,).

    Returns:
        Places ζ (k,) with (x − x_m)·x_m' = 0, True (k,) where found, and the line at these places. A point beyond an
        end of the line has no closest point within.
    """
    if 0 < zeta.size <= _FEW:
        found_places = [_closest_to(line, *start) for start in zip(points.tolist(), zeta.tolist(), strict=True)]
        places, found_here, *line_there = map(np.array, zip(*found_places, strict=True))
        return places, found_here, Around(*line_there)
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


def _closest_to(line: NeutralLine, point: complex, zeta: float) -> tuple[float, bool, int, complex, complex, complex]:
    """Closest place to a point x + i y, True if found, and the line there: the same method for a single point."""
    for iteration in range(_ITERATIONS):
        element = min(int(zeta), line.n - 1)
        xi = zeta - element
        t, b, a = line.cubic[:, element].tolist()
        last = xi * a
        bow = b + last
        twice = bow + last
        way, ahead, bent = xi * (t + xi * bow), t + xi * (bow + twice), 2.0 * (twice + last)
        r = point - line.nodes.item(element) - way
        f = r.real * ahead.real + r.imag * ahead.imag
        speed = ahead.real * ahead.real + ahead.imag * ahead.imag
        slope = speed - (r.real * bent.real + r.imag * bent.imag)
        step = max(min(f / (slope if slope > 0.1 * speed else speed), 1.0), -1.0)
        if iteration > _ITERATIONS // 4:
            step *= 0.5
        change = min(max(zeta + step, 0.0), float(line.n)) - zeta
        zeta += change
        if abs(change) < _ARRIVED:
            break
    size = math.sqrt(speed * (r.real * r.real + r.imag * r.imag + speed))
    return zeta, abs(f) <= 1e-6 * size, element, way + change * ahead, ahead + change * bent, bent
