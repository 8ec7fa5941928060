"""A long step goes through nothing: a strip whose sliding tip comes down on the end piece of a rigid line."""

import numpy as np

import cprbm
import fea_reference
from cprbm_scene import scene_from

COEFFICIENTS = [0.0, 1.579063862562064, -45.538437690705194, -504.5867953787889]


def strip():
    """As drawn at random; without the line the tip slides 8 mm in one step of 0.57 rad, past where that lies."""
    return scene_from(
        {
            "name": "strip",
            "materials": {"m": {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {
                    "motion": "slides",
                    "along": [0.4926, -0.8702],
                    "turns": True,
                    "points": {"T": [0.0051042, 0.0237168]},
                },
            },
            "beams": {
                "strip": {
                    "curve": {
                        "kind": "polynomial",
                        "axis": "y",
                        "coefficients": COEFFICIENTS,
                        "range": [0.0, 0.0237168],
                    },
                    "thickness": 0.000184,
                    "width": 0.00599,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "loads": {
                "wind": {"kind": "distributed", "beam": "strip", "direction": [0.767, -0.641], "along": [0.02, 0.91]}
            },
            "contacts": {
                "line": {
                    "kind": "beam-line",
                    "beam": "strip",
                    "body": "wall",
                    "points": [[0.0093131, 0.0189491], [0.0079478, 0.0211356], [0.0034388, 0.0212477]],
                    "side": "right",
                }
            },
            "stages": [{"name": "blown", "steps": "wind", "stations": [2.492]}],
            "probes": [{"of": "T", "quantity": "displacement"}, {"of": "line", "quantity": "force"}],
        }
    )


def test_a_tip_that_slides_comes_down_on_a_line_and_not_through_it():
    # reference: the finite elements, whose steps are short
    reference = fea_reference.answer(strip(), fea_reference.Settings(elements=40, kinematics="bending"))
    answer = cprbm.answer(strip(), cprbm.Settings(links=60))
    assert reference.completed
    assert answer.completed, answer.sentence
    wanted, found = (each.stations[-1].values for each in (reference, answer))
    assert wanted["line.force"][0] > 0.09
    for name in wanted:
        np.testing.assert_allclose(found[name], wanted[name], rtol=0.005, err_msg=name)
