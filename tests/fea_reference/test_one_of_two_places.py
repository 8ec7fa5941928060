"""An arc between two planes lies on one of them in two places, and lets go of one: that is no fold of its own."""

import pytest

from fea_reference import Settings, answer
from scene import Ending, Loss
from scene.reading import scene_from


def test_one_of_two_places_lets_go():
    # reference: the chain of 80 links, whose places have forces of their own.  That of the one at a quarter of the
    # beam's length goes to zero evenly, with 20.7 N left on the other; the curvature is 43.3 with it and -57.3 without
    scene = scene_from(
        {
            "name": "between",
            "materials": {"m": {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "slides", "along": [0.5476, 0.8368], "points": {"T": [0.164559, 0.251467]}},
            },
            "beams": {
                "beam": {
                    "curve": {
                        "kind": "arc",
                        "center": [1.7412332407491886, -0.9598791991770124],
                        "start": [0.0, 0.0],
                        "end": [0.164559, 0.251467],
                        "direction": "clockwise",
                    },
                    "thickness": {"at": [0.0, 1.0], "values": [0.00131, 0.00147]},
                    "width": 0.0339,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "pin", "point": "T"},
                }
            },
            "drives": {"press": {"kind": "displacement", "point": "T", "direction": [-0.5476, -0.8368]}},
            "contacts": {
                "left": {
                    "kind": "beam-half-plane",
                    "beam": "beam",
                    "body": "wall",
                    "point": [0.064068, 0.137651],
                    "normal": [0.8368, -0.5476],
                },
                "right": {
                    "kind": "beam-half-plane",
                    "beam": "beam",
                    "body": "wall",
                    "point": [0.100491, 0.113816],
                    "normal": [-0.8368, 0.5476],
                },
            },
            "stages": [{"name": "press", "steps": "press", "stations": [0.01489, 0.02234]}],
            "probes": [{"of": "left", "quantity": "force"}],
        }
    )
    found = answer(scene, Settings(elements=40, kinematics="bending"))
    assert found.ending is Ending.BRANCH_ENDS, found.sentence
    (critical,) = found.critical
    assert (critical.loss, critical.what) == (Loss.CONTACT, "left")
    assert critical.value == pytest.approx(0.0161072, rel=1e-3)
    assert critical.curvature == pytest.approx(43.3, rel=0.06)
    assert critical.left == pytest.approx(-57.3, rel=0.06)
