"""The tip contact checked by itself: statics of both beams, the linear limit, the energy."""

import numpy as np
import pytest

from tests.references.elastica import cantilever_under_tip_force
from tests.references.two_cantilevers import TwoCantilevers, solve

PAIR = TwoCantilevers(gap=0.02, reach=1.8, lower_length=1.0, force=2.0)


def _cross(arm, force):
    return arm[0] * force[1] - arm[1] * force[0]


def test_the_clamps_carry_the_moments_of_the_tip_forces():
    found = solve(PAIR)
    e = np.array([np.sin(found.lower_angle), -np.cos(found.lower_angle)])
    contact = found.contact_force * e
    load = np.array([0.0, -PAIR.force])
    assert e[1] > 0.0
    assert found.upper_moment == pytest.approx(_cross(found.tip - [0.0, PAIR.gap], load + contact), rel=1e-10)
    assert found.lower_moment == pytest.approx(_cross(found.tip - [PAIR.reach, 0.0], -contact), rel=1e-10)


def test_small_loads_share_as_two_springs():
    """F = 3 h + (3 + 3/σ³) w and P = 3 w / σ³ where w is the lower beam's deflection, σ = a − L1."""
    h = 1e-5
    found = solve(TwoCantilevers(gap=h, reach=1.8, lower_length=1.0, force=1e-4))
    sigma = 0.8
    w = (1e-4 / 3.0 - h) / (1.0 + 1.0 / sigma**3)
    assert found.contact_force == pytest.approx(3.0 * w / sigma**3, rel=1e-6)
    assert found.tip[1] == pytest.approx(-w, rel=1e-6)


def test_the_lower_beam_is_a_cantilever_under_the_contact_force():
    """Elliptic integrals for a force along y; the normal follows the beam, a difference of second order."""
    found = solve(TwoCantilevers(gap=1e-4, reach=1.8, lower_length=1.0, force=0.02))
    sigma = found.contact_arc_length
    closed = cantilever_under_tip_force(found.contact_force * sigma**2)
    assert -found.tip[1] == pytest.approx(closed.y * sigma, rel=1e-4)
    assert found.lower_angle - np.pi == pytest.approx(closed.rotation, rel=1e-4)


def test_more_force_moves_the_tip_by_less_than_without_the_lower_beam():
    alone = cantilever_under_tip_force(-PAIR.force)
    found = solve(PAIR)
    assert alone.y + PAIR.gap < found.tip[1] < 0.0


@pytest.mark.parametrize(
    ("pair", "words"),
    [
        (TwoCantilevers(0.02, 1.8, 1.0, 0.05), "where the gap closes"),
        (TwoCantilevers(0.02, 1.8, 0.81, 2.0), "off the lower beam"),
    ],
)
def test_what_is_no_tip_contact_is_refused(pair, words):
    with pytest.raises(ValueError, match=words):
        solve(pair)
