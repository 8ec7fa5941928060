"""Neutral lines, sizes along beams, distances and clearance as drawn, beside closed forms."""

import math
from itertools import pairwise
from math import asinh, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import Polynomial as Series
from scipy.integrate import quad
from scipy.spatial import cKDTree

from cprbm_scene import Arc, FunctionContact, HalfPlaneContact, Line, LineContact, Polynomial, Spline, scene_from
from cprbm_scene.contact_records import distance
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import CircleContact, EllipseContact, SplineContact
from tests.cprbm_scene.editing import (
    BOWED,
    CIRCLE,
    CIRCULAR,
    ELLIPSE,
    FUNCTION,
    HALF_PLANE,
    HINGE,
    LINE,
    LINES,
    PARABOLA,
    SPLINE,
    THROUGH_POINTS,
    TIP,
    A,
    L,
    R,
    T,
    cantilever,
    distance_to,
    edited,
    line_distance,
    mistakes,
    over,
    straight,
    two_lines,
)

FRACTIONS = np.linspace(0.0, 1.0, 23)


def polynomial(axis, coefficients, span):
    return Polynomial(kind="polynomial", axis=axis, coefficients=tuple(coefficients), range=span)


def parabola(first=0.0, last=TIP):
    return polynomial("y", PARABOLA["coefficients"], (first, last))


def spline(points, start=None, end=None):
    points = tuple((float(x), float(y)) for x, y in points)
    return Spline(kind="spline", points=points, start_direction=start, end_direction=end)


def line(start, end):
    return Line(kind="line", start=start, end=end)


def up_to(y, a=A):
    """Arc length of a parabola of curvature ``a`` at the vertex, from there: (z √(1 + z²) + arsinh z)/2a, z = a y."""
    return (a * y * sqrt(1.0 + (a * y) ** 2) + asinh(a * y)) / (2.0 * a)


GRAPHS = [
    *(
        (parabola(*span), "y", PARABOLA["coefficients"], abs(up_to(span[1]) - up_to(span[0])), A / hypot(1, A * v) ** 3)
        for span, v in (((0.0, TIP), 0), ((TIP, 0.0), 0), ((-0.03, 0.041), 0), ((0.2, 0.1), 0.1), ((0.02, 0.1), 0.02))
    ),
    (polynomial("x", [0, 0, 400], (-0.7131, 1)), "x", [0, 0, 400], up_to(0.7131, 800) + up_to(1, 800), 800.0),
    # the curvature of y = x³ is largest at x⁴ = 1/45
    (polynomial("x", [0.3, 0, 0, 1], (-0.1, 1.3)), "x", [0.3, 0, 0, 1], None, 6 * 45**-0.25 / (1 + 9 / 45) ** 1.5),
    (polynomial("x", [0.65, 0.5], (0.1, -0.2)), "x", [0.65, 0.5], 0.3 * sqrt(1.25), 0.0),
    # the spline of three points is a parabola, and the spline of a line's points the line
    (spline([(-0.91, 0.5915), (0, 0), (0.91, 0.5915)]), "x", [0, 0, 0.5 / 0.7], 2 * up_to(0.91, 1 / 0.7), 1 / 0.7),
    (spline([(0.1, 0.7), (0, 0.65), (-0.13, 0.585), (-0.2, 0.55)]), "x", [0.65, 0.5], 0.3 * sqrt(1.25), 0.0),
]


@pytest.mark.parametrize(("curve", "axis", "coefficients", "length", "bend"), GRAPHS)
def test_a_graph_by_its_closed_form(curve, axis, coefficients, length, bend):
    """The graph of f has the places (v, f), tangents along (1, f'), the curvature |f''|/(1 + f'²)^1.5."""
    f, shape = Series(coefficients), shape_of(curve)
    v, height = (shape.point(FRACTIONS) if axis == "x" else shape.point(FRACTIONS)[:, ::-1]).T
    slope, size = f.deriv()(v), max(1.0, abs(height).max())
    assert height == pytest.approx(f(v), abs=2e-15 * size)
    ends = np.array([curve.start, curve.end])
    assert shape.point(np.array([0.0, 1.0])) == pytest.approx(ends, abs=1e-15 * size)
    sense = np.sign(v[-1] - v[0])
    tangents = sense * np.column_stack((np.ones_like(v), slope)) / np.hypot(1.0, slope)[:, None]
    assert shape.tangent(FRACTIONS) == pytest.approx(tangents if axis == "x" else tangents[:, ::-1], abs=1e-12)
    assert shape.curvature(FRACTIONS) == pytest.approx(
        abs(f.deriv(2)(v)) / np.hypot(1, slope) ** 3, rel=1e-8, abs=1e-11
    )
    assert shape.largest_curvature == pytest.approx(bend, rel=1e-12, abs=1e-11)
    speed = [quad(lambda t: hypot(1.0, f.deriv()(t)), v[0], end, points=[0.0], epsrel=1e-13, limit=500)[0] for end in v]
    assert shape.length == pytest.approx(abs(speed[-1]) if length is None else length, rel=1e-13)
    assert np.abs(speed) == pytest.approx(FRACTIONS * shape.length, rel=1e-10, abs=1e-13)


