"""Clearance as drawn: beams of a contact, a beam and itself, circles and rigid edges."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from cprbm_scene import Arc, FunctionContact, HalfPlaneContact, Line, LineContact, Polynomial, SceneError, scene_from
from cprbm_scene.clearance import distance
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import CircleContact, EllipseContact, SplineContact
from tests.cprbm_scene.editing import HINGE, REMOVED, distance_to, edited, line_distance, mistakes, two_lines
from tests.cprbm_scene.scenes import CIRCLE, FUNCTION, HALF_PLANE, LINE, L, R, T, over, over_a_circle


def _hinge_with_gap(gap):
    """The hinge with its centres at ±(R + (t + gap)/2): edges ``gap`` apart."""
    y = 0.025 + 0.5 * (T + gap)
    edits = []
    for beam, sign, (start, end) in (("beam1", 1, "AB"), ("beam2", -1, "CD")):
        edits += [
            (f"beams/{beam}/curve/center", [0.026, sign * y]),
            (f"beams/{beam}/curve/start", [0.001, sign * y]),
            (f"beams/{beam}/curve/end", [0.051, sign * y]),
            (f"bodies/AC/points/{start}", [0.001, sign * y]),
            (f"bodies/BD/points/{end}", [0.051, sign * y]),
        ]
    return edited(*edits, base=HINGE)


@pytest.mark.parametrize("gap", [5e-4, 1e-9, 0.0, -0.5e-6 * T, -0.99e-3 * T])
def test_arcs_that_touch_or_are_apart_pass(gap):
    assert mistakes(base=_hinge_with_gap(gap)) == {}


@pytest.mark.parametrize("share", [1.01e-3, 0.5])
def test_arcs_that_overlap_are_refused_with_the_depth(share):
    (sentence,) = mistakes(base=_hinge_with_gap(-share * T)).values()
    assert f"overlap at the start by {share * T:.3g} m, {share:.3g} of their mean thickness" in sentence


def test_arcs_that_cross_are_refused():
    """Closer than the neutral lines' own crossing: their distance is nothing, the depth all of t."""
    (sentence,) = mistakes(base=_hinge_with_gap(-1.5 * T)).values()
    assert ", 1 of their mean thickness" in sentence


@pytest.mark.parametrize("gap", [T, -T, 1.1 * T, T * (1 - 0.99e-3)])
def test_parallel_lines_that_touch_along_their_length_pass(gap):
    assert mistakes(base=two_lines(gap)) == {}


@pytest.mark.parametrize("gap", [0.9 * T, T * (1 - 1.01e-3)])
def test_parallel_lines_that_overlap_are_refused(gap):
    assert "overlap at the start" in mistakes(base=two_lines(gap))["contacts.touch"]


def _from_one_block(share, *, slope=0.05, joint="weld", body="block"):
    """A level beam, and above it a beam of varying thickness that ends beside it and rises away."""
    y = T - share * T
    base = two_lines(0.0, second=((0.0, y + 0.1 * slope), (0.1, y)))
    base["bodies"][body]["points"]["S"] = [0.1, y]
    base["beams"]["upper"]["thickness"] = {"at": [0.0, 1.0], "values": [T * (1 + 1e-9), T]}
    return edited(("beams/upper/end", {"joint": joint, "point": "S"}), base=base)


@pytest.mark.parametrize("share", [0.0, 6.35e-4, 9e-4])
def test_beams_of_varying_thickness_may_overlap_beside_one_block(share):
    """6.35e-4 is what the gripper's coordinates make with the digits that are printed."""
    assert mistakes(base=_from_one_block(share)) == {}


@pytest.mark.parametrize(
    ("share", "change"),
    [(2e-3, {}), (6.35e-4, {"joint": "pin"}), (6.35e-4, {"body": "ground"}), (6.35e-4, {"slope": 0.0})],
    ids=["too much", "a pin", "two bodies", "all along"],
)
def test_every_other_overlap_of_a_varying_thickness_is_refused(share, change):
    found = mistakes(base=_from_one_block(share, **change))
    assert f"{share:.3g} of their mean thickness" in found["contacts.touch"]


