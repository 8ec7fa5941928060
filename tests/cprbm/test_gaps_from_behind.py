"""Derivatives of gaps of a beam end that presses the rear side of another beam."""

import numpy as np
import pytest

import cprbm
from cprbm.first_contact import NO_ROWS
from cprbm.kinematics import State
from cprbm.march import March
from cprbm.nearest import BEHIND
from cprbm.point import point_at
from cprbm_scene import Ending
from cprbm_scene.frozendict import frozendict
from cprbm_scene.statement import Profile
from tests.cprbm.lagrangian import check
from tests.scenes.rare_scenes import scene

THIN = 7.75e-05  # m: thickness of the beam that is pressed
TAPERED = Profile(at=(0.0, 1.0), values=(THIN, 0.9 * THIN))


def pressed(thickness):
    """The rare scene up to the first station with that contact; the pressed beam has the given thickness."""
    question = scene("pressed-from-behind-and-back")
    (stage,) = question.stages
    beams = dict(question.beams)
    beams["tip"] = beams["tip"].model_copy(update={"thickness": thickness})
    stage = stage.model_copy(update={"stations": stage.stations[:2]})
    return question.model_copy(update={"stages": (stage,), "beams": frozendict(beams)})


@pytest.mark.parametrize("thickness", [THIN, TAPERED], ids=["even", "tapered"])
@pytest.mark.parametrize("links", [{"arc": 23, "tip": 31}, {"arc": 31, "tip": 23}], ids=["rows on arc", "rows on tip"])
def test_derivatives_of_gaps_from_behind_and_of_the_lagrangian(thickness, links):
    """Reference: central differences, beside a state in which the arc's end presses from behind."""
    march = March(pressed(thickness), (cprbm.Settings(links=links),))
    assert march.run()[0] is Ending.COMPLETED
    problem, found = march.on.mechanism.problem, march.on.point
    assert any(key >= BEHIND or key < -1 for key in (key for _, key in found.rows.pressed(found.lam)))
    values, random = {"M": -2.4e-05}, np.random.default_rng(99)
    state = State(found.state.theta + 1e-5 * random.standard_normal(problem.model.n_links), found.state.bodies)
    mu = random.standard_normal(problem.closure.rows)
    moved = point_at(problem, values, state, mu, np.zeros(0), NO_ROWS)
    check(
        problem, values, point_at(problem, values, state, mu, 0.5 + random.random(moved.rows.size), moved.rows), random
    )