def test_ends_are_the_begin_and_the_end_of_the_range():
    start, end = (0.5, 1.0 - 1.0 + 3.0 / 8.0), (-0.25, 1.0 + 0.5 - 3.0 / 64.0)
    for axis, way in (("x", 1), ("y", -1)):
        curve = polynomial(axis, [1.0, -2.0, 0.0, 3.0], (0.5, -0.25))
        assert (curve.start, curve.end) == (start[::way], end[::way])


DISTANCES = [
    # from the parabola's axis; beyond the radius 1/A at the vertex the distance² is 2h/A − 1/A²
    (distance_to(parabola(-TIP, TIP), (0.05 - 0.013, 0.0)), 0.013),
    (distance_to(parabola(-TIP, TIP), (0.05 + 0.06, 0.0)), sqrt(2 * 0.06 / A - 1 / A**2)),
    (line_distance(line((0.04, -0.1), (0.04, 0.1)), parabola(-TIP, TIP), 0.009), 0.01),
    # y = x²/2 and y = x − 1.3 are nearest at the slope of one: 0.8/√2
    (line_distance(spline([(-2, 2), (0, 0), (2, 2)]), line((0.0, -1.3), (3.0, 1.7)), 0.56), 0.8 / sqrt(2.0)),
    # a chord cuts an arc twice, close to grazing: zero, not the samples' spacing
    (
        line_distance(
            Arc(kind="arc", center=(0, 0), start=(1, 0), end=(-1, 0), direction="counterclockwise"),
            line((-0.7, 0.9999), (0.9, 0.9999)),
        ),
        0.0,
    ),
]


@pytest.mark.parametrize(("found", "expected"), DISTANCES)
def test_distances_by_closed_forms(found, expected):
    assert found == pytest.approx(expected, rel=1e-10, abs=1e-8 if expected == 0.0 else 0.0)


@pytest.mark.parametrize("directed", [False, True])
def test_points_of_a_circle_come_near_it(directed):
    """Reference: Floater's order, four in the distance of the points; two less in the curvature."""
    radius, errors, u = 0.03, [], np.linspace(0.0, 1.0, 401)
    for n in (9, 17, 33, 65):
        share = np.linspace(0.0, 1.0, n)
        angle = 2.0 * (share + 0.04 * np.sin(2.0 * pi * share))
        ends = ((0.0, 7.0), (-sin(2.0), cos(2.0))) if directed else (None, None)
        shape = shape_of(spline(radius * np.column_stack([np.cos(angle), np.sin(angle)]), *ends))
        r = np.hypot(*shape.point(u).T)
        errors.append([np.max(np.abs(r - radius)), np.max(np.abs(shape.curvature(u) - 1.0 / radius))])
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx([4.0, 2.0], abs=0.25 if directed else 0.7)
    assert np.all(np.array(errors[-1]) < [1e-8, 0.06])
    assert shape.length == pytest.approx(2.0 * radius, rel=1e-7)


