"""Lengths and points of curves beside elementary geometry."""

import math

import numpy as np
import pytest

from comparisons.geometry import length, points
from cprbm_scene import Arc, Line, Polynomial

HALF = Arc(kind="arc", center=(0.0, 0.0), start=(-2.0, 0.0), end=(2.0, 0.0), direction="counterclockwise")
QUARTER = Arc(kind="arc", center=(1.0, 0.0), start=(2.0, 0.0), end=(1.0, -1.0), direction="clockwise")


def test_arcs_have_the_length_and_the_points_of_their_circles():
    assert length(HALF) == pytest.approx(2.0 * math.pi, rel=1e-15)
    assert length(QUARTER) == pytest.approx(0.5 * math.pi, rel=1e-15)
    three_quarters = QUARTER.model_copy(update={"direction": "counterclockwise"})
    assert length(three_quarters) == pytest.approx(1.5 * math.pi, rel=1e-15)
    found = points(HALF, np.array([0.0, math.pi, 2.0 * math.pi]))
    np.testing.assert_allclose(found, [[-2, 0], [0, -2], [2, 0]], atol=1e-15)
    np.testing.assert_allclose(
        points(QUARTER, np.array([0.25 * math.pi])), [[1 + math.sqrt(0.5), -math.sqrt(0.5)]], atol=1e-15
    )


def test_a_line_has_pythagoras_length():
    line = Line(kind="line", start=(1.0, 1.0), end=(4.0, 5.0))
    assert length(line) == 5.0
    np.testing.assert_allclose(points(line, np.array([0.0, 2.5, 5.0])), [[1, 1], [2.5, 3], [4, 5]])


def test_a_parabola():
    # reference: y = x²/2 has the arc length ½(x √(1 + x²) + arsinh x) from its vertex
    parabola = Polynomial(kind="polynomial", axis="x", coefficients=(0.0, 0.0, 0.5), range=(2.0, -1.0))
    to_vertex, beyond = (0.5 * (x * math.hypot(1.0, x) + math.asinh(x)) for x in (2.0, 1.0))
    assert length(parabola) == pytest.approx(to_vertex + beyond, rel=1e-14)
    found = points(parabola, np.array([0.0, to_vertex, to_vertex + beyond]))
    np.testing.assert_allclose(found, [[2, 2], [0, 0], [-1, 0.5]], atol=1e-13)
