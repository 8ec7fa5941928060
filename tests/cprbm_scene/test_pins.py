"""Pins between bodies: what meets, what is held once, and what is left free."""

import pytest

from cprbm_scene import scene_from
from tests.cprbm_scene.editing import REMOVED, mistakes

LINKAGE = {
    "name": "linkage",
    "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
    "bodies": {
        "ground": {"motion": "fixed", "points": {"O": [0.0, 0.0], "E": [0.2, 0.0]}},
        "crank": {"motion": "free", "points": {"O1": [0.0, 0.0], "A": [0.0, 0.05]}},
        "coupler": {"motion": "free", "points": {"A1": [0.0, 0.05], "B": [0.15, 0.1]}},
        "rocker": {"motion": "turns", "about": "D", "points": {"D": [0.15, 0.0], "B1": [0.15, 0.1]}},
    },
    "pins": {
        "at_O": {"points": ["O", "O1"]},
        "at_A": {"points": ["A", "A1"]},
        "at_B": {"points": ["B", "B1"]},
    },
    "beams": {
        "spring": {
            "curve": {
                "kind": "arc",
                "center": [0.175, 0.05],
                "start": [0.2, 0.0],
                "end": [0.15, 0.1],
                "direction": "counterclockwise",
            },
            "thickness": 0.001,
            "width": 0.01,
            "material": "steel",
            "start": {"joint": "weld", "point": "E"},
            "end": {"joint": "weld", "point": "B1"},
        }
    },
    "loads": {"M": {"kind": "moment", "body": "crank"}},
    "stages": [{"name": "load", "steps": "M", "stations": [0.01]}],
    "probes": [{"of": "A", "quantity": "displacement"}],
}
DRIVE = ("drives/phi", {"kind": "rotation", "body": "crank"})
LINKAGE["drives"] = {}


def test_a_linkage_is_a_scene():
    scene = scene_from(LINKAGE)
    assert scene.pins["at_A"].points == ("A", "A1")
    driven = [("loads", {}), ("stages/0/steps", "phi"), DRIVE]
    assert not mistakes(*driven, base=LINKAGE)
    assert not mistakes(("probes/1", {"of": "O", "quantity": "reaction"}), base=LINKAGE)


@pytest.mark.parametrize(
    ("edits", "key", "said"),
    [
        ([("pins/at_A/points", ["A", "A2"])], "pins.at_A.points[1]", "which names no point"),
        ([("pins/at_A/points", ["A"])], "pins.at_A.points[1]", "an item here"),
        ([("pins/at_A/points", ["A1", "B"])], "pins.at_A.points", "both of the body 'coupler'"),
        ([("pins/at_A/points", ["A", "B"])], "pins.at_A.points", "0.158 m apart"),
        ([("pins/at_A/stiffness", 1.0)], "pins.at_A.stiffness", "which names no key here"),
        (
            [("pins/at_A", REMOVED), ("pins/rocker", {"points": ["A", "A1"]})],
            "pins.rocker",
            "which bodies.rocker has too",
        ),
        ([("pins/again", {"points": ["A", "A1"]})], "pins.again", "hold already"),
        (
            [("bodies/coupler/points/C", [0.0, 0.05]), ("pins/again", {"points": ["A", "C"]})],
            "pins.again",
            "hold already",
        ),
        (
            [
                ("bodies/rocker", {"motion": "fixed", "points": {"D": [0.15, 0.0], "B1": [0.15, 0.1]}}),
                ("bodies/third", {"motion": "fixed", "points": {"F": [0.15, 0.1]}}),
                ("pins/grounds", {"points": ["B1", "F"]}),
            ],
            "pins.grounds.points",
            "points of two fixed bodies",
        ),
        ([("pins/at_B", REMOVED)], "bodies.crank", "without bending a beam"),
        ([("pins/at_A", REMOVED), ("pins/at_B", REMOVED)], "bodies.coupler", "no beam meets"),
        (
            [
                ("beams/spring/end", {"joint": "pin", "point": "B1"}),
                ("beams/spring/start", {"joint": "pin", "point": "E"}),
                ("pins/at_B", REMOVED),
            ],
            "bodies.coupler",
            "without bending a beam",
        ),
        ([DRIVE, ("drives/psi", {"kind": "rotation", "body": "rocker"})], "drives.psi", "hold already"),
        (
            [DRIVE, ("drives/x", {"kind": "displacement", "point": "A", "direction": [0.0, 1.0]})],
            "drives.x",
            "hold already",
        ),
    ],
)
def test_mistakes_have_their_key(edits, key, said):
    found = mistakes(*edits, base=LINKAGE)
    assert said in found[key], found


def test_two_pins_between_two_bodies_hold_them_twice():
    edits = [
        ("bodies/plate", {"motion": "free", "points": {"A2": [0.0, 0.05], "B2": [0.15, 0.1]}}),
        ("pins/one", {"points": ["A1", "A2"]}),
        ("pins/two", {"points": ["B", "B2"]}),
    ]
    assert list(mistakes(*edits, base=LINKAGE)) == ["pins.two"]


BEAM = {"thickness": 0.001, "width": 0.01, "material": "steel"}
HUNG = {
    "name": "hung",
    "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
    "bodies": {
        "ground": {"motion": "fixed", "points": {"R": [0.0, 0.0], "S": [0.031, 0.047]}},
        "plate": {"motion": "free", "points": {"P": [0.0731, 0.0], "Q": [0.0731, 0.0193]}},
    },
    "beams": {
        "low": {
            "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.0731, 0.0]},
            "start": {"joint": "pin", "point": "R"},
            "end": {"joint": "pin", "point": "P"},
            **BEAM,
        },
        "high": {
            "curve": {"kind": "line", "start": [0.031, 0.047], "end": [0.0731, 0.0193]},
            "start": {"joint": "pin", "point": "S"},
            "end": {"joint": "pin", "point": "Q"},
            **BEAM,
        },
    },
    "loads": {"F": {"kind": "force", "point": "P", "direction": [0.0, -1.0]}},
    "stages": [{"name": "load", "steps": "F", "stations": [1.0]}],
    "probes": [{"of": "P", "quantity": "displacement"}],
}
BELOW = {"kind": "beam-half-plane", "beam": "low", "body": "ground", "point": [0.0, -0.013], "normal": [0.0, 1.0]}


def test_a_motion_that_bends_no_beam_is_told():
    # reference: a plate on two bars turns about the point in which their lines meet
    pole = 0.0731 + 0.0193 * (0.0731 - 0.031) / (0.047 - 0.0193)
    (found,) = mistakes(base=HUNG).values()
    assert f"turn about [{pole:.4g}, 0] m" in found
    # on bars side by side it goes along, across them
    even = [("bodies/ground/points/S", [0.0, 0.0193]), ("beams/high/curve/start", [0.0, 0.0193])]
    (found,) = mistakes(*even, base=HUNG).values()
    assert "move along [0, 1]" in found


@pytest.mark.parametrize(
    "edits",
    [
        [("beams/low/start/joint", "weld"), ("beams/low/end/joint", "weld")],
        [("drives", {"D": {"kind": "rotation", "body": "plate"}})],
        [("contacts", {"below": BELOW})],
    ],
)
def test_what_a_weld_a_drive_or_a_contact_may_hold_is_a_scene(edits):
    assert not mistakes(*edits, base=HUNG)
