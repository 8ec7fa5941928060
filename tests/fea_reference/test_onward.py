"""Where something has just come to touch, the branch goes on along what holds it back."""

import numpy as np
import pytest

from comparisons import cases
from fea_reference import Settings
from fea_reference.contacts import contacts, zones_of
from fea_reference.march import begin
from fea_reference.model import build
from fea_reference.touch import Penalty

SHARE = 1.3e-3  # of the last moment: how far on the difference quotient looks
STIFF = 3e5  # times the first penalty


@pytest.fixture(scope="module")
def touching():
    """The hinge, stepped until its beams have come to touch, and the value of its last moment."""
    scene = cases.opened("hinge")
    settings = Settings(elements=24, kinematics="bending")
    model = build(scene, settings)
    march = begin(model, settings, contacts(scene, model, settings.penetration))
    last = scene.stages[0].stations[-1] / model.stepped[0].unit
    for _ in range(20):
        if march.penalties:
            return march, last
        assert march.step(0, float(march.values[0]) + 0.11 * last, march.onward(0, march.rate(0), last)) is None
    pytest.fail("nothing touches")


def test_the_rate_on_is_that_of_the_equilibria_with_the_contact(touching):
    march, last = touching
    stiff, moving = march.saved(), march.model.moving
    stiff.penalties = {pair: Penalty(STIFF * penalty.stiffness) for pair, penalty in march.penalties.items()}
    stiff.renew()
    onward, before = stiff.onward(0, stiff.rate(0), last), stiff.system
    assert stiff.step(0, float(stiff.values[0]) + SHARE * last, onward) is None
    quotient = (stiff.system.z.values - before.z.values)[moving] / (SHARE * last)
    free, held = (float(np.abs(rate[moving] - quotient).max()) for rate in (march.rate(0), onward.rate))
    # what the penalty gives way, and the branch bends, in so short a step is of the order of its length
    assert held < 0.05 * free
    (push,) = onward.pushes.values()
    assert push * SHARE * last == pytest.approx(stiff.system.touches[0].push, rel=0.03)


def test_on_the_way_back_nothing_holds(touching):
    march, _ = touching
    rate = march.rate(0)
    back = march.onward(0, rate, 0.0)
    assert not back.pushes
    assert back.rate is rate


def test_a_step_begins_where_the_contact_pushes_as_foreseen(touching):
    march, last = touching
    march = march.saved()
    (pair,) = march.penalties
    value = float(march.values[0]) + 0.07 * last
    spent = march.iterations
    assert march.step(0, value, march.onward(0, march.rate(0), last)) is None
    assert march.values[0] == value
    assert zones_of(march.model, pair, march.system.z).least < 0.0
    assert march.iterations - spent <= 5  # from the rate without the contact it is nine
