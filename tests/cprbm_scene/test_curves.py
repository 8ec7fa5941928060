"""Neutral lines and sizes along them: geometry beside closed forms."""

from math import asinh, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest
from scipy.spatial import cKDTree

from cprbm_scene import Line, Polynomial, Profile, Spline, scene_from
from cprbm_scene.curve_records import shape_of
from tests.cprbm_scene.editing import REMOVED, distance_to, edited, line_distance, mistakes, two_lines
from tests.cprbm_scene.scenes import PARABOLA, POINTS, TIP, A, bowed, through_points

FRACTIONS = np.linspace(0.0, 1.0, 23)


def polynomial(axis, coefficients, span):
    return Polynomial(kind="polynomial", axis=axis, coefficients=tuple(coefficients), range=span)


def parabola(first=0.0, last=TIP):
    return polynomial("y", PARABOLA["coefficients"], (first, last))


def up_to(y):
    """Arc length of the parabola from its vertex: (z √(1 + z²) + arsinh z)/2A with z = A y."""
    z = A * y
    return (z * sqrt(1.0 + z * z) + asinh(z)) / (2.0 * A)


@pytest.mark.parametrize("span", [(0.0, TIP), (TIP, 0.0), (-0.03, 0.041), (0.2, 0.1)])
def test_a_parabola_by_its_closed_form(span):
    curve = parabola(*span)
    length = abs(up_to(span[1]) - up_to(span[0]))
    assert shape_of(curve).length == pytest.approx(length, rel=1e-14)
    x, y = shape_of(curve).point(FRACTIONS).T
    assert x == pytest.approx(0.05 + A / 2 * y**2, abs=1e-15)
    along = [abs(up_to(value) - up_to(span[0])) / length for value in y]
    assert along == pytest.approx(FRACTIONS, abs=1e-13)
    sense = np.sign(span[1] - span[0])
    tangents = sense * np.column_stack([A * y, np.ones_like(y)]) / np.hypot(1.0, A * y)[:, None]
    assert shape_of(curve).tangent(FRACTIONS) == pytest.approx(tangents, abs=1e-13)


@pytest.mark.parametrize(("span", "nearest"), [((0.0, TIP), 0.0), ((-0.03, 0.041), 0.0), ((0.02, 0.1), 0.02)])
def test_the_largest_curvature_of_a_parabola_is_nearest_its_vertex(span, nearest):
    # reference: κ = A/(1 + (A y)²)^(3/2)
    assert shape_of(parabola(*span)).largest_curvature == pytest.approx(A / hypot(1.0, A * nearest) ** 3, rel=1e-12)


def test_a_steep_parabola_turns_sharply_at_its_vertex():
    curve = polynomial("x", [0.0, 0.0, 400.0], (-0.7131, 1.0))
    assert shape_of(curve).largest_curvature == pytest.approx(800.0, rel=1e-12)


def test_the_largest_curvature_of_a_cubic_inside_its_range():
    # reference: y = x³, κ' = 0 at x⁴ = 1/45
    x = 45.0**-0.25
    curve = polynomial("x", [0.3, 0.0, 0.0, 1.0], (-0.1, 1.3))
    assert shape_of(curve).largest_curvature == pytest.approx(6.0 * x / (1.0 + 9.0 * x**4) ** 1.5, rel=1e-12)


@pytest.mark.parametrize("axis", ["x", "y"])
def test_ends_are_where_the_beam_begins_and_ends(axis):
    curve = polynomial(axis, [1.0, -2.0, 0.0, 3.0], (0.5, -0.25))
    start, end = (0.5, 1.0 - 1.0 + 3.0 / 8.0), (-0.25, 1.0 + 0.5 - 3.0 / 64.0)
    assert (curve.start, curve.end) == ((start, end) if axis == "x" else (start[::-1], end[::-1]))
    assert shape_of(curve).point(np.array([0.0, 1.0])) == pytest.approx(np.array([curve.start, curve.end]), abs=1e-15)


