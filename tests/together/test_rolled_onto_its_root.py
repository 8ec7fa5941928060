"""A thin strip rolled up by its tip in one long step: it would sink through its own root before a penalty is tight.

Under the penalty to begin with, which goes by a share of the length, the tip sinks by all of the thickness of a strip
so thin, and lines that cross are parted by no penalty.
"""

import pytest

import cprbm
import fea_reference
from cprbm_scene import Ending, scene_from


def rolled(stations):
    tip = [0.0315866, -0.0046678]
    return scene_from(
        {
            "name": "rolled-onto-its-root",
            "materials": {"m": {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "free", "points": {"T": tip}},
            },
            "beams": {
                "strip": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": tip},
                    "thickness": 0.000119,
                    "width": {"at": [0.0, 0.3, 0.9, 1.0], "values": [0.00484, 0.00366, 0.00407, 0.00276]},
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "drives": {"roll": {"kind": "rotation", "body": "tip"}},
            "contacts": {"itself": {"kind": "beam-self", "beam": "strip"}},
            "stages": [{"name": "roll", "steps": "roll", "stations": stations}],
            "probes": [{"of": "scene", "quantity": "potential_energy"}, {"of": "itself", "quantity": "force"}],
        }
    )


def last(answer):
    assert answer.ending is Ending.COMPLETED, answer.sentence
    values = answer.stations[-1].values
    return values["scene.potential_energy"].item(), values["itself.force"].item()


def test_the_finite_elements_arrive_where_the_chain_does():
    scene = rolled([7.263])
    energy, force = last(fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending")))
    coarse, fine = (last(cprbm.answer(scene, cprbm.Settings(links=links))) for links in (41, 82))
    # 82 links are off by a third of what half as many are from them, and the elements by far less
    assert energy == pytest.approx(fine[0], abs=abs(fine[0] - coarse[0]))
    assert force == pytest.approx(fine[1], abs=abs(fine[1] - coarse[1]))
    assert abs(fine[0] - coarse[0]) < 1e-4 * fine[0]
    assert abs(fine[1] - coarse[1]) < 5e-2 * fine[1]