def test_a_spline_meets_its_points_with_one_tangent_and_one_curvature():
    curve = spline([(0.0, 0.0), (0.4, 0.3), (0.7, -0.1), (1.6, 0.0), (1.7, 0.6)], start=(0.0, -2.0), end=(1.0, 1.0))
    for point in curve.points:
        assert line_distance(curve, line(point, (point[0] + 0.01, point[1] - 0.003))) == pytest.approx(0.0, abs=1e-9)
    shape, fine = shape_of(curve), np.linspace(0.0, 1.0, 20_001)
    assert shape.tangent(np.array([0.0, 1.0])) == pytest.approx(np.array([[0.0, -1.0], [sqrt(0.5)] * 2]))
    assert np.max(np.abs(np.diff(shape.curvature(fine)))) < 2e-2 * shape.largest_curvature
    assert np.sum(np.hypot(*np.diff(shape.point(fine), axis=0).T)) == pytest.approx(shape.length, rel=1e-6)
    assert shape.largest_curvature == pytest.approx(np.max(shape.curvature(fine)), rel=1e-4)


@settings(max_examples=30, deadline=None, derandomize=True)
@given(offset=st.floats(2.1, 4.0), towards=st.floats(0.0, 6.28), radius=st.floats(0.2, 1.0))
def test_the_distance_of_two_circles_is_that_of_their_centres_less_the_radii(offset, towards, radius):
    """Nearly full circles with opposite openings."""
    centre = (offset * np.cos(towards), offset * np.sin(towards))

    def ring(middle, R, opening):
        ends = [(middle[0] + R * np.cos(opening + d), middle[1] + R * np.sin(opening + d)) for d in (0.1, -0.1)]
        return Arc(kind="arc", center=middle, start=ends[0], end=ends[1], direction="counterclockwise")

    apart = line_distance(ring((0.0, 0.0), 1.0, towards + np.pi), ring(centre, radius, towards))
    assert apart == pytest.approx(offset - 1.0 - radius, abs=1e-8)


@settings(max_examples=50, deadline=None, derandomize=True)
@given(
    x=st.floats(-3, 3),
    y=st.floats(-3, 3),
    first=st.floats(-3.1, 3.1),
    turn=st.floats(0.05, 6.2),
    direction=st.sampled_from(["clockwise", "counterclockwise"]),
)
def test_the_distance_of_a_point_is_the_least_over_samples(x, y, first, turn, direction):
    last = first + (turn if direction == "counterclockwise" else -turn)
    start, end = ((0.5 + math.cos(angle), math.sin(angle)) for angle in (first, last))
    arc = Arc(kind="arc", center=(0.5, 0.0), start=start, end=end, direction=direction)
    for curve, length in ((arc, turn), (line(start, end), math.dist(start, end))):
        samples = shape_of(curve).point(np.linspace(0.0, 1.0, 4001))
        sampled = np.hypot(*(samples - [x, y]).T).min()
        assert sampled - length / 8000 - 1e-12 <= distance_to(curve, (x, y)) <= sampled + 1e-12


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.lists(st.floats(-40.0, 40.0), min_size=3, max_size=7), st.floats(0.01, 1.0))
def test_no_polynomial_overlaps_itself(coefficients, share):
    """The thickest beam of any polynomial: places nearer than the thickness are neighbours along the beam."""
    shape = shape_of(polynomial("x", (0.0, *coefficients), (-1.0, 1.0)))
    thickness = share * min(0.2 * shape.length, 0.999 / max(shape.largest_curvature, 1e-9))
    u = np.linspace(0.0, 1.0, 1500)
    near = cKDTree(shape.point(u)).query_pairs(thickness, output_type="ndarray")
    assert np.all(shape.length * np.abs(np.diff(u[near], axis=1)) <= 1.1 * thickness)


def sampled(points, p):
    """Distance of places (k, 2) from the straight pieces between ``points``, by many places on them."""
    on = np.concatenate([a + (b - a) * np.linspace(0, 1, 401)[:, None] for a, b in pairwise(points)])
    return np.hypot(*(p[:, None] - on).transpose(2, 0, 1)).min(axis=1)