def test_degree_one_is_a_line():
    line = Line(kind="line", start=(0.1, 0.7), end=(-0.2, 0.55))
    curve = polynomial("x", [0.65, 0.5], (0.1, -0.2))
    graph, straight = shape_of(curve), shape_of(line)
    assert graph.length == pytest.approx(straight.length, rel=1e-13)
    assert graph.largest_curvature == pytest.approx(0.0, abs=1e-15)
    assert distance_to(curve, (0.0, 0.0)) == pytest.approx(distance_to(line, (0.0, 0.0)), rel=1e-13)
    assert graph.point(FRACTIONS) == pytest.approx(straight.point(FRACTIONS), abs=1e-14)
    assert graph.tangent(FRACTIONS) == pytest.approx(straight.tangent(FRACTIONS), abs=1e-14)


def test_distances():
    # reference: from (0.05, p) on the parabola's axis of x, and a circle's centre far inside its bow
    curve = parabola(-TIP, TIP)
    assert distance_to(curve, (0.05 - 0.013, 0.0)) == pytest.approx(0.013, rel=1e-12)
    # beyond the radius at the vertex, 1/A: the feet are at y² = 2(h − 1/A)/A, the distance² is 2h/A − 1/A²
    h = 0.06
    assert distance_to(curve, (0.05 + h, 0.0)) == pytest.approx(sqrt(2 * h / A - 1 / A**2), rel=1e-12)
    line = Line(kind="line", start=(0.04, -0.1), end=(0.04, 0.1))
    assert line_distance(line, curve, 0.009) == pytest.approx(0.01, rel=1e-10)


def test_a_polynomial_reads_as_it_is_written():
    curve = scene_from(bowed()).beams["lower"].curve
    assert curve == parabola()
    assert (curve.start, curve.end) == ((0.05, 0.0), (pytest.approx(0.0866), TIP))


CURVE = "beams/lower/curve"


def test_a_thickness_near_the_radius_at_the_vertex():
    # the radius there is 1/80 m, thrice that of the parabola's chord
    curve = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, 0.0, 40.0], "range": [-0.1, 0.1]}
    base = edited(
        (CURVE, curve),
        ("beams/lower/thickness", 0.0126),
        ("bodies/ground/points/O", [-0.1, 0.4]),
        ("bodies/block/points/Q", [0.1, 0.4]),
        base=bowed(),
    )
    assert "half of which is 0.504 of the radius of curvature" in mistakes(base=base)["beams.lower.thickness"]
    assert mistakes(("beams/lower/thickness", 0.0124), base=base) == {}


def test_terms_that_cancel_leave_no_digits():
    # (y − 1000)² in full: what is left of the sum has lost six digits and more
    coefficients = [1e6, -2e3, 1.0]
    base = edited(
        (f"{CURVE}/coefficients", coefficients),
        (f"{CURVE}/range", [999.9, 1000.1]),
        ("bodies/ground/points/O", [0.01, 999.9]),
        ("bodies/block/points/Q", [0.01, 1000.1]),
        base=bowed(),
    )
    assert "a term of 2e+06 m in a curve of 0.201 m" in mistakes(base=base)["beams.lower.curve.coefficients"]


def test_an_overlap_of_two_bows_is_refused_and_a_touch_is_not():
    def pair(gap):
        data = edited(("beams/upper/curve", REMOVED), base=two_lines(0.01))
        bow = {"kind": "polynomial", "axis": "x", "range": [0.0, 0.1]}
        data["beams"]["lower"]["curve"] = {**bow, "coefficients": [0.0, 0.4, -4.0]}
        data["beams"]["upper"]["curve"] = {**bow, "coefficients": [0.01 + 0.002 + gap, -0.4, 4.0 + 4.0]}
        data["bodies"]["ground"]["points"]["P"] = [0.0, 0.012 + gap]
        return data

    # the lower bow's top is at (0.05, 0.01); the upper one's bottom at (0.025, 0.007 + gap): they cross
    assert "overlap at the start" in mistakes(base=pair(0.0))["contacts.touch"]
    assert mistakes(base=pair(0.02)) == {}


