"""A thin strip, by its edges, bent over the corner at which a rigid graph ends: each solver for itself."""

import pytest

import cprbm
import fea_reference
from cprbm_scene import Ending, scene_from

STRIP = {
    "kind": "spline",
    "points": [[0.0, 0.0], [0.0110274, -0.0031654], [0.024948, 0.0015175], [0.036689, 0.0011024]],
    "end_direction": [1.007, -0.232],
}


def over_the_end():
    return scene_from(
        {
            "name": "over-the-end",
            "materials": {"m": {"youngs_modulus": 114e9, "poisson_ratio": 0.33}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "free", "points": {"T": [0.036689, 0.0011024], "Q": [0.0405961, 0.002684]}},
                "car": {
                    "motion": "turns",
                    "about": "K",
                    "points": {"J": [0.0405961, 0.002684], "K": [0.0544101, -0.00229]},
                },
            },
            "pins": {"joint": {"points": ["Q", "J"]}},
            "beams": {
                "strip": {
                    "curve": STRIP,
                    "thickness": 6.19e-05,
                    "width": 0.00296,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "drives": {"turn": {"kind": "rotation", "body": "car"}},
            "contacts": {
                "graph": {
                    "kind": "beam-function",
                    "beam": "strip",
                    "body": "wall",
                    "axis": "x",
                    "coefficients": [-0.00153997129, -0.205681745, 17.8160587],
                    "range": [0.005202, 0.02093],
                    "side": "below",
                }
            },
            "stages": [{"name": "turn", "steps": "turn", "stations": [-0.135]}],
            "probes": [{"of": "graph", "quantity": "force"}, {"of": "scene", "quantity": "potential_energy"}],
        }
    )


def whole(answer):
    assert answer.ending is Ending.COMPLETED, answer.sentence
    return answer.stations[-1].values


def test_a_thick_beam_on_a_corner_sinks_in_as_little_as_is_asked_on_any_mesh():
    # reference: the chain's values, whose error goes with N^-2, led on from two N
    scene = over_the_end()
    coarse, fine = (whole(cprbm.answer(scene, cprbm.Settings(links=links))) for links in (83, 166))
    for elements, close in ((21, 0.02), (43, 0.005)):
        found = whole(fea_reference.answer(scene, fea_reference.Settings(elements=elements, kinematics="bending")))
        for name in ("graph.force", "scene.potential_energy"):
            limit = fine[name] + (fine[name] - coarse[name]) / 3.0
            assert found[name] == pytest.approx(limit, rel=close)