def test_distances_from_lines_and_functions():
    p, on = np.random.default_rng(1).uniform(-1.0, 1.0, (100, 2)), {"beam": "b", "body": "g"}
    corners = np.array([(-0.5, 0.2), (0.0, 0.6), (0.3, -0.1), (0.7, 0.0)])
    edge = LineContact(kind="beam-line", **on, points=tuple(map(tuple, corners.tolist())), side="left")
    assert np.abs(distance(edge, p)) == pytest.approx(sampled(corners, p), abs=1e-3)
    # in front of the line and behind, and beside its end
    near = distance(edge, np.array([(-0.3, 0.5), (0.0, 0.7), (0.0, 0.5), (0.3, 0.0), (0.3, -0.2), (0.9, -0.2)]))
    assert np.sign(near).tolist() == [1.0, 1.0, -1.0, 1.0, -1.0, 1.0]
    graph = {"axis": "y", "coefficients": (0.1, 0.3, -0.8), "range": (-0.6, 0.5), "side": "above"}
    d, y = distance(FunctionContact(kind="beam-function", **on, **graph), p), np.linspace(-0.6, 0.5, 21)
    assert np.abs(d) == pytest.approx(sampled(np.column_stack((0.1 + 0.3 * y - 0.8 * y**2, y)), p), abs=1e-3)
    inside = (np.abs(p[:, 1]) < 0.2) & (np.abs(d) < 0.3)
    f = 0.1 + 0.3 * p[:, 1] - 0.8 * p[:, 1] ** 2
    assert np.array_equal(np.sign(d[inside]), np.sign(p[inside, 0] - f[inside]))
    plane = HalfPlaneContact(kind="beam-half-plane", **on, point=(0.1, 0.2), normal=(3.0, 4.0))
    assert distance(plane, p) == pytest.approx((p - (0.1, 0.2)) @ (0.6, 0.8))


def test_distances_from_ellipses_splines_and_from_inside_a_circle():
    turn, out, on = np.linspace(0.0, 6.2, 40), np.linspace(-0.4, 0.9, 40), {"beam": "b", "body": "g"}
    # reference: a place at the distance d along the normal of an ellipse, with d above the least radius b²/a = 0.5
    # of curvature inside
    outward = np.column_stack((np.cos(turn) / 2.0, np.sin(turn)))
    outward /= np.hypot(*outward.T)[:, None]
    rotated = np.array([[0.6, 0.8], [-0.8, 0.6]])
    p = (0.1, 0.2) + (np.column_stack((2.0 * np.cos(turn), np.sin(turn))) + out[:, None] * outward) @ rotated
    ellipse = EllipseContact(
        kind="beam-ellipse", **on, center=(0.1, 0.2), semi_axes=(2.0, 1.0), angle=math.atan2(0.8, 0.6)
    )
    assert distance(ellipse, p) == pytest.approx(out, abs=1e-8)
    assert distance(ellipse.model_copy(update={"side": "inside"}), p) == pytest.approx(-out, abs=1e-8)
    # reference: the spline of three points is the parabola through them
    points = ((-1.0, 1.0), (0.0, 0.0), (1.0, 1.0))
    edge = SplineContact(kind="beam-spline", **on, points=points, side="right")
    graph = {"axis": "x", "coefficients": (0, 0, 1.0), "range": (-1.0, 1.0), "side": "below"}
    p = np.random.default_rng(2).uniform(-0.5, 0.5, (40, 2)) + np.array((0.0, 0.3))
    assert distance(edge, p) == pytest.approx(
        distance(FunctionContact(kind="beam-function", **on, **graph), p), abs=1e-9
    )
    hole = CircleContact(kind="beam-circle", **on, center=(0.0, 0.3), radius=0.5, side="inside")
    assert distance(hole, p) == pytest.approx(0.5 - np.hypot(*(p - (0.0, 0.3)).T))


SIZE = {"at": [0.0, 0.25, 1.0], "values": [0.003, 0.001, 0.002]}
OF_LOWER = "beams/lower/thickness"


def test_a_size_goes_straight_between_its_places():
    width = {"at": [0.0, 0.7, 1.0], "values": [0.01, 0.01, 0.01]}
    beam = scene_from(edited((OF_LOWER, SIZE), ("beams/lower/width", width), base=LINES)).beams["lower"]
    at = np.array([[0.0, 0.125, 0.25], [0.5, 0.75, 1.0]])
    expected = np.array([[0.003, 0.002, 0.001], [0.004 / 3, 0.005 / 3, 0.002]])
    assert beam.thickness_at(at) == pytest.approx(expected, rel=1e-14)
    assert beam.width_at(at) == pytest.approx(np.full((2, 3), 0.01))
    assert (beam.thinnest, beam.thickest, beam.tapered) == (0.001, 0.003, True)
    assert beam.knots.tolist() == [0.0, 0.25, 0.7, 1.0]
    even = edited((OF_LOWER, {"at": [0.0, 1.0], "values": [0.002, 0.002]}), base=two_lines(0.01))
    assert not scene_from(even).beams["lower"].tapered