def test_a_parabola_at_any_scale():
    """No bound stands on a length: the same question in other units is answered alike."""
    for exponent in (-140, 0, 140):
        factor = 2.0**exponent
        data = bowed(coefficients=[0.05 * factor, 0.0, A / 2 / factor], range=[0.0, TIP * factor])
        for key in ("thickness", "width"):
            data["beams"]["lower"][key] *= factor
        for body in data["bodies"].values():
            body["points"] = {name: [factor * value for value in place] for name, place in body["points"].items()}
        assert scene_from(data).name == "pair"


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
    assert shape_of(curve).length == pytest.approx(a * (z * sqrt(1.0 + z * z) + asinh(z)), rel=1e-14)
    x, y = shape_of(curve).point(U).T
    assert y == pytest.approx(x**2 / (2 * a), abs=1e-15)
    assert shape_of(curve).largest_curvature == pytest.approx(1.0 / a, rel=1e-12)
    assert shape_of(curve).curvature(U) == pytest.approx(1.0 / a / (1.0 + (x / a) ** 2) ** 1.5, rel=1e-12)
    slope = x / a
    tangent = np.column_stack([np.ones_like(x), slope]) / np.hypot(1.0, slope)[:, None]
    assert shape_of(curve).tangent(U) == pytest.approx(tangent, abs=1e-13)


def test_points_of_a_line_are_a_line():
    curve = spline([(0.1, 0.7), (0.0, 0.65), (-0.13, 0.585), (-0.2, 0.55)])
    line = Line(kind="line", start=(0.1, 0.7), end=(-0.2, 0.55))
    assert shape_of(curve).length == pytest.approx(shape_of(line).length, rel=1e-14)
    assert shape_of(curve).point(U) == pytest.approx(shape_of(line).point(U), abs=1e-14)
    assert shape_of(curve).tangent(U) == pytest.approx(shape_of(line).tangent(U), abs=1e-13)
    assert shape_of(curve).largest_curvature < 1e-11
    assert distance_to(curve, (0.0, 0.0)) == pytest.approx(distance_to(line, (0.0, 0.0)), rel=1e-12)


@pytest.mark.parametrize("directed", [False, True])
def test_points_of_a_circle_come_near_it(directed):
    """Reference: Floater's order, four in the distance of the points; two less in the curvature."""
    radius = 0.03
    errors = []
    for n in (9, 17, 33, 65):
        curve = on_a_circle(n, radius, directed=directed)
        r = np.hypot(*shape_of(curve).point(U).T)
        errors.append([np.max(np.abs(r - radius)), np.max(np.abs(shape_of(curve).curvature(U) - 1.0 / radius))])
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx([4.0, 2.0], abs=0.25 if directed else 0.7)
    assert np.all(np.array(errors[-1]) < [1e-8, 0.06])
    assert shape_of(curve).length == pytest.approx(2.0 * radius, rel=1e-7)


def test_it_meets_its_points_with_one_tangent_and_one_curvature():
    curve = spline([(0.0, 0.0), (0.4, 0.3), (0.7, -0.1), (1.6, 0.0), (1.7, 0.6)], start=(0.0, -2.0), end=(1.0, 1.0))
    assert (curve.start, curve.end) == ((0.0, 0.0), (1.7, 0.6))
    for point in curve.points:
        beside = Line(kind="line", start=point, end=(point[0] + 0.01, point[1] - 0.003))
        assert line_distance(curve, beside) == pytest.approx(0.0, abs=1e-9)
    assert shape_of(curve).tangent(np.array([0.0, 1.0])) == pytest.approx(np.array([[0.0, -1.0], [sqrt(0.5)] * 2]))
    fine = np.linspace(0.0, 1.0, 20_001)
    assert np.max(np.abs(np.diff(shape_of(curve).curvature(fine)))) < 2e-2 * shape_of(curve).largest_curvature
    # by small steps
    p = shape_of(curve).point(fine)
    assert np.sum(np.hypot(*np.diff(p, axis=0).T)) == pytest.approx(shape_of(curve).length, rel=1e-6)
    assert shape_of(curve).largest_curvature == pytest.approx(np.max(shape_of(curve).curvature(fine)), rel=1e-4)


def test_the_way_to_another_line():
    # reference: the parabola y = x²/2 and the line y = x − 1.3, nearest where the slope is one: 0.8/√2
    curve = spline([(-2.0, 2.0), (0.0, 0.0), (2.0, 2.0)])
    line = Line(kind="line", start=(0.0, -1.3), end=(3.0, 1.7))
    assert line_distance(curve, line, 0.56) == pytest.approx(0.8 / sqrt(2.0), rel=1e-10)