def test_lines_without_thickness_may_touch_and_not_cross():
    tee = ((0.05, 0.0), (0.05, 0.08))
    cross = ((0.05, -0.03), (0.05, 0.08))
    assert mistakes(base=two_lines(0.0, thick=False, second=tee)) == {}
    found = mistakes(base=two_lines(0.0, thick=False, second=cross))
    assert "cross at the start, at (0.05, 0) m" in found["contacts.touch"]


def test_beams_that_share_an_end_may_overlap_beside_it_only():
    fork, fold = ((0.0, 0.0), (0.08, 0.04)), ((0.0, 0.0), (0.08, 0.001))
    assert mistakes(base=two_lines(0.0, second=fork)) == {}
    assert "overlap" in mistakes(base=two_lines(0.0, second=fold))["contacts.touch"]


ANGLES = st.floats(0.0, 6.28)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(offset=st.floats(2.1, 4.0), towards=ANGLES, radius=st.floats(0.2, 1.0))
def test_the_distance_of_two_circles_is_that_of_their_centres_less_the_radii(offset, towards, radius):
    """Nearly full circles whose openings point away from each other."""
    centre = (offset * np.cos(towards), offset * np.sin(towards))

    def ring(middle, R, opening):
        ends = [(middle[0] + R * np.cos(opening + d), middle[1] + R * np.sin(opening + d)) for d in (0.1, -0.1)]
        return Arc(kind="arc", center=middle, start=ends[0], end=ends[1], direction="counterclockwise")

    apart = line_distance(ring((0.0, 0.0), 1.0, towards + np.pi), ring(centre, radius, towards))
    assert apart == pytest.approx(offset - 1.0 - radius, abs=1e-8)


def test_a_crossing_is_found_where_another_place_is_nearly_as_near():
    """A chord cuts the arc twice, close to grazing: the distance is zero, not the samples' spacing."""
    arc = Arc(kind="arc", center=(0.0, 0.0), start=(1.0, 0.0), end=(-1.0, 0.0), direction="counterclockwise")
    chord = Line(kind="line", start=(-0.7, 0.9999), end=(0.9, 0.9999))
    assert line_distance(arc, chord) == pytest.approx(0.0, abs=1e-8)


OWN = {"kind": "beam-self", "beam": "beam1"}


VARYING = {"at": [0.0, 1.0], "values": [0.002, 0.001]}


def test_a_beam_may_touch_itself_beside_what_else_it_touches():
    scene = scene_from(edited(("contacts/own", OWN)))
    assert scene.contacts["own"].beams == ("beam1",)
    assert mistakes(("contacts/own", OWN), ("contacts/other", {**OWN, "beam": "beam2"})) == {}


def test_each_beam_once():
    found = mistakes(("contacts/own", OWN), ("contacts/again", {**OWN, "thick": False}))
    assert found == {"contacts.again.beam": "the beam of contacts.own again; each beam once"}


def test_a_pair_of_one_beam_is_told_what_to_ask():
    sentence = mistakes(("contacts/contact/between", ["beam1", "beam1"]))["contacts.contact.between"]
    assert "'beam1' twice; two different beams; a beam may touch itself in a contact of kind 'beam-self'" in sentence


def test_a_beam_that_is_not_there():
    (sentence,) = mistakes(("contacts/own", {**OWN, "beam": "beam3"})).values()
    assert "'beam3', which names no beam" in sentence


def test_edges_of_varying_thickness():
    base = edited(("beams/beam1/thickness", VARYING), ("contacts/contact/thick", False), base=HINGE)
    for thick in (True, False):
        assert mistakes(("contacts/own", {**OWN, "thick": thick}), base=base) == {}


