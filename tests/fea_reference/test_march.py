"""Several contacts on the way: what closes where, and whether the march arrives."""

import pytest

from comparisons import cases
from fea_reference import Settings, answer
from scene.answer import Ending


def with_stations(scene, *stations):
    return scene.model_copy(update={"stages": (scene.stages[0].model_copy(update={"stations": stations}),)})


@pytest.mark.parametrize("kinematics", ["bending", "stretch"])
def test_tips_that_slide_along_one_another_arrive_in_long_steps(kinematics):
    """Three contacts, two of them of a free end that slides along a beam under a penalty whose force on what a step
    overlaps is thousands of times the contact's own.
    """
    found = answer(cases.opened("stack"), Settings(elements=20, kinematics=kinematics))
    assert found.ending is Ending.COMPLETED, found.sentence
    assert sum(station.certificate.iterations for station in found.stations) < 600


def test_a_little_penetration_in_few_stations_arrives():
    """A 256th of the standard penetration: the penalties of both contacts are the stiffest that are ever asked for."""
    scene = with_stations(cases.opened("gripper"), 9.6, 16.0)
    found = answer(scene, Settings(elements=320, kinematics="bending", penetration=1e-4 / 256))
    assert found.ending is Ending.COMPLETED, found.sentence


def test_where_a_contact_closes_is_not_a_matter_of_the_stations():
    """Another contact that is still under its first, loose penalty must not let the next one close too late."""
    first, second = (
        answer(with_stations(cases.opened("stack"), *stations), Settings(elements=40)).stations[-1].values
        for stations in ((0.015,), (0.012, 0.014, 0.015))
    )
    # a penetration of 1e-4 of 0.95 mm, on a way of 14 mm, and as much again for the levers in between
    assert first["second.closing_load"] == pytest.approx(second["second.closing_load"], rel=2e-5)


def test_a_contact_that_closes_a_second_time_within_an_element_arrives():
    """A thousandth of the standard penetration, where the nodes of both beams lie beside the place of contact."""
    scene = with_stations(cases.opened("gripper-driven"), 0.03, 0.034)
    found = answer(scene, Settings(elements=320, kinematics="shear", penetration=2e-7))
    assert found.ending is Ending.COMPLETED, found.sentence


@pytest.mark.parametrize("elements", [20, 80])
def test_what_a_penalty_leaves_is_the_same_share_of_the_penetration_asked(elements):
    """The same at every load and for every number of elements: else it would not go evenly with either."""
    asked = 1e-4 * (40 / elements) ** 4
    found = answer(cases.opened("hinge"), Settings(elements=elements, kinematics="bending", penetration=asked))
    left = [station.certificate.penetration / asked for station in found.stations if station.values["contact.force"]]
    assert len(left) > 5
    assert left == pytest.approx(len(left) * [left[0]], rel=0.04)
    assert 0.5 < left[0] <= 1.0


def test_tips_that_slide_are_held_while_a_circle_s_penalty_rises():
    """Both tips overlap by less than what the circle's rising penalty moves them: they must not open."""
    scene = with_stations(cases.opened("stack"), 0.01, 0.015, 0.02, 0.025, 0.03, 0.035)
    found = answer(scene, Settings(elements=40, kinematics="bending", penetration=6e-9))
    assert found.ending is Ending.COMPLETED, found.sentence
