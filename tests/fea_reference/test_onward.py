"""Where something has just come to touch, the branch goes on along what holds it back."""

import numpy as np
import pytest

from comparisons import cases
from fea_reference import Settings, prepared
from fea_reference.contacts import contacts, touch, zones_of
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.touch import Penalty
from tests.fea_reference.on_an_edge import cantilever_over

SHARE = 1.3e-3  # of the last moment: how far on the difference quotient looks
STIFF = 3e5  # times the first penalty


@pytest.fixture(scope="module")
def touching():
    """The hinge, stepped until its beams have come to touch, and the value of its last moment."""
    scene = cases.opened("hinge")
    settings = Settings(elements=24, kinematics="bending")
    march = prepared(scene, settings).march
    last = scene.stages[0].stations[-1] / march.model.stepped[0].unit
    for _ in range(20):
        if march.penalties:
            return march, last
        assert march.step(0, float(march.values[0]) + 0.11 * last, march.path_tangent(0, march.rate(0), last)) is None
    pytest.fail("nothing touches")


def test_the_rate_on_is_that_of_the_equilibria_with_the_contact(touching):
    march, last = touching
    stiff, moving = march.saved(), march.model.moving
    stiff.penalties = {pair: Penalty(STIFF * penalty.stiffness) for pair, penalty in march.penalties.items()}
    stiff.reassemble()
    tangent, before = stiff.path_tangent(0, stiff.rate(0), last), stiff.system
    assert stiff.step(0, float(stiff.values[0]) + SHARE * last, tangent) is None
    quotient = (stiff.system.z.values - before.z.values)[moving] / (SHARE * last)
    free, held = (float(np.abs(rate[moving] - quotient).max()) for rate in (march.rate(0), tangent.rate))
    # what the penalty gives way, and the branch bends, in so short a step is of the order of its length
    assert held < 0.05 * free
    (push,) = tangent.pushes.values()
    assert push * SHARE * last == pytest.approx(stiff.system.touches[0].push, rel=0.03)


def test_on_the_way_back_nothing_holds(touching):
    march, _ = touching
    rate = march.rate(0)
    back = march.path_tangent(0, rate, 0.0)
    assert not back.pushes
    assert back.rate is rate


def test_a_step_begins_where_the_contact_pushes_as_foreseen(touching):
    march, last = touching
    march = march.saved()
    (pair,) = march.penalties
    value = float(march.values[0]) + 0.07 * last
    spent = march.iterations
    assert march.step(0, value, march.path_tangent(0, march.rate(0), last)) is None
    assert march.values[0] == value
    assert zones_of(march.model, pair, march.system.z).least < 0.0
    assert march.iterations - spent <= 5  # from the rate without the contact it is nine


def test_a_pressure_that_begins_before_an_edge_is_that_on_an_edge_so_far_ahead():
    lead, bow = 0.0031, 0.07
    normal = np.array([0.13, 1.0]) / np.hypot(0.13, 1.0)
    found = []
    for ahead in (0.0, lead):
        point = tuple((np.array([0.0, 0.06]) + ahead * normal).tolist())
        edge = {"kind": "beam-half-plane", "point": point, "normal": tuple(normal.tolist())}
        settings = Settings(elements=11)
        scene = cantilever_over(edge)
        model = build(scene, settings)
        (face,) = contacts(scene, model, settings.penetration)
        bent = model.start.values.copy()
        x = bent[model.node_dofs[0]]
        bent[model.node_dofs[1]], bent[model.node_dofs[2]] = -bow * x**2, -2.0 * bow * x
        found.append(touch(model, face, Penalty(17.3, lead - ahead), 5, State.of(bent)))
    led, shifted = found
    assert led.closed
    assert led.zeta == pytest.approx(shifted.zeta, abs=1e-9)
    assert led.gap == pytest.approx(shifted.gap, abs=1e-12)
    assert led.gradient == pytest.approx(shifted.gradient, abs=1e-9 * np.abs(shifted.gradient).max())
    assert led.zones.least == pytest.approx(shifted.zones.least + lead, abs=1e-12)