def test_a_ring_that_overlaps_itself_as_drawn():
    """Ends of an arc of radius 25 mm that are 1 mm apart, and 2 mm thick."""
    half = math.asin(0.0005 / 0.025)
    ends = {
        side: [0.025 * math.sin(sign * half), -0.025 * math.cos(half)] for side, sign in (("start", 1), ("end", -1))
    }
    curve = {"kind": "arc", "center": [0.0, 0.0], "direction": "counterclockwise", **ends}
    data = {
        "name": "ring",
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": 2e9, "poisson_ratio": 0.3}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"A": ends["start"]}},
            "tip": {"motion": "free", "points": {"B": ends["end"]}},
        },
        "beams": {
            "ring": {
                "curve": curve,
                "thickness": 0.002,
                "width": 0.01,
                "material": "m",
                "start": {"joint": "weld", "point": "A"},
                "end": {"joint": "weld", "point": "B"},
            }
        },
        "loads": {"M": {"kind": "moment", "body": "tip"}},
        "contacts": {"own": {"kind": "beam-self", "beam": "ring"}},
        "stages": [{"name": "load", "steps": "M", "stations": [0.1]}],
        "probes": [{"of": "own", "quantity": "force"}],
    }
    (sentence,) = mistakes(base=data).values()
    assert "a beam that overlaps itself" in sentence
    assert mistakes(("beams/ring/thickness", 0.0009), base=data) == {}


LOWER = "beams.lower.curve"


def with_curve(curve, *edits, thickness=T):
    """The cantilevers with the lower one's curve replaced, its end free and the block at the upper one's."""
    return edited(
        ("beams/lower/curve", curve),
        ("beams/lower/thickness", thickness),
        ("beams/lower/end", {"joint": "free"}),
        ("bodies/ground/points/O", curve["start"]),
        ("bodies/block/points/Q", [0.1, 0.3]),
        ("beams/upper/end", {"joint": "weld", "point": "Q"}),
        ("contacts", {}),
        *edits,
        base=two_lines(0.0, second=((0.0, 0.3), (0.1, 0.3))),
    )


def _ring(opening, direction="counterclockwise", radius=0.03):
    """A circle whose ends are a chord ``opening`` apart."""
    half = np.arcsin(0.5 * opening / radius)
    sign = 1.0 if direction == "counterclockwise" else -1.0
    start, end = ([radius * np.cos(a), radius * np.sin(a)] for a in (sign * half, -sign * half))
    return {"kind": "arc", "center": [0.0, 0.0], "start": start, "end": end, "direction": direction}


@pytest.mark.parametrize("direction", ["counterclockwise", "clockwise"])
def test_a_ring_is_open_by_its_thickness_or_refused(direction):
    assert mistakes(base=with_curve(_ring(1.0001 * T, direction))) == {}
    found = mistakes(base=with_curve(_ring(0.9 * T, direction)))
    assert list(found) == [LOWER]
    assert "overlaps itself" in found[LOWER]
    assert "0.0018 m from itself, and is 0.002 m thick" in found[LOWER]


def test_a_short_arc_is_no_ring():
    """Its ends are near each other since it is short, not since it comes round."""
    ends = {"start": [0.03, 0.0], "end": [0.0, 0.03]}
    arc = {"kind": "arc", "center": [0.0, 0.0], **ends, "direction": "counterclockwise"}
    assert mistakes(base=with_curve(arc, thickness=0.2 * 0.03 * np.pi / 2 * 0.99)) == {}


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.lists(st.floats(-40.0, 40.0), min_size=3, max_size=7), st.floats(0.01, 1.0))
def test_no_polynomial_overlaps_itself(coefficients, share):
    """The thickest beam of any polynomial: places nearer than its thickness are neighbours along it."""
    curve = Polynomial(kind="polynomial", axis="x", coefficients=(0.0, *coefficients), range=(-1.0, 1.0))
    L = shape_of(curve).length
    thickness = share * min(0.2 * L, 0.999 / max(shape_of(curve).largest_curvature, 1e-9))
    u = np.linspace(0.0, 1.0, 1500)
    p = shape_of(curve).point(u)
    near = cKDTree(p).query_pairs(thickness, output_type="ndarray")
    assert np.all(L * np.abs(np.diff(u[near], axis=1)) <= 1.1 * thickness)


