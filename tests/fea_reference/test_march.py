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
