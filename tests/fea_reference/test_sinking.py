"""Contacts in a point lie as deep as their foreseen push asks for: iterations do not grow with the elements."""

import numpy as np
import pytest

from comparisons import cases
from cprbm_scene import Ending
from fea_reference import Settings, answer, prepared
from fea_reference.advance import advance
from fea_reference.contacts import touch
from fea_reference.sinking import known_depths, with_predicted_depths
from fea_reference.travel import Course, reach

PRESSED = 0.5  # of the hinge's last moment, with which its beams touch


@pytest.fixture(scope="module")
def pressed():
    """The hinge, its contact closed in a point, stepped and penalties tightened."""
    scene = cases.opened("hinge")
    settings = Settings(elements=80, kinematics="bending")
    march = prepared(scene, settings).march
    last = scene.stages[0].stations[-1] / march.model.stepped[0].unit
    for share in (0.4, PRESSED, 0.6):
        reach(march, Course(0, last, "load", None), share * last)
    assert march.system.touches[0].closed
    return march


@pytest.mark.parametrize("by", [-1e-3, -1e-5, 1e-5, 1e-3])
@pytest.mark.parametrize("share", [0.5, 1.0, 2.0])
def test_a_contact_pushes_as_foreseen_from_wherever_a_step_has_left_it(pressed, by, share):
    """Too deep or open by a thousand times its depth, and for another force than before."""
    model, system = pressed.model, pressed.system
    (one,) = system.touches
    c = np.bincount(one.dofs.ravel(), one.mean.ravel(), model.size)
    motion = system.solve(c)
    aside = advance(model, system.z, by / float(c @ motion) * motion)
    known = known_depths(system, pressed.depths(), pressed.pushes())
    foreseen = {one.pair: share * one.pushes}
    there = with_predicted_depths(model, pressed.penalties, pressed.settings.quadrature, system, aside, foreseen, known)
    pressed_there = pressed_at(pressed, there)
    assert pressed_there.push == pytest.approx(share * one.push, rel=1e-2)
    assert np.abs((there.values - system.z.values)[model.moving]).max() < 1e-3


def pressed_at(march, z):
    ((pair, penalty),) = march.penalties.items()
    return touch(march.model, pair, penalty, march.settings.quadrature, z)


def test_what_has_pushed_with_nothing_is_not_known(pressed):
    (one,) = pressed.system.touches
    assert set(known_depths(pressed.system, pressed.depths(), pressed.pushes())) == {one.pair}
    assert not known_depths(pressed.system, pressed.depths(), {})
    assert not known_depths(pressed.system, {one.pair: 1e-18}, pressed.pushes())


@pytest.mark.parametrize("elements", [40, 320])
def test_stations_with_a_closed_contact_take_few_iterations_on_any_mesh(elements):
    got = answer(cases.opened("hinge"), Settings(elements=elements, kinematics="bending"))
    assert got.ending is Ending.COMPLETED
    closed = [one.certificate.iterations for one in got.stations if one.values["contact.force"][0] > 0.0]
    assert max(closed[1:]) <= 6
