"""A piece's end and its derivatives beside differences of it, a circle, and the work that bends it."""

from __future__ import annotations

import numpy as np
import pytest

from tests.references.rod import carried, shape, stored

START, FORCE, LENGTH, CURVATURE = np.array([0.2, -0.1, 0.4, 0.9]), np.array([-3.1, 1.7]), 1.3, -0.8


def test_derivatives():
    # reference: central differences, whose error is as h² times a third derivative, at two h
    _, found = carried(START, FORCE, LENGTH, CURVATURE)

    def end(change):
        return carried(START + change[:4], FORCE + change[4:], LENGTH, CURVATURE)[0]

    def differences(h):
        return np.column_stack([(end(h * e) - end(-h * e)) / (2.0 * h) for e in np.eye(6)])

    extrapolated = (4.0 * differences(1e-3) - differences(2e-3)) / 3.0
    assert found == pytest.approx(extrapolated, abs=1e-9)


def test_without_force_it_is_a_circle():
    # reference: a circle of curvature κ⁰ + M
    k = CURVATURE + START[3]
    end, _ = carried(START, np.zeros(2), LENGTH, CURVATURE)
    turn = np.sin(0.4 + k * LENGTH) - np.sin(0.4), np.cos(0.4) - np.cos(0.4 + k * LENGTH)
    assert end == pytest.approx([0.2 + turn[0] / k, -0.1 + turn[1] / k, 0.4 + k * LENGTH, 0.9], abs=1e-13)


def test_moment_is_that_of_the_force():
    # reference: equilibrium, M + (place × F) does not change along the piece
    x, y, _, M = shape(START, FORCE, LENGTH, CURVATURE, np.linspace(0.0, LENGTH, 7))
    about_origin = M + x * FORCE[1] - y * FORCE[0]
    assert about_origin == pytest.approx(np.full(7, about_origin[0]), abs=1e-12)


def test_stored_energy_is_the_work_of_what_bends_it():
    # reference: dU = M₁ dθ₁ + F · dx₁ − M₀ dθ₀ for a change of M₀, by an extrapolated difference
    end, derivative = carried(START, FORCE, LENGTH, CURVATURE)

    def slope(h):
        change = np.array([0.0, 0.0, 0.0, h])
        ends = (stored(START + sign * change, FORCE, LENGTH, CURVATURE) for sign in (1.0, -1.0))
        return (next(ends) - next(ends)) / (2.0 * h)

    dx, dy, dtheta, _ = derivative[:, 3]
    work = end[3] * dtheta + FORCE @ [dx, dy]
    assert (4.0 * slope(1e-3) - slope(2e-3)) / 3.0 == pytest.approx(work, rel=1e-9)
