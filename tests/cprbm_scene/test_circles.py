"""A beam and a rigid circle: names, keys, proportions, and the start outside or just touching."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cprbm_scene import Arc, Line, scene_from
from cprbm_scene.geometry import points_on
from tests.cprbm_scene.editing import REMOVED, distance_to, edited, mistakes

T, L, R = 0.002, 0.1, 0.03


def over_a_circle(gap=0.0, *, thick=True, body="ground"):
    """A level cantilever of 0.1 m, 2 mm thick, ``gap`` above a circle of 30 mm below its clamp."""
    offset = R + gap + (0.5 * T if thick else 0.0)
    return {
        "name": "circle",
        "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"O": [0.0, 0.0]}},
            "block": {"motion": "free", "points": {"Q": [L, 0.0]}},
        },
        "beams": {
            "beam": {
                "curve": {"kind": "line", "start": [0.0, 0.0], "end": [L, 0.0]},
                "thickness": T,
                "width": 0.01,
                "material": "steel",
                "start": {"joint": "weld", "point": "O"},
                "end": {"joint": "weld", "point": "Q"},
            }
        },
        "loads": {"F": {"kind": "force", "point": "Q", "direction": [0.0, -1.0]}},
        "contacts": {
            "touch": {
                "kind": "beam-circle",
                "beam": "beam",
                "body": body,
                "center": [0.0, -offset],
                "radius": R,
                "thick": thick,
            }
        },
        "stages": [{"name": "load", "steps": "F", "stations": [1.0]}],
        "probes": [{"of": "Q", "quantity": "displacement"}],
    }


CIRCLE = over_a_circle()
TOUCH = "contacts/touch"


@pytest.mark.parametrize("body", ["ground", "block"])
@pytest.mark.parametrize("thick", [True, False])
def test_a_beam_that_touches_or_is_apart_passes(thick, body):
    for gap in (0.0, 1e-12, 0.01, -0.5e-6 * T):
        assert mistakes(base=over_a_circle(gap, thick=thick, body=body)) == {}, gap


def test_what_is_written_is_what_is_read():
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


@pytest.mark.parametrize(
    ("path", "value", "key", "words"),
    [
        ("beam", "baem", "contacts.touch.beam", "names no beam (is 'beam' meant?)"),
        ("body", "grund", "contacts.touch.body", "names no body (is 'ground' meant?)"),
        ("body", "beam", "contacts.touch.body", "'ground', 'block'"),
        ("kind", "beam-circel", "contacts.touch.kind", "one of 'beam-beam', 'beam-self', 'beam-circle'"),
        ("kind", REMOVED, "contacts.touch.kind", "nothing; one of 'beam-beam', 'beam-self', 'beam-circle'"),
        ("raduis", 1.0, "contacts.touch.raduis", "is 'radius' meant"),
        ("paper", {"boundary": "beam"}, "contacts.touch.paper.boundary", "names no key here"),
        ("paper", {"related": {"block": {"y": [0.0, 1.0]}}}, "contacts.touch.paper.related.block", "beam 'beam'"),
        ("paper", {"related": {"beam": {}}}, "contacts.touch.paper.related.beam", "neither x nor y"),
        ("paper", {"related": {"beam": {"x": [1.0, 0.0]}}}, "contacts.touch.paper.related.beam.x", "the smaller"),
        ("between", ["beam", "beam"], "contacts.touch.between", "names no key here"),
        ("radius", 0.0, "contacts.touch.radius", "greater than 0"),
        ("radius", -1.0, "contacts.touch.radius", "greater than 0"),
        ("radius", float("inf"), "contacts.touch.radius", "finite"),
        ("radius", REMOVED, "contacts.touch.radius", "required"),
        ("center", [0.0], "contacts.touch.center[1]", "an item"),
        ("thick", 1, "contacts.touch.thick", "true or false"),
        ("radius", 1e-9, "contacts.touch.radius", "1e-08 of the beam's length"),
        ("radius", 1e6, "contacts.touch.radius", "1e+07 of the beam's length"),
        ("center", [0.0, -1e40], "contacts.touch.center", "coordinates up to 1e+40 m"),
    ],
)
def test_a_mistake_is_named_by_its_key_and_only_once(path, value, key, words):
    found = mistakes((f"{TOUCH}/{path}", value), base=CIRCLE)
    assert list(found) == [key]
    assert words in found[key]


def test_the_same_circle_twice_is_refused_and_two_circles_pass():
    second = dict(CIRCLE["contacts"]["touch"])
    assert "shape of contacts.touch again" in mistakes(("contacts/more", second), base=CIRCLE)["contacts.more"]
    assert mistakes(("contacts/more", {**second, "center": [0.06, 0.031]}), base=CIRCLE) == {}
    assert mistakes(("contacts/more", {**second, "body": "block"}), base=CIRCLE) == {}


@pytest.mark.parametrize("quantity", ["force", "centre", "ends", "closing_load"])
def test_what_may_be_asked_of_a_circle(quantity):
    assert mistakes(("probes/0", {"of": "touch", "quantity": quantity}), base=CIRCLE) == {}


def test_what_may_not():
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
        samples = points_on(curve, np.linspace(0.0, 1.0, 4001))
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
