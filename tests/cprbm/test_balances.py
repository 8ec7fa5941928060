"""ΣF and ΣM of a state, and what of the closures is given, by what statics says of them."""

import pytest

import cprbm
from cprbm_scene import scene_from
from tests.cprbm.driven import UNIT_FORCE
from tests.cprbm.scenes import cantilever_data, force

SETTINGS = cprbm.Settings(links=7)


def test_what_is_fixed_does_not_turn():
    data = cantilever_data(force(0.0, 1.0), [0.7 * UNIT_FORCE])
    data["probes"] = [{"of": "wall", "quantity": "rotation"}, {"of": "R", "quantity": "displacement"}]
    (station,) = cprbm.answer(scene_from(data), SETTINGS).stations
    assert station.values["wall.rotation"] == pytest.approx([0.0], abs=0.0)
    assert station.values["R.displacement"] == pytest.approx([0.0, 0.0], abs=0.0)
