"""Stability of a column between circles that touch without force: contact forbids a motion in a single sense."""

import pytest

import cprbm
from cprbm_scene import Ending, Loss, scene_from
from tests.references import columns
from tests.together.branches import FORCE, column_between_pegs


@pytest.mark.parametrize("links", [20, 21])
@pytest.mark.parametrize(("sides", "times"), [(("left", "right"), 4.0), (("left",), 1.0), (("right",), 1.0)])
def test_a_touching_circle_forbids_one_sense_of_a_mode(sides, times, links):
    # Euler: a half wave where the middle is free on one side, two half waves between circles on both sides
    euler = columns.critical("pinned")
    scene = scene_from(column_between_pegs([0.5 * euler, 5.0 * euler], sides=sides, beyond="stop"))
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    (critical,) = answer.critical
    assert answer.ending is Ending.BRANCH_ENDS
    assert critical.loss is Loss.BIFURCATION
    assert critical.value == pytest.approx(times * euler * FORCE, rel=1e-3)
