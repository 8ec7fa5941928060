"""Tips of leaves on other beams, at numbers of links where a tip is special."""

import pytest

import cprbm
from cprbm_scene import Scene, read
from tests.scenes.rare_scenes import FOLDER, scene


def last_force(asked: Scene, links: int) -> float:
    answer = cprbm.answer(asked, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    return float(answer.stations[-1].values["k.force"][0])


@pytest.mark.parametrize("links", [20, 40])
def test_a_step_past_a_closing_stays_on_the_branch(links):
    # reference: 160 finite elements; a state with 114 N belongs to another branch
    assert last_force(scene("coupler-on-a-tip"), links) == pytest.approx(77.858, rel=5e-3)


def test_a_tip_above_a_joint_is_a_single_contact():
    # reference: the same with links whose joints lie elsewhere
    asked = read(FOLDER.parent / "tip-above-a-joint.toml")
    assert last_force(asked, 40) == pytest.approx(last_force(asked, 38), rel=1e-3)
