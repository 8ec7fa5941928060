"""The closing load of a contact in stages that step the load under which the contact closed, and another load."""

import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, MOMENT, RIGIDITY, THICKNESS, cantilever_data, force

PLACE, GAP, RADIUS = 0.9 * LENGTH, 0.003 * LENGTH, 0.05 * LENGTH

CLOSING = GAP * 6.0 * RIGIDITY / (PLACE**2 * (3.0 * LENGTH - PLACE))
"""Load at which the line at the place x has sunk by the gap: w = P x² (3 L − x)/(6 EI)."""


def pressed_twice():
    """A cantilever that a load at the tip brings to a circle below the tip, before a moment acts."""
    data = cantilever_data(force(0.0, -1.0), [])
    data["loads"]["M"] = MOMENT
    center = [PLACE, -GAP - 0.5 * THICKNESS - RADIUS]
    data["contacts"] = {
        "stop": {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": center, "radius": RADIUS}
    }
    data["stages"] = [
        {"name": "press", "steps": "P", "stations": [2.0 * CLOSING]},
        {"name": "turn", "steps": "M", "stations": [0.05 * CLOSING * LENGTH]},
        {"name": "press more", "steps": "P", "stations": [2.2 * CLOSING]},
    ]
    data["probes"] = [{"of": "stop", "quantity": "closing_load"}, {"of": "stop", "quantity": "force"}]
    return scene_from(data)


@pytest.mark.parametrize("solver", [cprbm, fea_reference], ids=["cprbm", "fea"])
def test_a_closing_load_is_a_value_of_the_load_that_closed_the_contact(solver):
    press, turn, more = solver.answer(pressed_twice()).stations
    assert press.values["stop.closing_load"] == pytest.approx([CLOSING], rel=1e-3)
    assert turn.values["stop.force"][0] > 0.0
    assert turn.values["stop.closing_load"].size == 0
    assert more.values["stop.closing_load"] == pytest.approx([CLOSING], rel=1e-3)
