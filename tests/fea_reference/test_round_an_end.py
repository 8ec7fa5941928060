"""A hand leads a beam round the free end of another beam; the beams then press from the other side."""

import pytest

from fea_reference import Settings, answer
from tests.references.led_round import contact_force, led_round

LEFT = -0.02


@pytest.mark.parametrize("order", [("first", "second"), ("second", "first")])
@pytest.mark.parametrize("angle", [0.0, 0.65])
@pytest.mark.parametrize(("thick", "beneath"), [(True, 10e-3), (True, 1.5e-3), (False, 10e-3), (False, 0.8e-3)])
def test_a_beam_that_came_round_the_end_presses_from_the_other_side(order, angle, thick, beneath):
    got = answer(led_round(order, left=LEFT, beneath=beneath, thick=thick, angle=angle), Settings(elements=20))
    assert got.completed, got.sentence
    forces = [station.values["c.force"][0] for station in got.stations]
    assert forces == pytest.approx([0.0, 0.0, contact_force(LEFT)], rel=1e-3)
