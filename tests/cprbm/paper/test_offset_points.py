"""Offset points of a chain: exact on a circle, and of the orders that the module derives."""

import numpy as np
import pytest

from cprbm import offset_points
from cprbm.paper.offset_points import joint_places, joints_on
from cprbm_scene import Arc, Polynomial, Spacing

PARABOLA = Polynomial(kind="polynomial", axis="x", coefficients=(10.0, 0.0, -0.06), range=(-10.0, 10.0))
SPACINGS = [Spacing(law=law, of=of) for law in ("even", "sine") for of in ("joints", "elements")]


def tangent_angle(x):
    """By hand: dy/dx = −0.12 x."""
    return np.arctan(-0.12 * x)


def test_even_joints_on_a_circle_give_its_offset_circle():
    # the normal of a regular polygon's corner is the circle's: β is exact
    arc = Arc(kind="arc", center=(1.0, 2.0), start=(4.0, 2.0), end=(-2.0, 2.0), direction="counterclockwise")
    found = offset_points(arc, Spacing(law="even", of="joints"), 9, np.array([0.5, -0.7]))
    radii = np.hypot(found.points[..., 0] - 1.0, found.points[..., 1] - 2.0)
    assert radii == pytest.approx(np.array([[2.5], [3.7]]) * np.ones(9), rel=1e-14)


def test_sine_joints_are_where_the_sentence_puts_them():
    x = joints_on(PARABOLA, joint_places(SPACINGS[2], 6))[:, 0]
    assert x == pytest.approx(10.0 * np.sin(np.linspace(-np.pi / 2.0, np.pi / 2.0, 8)), abs=1e-13)


def test_springs_of_elements_stand_in_their_middles():
    x = joints_on(PARABOLA, joint_places(SPACINGS[1], 4))[:, 0]
    assert x == pytest.approx([-10.0, -7.5, -2.5, 2.5, 7.5, 10.0], abs=1e-14)


def test_eq_9_is_of_second_order_where_links_vary_smoothly():
    errors = []
    for n in (39, 79, 159):
        found = offset_points(PARABOLA, SPACINGS[2], n, np.array([1.0]))
        x = joints_on(PARABOLA, joint_places(SPACINGS[2], n))[1:-1, 0]
        errors.append(np.max(np.abs(found.tangents - tangent_angle(x))))
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([2.0, 2.0], abs=0.05)


@pytest.mark.parametrize("spacing", SPACINGS, ids=lambda each: f"{each.law}-{each.of}")
@pytest.mark.parametrize("t", [1.0, 8.0, 20.0, -4.0])
def test_the_estimate_bounds_the_distance_from_the_parabolas_offset(spacing, t):
    # distance of b from the offset curve = | |b − foot| − |t| |, the foot of b on the parabola by the cubic
    # x0 − x + (y0 − y)·y'(x0) = 0 of its normal
    found = offset_points(PARABOLA, spacing, 24, np.array([t]))
    off = []
    for x, y in found.points[0]:
        cubic = np.polynomial.Polynomial([-x, 1.0 - 0.12 * (10.0 - y), 0.0, 0.12 * 0.06])
        roots = cubic.roots()
        real = roots.real[np.abs(roots.imag) < 1e-7]
        off.append(np.min(np.abs(np.hypot(x - real, y - 10.0 + 0.06 * real**2) - abs(t))))
    stated = 1.25 * np.maximum(found.off_curve[0], 0.25 * found.off_curve[0].max()) + 1e-13
    assert np.all(np.array(off) <= stated)
    assert np.max(off) > 0.1 * np.max(stated)
