"""A step that releases energy has left its branch, whether or not its stage asks where that ends."""

import re

import pytest

import cprbm
from cprbm_scene import Ending, Loss, scene_from
from fea_reference import Settings, answer
from tests.fea_reference.pressed_arc import pressed_arc

# an arc that is pressed flat on a plane.  The chain of 37 links, whose branch no one watches either, says where it
# buckles off: between 21.1 and 21.2 mm its energy rises by 6.86 mJ, and its reaction does 8.0 mJ of work
ENDS = 0.02115


def flat(beyond):
    return pressed_arc(
        (2.3e9, 0.35),
        (1.8427644548380948, -0.5229618304332817),
        (0.104404, 0.281633),
        (0.3476, 0.9376),
        (0.00173, 0.0361),
        {"plane": ((0.021876, 0.152059), (0.9376, -0.3476))},
        [0.01913, 0.02869],
        beyond,
    )


def test_what_lies_flat_and_buckles_off_ends_its_branch():
    found = answer(flat("stop"), Settings(elements=40, kinematics="bending"))
    assert found.ending is Ending.BRANCH_ENDS, found.sentence
    (critical,) = found.critical
    assert critical.loss is Loss.FOLD
    assert critical.value == pytest.approx(ENDS, rel=0.01)


def test_where_nothing_is_asked_the_march_goes_on_beside_it_and_says_so():
    found = answer(flat(None), Settings(elements=40, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    assert not found.critical
    (said,) = (note for note in found.notes if "folds back" in note)
    told = re.search(r"press = (\S+)", said)
    assert told is not None
    assert float(told[1]) == pytest.approx(ENDS, rel=0.01)
    # the chain comes to the same, and to within a part of its links' squares
    chain = cprbm.answer(flat(None), cprbm.Settings(links=37))
    assert chain.completed, chain.sentence
    for probe in ("scene.potential_energy", "plane.force"):
        assert found.stations[-1].values[probe] == pytest.approx(chain.stations[-1].values[probe], rel=0.015)


def test_an_unloaded_leaf_on_a_driven_slider_goes_where_the_slider_goes():
    # reference: a rigid motion; energies and forces are round-off, and no branch ends
    scene = scene_from(
        {
            "name": "carried",
            "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
            "bodies": {"slider": {"motion": "slides", "along": [1.0, 0.0], "points": {"A": [0.0, 0.0]}}},
            "beams": {
                "leaf": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.0, -0.036]},
                    "thickness": 6e-4,
                    "width": 8e-3,
                    "material": "steel",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "free"},
                }
            },
            "drives": {"d": {"kind": "displacement", "point": "A", "direction": [1.0, 0.0]}},
            "stages": [
                {"name": "on", "steps": "d", "stations": [0.004, 0.008, 0.02], "beyond": "jump"},
                {"name": "back", "steps": "d", "stations": [0.012, 0.0], "beyond": "jump"},
            ],
            "probes": [{"of": "A", "quantity": "displacement"}],
        }
    )
    answered = answer(scene, Settings(elements=80))
    assert answered.completed, answered.sentence
