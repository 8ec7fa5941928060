"""Neutral lines that are polynomials: their geometry beside closed forms, and what is wrong with some of them."""

from math import asinh, hypot, sqrt

import numpy as np
import pytest

from cprbm_scene import Line, Polynomial, scene_from
from cprbm_scene.geometry import (
    arc_length,
    largest_curvature,
    points_on,
    tangents_on,
)
from tests.cprbm_scene.editing import REMOVED, distance_to, edited, line_distance, mistakes, two_lines

A, TIP = 29.28, 0.05  # the parabola x = A y²/2 + 0.05 m up to y = TIP
PARABOLA = {"kind": "polynomial", "axis": "y", "coefficients": [0.05, 0.0, A / 2], "range": [0.0, TIP]}
U = np.linspace(0.0, 1.0, 23)


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
    assert arc_length(curve) == pytest.approx(length, rel=1e-14)
    x, y = points_on(curve, U).T
    assert x == pytest.approx(0.05 + A / 2 * y**2, abs=1e-15)
    along = [abs(up_to(value) - up_to(span[0])) / length for value in y]
    assert along == pytest.approx(U, abs=1e-13)
    sense = np.sign(span[1] - span[0])
    tangents = sense * np.column_stack([A * y, np.ones_like(y)]) / np.hypot(1.0, A * y)[:, None]
    assert tangents_on(curve, U) == pytest.approx(tangents, abs=1e-13)


@pytest.mark.parametrize(("span", "nearest"), [((0.0, TIP), 0.0), ((-0.03, 0.041), 0.0), ((0.02, 0.1), 0.02)])
def test_the_largest_curvature_of_a_parabola_is_nearest_its_vertex(span, nearest):
    # reference: κ = A/(1 + (A y)²)^(3/2)
    assert largest_curvature(parabola(*span)) == pytest.approx(A / hypot(1.0, A * nearest) ** 3, rel=1e-12)


def test_a_steep_parabola_turns_sharply_at_its_vertex():
    curve = polynomial("x", [0.0, 0.0, 400.0], (-0.7131, 1.0))
    assert largest_curvature(curve) == pytest.approx(800.0, rel=1e-12)


def test_the_largest_curvature_of_a_cubic_inside_its_range():
    # reference: y = x³, κ' = 0 at x⁴ = 1/45
    x = 45.0**-0.25
    curve = polynomial("x", [0.3, 0.0, 0.0, 1.0], (-0.1, 1.3))
    assert largest_curvature(curve) == pytest.approx(6.0 * x / (1.0 + 9.0 * x**4) ** 1.5, rel=1e-12)


@pytest.mark.parametrize("axis", ["x", "y"])
def test_ends_are_where_the_beam_begins_and_ends(axis):
    curve = polynomial(axis, [1.0, -2.0, 0.0, 3.0], (0.5, -0.25))
    start, end = (0.5, 1.0 - 1.0 + 3.0 / 8.0), (-0.25, 1.0 + 0.5 - 3.0 / 64.0)
    assert (curve.start, curve.end) == ((start, end) if axis == "x" else (start[::-1], end[::-1]))
    assert points_on(curve, np.array([0.0, 1.0])) == pytest.approx(np.array([curve.start, curve.end]), abs=1e-15)


def test_degree_one_is_a_line():
    line = Line(kind="line", start=(0.1, 0.7), end=(-0.2, 0.55))
    curve = polynomial("x", [0.65, 0.5], (0.1, -0.2))
    for of in (arc_length, largest_curvature, lambda c: distance_to(c, (0.0, 0.0))):
        assert of(curve) == pytest.approx(of(line), rel=1e-13, abs=1e-15)
    for at in (points_on, tangents_on):
        assert at(curve, U) == pytest.approx(at(line, U), abs=1e-14)