def hinge(gap):
    """The hinge with centres at ±(R + (t + gap)/2): edges ``gap`` apart."""
    y, data = 0.025 + 0.5 * (T + gap), edited(base=HINGE)
    for beam, sign, (start, end) in (("beam1", 1, "AB"), ("beam2", -1, "CD")):
        places = {"center": [0.026, sign * y], "start": [0.001, sign * y], "end": [0.051, sign * y]}
        data["beams"][beam]["curve"] |= places
        data["bodies"]["AC"]["points"][start], data["bodies"]["BD"]["points"][end] = places["start"], places["end"]
    return data


def from_one_block(share, *, slope=0.05, joint="weld", body="block"):
    """A level beam, and an upper beam of varying thickness that rises from the end of the level beam."""
    y = T - share * T
    base = two_lines(0.0, second=((0.0, y + 0.1 * slope), (0.1, y)))
    base["bodies"][body]["points"]["S"] = [0.1, y]
    base["beams"]["upper"]["thickness"] = {"at": [0.0, 1.0], "values": [T * (1 + 1e-9), T]}
    return edited(("beams/upper/end", {"joint": joint, "point": "S"}), base=base)


def bows(gap):
    """Two bows: the lower bow's top at (0.05, 0.01), the upper bow's bottom at (0.025, 0.007 + gap)."""
    bow = {"kind": "polynomial", "axis": "x", "range": [0.0, 0.1]}
    data = two_lines(0.012 + gap)
    data["beams"]["lower"]["curve"] = {**bow, "coefficients": [0.0, 0.4, -4.0]}
    data["beams"]["upper"]["curve"] = {**bow, "coefficients": [0.012 + gap, -0.4, 8.0]}
    return data


def leaning(closer):
    """Lines with an angle between them, and edges in touch all along: u is normal to the lower edge."""
    sine = 0.01
    u, along = np.array([-sine, sqrt(1.0 - sine**2)]), np.array([sqrt(1.0 - sine**2), sine])
    middle = np.array([0.05, 0.0]) + (0.5e-3 + sine * 0.05 + 0.001 - closer) * u
    ends = tuple(tuple((middle + way * along).tolist()) for way in (-0.04, 0.04))
    thickness = {"at": [0.0, 1.0], "values": [0.001, 0.001 + 2.0 * sine * 0.1]}
    return edited((OF_LOWER, thickness), base=two_lines(0.0, second=ends))


def ring(opening, direction="counterclockwise", radius=0.03):
    """A beam on a circle whose ends are a chord ``opening`` apart, with contact of the beam with itself."""
    half = np.arcsin(0.5 * opening / radius)
    sign = 1.0 if direction == "counterclockwise" else -1.0
    start, end = ([radius * np.cos(a), radius * np.sin(a)] for a in (sign * half, -sign * half))
    arc = {"kind": "arc", "center": [0.0, 0.0], "start": start, "end": end, "direction": direction}
    return cantilever(arc, start, end) | {"contacts": {"own": {"kind": "beam-self", "beam": "lower"}}}


def through(points, thickness=T):
    """A beam through points."""
    return cantilever({"kind": "spline", "points": points}, points[0], points[-1], thickness=thickness)


BOW = [[0.06 + 0.025 * cos(a), 0.025 + 0.025 * sin(a)] for a in np.linspace(-pi / 2, pi / 2, 13)]
HAIRPIN = [[0.0, 0.0], [0.02, 0.0], [0.04, 0.0], *BOW, [0.04, 0.05], [0.01, 0.012]]
HALVES = [shape_of(spline(HAIRPIN)).point(np.linspace(*ends, 2001)) for ends in ((0.0, 0.4), (0.6, 1.0))]
NECK = float(cKDTree(HALVES[0]).query(HALVES[1])[0].min())
"""Least distance of the hairpin's halves, between the places of two dense halves."""
LOOP = [[0.1 + 0.03 * cos(a), 0.03 * sin(a)] for a in np.linspace(-0.4 * pi, 0.4 * pi, 11)]