TOUCH = "contacts/touch"


@pytest.mark.parametrize("body", ["ground", "block"])
@pytest.mark.parametrize("thick", [True, False])
def test_a_beam_that_touches_or_is_apart_passes(thick, body):
    for gap in (0.0, 1e-12, 0.01, -0.5e-6 * T):
        assert mistakes(base=over_a_circle(gap, thick=thick, body=body)) == {}, gap


def test_a_circle_reads_as_it_is_written():
    contact = scene_from(CIRCLE).contacts["touch"]
    assert (contact.beams, contact.body, contact.center, contact.radius) == (("beam",), "ground", (0.0, -0.031), R)
    assert scene_from(edited((f"{TOUCH}/thick", REMOVED), base=CIRCLE)).contacts["touch"].thick is True


@pytest.mark.parametrize("share", [2e-6, 1e-3, 0.5])
def test_an_overlap_is_refused_with_its_depth(share):
    found = mistakes(base=over_a_circle(-share * T))
    assert f"at the start by {share * T:.3g} m, {share:.3g} of its thickness" in found["contacts.touch"]
    assert len(found) == 1


def test_the_overlap_of_a_line_is_measured_by_its_length():
    assert mistakes(base=over_a_circle(-0.9e-6 * L, thick=False)) == {}
    found = mistakes(base=over_a_circle(-2e-3 * L, thick=False))
    assert "by 0.0002 m, 0.002 of its length" in found["contacts.touch"]


@pytest.mark.parametrize("thick", [True, False])
def test_a_beam_wholly_inside_is_refused(thick):
    """The nearest place is a quarter of the length beside the center, the circle ten lengths wide."""
    data = edited((f"{TOUCH}/radius", 10 * L), (f"{TOUCH}/center", [0.5 * L, -0.25 * L]), base=CIRCLE)
    data["contacts"]["touch"]["thick"] = thick
    depth = 9.75 * L + (0.5 * T if thick else 0.0)
    assert f"overlaps the circle at the start by {depth:.3g} m" in mistakes(base=data)["contacts.touch"]


def test_an_arc_inside_a_circle_and_one_round_it():
    arc = {"kind": "arc", "center": [0.0, 0.0], "start": [0.05, 0.0], "end": [-0.05, 0.0]}
    base = edited(
        ("beams/beam/curve", {**arc, "direction": "counterclockwise"}),
        ("bodies/ground/points/O", arc["start"]),
        ("bodies/block/points/Q", arc["end"]),
        (f"{TOUCH}/center", [0.0, 0.0]),
        base=CIRCLE,
    )
    assert mistakes((f"{TOUCH}/radius", 0.05 - 0.5 * T), base=base) == {}
    assert "by 1e-05 m" in mistakes((f"{TOUCH}/radius", 0.05 - 0.5 * T + 1e-5), base=base)["contacts.touch"]
    assert "by 0.051 m" in mistakes((f"{TOUCH}/radius", 0.1), base=base)["contacts.touch"]


def test_the_same_circle_twice_is_refused_and_two_circles_pass():
    second = dict(CIRCLE["contacts"]["touch"])
    assert "shape of contacts.touch again" in mistakes(("contacts/more", second), base=CIRCLE)["contacts.more"]
    assert mistakes(("contacts/more", {**second, "center": [0.06, 0.031]}), base=CIRCLE) == {}
    assert mistakes(("contacts/more", {**second, "body": "block"}), base=CIRCLE) == {}


@pytest.mark.parametrize("quantity", ["force", "centre", "ends", "closing_load"])
def test_what_may_be_asked_of_a_circle(quantity):
    assert mistakes(("probes/0", {"of": "touch", "quantity": quantity}), base=CIRCLE) == {}