def test_a_spline_reads_as_it_is_written():
    curve = scene_from(through_points(end_direction=[1, -0.5])).beams["lower"].curve
    assert curve == spline(POINTS, end=(1.0, -0.5))


LOWER = "beams.lower.curve"


def test_a_sharp_bend_is_no_beam():
    sharp = [[0.0, 0.0], [0.049, 0.0], [0.05, 0.0005], [0.049, 0.001], [0.0, 0.006]]
    edits = ((f"{CURVE}/points", sharp), ("bodies/block/points/Q", sharp[-1]))
    assert "of the radius of curvature" in mistakes(*edits, base=through_points())["beams.lower.thickness"]


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
    first, second = (
        shape_of(curve).point(np.linspace(0.0, 0.4, 2001)),
        shape_of(curve).point(np.linspace(0.6, 1.0, 2001)),
    )
    apart, _ = cKDTree(first).query(second)
    found = mistakes(*through(points, thickness=float(share * apart.min())), base=through_points())
    assert (LOWER in found) is overlaps
    assert not overlaps or f"it comes to {apart.min():.3g} m from itself" in found[LOWER]


def test_a_loop_crosses_itself():
    angle = np.linspace(-0.4 * pi, 0.4 * pi, 11)
    ring = [[0.1 + 0.03 * cos(a), 0.03 * sin(a)] for a in angle]
    start, end = [0.0, -0.04], [0.0, 0.04]
    assert mistakes(*through([start, *ring, end]), base=through_points()) == {}
    assert "a beam that overlaps itself" in mistakes(*through([start, *ring[::-1], end]), base=through_points())[LOWER]


LOWER_BEAM = "beams/lower"


SIZE = {"at": [0.0, 0.25, 1.0], "values": [0.003, 0.001, 0.002]}


def line(*edits):
    return edited(*edits, base=two_lines(0.01, thick=False))


def test_a_size_goes_straight_between_its_places():
    beam = scene_from(line((f"{LOWER_BEAM}/thickness", SIZE))).beams["lower"]
    assert isinstance(beam.thickness, Profile)
    at = np.array([[0.0, 0.125, 0.25], [0.5, 0.75, 1.0]])
    expected = np.array([[0.003, 0.002, 0.001], [0.004 / 3, 0.005 / 3, 0.002]])
    assert beam.thickness_at(at) == pytest.approx(expected, rel=1e-14)
    assert beam.width_at(at) == pytest.approx(np.full((2, 3), 0.01))
    assert (beam.thinnest, beam.thickest, beam.tapered) == (0.001, 0.003, True)
    assert beam.knots.tolist() == [0.0, 0.25, 1.0]


def test_kinks_of_both_sizes_are_knots():
    data = line(
        (f"{LOWER_BEAM}/thickness", SIZE),
        (f"{LOWER_BEAM}/width", {"at": [0.0, 0.7, 1.0], "values": [0.01, 0.02, 0.01]}),
    )
    assert scene_from(data).beams["lower"].knots.tolist() == [0.0, 0.25, 0.7, 1.0]


def test_a_profile_of_one_value_is_no_taper():
    size = {"at": [0.0, 1.0], "values": [0.002, 0.002]}
    data = edited((f"{LOWER_BEAM}/thickness", size), base=two_lines(0.01))
    assert not scene_from(data).beams["lower"].tapered


@pytest.mark.parametrize("value", ["thin", [0.001, 0.002], None])
def test_what_is_neither_number_nor_profile(value):
    found = mistakes((f"{LOWER_BEAM}/thickness", value), base=two_lines(0.01, thick=False))
    assert "a number, or a table with the keys 'at' and 'values'" in found["beams.lower.thickness"]


@pytest.mark.parametrize("thickness", [0.021, 0.9e-6])
def test_the_thinnest_and_the_thickest_place_are_in_proportion(thickness):
    found = mistakes(
        (f"{LOWER_BEAM}/thickness", {**SIZE, "values": [0.003, thickness, 0.002]}), base=two_lines(0.01, thick=False)
    )
    assert f"{thickness:g} m, which is" in found["beams.lower.thickness"]