HOLLOW = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, 0.0, 50.0], "range": [0.0, 0.1]}
BOWL = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, -4.0, 40.0], "range": [0.0, 0.1]}
DISH = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, -0.4, 4.0], "range": [0.0, 0.1]}
SHORT = {"kind": "arc", "center": [0.0, 0.0], "start": [R, 0.0], "end": [0.0, R], "direction": "counterclockwise"}
HALF_CIRCLE = {"kind": "arc", "center": [0.05, 0.0], "start": [0.0, 0.0], "end": [0.1, 0.0], "direction": "clockwise"}
THICKNESS, TOUCH = "beams.lower.thickness", "contacts.touch"


def tapered(inner, outer):
    """A beam along y = 50 x², of radius 0.01 m at the start only, with two thicknesses."""
    size = {"at": [0.0, 0.2, 0.3, 1.0], "values": [inner, inner, outer, outer]}
    return cantilever(HOLLOW, (0.0, 0.0), (0.1, 0.5), thickness=size)


def round_arc(radius):
    """A beam on an arc of 50 mm, and a circle about its centre."""
    arc = {"kind": "arc", "center": [0.0, 0.0], "start": [0.05, 0.0], "end": [-0.05, 0.0]}
    data = cantilever({**arc, "direction": "counterclockwise"}, arc["start"], arc["end"])
    circle = {"kind": "beam-circle", "beam": "lower", "body": "ground", "center": [0.0, 0.0], "radius": radius}
    return data | {"contacts": {"touch": circle}}


def uniform(curve, axis, end=(0.1, 0.0)):
    """A beam with uniform elements along an axis."""
    return cantilever(curve, (0.0, 0.0), end, paper={"uniform": axis})


FORK, FOLD = ((0.0, 0.0), (0.08, 0.04)), ((0.0, 0.0), (0.08, 0.001))
TEE, CROSS = ((0.05, 0.0), (0.05, 0.08)), ((0.05, -0.03), (0.05, 0.08))
EDGES = [CIRCLE, LINE, HALF_PLANE, FUNCTION, ELLIPSE, SPLINE]
RACK = [[-0.01, -0.02], [0.03, -0.02], [0.035, -0.01], [0.045, -0.01], [0.05, -0.02], [0.12, -0.02]]
OTHER_SIDE = [("side", "right"), ("normal", [0, -1.0]), ("side", "below"), ("side", "inside"), ("side", "right")]

FITS = {
    # beams may touch, be apart, and overlap by rounded coordinates
    **{f"hinge {gap}": hinge(gap) for gap in (5e-4, 1e-9, 0.0, -0.5e-6 * T, -0.99e-3 * T)},
    **{f"lines {gap}": two_lines(gap) for gap in (T, -T, 1.1 * T, T * (1 - 0.99e-3))},
    # 6.35e-4: overlap of the gripper with the printed digits of its coordinates
    **{f"one block {share}": from_one_block(share) for share in (0.0, 6.35e-4, 9e-4)},
    "tee": two_lines(0.0, thick=False, second=TEE),
    "fork": two_lines(0.0, second=FORK),
    "bows": bows(0.02),
    "leaning": leaning(0.0),
    "open ring": ring(1.0001 * T),
    "open ring, clockwise": ring(1.0001 * T, "clockwise"),
    # ends of a short arc are near each other along the arc
    "short arc": cantilever(SHORT, SHORT["start"], SHORT["end"], thickness=0.2 * R * pi / 2 * 0.99),
    "open loop": through([[0.0, -0.04], *LOOP, [0.0, 0.04]]),
    **{f"hairpin {share}": through(HAIRPIN, share * NECK) for share in (0.9, 0.999)},
    "bend": cantilever(BOWL, (0, 0), (0.1, 0), thickness=0.0124),
    "thick beside a bend": tapered(0.004, 0.028),
    **{f"uniform {k}": uniform(c, "x") for k, c in enumerate((straight((0, 0), (L, 0)), HALF_CIRCLE, DISH))},
    # pieces of a line on the same straight line do not meet
    "rack": over({**LINE, "points": RACK}),
    # beside the ends of a line is no solid; the end of a thick beam's line is round
    "beside a line": over({**LINE, "points": [[0.2, 0.05], [0.3, 0.05]]}),
    "before a line": over({**LINE, "points": [[L + 0.5 * T + 1e-6, 0.5 * T], [L + 0.1, 0.05]]}),
    "inside an arc": round_arc(0.05 - 0.5 * T),
    "less than its length": over(CIRCLE, -0.9e-6 * L, thick=False),
    # an edge as far from a joint as the joint may be from the end of its beam
    **{
        f"joined {joint} {y}": over({**LINE, "points": [[-0.01, y], [0.12, y]]}, thick=False, start=joint)
        for joint in ("pin", "weld")
        for y in (0.0, 5e-8)
    },
}
"""Scenes without overlap, by name."""

