"""A certificate is refused where what it says is more than was asked."""

from dataclasses import replace

import pytest

from fea_reference import Settings, answer
from fea_reference.certificates import certify
from fea_reference.contacts import contacts
from fea_reference.march import begin
from fea_reference.model import build
from fea_reference.travel import Course, reach
from tests.fea_reference.on_an_edge import cantilever_over
from tests.fea_reference.test_contact import CLOSING, two_cantilevers
from tests.together.pivots import wheel


@pytest.mark.parametrize("thick", [True, False])
def test_what_overlaps_by_more_than_was_asked_is_not_certified(thick):
    # two beams, one pressed on the other by three times what closes the gap, at the penetration of 1e-2
    scene, settings = two_cantilevers("upper", "lower", [1.0], thick=thick), Settings(elements=5, penetration=1e-2)
    model = build(scene, settings)
    march = begin(model, settings, contacts(scene, model, settings.penetration))
    reach(march, Course(0, 1.0), 3.0 * CLOSING / model.stepped[0].unit)
    assert certify(march).failures == ()
    march.settings = replace(settings, penetration=1e-4)
    (failure,) = certify(march).failures
    assert failure.startswith("contact touch has a relative penetration of ")
    assert failure.endswith("; 1.0e-04 was requested")
    # as tight as the penalties are made for the penetration that was asked of them, or for what may be felt of it
    assert 2e-3 < float(failure.split(";")[0].rsplit(" ", 1)[1]) <= 1e-2


@pytest.mark.parametrize(
    ("limit", "beyond"), [({"least": -2.17}, 0.03), ({"most": -2.31}, 0.11), ({"least": -2.3}, 0.0)]
)
def test_an_angle_beyond_its_stop_is_not_certified(limit, beyond):
    # reference: the stop is drawn at −2 rad, and a wheel that has turned by 0.2 leaves it at −2.2; the limit is put
    # there afterwards, so that the march knew nothing of it
    scene, settings = wheel(2.0, "end", {"least": -2.9}, [[0.2]]), Settings(elements=4)
    model = build(scene, settings)
    march = begin(model, settings, ())
    reach(march, Course(0, 0.2), 0.2 / model.stepped[0].unit)
    limits = {"least": None, "most": None, **limit}
    march.model = replace(model, stops=tuple(replace(stop, **limits) for stop in model.stops))
    failures = certify(march).failures
    told = [f"a joint, a stop or an element's length is violated by {beyond:.1e} of the longest beam"] if beyond else []
    assert list(failures) == told


@pytest.mark.parametrize("elements", [83, 157])
def test_a_corner_that_is_pressed_hard_by_a_tight_penalty_leaves_no_force(elements):
    # reference: action and reaction; the corner lies far from where the body's places are counted from
    corner = {"kind": "beam-line", "points": ((0.2, -0.3), (0.437, -0.0053), (0.8, -0.4)), "side": "left"}
    settings = Settings(elements=elements, kinematics="bending", penetration=4e-7)
    found = answer(cantilever_over(corner, force=8.0), settings)
    assert found.completed
    assert found.stations[0].certificate.force_balance < 1e-8
    assert found.stations[0].certificate.residual_floor < 3e-8
