"""Beams and themselves: contact of a beam with itself, and curves that come too close to themselves."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from cprbm_scene import Polynomial, scene_from
from cprbm_scene.geometry import arc_length, largest_curvature, points_on
from tests.cprbm_scene.editing import HINGE, edited, mistakes, two_lines

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


@pytest.mark.parametrize("extra", [{"between": ["beam1", "beam1"]}, {"side": "left"}, {"paper": {"boundary": "beam1"}}])
def test_words_that_it_does_not_know(extra):
    (key,) = extra
    sentence = mistakes(("contacts/own", OWN | extra))[f"contacts.own.{key}"]
    assert sentence.endswith("the name of a key here: 'kind', 'beam', 'thick'")


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


T = 0.002
KEY = "beams.lower.curve"


def _with(curve, *edits, thickness=T):
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
    assert mistakes(base=_with(_ring(1.0001 * T, direction))) == {}
    found = mistakes(base=_with(_ring(0.9 * T, direction)))
    assert list(found) == [KEY]
    assert "overlaps itself" in found[KEY]
    assert "0.0018 m from itself, and is 0.002 m thick" in found[KEY]


def test_a_short_arc_is_no_ring():
    """Its ends are near each other since it is short, not since it comes round."""
    ends = {"start": [0.03, 0.0], "end": [0.0, 0.03]}
    arc = {"kind": "arc", "center": [0.0, 0.0], **ends, "direction": "counterclockwise"}
    assert mistakes(base=_with(arc, thickness=0.2 * 0.03 * np.pi / 2 * 0.99)) == {}


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.lists(st.floats(-40.0, 40.0), min_size=3, max_size=7), st.floats(0.01, 1.0))
def test_no_polynomial_overlaps_itself(coefficients, share):
    """The thickest beam of any polynomial: places nearer than its thickness are neighbours along it."""
    curve = Polynomial(kind="polynomial", axis="x", coefficients=(0.0, *coefficients), range=(-1.0, 1.0))
    L = arc_length(curve)
    thickness = share * min(0.2 * L, 0.999 / max(largest_curvature(curve), 1e-9))
    u = np.linspace(0.0, 1.0, 1500)
    p = points_on(curve, u)
    near = cKDTree(p).query_pairs(thickness, output_type="ndarray")
    assert np.all(L * np.abs(np.diff(u[near], axis=1)) <= 1.1 * thickness)
