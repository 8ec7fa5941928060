"""Neutral lines through points: their geometry beside closed forms, and what is wrong with some of them."""

from math import asinh, cos, pi, sin, sqrt

import numpy as np
import pytest
from scipy.spatial import cKDTree

from cprbm_scene import Line, Spline, scene_from
from cprbm_scene.geometry import (
    arc_length,
    curvature_on,
    largest_curvature,
    points_on,
    tangents_on,
)
from tests.cprbm_scene.editing import distance_to, line_distance, mistakes, two_lines

U = np.linspace(0.0, 1.0, 401)


def spline(points, start=None, end=None):
    return Spline(
        kind="spline",
        points=tuple((float(x), float(y)) for x, y in points),
        start_direction=start,
        end_direction=end,
    )


def on_a_circle(n, radius=0.03, turn=2.0, *, directed=False):
    """Through n points, not even, of an arc about the origin that begins on the axis of x."""
    share = np.linspace(0.0, 1.0, n)
    angle = turn * (share + 0.04 * np.sin(2.0 * pi * share))
    ends = ((0.0, 7.0), (-sin(turn), cos(turn))) if directed else (None, None)
    return spline(radius * np.column_stack([np.cos(angle), np.sin(angle)]), *ends)


def test_through_three_points_it_is_a_parabola():
    # reference: y = x²/2a, of arc length a (z √(1 + z²) + arsinh z) between x = ±a z, of curvature 1/a at its vertex
    a, z = 0.7, 1.3
    curve = spline([(-a * z, a * z * z / 2), (0.0, 0.0), (a * z, a * z * z / 2)])
    assert arc_length(curve) == pytest.approx(a * (z * sqrt(1.0 + z * z) + asinh(z)), rel=1e-14)
    x, y = points_on(curve, U).T
    assert y == pytest.approx(x**2 / (2 * a), abs=1e-15)
    assert largest_curvature(curve) == pytest.approx(1.0 / a, rel=1e-12)
    assert curvature_on(curve, U) == pytest.approx(1.0 / a / (1.0 + (x / a) ** 2) ** 1.5, rel=1e-12)
    slope = x / a
    tangent = np.column_stack([np.ones_like(x), slope]) / np.hypot(1.0, slope)[:, None]
    assert tangents_on(curve, U) == pytest.approx(tangent, abs=1e-13)


def test_points_of_a_line_are_a_line():
    curve = spline([(0.1, 0.7), (0.0, 0.65), (-0.13, 0.585), (-0.2, 0.55)])
    line = Line(kind="line", start=(0.1, 0.7), end=(-0.2, 0.55))
    assert arc_length(curve) == pytest.approx(arc_length(line), rel=1e-14)
    assert points_on(curve, U) == pytest.approx(points_on(line, U), abs=1e-14)
    assert tangents_on(curve, U) == pytest.approx(tangents_on(line, U), abs=1e-13)
    assert largest_curvature(curve) < 1e-11
    assert distance_to(curve, (0.0, 0.0)) == pytest.approx(distance_to(line, (0.0, 0.0)), rel=1e-12)


@pytest.mark.parametrize("directed", [False, True])
def test_points_of_a_circle_come_near_it(directed):
    """Reference: Floater's order, four in the distance of the points; two less in the curvature."""
    radius = 0.03
    errors = []
    for n in (9, 17, 33, 65):
        curve = on_a_circle(n, radius, directed=directed)
        r = np.hypot(*points_on(curve, U).T)
        errors.append([np.max(np.abs(r - radius)), np.max(np.abs(curvature_on(curve, U) - 1.0 / radius))])
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx([4.0, 2.0], abs=0.25 if directed else 0.7)
    assert np.all(np.array(errors[-1]) < [1e-8, 0.06])
    assert arc_length(curve) == pytest.approx(2.0 * radius, rel=1e-7)


def test_it_meets_its_points_with_one_tangent_and_one_curvature():
    curve = spline([(0.0, 0.0), (0.4, 0.3), (0.7, -0.1), (1.6, 0.0), (1.7, 0.6)], start=(0.0, -2.0), end=(1.0, 1.0))
    assert (curve.start, curve.end) == ((0.0, 0.0), (1.7, 0.6))
    for point in curve.points:
        beside = Line(kind="line", start=point, end=(point[0] + 0.01, point[1] - 0.003))
        assert line_distance(curve, beside) == pytest.approx(0.0, abs=1e-9)
    assert tangents_on(curve, np.array([0.0, 1.0])) == pytest.approx(np.array([[0.0, -1.0], [sqrt(0.5)] * 2]))
    fine = np.linspace(0.0, 1.0, 20_001)
    assert np.max(np.abs(np.diff(curvature_on(curve, fine)))) < 2e-2 * largest_curvature(curve)
    # by small steps
    p = points_on(curve, fine)
    assert np.sum(np.hypot(*np.diff(p, axis=0).T)) == pytest.approx(arc_length(curve), rel=1e-6)
    assert largest_curvature(curve) == pytest.approx(np.max(curvature_on(curve, fine)), rel=1e-4)


def test_the_way_to_another_line():
    # reference: the parabola y = x²/2 and the line y = x − 1.3, nearest where the slope is one: 0.8/√2
    curve = spline([(-2.0, 2.0), (0.0, 0.0), (2.0, 2.0)])
    line = Line(kind="line", start=(0.0, -1.3), end=(3.0, 1.7))
    assert line_distance(curve, line, 0.56) == pytest.approx(0.8 / sqrt(2.0), rel=1e-10)


