"""Which probes converge with the first order only; shown by tests/cprbm/test_circle.py and tests/fea_reference."""

import pytest

from comparisons.order import order_of, richardson
from cprbm_scene import Probe
from tests.cprbm.test_circle import scene_of
from tests.cprbm.test_lying import lying
from tests.fea_reference.meeting_itself import strip


def test_the_ends_of_a_contact_with_a_circle_are_of_first_order_and_of_another_beam_of_second(hinge):
    assert order_of(scene_of([1.0]), Probe(of="circle", quantity="ends")) == 1
    assert order_of(hinge, Probe(of="contact", quantity="ends")) == 2


@pytest.mark.parametrize(
    ("probe", "order"),
    [("circle.force", 1), ("circle.centre", 1), ("R.reaction", 1), ("R.reaction_moment", 2), ("T.displacement", 2)],
)
def test_the_share_of_a_clamp_beside_a_circle_is_of_first_order(probe, order):
    scene = scene_of([1.0])
    assert order_of(scene, next(p for p in scene.probes if p.name == probe)) == order


@pytest.mark.parametrize(
    ("probe", "order"), [("c.force", 1), ("c.centre", 1), ("R.reaction", 1), ("T.displacement", 2)]
)
def test_the_share_of_a_clamp_that_two_touching_beams_have_in_common_is_of_first_order(probe, order):
    scene = lying()
    assert order_of(scene, next(p for p in scene.probes if p.name == probe)) == order


def test_everything_of_the_hinge_is_of_second_order(hinge):
    assert {order_of(hinge, probe) for probe in hinge.probes} == {2}


def test_the_factor_of_a_known_order():
    # reference: an error C/N^p, of which the change from N to 2N leaves 1 − 2^−p
    assert richardson(1) == 2.0
    assert richardson(2) == pytest.approx(4.0 / 3.0)


@pytest.mark.parametrize("probe", ["force", "centre", "ends"])
def test_a_beam_that_touches_itself_away_from_its_ends_is_of_second_order(probe):
    scene = strip(0.0012, [8.0])
    assert order_of(scene, Probe(of="lap", quantity=probe)) == 2
    assert order_of(scene, Probe(of="C", quantity="reaction")) == 2
