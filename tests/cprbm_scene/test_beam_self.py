"""Contact of a beam with itself: each beam once, and drawn apart from itself."""

import math

import pytest

from cprbm_scene import scene_from
from tests.cprbm_scene.editing import HINGE, edited, mistakes

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
    """Ends of an arc of radius 25 mm that are 1 mm apart, and 2 mm thick; more in test_beside_itself."""
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
