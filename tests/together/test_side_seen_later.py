"""An arch drawn over the end of another beam, beyond whose reach it ends at rest: its side of that is seen on the way.

At rest no place of the beam below has a closest point on the arch, whose root in turn lies across from it on the other
side: the end below is what is nearest once the arch has come over it.
"""

import pytest

import exact
import fea_reference
from scene import Ending
from scene.reading import scene_from


def arch_over_an_end():
    root, tip = [0.0461496, 0.0185081], [0.0064772, 0.0659698]
    material = {"material": "m"}
    return scene_from(
        {
            "name": "arch",
            "materials": {"m": {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "S": root}},
                "tip": {"motion": "free", "points": {"T": tip}},
            },
            "beams": {
                "arch": {
                    **material,
                    "curve": {
                        "kind": "arc",
                        "center": [0.014323886923516098, 0.03189649863360206],
                        "start": [0.0, 0.0],
                        "end": tip,
                        "direction": "clockwise",
                    },
                    "thickness": 0.00033,
                    "width": 0.0116,
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                },
                "below": {
                    **material,
                    "curve": {"kind": "line", "start": root, "end": [0.0105549, 0.057178]},
                    "thickness": 0.000291,
                    "width": 0.0053,
                    "start": {"joint": "weld", "point": "S"},
                    "end": {"joint": "free"},
                },
            },
            "loads": {"F": {"kind": "force", "point": "T", "direction": [0.7, -0.71]}},
            "contacts": {"touch": {"kind": "beam-beam", "between": ["arch", "below"]}},
            "stages": [{"name": "draw", "steps": "F", "stations": [0.0075]}],
            "probes": [{"of": "T", "quantity": "displacement"}, {"of": "touch", "quantity": "force"}],
        }
    )


def test_an_end_below_an_arch_is_met_whichever_side_is_seen_first():
    """Reference: the exact answer."""
    scene = arch_over_an_end()
    (true,) = exact.answer(scene).stations
    got = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    assert got.ending is Ending.COMPLETED, got.sentence
    values = got.stations[0].values
    assert values["T.displacement"] == pytest.approx(true.values["T.displacement"], rel=2e-5)
    assert values["touch.force"] == pytest.approx(true.values["touch.force"], rel=2e-4)