def test_only_the_thickness_where_a_line_bends_must_fit_its_bend():
    # y = 50 x² has the radius 0.01 m where it begins, and is nearly straight for the most of its length
    curve = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, 0.0, 50.0], "range": [0.0, 0.1]}
    base = two_lines(0.01, thick=False)
    base["bodies"]["block"]["points"]["Q"] = [0.1, 0.5]
    base["beams"]["lower"]["curve"] = curve
    base["contacts"] = {}
    assert "radius of curvature" in mistakes((f"{LOWER_BEAM}/thickness", 0.028), base=base)["beams.lower.thickness"]
    outer = {"at": [0.0, 0.2, 0.3, 1.0], "values": [0.004, 0.004, 0.028, 0.028]}
    assert mistakes((f"{LOWER_BEAM}/thickness", outer), base=base) == {}
    inner = {"at": [0.0, 0.2, 0.3, 1.0], "values": [0.028, 0.028, 0.004, 0.004]}
    assert "radius of curvature" in mistakes((f"{LOWER_BEAM}/thickness", inner), base=base)["beams.lower.thickness"]


@pytest.mark.parametrize(
    ("values", "apart"), [([0.001, 0.002], 0.002), ([0.001, 0.0013, 0.001], 0.00165), ([0.0012, 0.001, 0.0018], 0.0019)]
)
def test_edges_of_a_varying_thickness_touch_where_it_is_thickest(values, apart):
    """Two level lines, the upper one 2 mm thick."""
    at = [0.0, 0.37, 1.0] if len(values) == 3 else [0.0, 1.0]
    for gap, fits in ((apart, True), (apart + 1e-5, True), (apart - 1e-8, False), (0.4 * apart, False)):
        found = mistakes((f"{LOWER_BEAM}/thickness", {"at": at, "values": values}), base=two_lines(gap))
        assert (found == {}) if fits else (f"overlap at the start by {apart - gap:.3g} m" in found["contacts.touch"])


def test_edges_of_a_varying_thickness_lean():
    """Lines that are not parallel, and whose edges touch all along: u is normal to these."""
    sine = 0.01
    u, along = np.array([-sine, np.sqrt(1.0 - sine**2)]), np.array([np.sqrt(1.0 - sine**2), sine])
    thickness = {"at": [0.0, 1.0], "values": [0.001, 0.001 + 2.0 * sine * 0.1]}
    for closer, fits in ((0.0, True), (1e-8, False)):
        middle = np.array([0.05, 0.0]) + (0.5e-3 + sine * 0.05 + 0.001 - closer) * u
        ends = tuple(tuple((middle + way * along).tolist()) for way in (-0.04, 0.04))
        found = mistakes((f"{LOWER_BEAM}/thickness", thickness), base=two_lines(0.0, second=ends))
        assert (found == {}) == fits, found


APART = two_lines(0.1)


HALF_CIRCLE = {"kind": "arc", "center": [0.05, 0.0], "start": [0.0, 0.0], "end": [0.1, 0.0], "direction": "clockwise"}


BOWL = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, -0.4, 4.0], "range": [0.0, 0.1]}


def with_elements(curve, axis):
    return edited(("beams/lower/curve", curve), ("beams/lower/paper", {"uniform": axis}), ("contacts", {}), base=APART)


@pytest.mark.parametrize(
    "curve", [APART["beams"]["lower"]["curve"], HALF_CIRCLE, BOWL], ids=["line", "half circle", "bowl"]
)
def test_elements_are_uniform_only_along_an_axis_along_which_the_beam_runs_one_way(curve):
    assert mistakes(base=with_elements(curve, "x")) == {}
    found = mistakes(base=with_elements(curve, "y"))
    assert list(found) == ["beams.lower.paper.uniform"]
    assert "'y', along which the curve turns back" in found["beams.lower.paper.uniform"]


def test_an_unknown_axis_of_elements():
    found = mistakes(base=with_elements(HALF_CIRCLE, "s"))
    assert list(found) == ["beams.lower.paper.uniform"]
    assert "'x'" in found["beams.lower.paper.uniform"]
