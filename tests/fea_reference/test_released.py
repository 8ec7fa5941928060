"""A step that releases energy has left its branch, whether or not its stage asks where that ends."""

import pytest

from fea_reference import Settings, answer
from scene import Ending, Loss
from tests.fea_reference.pressed_arc import pressed_arc


def test_what_lies_flat_and_buckles_off_ends_its_branch_though_nothing_asked():
    # an arc that is pressed flat on a plane.  The chain of 37 links, whose branch no one watches either, says where:
    # between 21.1 and 21.2 mm its energy rises by 6.86 mJ, and its reaction does 8.0 mJ of work
    scene = pressed_arc(
        (2.3e9, 0.35),
        (1.8427644548380948, -0.5229618304332817),
        (0.104404, 0.281633),
        (0.3476, 0.9376),
        (0.00173, 0.0361),
        {"plane": ((0.021876, 0.152059), (0.9376, -0.3476))},
        [0.01913, 0.02869],
    )
    found = answer(scene, Settings(elements=40, kinematics="bending"))
    assert found.ending is Ending.BRANCH_ENDS, found.sentence
    (critical,) = found.critical
    assert critical.loss is Loss.FOLD
    assert critical.value == pytest.approx(0.02115, rel=0.01)