POINTS = [[0.0, 0.0], [0.03, 0.008], [0.07, 0.004], [0.1, 0.0]]


def beam(**changes):
    """A cantilever through points."""
    data = two_lines(0.01)
    del data["beams"]["upper"], data["contacts"], data["bodies"]["ground"]["points"]["P"]
    data["beams"]["lower"]["curve"] = {"kind": "spline", "points": POINTS, **changes}
    return data


def test_what_is_written_is_what_is_read():
    curve = scene_from(beam(end_direction=[1, -0.5])).beams["lower"].curve
    assert curve == spline(POINTS, end=(1.0, -0.5))


CURVE = "beams/lower/curve"
KEY = "beams.lower.curve"
ZIGZAG = [[0.0, 0.0], [0.05, 0.0], [0.02, 0.0], [0.1, 0.0]]
WRONG = [
    (f"{CURVE}/kind", "splin", f"{KEY}.kind", "one of 'line', 'arc', 'polynomial', 'spline'"),
    (f"{CURVE}/points", POINTS[:2], f"{KEY}.points", "at least 3"),
    (f"{CURVE}/points", [*POINTS[:2], [0.1]], f"{KEY}.points[2][1]", "an item"),
    (f"{CURVE}/points", [*POINTS[:2], [0.1, float("inf")]], f"{KEY}.points[2][1]", "a finite number"),
    (f"{CURVE}/points", [*POINTS[:2], *POINTS[1:]], f"{KEY}.points[2]", "(0.03, 0.008) m, 0 m from the point before"),
    (f"{CURVE}/points", [[0.0, 0.0], [1e308, 0.0], [-1e308, 0.1]], f"{KEY}.points[1][0]", "between 1e-50 and 1e+50"),
    (f"{CURVE}/points", [[i * 1e-4, 0.0] for i in range(1002)], f"{KEY}.points", "1002 points; at most 1001"),
    (f"{CURVE}/points", ZIGZAG, f"{KEY}.points", "turn back on the spot, near (0.0"),
    (f"{CURVE}/points", [*POINTS[:3], [0.0, 0.0]], KEY, "a start and an end at the same place"),
    (f"{CURVE}/start_direction", [0.0, 0.0], f"{KEY}.start_direction", "[0, 0]; a direction"),
    (f"{CURVE}/end_direction", [1.0], f"{KEY}.end_direction[1]", "an item"),
    (f"{CURVE}/start", [0.0, 0.0], f"{KEY}.start", "'kind', 'points', 'start_direction', 'end_direction'"),
    (f"{CURVE}/points", [*POINTS[:3], [0.11, 0.0]], "beams.lower.end", "the curve's end is at (0.11, 0) m"),
    ("beams/lower/thickness", 0.03, "beams.lower.thickness", "0.29"),
]


@pytest.mark.parametrize(("path", "value", "key", "said"), WRONG)
def test_mistakes(path, value, key, said):
    found = mistakes((path, value), base=beam())
    assert key in found
    assert said in found[key]


def test_a_sharp_bend_is_no_beam():
    sharp = [[0.0, 0.0], [0.049, 0.0], [0.05, 0.0005], [0.049, 0.001], [0.0, 0.006]]
    edits = ((f"{CURVE}/points", sharp), ("bodies/block/points/Q", sharp[-1]))
    assert "of the radius of curvature" in mistakes(*edits, base=beam())["beams.lower.thickness"]


def through(points, *, thickness=0.002):
    """Edits that lead the beam through other points."""
    ends = (("bodies/ground/points/O", points[0]), ("bodies/block/points/Q", points[-1]))
    return ((f"{CURVE}/points", points), ("beams/lower/thickness", thickness), *ends)


@pytest.mark.parametrize(("share", "overlaps"), [(0.9, False), (0.999, False), (1.001, True), (1.1, True)])
def test_a_beam_that_comes_back_to_itself(share, overlaps):
    angle = np.linspace(-pi / 2, pi / 2, 13)
    bow = [[0.06 + 0.025 * cos(a), 0.025 + 0.025 * sin(a)] for a in angle]
    points = [[0.0, 0.0], [0.02, 0.0], [0.04, 0.0], *bow, [0.04, 0.05], [0.01, 0.012]]
    # reference: distances between the places of two dense halves
    curve = spline(points)
    first, second = points_on(curve, np.linspace(0.0, 0.4, 2001)), points_on(curve, np.linspace(0.6, 1.0, 2001))
    apart, _ = cKDTree(first).query(second)
    found = mistakes(*through(points, thickness=float(share * apart.min())), base=beam())
    assert (KEY in found) is overlaps
    assert not overlaps or f"it comes to {apart.min():.3g} m from itself" in found[KEY]


def test_a_loop_crosses_itself():
    angle = np.linspace(-0.4 * pi, 0.4 * pi, 11)
    ring = [[0.1 + 0.03 * cos(a), 0.03 * sin(a)] for a in angle]
    start, end = [0.0, -0.04], [0.0, 0.04]
    assert mistakes(*through([start, *ring, end]), base=beam()) == {}
    assert "a beam that overlaps itself" in mistakes(*through([start, *ring[::-1], end]), base=beam())[KEY]