def test_what_may_not_be_asked_of_a_circle():
    found = mistakes(("probes/0", {"of": "touch", "quantity": "rotation"}), base=CIRCLE)
    assert "'rotation' of a body" in found["probes[0]"]


@settings(max_examples=100, deadline=None, derandomize=True)
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
    for curve, length in ((arc, turn), (Line(kind="line", start=start, end=end), math.dist(start, end))):
        samples = shape_of(curve).point(np.linspace(0.0, 1.0, 4001))
        sampled = np.hypot(*(samples - [x, y]).T).min()
        assert sampled - length / 8000 - 1e-12 <= distance_to(curve, (x, y)) <= sampled + 1e-12


NUMBERS = st.one_of(st.floats(), st.sampled_from([1e-308, 1e-200, 1e154, 1e308, 10**400, True, None, "1"]))


@settings(max_examples=150, deadline=None, derandomize=True)
@given(x=NUMBERS, y=NUMBERS, radius=NUMBERS, thick=st.booleans())
def test_any_circle_is_a_scene_or_a_scene_error(x, y, radius, thick):
    data = edited((f"{TOUCH}/center", [x, y]), (f"{TOUCH}/radius", radius), (f"{TOUCH}/thick", thick), base=CIRCLE)
    assert all(key.startswith("contacts.touch") for key in mistakes(base=data))


@settings(max_examples=40, deadline=None, derandomize=True)
@given(exponent=st.integers(-140, 140))
def test_the_circle_at_any_scale_is_the_same_question(exponent):
    factor = math.ldexp(1.0, exponent)
    data = edited(base=CIRCLE)
    for beam in data["beams"].values():
        for key in ("thickness", "width"):
            beam[key] *= factor
        beam["curve"] |= {key: [factor * value for value in beam["curve"][key]] for key in ("start", "end")}
    data["bodies"]["block"]["points"]["Q"] = [factor * L, 0.0]
    touch = data["contacts"]["touch"]
    touch |= {"radius": factor * R, "center": [0.0, factor * touch["center"][1]]}
    assert mistakes(base=data) == {}


ELLIPSE = {"kind": "beam-ellipse", "center": [0.0, -0.03], "semi_axes": [0.05, 0.03]}


SPLINE = {"kind": "beam-spline", "points": [[-0.1, -0.01], [0.0, 0.0], [0.1, -0.01]], "side": "left"}


KINDS = [LINE, HALF_PLANE, FUNCTION, ELLIPSE, SPLINE]


@pytest.mark.parametrize("contact", KINDS)
@pytest.mark.parametrize("thick", [True, False])
def test_a_beam_may_touch_an_edge_or_be_apart(contact, thick):
    for gap in (0.0, 1e-12, 0.01, -0.5e-6 * T):
        scene = scene_from(over(contact, gap, thick=thick))
        assert scene.contacts["touch"].beams == ("beam",), gap
        assert scene.contacts["touch"].kind == contact["kind"]


@pytest.mark.parametrize("contact", KINDS)
@pytest.mark.parametrize("thick", [True, False])
def test_a_beam_on_the_wrong_side_is_told_how_deep(contact, thick):
    found = mistakes(base=over(contact, -0.002, thick=thick))
    assert list(found) == ["contacts.touch"]
    assert "'beam' on the wrong side" in found["contacts.touch"]
    assert "by 0.002 m" in found["contacts.touch"]
    other = {
        "beam-line": ("side", "right"),
        "beam-function": ("side", "below"),
        "beam-half-plane": ("normal", [0, -1.0]),
        "beam-ellipse": ("side", "inside"),
        "beam-spline": ("side", "right"),
    }
    key, value = other[contact["kind"]]
    assert list(mistakes((f"contacts/touch/{key}", value), base=over(contact, 0.001, thick=thick))) == [
        "contacts.touch"
    ]


