"""A beam is led round the end of another beam and presses from the other side, against slender beams in series."""

import pytest

import cprbm
from tests.references.led_round import contact_force, led_round


@pytest.mark.parametrize("order", [("first", "second"), ("second", "first")])
@pytest.mark.parametrize("angle", [0.0, 0.65])
@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("left", [-0.02, -0.045])
def test_a_beam_that_came_round_the_end_presses_from_the_other_side(left, thick, angle, order):
    scene = led_round(order, left=left, beneath=10e-3, thick=thick, angle=angle)
    answer = cprbm.answer(scene, cprbm.Settings(links=41))
    assert answer.completed, answer.sentence
    forces = [station.values["c.force"][0] for station in answer.stations]
    assert forces == pytest.approx([0.0, 0.0, contact_force(left)], rel=2e-3)
