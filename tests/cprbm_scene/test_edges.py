"""Rigid edges: names, keys, proportions, and the start on the free side or just touching."""

import math
from itertools import pairwise

import numpy as np
import pytest

from cprbm_scene import FunctionContact, HalfPlaneContact, LineContact, SceneError, scene_from
from cprbm_scene.edges import distance_from
from cprbm_scene.statement import CircleContact, EllipseContact, SplineContact
from tests.cprbm_scene.editing import REMOVED, edited, mistakes

T, L = 0.002, 0.1
LINE = {"kind": "beam-line", "points": [[-0.01, 0.0], [0.05, 0.0], [0.12, -0.01]], "side": "left"}
HALF_PLANE = {"kind": "beam-half-plane", "point": [0.3, 0.0], "normal": [0.0, 7.0]}
FUNCTION = {
    "kind": "beam-function",
    "axis": "x",
    "coefficients": [0.0, 0.0, -1.0],
    "range": [-0.1, 0.1],
    "side": "above",
}
ELLIPSE = {"kind": "beam-ellipse", "center": [0.0, -0.03], "semi_axes": [0.05, 0.03]}
SPLINE = {"kind": "beam-spline", "points": [[-0.1, -0.01], [0.0, 0.0], [0.1, -0.01]], "side": "left"}
KINDS = [LINE, HALF_PLANE, FUNCTION, ELLIPSE, SPLINE]


def over(contact, gap=0.0, *, thick=True, start="weld"):
    """A level cantilever of 0.1 m, 2 mm thick, whose edge starts ``gap`` above the origin."""
    y = gap + (0.5 * T if thick else 0.0)
    return {
        "name": "edge",
        "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"O": [0.0, y]}},
            "block": {"motion": "free", "points": {"Q": [L, y]}},
        },
        "beams": {
            "beam": {
                "curve": {"kind": "line", "start": [0.0, y], "end": [L, y]},
                "thickness": T,
                "width": 0.01,
                "material": "steel",
                "start": {"joint": start, "point": "O"},
                "end": {"joint": "weld", "point": "Q"},
            }
        },
        "loads": {"F": {"kind": "force", "point": "Q", "direction": [0.0, -1.0]}},
        "contacts": {"touch": {"beam": "beam", "body": "ground", "thick": thick, **contact}},
        "stages": [{"name": "load", "steps": "F", "stations": [1.0]}],
        "probes": [{"of": "Q", "quantity": "displacement"}],
    }


@pytest.mark.parametrize("contact", KINDS)
@pytest.mark.parametrize("thick", [True, False])
def test_a_beam_may_touch_or_be_apart(contact, thick):
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


@pytest.mark.parametrize(
    ("contact", "path", "value", "key", "said"),
    [
        (LINE, "points", [[0.0, 0.0]], "points", "at least 2 of them"),
        (LINE, "points", [[0.0, 0.0], [0.0, 0.0]], "points[1]", "0 m from the one before"),
        (LINE, "points", [[-0.1, 0.0], [0.2, 0.0], [0.1, 0.0]], "points[1]", "turns back on itself"),
        (LINE, "points", [[0.0, -0.1], [0.1, -0.1], [0.1, -0.05], [0.05, -0.2]], "points", "meet itself"),
        (LINE, "points", [[0.0, 0.0], [1e7, 0.0]], "points[1]", "1e+08 of the beam's length"),
        (LINE, "side", "above", "side", "one of 'left' or 'right'"),
        (LINE, "body", "graund", "body", "is 'ground' meant?"),
        (LINE, "beam", "beem", "beam", "is 'beam' meant?"),
        (LINE, "radius", 1.0, "radius", "which names no key here"),
        (LINE, "paper", {"related": {"other": {"x": [0.0, 1.0]}}}, "paper.related.other", "the contact's beam 'beam'"),
        (LINE, "paper", {"related": {"beam": {"x": [1.0, 0.0]}}}, "paper.related.beam.x", "smaller to the larger"),
        (HALF_PLANE, "normal", [0.0, 0.0], "normal", "a direction"),
        (HALF_PLANE, "point", [1e6, 0.0], "", "coordinates up to"),
        (FUNCTION, "range", [0.1, 0.1], "range", "two different values"),
        (FUNCTION, "range", [0.0, 1e-12], "range", "between 1e-06 and 1e+06 of the beam's length"),
        (FUNCTION, "coefficients", [0.0], "coefficients", "at least 2 of them"),
        (FUNCTION, "coefficients", [0.0, 1e5], "coefficients", "a slope of at most 1000"),
        (FUNCTION, "side", "left", "side", "one of 'above' or 'below'"),
    ],
)
def test_mistakes_have_their_key(contact, path, value, key, said):
    found = mistakes((f"contacts/touch/{path}", value), base=over(contact))
    place = f"contacts.touch.{key}" if key else "contacts.touch"
    assert said in found[place]


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
    d = distance_from(line)(p)
    assert np.abs(d) == pytest.approx(sampled(corners, p), abs=1e-3)
    # in front of it and behind, and beside its end
    near = distance_from(line)(np.array([(-0.3, 0.5), (0.0, 0.7), (0.0, 0.5), (0.3, 0.0), (0.3, -0.2), (0.9, -0.2)]))
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
    d = distance_from(edge)(p)
    assert np.abs(d) == pytest.approx(sampled(np.column_stack((0.1 + 0.3 * y - 0.8 * y**2, y)), p), abs=1e-3)
    inside = (np.abs(p[:, 1]) < 0.2) & (np.abs(d) < 0.3)
    f = 0.1 + 0.3 * p[:, 1] - 0.8 * p[:, 1] ** 2
    assert np.array_equal(np.sign(d[inside]), np.sign(p[inside, 0] - f[inside]))

    plane = HalfPlaneContact(kind="beam-half-plane", beam="b", body="g", point=(0.1, 0.2), normal=(3.0, 4.0))
    assert distance_from(plane)(p) == pytest.approx((p - (0.1, 0.2)) @ (0.6, 0.8))


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
    assert distance_from(ellipse)(p) == pytest.approx(out, abs=1e-8)
    assert distance_from(ellipse.model_copy(update={"side": "inside"}))(p) == pytest.approx(-out, abs=1e-8)
    # reference: the spline of three points is the parabola through them
    spline = SplineContact(
        kind="beam-spline", beam="b", body="g", points=((-1.0, 1.0), (0.0, 0.0), (1.0, 1.0)), side="right"
    )
    parabola = FunctionContact(
        kind="beam-function", beam="b", body="g", axis="x", coefficients=(0, 0, 1.0), range=(-1.0, 1.0), side="below"
    )
    p = np.random.default_rng(2).uniform(-0.5, 0.5, (40, 2)) + np.array((0.0, 0.3))
    assert distance_from(spline)(p) == pytest.approx(distance_from(parabola)(p), abs=1e-9)
    hole = CircleContact(kind="beam-circle", beam="b", body="g", center=(0.0, 0.3), radius=0.5, side="inside")
    assert distance_from(hole)(p) == pytest.approx(0.5 - np.hypot(*(p - (0.0, 0.3)).T))


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