def test_behind_the_ends_of_a_line_there_is_nothing():
    """A beam that is lower than a line, beside it, is not behind it."""
    line = {**LINE, "points": [[0.2, 0.05], [0.3, 0.05]]}
    assert not mistakes(base=over(line))
    assert list(mistakes(base=over({**LINE, "points": [[-0.2, 0.05], [0.3, 0.05]]}))) == ["contacts.touch"]


def test_the_end_of_a_thick_beams_line_is_round():
    """Half a thickness from the neutral line, the edge of the beam is as near to the end of a line as to its inside."""
    for away, expected in ((0.5 * T + 1e-6, []), (0.5 * T - 1e-6, ["contacts.touch"])):
        points = [[L + away, 0.5 * T], [L + 0.1, 0.05]]
        assert list(mistakes(base=over({**LINE, "points": points}))) == expected


@pytest.mark.parametrize("joint", ["pin", "weld"])
def test_a_beam_may_be_joined_to_what_it_touches(joint):
    base = over(LINE, 0.0, thick=False, start=joint)
    assert not mistakes(base=base)
    # the line as far from the joint as a joint may be from the end of its beam
    assert not mistakes(("contacts/touch/points", [[-0.01, 5e-8], [0.12, 5e-8]]), base=base)
    assert list(mistakes(("contacts/touch/points", [[-0.01, 5e-6], [0.12, 5e-6]]), base=base)) == ["contacts.touch"]


def test_the_same_edge_twice():
    base = over(LINE)
    again = {**base["contacts"]["touch"], "thick": False}
    assert "contacts.touch again" in mistakes(("contacts/again", again), base=base)["contacts.again"]


def test_a_kind_that_there_is_not():
    found = mistakes(("contacts/touch/kind", "beam-wall"), base=over(LINE))
    for kind in ("beam-line", "beam-half-plane", "beam-function"):
        assert repr(kind) in found["contacts.touch.kind"]


def test_a_moment_is_asked_of_what_may_have_a_pin():
    base = over(LINE, start="pin")
    probe = {"of": "touch", "quantity": "moment"}
    assert not mistakes(("probes/1", probe), base=base)
    circle = {"kind": "beam-circle", "beam": "beam", "body": "ground", "center": [0.0, -0.5], "radius": 0.1}
    assert "'moment' of 'touch'" in mistakes(("probes/1", probe), ("contacts/touch", circle), base=base)["probes[1]"]
    # without a pin there is nothing that the moment could be about
    assert mistakes(("probes/1", probe), base=over(LINE))["probes[1]"].endswith("there is none")


def sampled(points, p):
    """Distance of places (k, 2) from the straight pieces between ``points``, by many places on them."""
    on = np.concatenate([a + (b - a) * np.linspace(0, 1, 401)[:, None] for a, b in pairwise(points)])
    return np.hypot(*(p[:, None] - on).transpose(2, 0, 1)).min(axis=1)


def test_distances_from_lines_and_functions():
    rng = np.random.default_rng(1)
    p = rng.uniform(-1.0, 1.0, (100, 2))
    corners = np.array([(-0.5, 0.2), (0.0, 0.6), (0.3, -0.1), (0.7, 0.0)])
    line = LineContact(
        kind="beam-line", beam="b", body="g", points=tuple(map(tuple, corners.tolist())), side="left", thick=False
    )
    d = distance(line, p)
    assert np.abs(d) == pytest.approx(sampled(corners, p), abs=1e-3)
    # in front of it and behind, and beside its end
    near = distance(line, np.array([(-0.3, 0.5), (0.0, 0.7), (0.0, 0.5), (0.3, 0.0), (0.3, -0.2), (0.9, -0.2)]))
    assert np.sign(near).tolist() == [1.0, 1.0, -1.0, 1.0, -1.0, 1.0]

    edge = FunctionContact(
        kind="beam-function",
        beam="b",
        body="g",
        axis="y",
        coefficients=(0.1, 0.3, -0.8),
        range=(-0.6, 0.5),
        side="above",
    )
    y = np.linspace(-0.6, 0.5, 21)
    d = distance(edge, p)
    assert np.abs(d) == pytest.approx(sampled(np.column_stack((0.1 + 0.3 * y - 0.8 * y**2, y)), p), abs=1e-3)
    inside = (np.abs(p[:, 1]) < 0.2) & (np.abs(d) < 0.3)
    f = 0.1 + 0.3 * p[:, 1] - 0.8 * p[:, 1] ** 2
    assert np.array_equal(np.sign(d[inside]), np.sign(p[inside, 0] - f[inside]))

    plane = HalfPlaneContact(kind="beam-half-plane", beam="b", body="g", point=(0.1, 0.2), normal=(3.0, 4.0))
    assert distance(plane, p) == pytest.approx((p - (0.1, 0.2)) @ (0.6, 0.8))


