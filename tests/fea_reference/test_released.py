"""A step that releases energy has left its branch, whether or not its stage asks where that ends."""

import pytest

from fea_reference import Settings, answer
from scene import Ending, Loss
from scene.reading import scene_from


def test_what_lies_flat_and_buckles_off_ends_its_branch_though_nothing_asked():
    # an arc that is pressed flat on a plane.  The chain of 37 links, whose branch no one watches either, says where:
    # between 21.1 and 21.2 mm its energy rises by 6.86 mJ, and its reaction does 8.0 mJ of work
    scene = scene_from(
        {
            "name": "flat",
            "materials": {"m": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "slides", "along": [0.3476, 0.9376], "points": {"T": [0.104404, 0.281633]}},
            },
            "beams": {
                "beam": {
                    "curve": {
                        "kind": "arc",
                        "center": [1.8427644548380948, -0.5229618304332817],
                        "start": [0.0, 0.0],
                        "end": [0.104404, 0.281633],
                        "direction": "clockwise",
                    },
                    "thickness": 0.00173,
                    "width": 0.0361,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "pin", "point": "T"},
                }
            },
            "drives": {"press": {"kind": "displacement", "point": "T", "direction": [-0.3476, -0.9376]}},
            "contacts": {
                "plane": {
                    "kind": "beam-half-plane",
                    "beam": "beam",
                    "body": "wall",
                    "point": [0.021876, 0.152059],
                    "normal": [0.9376, -0.3476],
                }
            },
            "stages": [{"name": "press", "steps": "press", "stations": [0.01913, 0.02869]}],
            "probes": [{"of": "plane", "quantity": "force"}],
        }
    )
    found = answer(scene, Settings(elements=40, kinematics="bending"))
    assert found.ending is Ending.BRANCH_ENDS, found.sentence
    (critical,) = found.critical
    assert critical.loss is Loss.FOLD
    assert critical.value == pytest.approx(0.02115, rel=0.01)
