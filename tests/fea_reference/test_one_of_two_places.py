"""An arc between two planes lies on one of them in two places, and lets go of one: that is no fold of its own."""

import pytest

from cprbm_scene import Ending, Loss
from fea_reference import Settings, answer
from tests.fea_reference.pressed_arc import pressed_arc


def test_one_of_two_places_lets_go():
    # reference: the chain, whose places have forces of their own, at 0.0161072, 0.0160716 and 0.0160627 with 80, 160
    # and 320 links, of second order.  The force of the one at a quarter of the beam's length goes to zero evenly, with
    # 20.7 N left on the other; the curvature is 43.5 with it and -57.4 without
    scene = pressed_arc(
        (1.37e9, 0.42),
        (1.7412332407491886, -0.9598791991770124),
        (0.164559, 0.251467),
        (0.5476, 0.8368),
        ({"at": [0.0, 1.0], "values": [0.00131, 0.00147]}, 0.0339),
        {"left": ((0.064068, 0.137651), (0.8368, -0.5476)), "right": ((0.100491, 0.113816), (-0.8368, 0.5476))},
        [0.01489, 0.02234],
    )
    found = answer(scene, Settings(elements=40, kinematics="bending"))
    assert found.ending is Ending.BRANCH_ENDS, found.sentence
    (critical,) = found.critical
    assert (critical.loss, critical.what) == (Loss.CONTACT, "left")
    assert critical.value == pytest.approx(0.0160598, rel=2e-5)
    assert critical.curvature == pytest.approx(43.5, rel=0.06)
    assert critical.left == pytest.approx(-57.4, rel=0.06)