def test_distances():
    # reference: from (0.05, p) on the parabola's axis of x, and a circle's centre far inside its bow
    curve = parabola(-TIP, TIP)
    assert distance_to(curve, (0.05 - 0.013, 0.0)) == pytest.approx(0.013, rel=1e-12)
    # beyond the radius at the vertex, 1/A: the feet are at y² = 2(h − 1/A)/A, the distance² is 2h/A − 1/A²
    h = 0.06
    assert distance_to(curve, (0.05 + h, 0.0)) == pytest.approx(sqrt(2 * h / A - 1 / A**2), rel=1e-12)
    line = Line(kind="line", start=(0.04, -0.1), end=(0.04, 0.1))
    assert line_distance(line, curve, 0.009) == pytest.approx(0.01, rel=1e-10)


def bowed(**changes):
    """A cantilever of one beam on the parabola."""
    data = two_lines(0.01)
    del data["beams"]["upper"], data["contacts"], data["bodies"]["ground"]["points"]["P"]
    data["beams"]["lower"]["curve"] = {**PARABOLA, **changes}
    data["bodies"]["ground"]["points"]["O"] = [0.05, 0.0]
    data["bodies"]["block"]["points"]["Q"] = [0.05 + A / 2 * TIP**2, TIP]
    return data


def test_what_is_written_is_what_is_read():
    curve = scene_from(bowed()).beams["lower"].curve
    assert curve == parabola()
    assert (curve.start, curve.end) == ((0.05, 0.0), (pytest.approx(0.0866), TIP))


CURVE = "beams/lower/curve"
WRONG = [
    (f"{CURVE}/axis", "z", "beams.lower.curve.axis", "'z'; one of 'x' or 'y'"),
    (f"{CURVE}/axis", REMOVED, "beams.lower.curve.axis", "required"),
    (f"{CURVE}/kind", "polynomal", "beams.lower.curve.kind", "one of 'line', 'arc', 'polynomial'"),
    (f"{CURVE}/coefficients", [0.05], "beams.lower.curve.coefficients", "at least 2"),
    (f"{CURVE}/coefficients", [0.05, float("nan")], "beams.lower.curve.coefficients[1]", "a finite number"),
    (f"{CURVE}/coefficients", [0.05, "1"], "beams.lower.curve.coefficients[1]", "'1'; a number"),
    (f"{CURVE}/coefficients", [0.05] + [0.0] * 21, "beams.lower.curve.coefficients", "22 coefficients; at most 21"),
    (f"{CURVE}/coefficients", [0.05, 2e3], "beams.lower.curve.coefficients", "a slope of up to 2e+03 in the range"),
    (f"{CURVE}/coefficients", [0.05, 2e3], "beams.lower.curve.coefficients", "may be a function of x"),
    (f"{CURVE}/coefficients", [1e308, 1e308, 1e308], "beams.lower.curve.coefficients", "a slope of at most 1000"),
    (f"{CURVE}/coefficients", [1e5, 0.1], "beams.lower.curve", "at coordinates up to 1e+05"),
    (f"{CURVE}/range", [0.05, 0.05], "beams.lower.curve.range", "from 0.05 m to the same 0.05 m; two different values"),
    (f"{CURVE}/range", [0.05], "beams.lower.curve.range[1]", "an item"),
    (f"{CURVE}/range", [-1e308, 1e308], "beams.lower.curve.range[0]", "between 1e-50 and 1e+50 in SI units"),
    (f"{CURVE}/rnage", [0.0, 0.05], "beams.lower.curve.rnage", "is 'range' meant"),
    (f"{CURVE}/start", [0.0, 0.0], "beams.lower.curve.start", "'kind', 'axis', 'coefficients', 'range'"),
    (f"{CURVE}/range", [0.0, 0.06], "beams.lower.end", "the curve's end is at (0.102704, 0.06) m, the point 'Q' at"),
    (f"{CURVE}/range", [0.05, 0.0], "beams.lower.start", "the point 'O' at (0.05, 0) m"),
    ("bodies/block/points/Q", [0.0866, 0.0501], "beams.lower.end", "meets no body"),
    ("beams/lower/thickness", 0.0137, "beams.lower.thickness", "0.213 of the beam's length"),
]


@pytest.mark.parametrize(("path", "value", "key", "words"), WRONG, ids=[row[2] for row in WRONG])
def test_a_mistake_is_named_by_its_key(path, value, key, words):
    assert words in mistakes((path, value), base=bowed())[key]


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