REFUSED = {
    **{
        f"hinge {share}": (
            hinge(-share * T),
            "contacts.contact",
            f"start by {share * T:.3g} m, {share:.3g} of their mean",
        )
        for share in (1.01e-3, 0.5)
    },
    # beyond the crossing of the neutral lines the depth is all of t
    "crossed hinge": (hinge(-1.5 * T), "contacts.contact", ", 1 of their mean thickness"),
    **{f"lines {gap}": (two_lines(gap), TOUCH, "overlap at the start") for gap in (0.9 * T, T * (1 - 1.01e-3))},
    "too much": (from_one_block(2e-3), TOUCH, "0.002 of their mean thickness"),
    **{
        name: (from_one_block(6.35e-4, **change), TOUCH, "0.000635 of their mean thickness")
        for name, change in {
            "a pin": {"joint": "pin"},
            "two bodies": {"body": "ground"},
            "along": {"slope": 0.0},
        }.items()
    },
    "cross": (two_lines(0.0, thick=False, second=CROSS), TOUCH, "cross at the start, at (0.05, 0) m"),
    "fold": (two_lines(0.0, second=FOLD), TOUCH, "overlap"),
    "bows": (bows(0.0), TOUCH, "overlap at the start"),
    "leaning": (leaning(1e-8), TOUCH, "overlap at the start by 1e-08 m"),
    "ring": (ring(0.9 * T), "beams.lower.curve", "overlaps itself: near (0.029986497, 0.0009) m"),
    "ring, clockwise": (ring(0.9 * T, "clockwise"), "beams.lower.curve", "0.0018 m from itself, and is 0.002 m thick"),
    "loop": (through([[0.0, -0.04], *LOOP[::-1], [0.0, 0.04]]), "beams.lower.curve", "a beam that overlaps itself"),
    **{
        f"hairpin {share}": (through(HAIRPIN, share * NECK), "beams.lower.curve", f"{NECK:.3g} m from itself")
        for share in (1.001, 1.1)
    },
    "bend": (
        cantilever(BOWL, (0, 0), (0.1, 0), thickness=0.0126),
        THICKNESS,
        "half of which is 0.504 of the radius of curvature at 0.5 of the length, near (0.05, -0.1) m",
    ),
    "thick at a bend": (tapered(0.028, 0.004), THICKNESS, "radius of curvature"),
    "thick all along": (tapered(0.028, 0.028), THICKNESS, "radius of curvature"),
    **{
        f"uniform {k}": (uniform(c, "y"), "beams.lower.paper.uniform", "'y', along which the curve turns back")
        for k, c in enumerate((straight((0, 0), (L, 0)), HALF_CIRCLE, DISH))
    },
    **{
        f"circle {share}": (
            over(CIRCLE, -share * T),
            TOUCH,
            f"start by {share * T:.3g} m, {share:.3g} of its thickness",
        )
        for share in (2e-6, 1e-3, 0.5)
    },
    "a share of its length": (over(CIRCLE, -2e-3 * L, thick=False), TOUCH, "by 0.0002 m, 0.002 of its length"),
    # the nearest place is a quarter of the length beside the center, the circle ten lengths wide
    **{
        f"inside, thick {thick}": (
            over(
                {**CIRCLE, "radius": 10 * L, "center": [0.5 * L, (0.5 * T if thick else 0.0) - 0.25 * L]}, thick=thick
            ),
            TOUCH,
            f"overlaps the circle at the start by {9.75 * L + (0.5 * T if thick else 0.0):.3g} m",
        )
        for thick in (True, False)
    },
    "inside an arc": (round_arc(0.05 - 0.5 * T + 1e-5), TOUCH, "by 1e-05 m"),
    "round an arc": (round_arc(0.1), TOUCH, "by 0.051 m"),
    "behind a line": (over({**LINE, "points": [[-0.2, 0.05], [0.3, 0.05]]}), TOUCH, "on the wrong side"),
    "end of a line": (over({**LINE, "points": [[L + 0.5 * T - 1e-6, 0.5 * T], [L + 0.1, 0.05]]}), TOUCH, "wrong side"),
    **{
        f"joined {joint}": (
            over({**LINE, "points": [[-0.01, 5e-6], [0.12, 5e-6]]}, thick=False, start=joint),
            TOUCH,
            "",
        )
        for joint in ("pin", "weld")
    },
}
"""Scenes with an overlap, by name, with the key and a part of the sentence."""