def test_distances_from_ellipses_splines_and_from_inside_a_circle():
    turn, out = np.linspace(0.0, 6.2, 40), np.linspace(-0.4, 0.9, 40)
    # reference: a place at the distance d along the normal of an ellipse, with d above the least radius b²/a = 0.5
    # of curvature inside
    outward = np.column_stack((np.cos(turn) / 2.0, np.sin(turn)))
    outward /= np.hypot(*outward.T)[:, None]
    on = np.column_stack((2.0 * np.cos(turn), np.sin(turn)))
    rotated = np.array([[0.6, 0.8], [-0.8, 0.6]])
    base = {"kind": "beam-ellipse", "beam": "b", "body": "g", "center": (0.1, 0.2), "semi_axes": (2.0, 1.0)}
    ellipse = EllipseContact(**base, angle=math.atan2(0.8, 0.6))
    p = (0.1, 0.2) + (on + out[:, None] * outward) @ rotated
    assert distance(ellipse, p) == pytest.approx(out, abs=1e-8)
    assert distance(ellipse.model_copy(update={"side": "inside"}), p) == pytest.approx(-out, abs=1e-8)
    # reference: the spline of three points is the parabola through them
    spline = SplineContact(
        kind="beam-spline", beam="b", body="g", points=((-1.0, 1.0), (0.0, 0.0), (1.0, 1.0)), side="right"
    )
    parabola = FunctionContact(
        kind="beam-function", beam="b", body="g", axis="x", coefficients=(0, 0, 1.0), range=(-1.0, 1.0), side="below"
    )
    p = np.random.default_rng(2).uniform(-0.5, 0.5, (40, 2)) + np.array((0.0, 0.3))
    assert distance(spline, p) == pytest.approx(distance(parabola, p), abs=1e-9)
    hole = CircleContact(kind="beam-circle", beam="b", body="g", center=(0.0, 0.3), radius=0.5, side="inside")
    assert distance(hole, p) == pytest.approx(0.5 - np.hypot(*(p - (0.0, 0.3)).T))


@pytest.mark.parametrize("contact", KINDS)
def test_a_key_that_is_missing(contact):
    for key in contact:
        with pytest.raises(SceneError, match=rf"contacts\.touch\.{key}"):
            scene_from(edited((f"contacts/touch/{key}", REMOVED), base=over(contact)))


def test_a_scene_in_other_units_has_the_same_mistakes():
    for factor in (1e-3, 1e3):
        base = over(LINE, -0.002)
        base["contacts"]["touch"]["points"] = [[factor * x, factor * y] for x, y in LINE["points"]]
        for body in base["bodies"].values():
            body["points"] = {name: [factor * x, factor * y] for name, (x, y) in body["points"].items()}
        beam = base["beams"]["beam"]
        beam["thickness"] *= factor
        beam["curve"] = {
            "kind": "line",
            **{key: [factor * each for each in beam["curve"][key]] for key in ("start", "end")},
        }
        found = mistakes(base=base)
        assert list(found) == ["contacts.touch"]
        assert math.isclose(float(found["contacts.touch"].split(" m, ")[0].split()[-1]), 0.002 * factor, rel_tol=1e-3)
