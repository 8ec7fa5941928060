"""The cantilever over a corner against beam theory for small deflections, and against its own energy."""

import pytest

from tests.references.cornered import Cornered


@pytest.mark.parametrize("half", [0.0, 0.005])
def test_a_little_pressed_it_is_a_beam_on_two_supports(half):
    # a propped cantilever with an overhang: moment −P(1 − a)/2 at the clamp, N = P (1 + 3(1 − a)/(2a))
    a, P = 0.6, 1e-4
    found = Cornered(P, (a, -half), half)
    assert found.pressed == pytest.approx(P * (1.0 + 1.5 * (1.0 - a) / a), rel=1e-4)
    assert found.place == pytest.approx(a, abs=1e-5)
    # tip: overhang P l³/3 and the slope P l a/4 over the prop
    overhang = 1.0 - a
    assert -found.tip[1] == pytest.approx(P * overhang**3 / 3.0 + P * overhang**2 * a / 4.0, rel=1e-3)


def test_what_the_force_does_is_stored():
    # Clapeyron's other form: d(potential energy)/dP = −deflection of the tip
    P, h = 3.0, 1e-3
    low, mid, high = (Cornered(P + d, (0.5, -0.02), 0.005) for d in (-h, 0.0, h))
    slope = (high.potential_energy - low.potential_energy) / (2.0 * h)
    assert slope == pytest.approx(mid.tip[1], rel=1e-5)