@pytest.mark.parametrize("name", FITS)
def test_beams_that_touch_or_are_apart_pass(name):
    assert mistakes(base=FITS[name]) == {}


@pytest.mark.parametrize("name", REFUSED)
def test_an_overlap_is_refused_with_its_depth(name):
    data, key, words = REFUSED[name]
    found = mistakes(base=data)
    assert list(found) == [key]
    assert words in found[key]


@pytest.mark.parametrize("thick", [True, False])
@pytest.mark.parametrize("contact", EDGES, ids=[each["kind"] for each in EDGES])
def test_a_beam_may_touch_an_edge_or_be_apart_and_is_told_how_deep_it_is(contact, thick):
    for gap in (0.0, 1e-12, 0.01, -0.5e-6 * T):
        for body in ("ground", "block"):
            assert mistakes(base=over(contact, gap, thick=thick, body=body)) == {}, gap
    found = mistakes(base=over(contact, -0.002, thick=thick))
    assert list(found) == [TOUCH]
    assert "'beam' that overlaps" in found[TOUCH] or "'beam' on the wrong side" in found[TOUCH]
    assert "by 0.002 m" in found[TOUCH]
    if contact is not CIRCLE:
        key, value = OTHER_SIDE[EDGES.index(contact) - 1]
        assert list(mistakes((f"contacts/touch/{key}", value), base=over(contact, 0.001, thick=thick))) == [TOUCH]


@pytest.mark.parametrize(
    ("values", "apart"), [([0.001, 0.002], 0.002), ([0.001, 0.0013, 0.001], 0.00165), ([0.0012, 0.001, 0.0018], 0.0019)]
)
def test_edges_of_a_varying_thickness_touch_where_it_is_thickest(values, apart):
    """Two level lines, the upper line 2 mm thick."""
    at = [0.0, 0.37, 1.0] if len(values) == 3 else [0.0, 1.0]
    for gap, fits in ((apart, True), (apart + 1e-5, True), (apart - 1e-8, False), (0.4 * apart, False)):
        found = mistakes((OF_LOWER, {"at": at, "values": values}), base=two_lines(gap))
        assert (found == {}) if fits else (f"overlap at the start by {apart - gap:.3g} m" in found[TOUCH])


SCALED = [HINGE, CIRCULAR, BOWED, THROUGH_POINTS, over(LINE, -0.002)]


def scaled(value, factor, key=""):
    """Data with all lengths times a factor; the coefficient k of a polynomial times factor^(1-k)."""
    if key == "coefficients":
        return [each * factor ** (1 - k) for k, each in enumerate(value)]
    if isinstance(value, dict):
        return {name: scaled(item, factor, name if key != "points" else key) for name, item in value.items()}
    if isinstance(value, list):
        return [scaled(item, factor, key) for item in value]
    lengths = {"points", "start", "end", "center", "thickness", "width", "radius", "range"}
    return factor * value if key in lengths and isinstance(value, float | int) else value


@pytest.mark.parametrize("exponent", [-140, 140])
@pytest.mark.parametrize("data", SCALED, ids=["arcs", "circle", "polynomial", "spline", "overlap"])
def test_a_scene_at_any_scale_is_the_same_question(data, exponent):
    """All lengths times a power of two: no bound stands on a length."""
    parts = {name: scaled(data[name], 2.0**exponent) for name in ("beams", "bodies")}
    contacts = {
        name: {k: each[k] if k == "paper" else scaled(each[k], 2.0**exponent, k) for k in each}
        for name, each in data.get("contacts", {}).items()
    }
    assert list(mistakes(base=data | parts | {"contacts": contacts})) == list(mistakes(base=data))
