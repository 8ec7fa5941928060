"""Where a trial has places of contact come past each other the way is gone in a shorter step, and nothing crashes."""

from pathlib import Path

import pytest

import elastica_reference
import fea_reference
from cprbm_scene import read

SCENE = Path(__file__).parents[1] / "together" / "scenes" / "past-each-other.toml"


def test_places_that_have_come_past_each_other_are_no_state():
    """Reference: the finite elements, of fourth order in an element."""
    scene = read(SCENE)
    found = elastica_reference.answer(scene, elastica_reference.Settings())
    beside = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending", penetration=1e-6))
    assert found.completed, found.sentence
    energy = "scene.potential_energy"
    for mine, its in zip(found.stations, beside.stations, strict=True):
        assert mine.values[energy] == pytest.approx(its.values[energy], rel=1e-5)
