"""The elliptic integrals beside direct integration of the elastica, and printed values."""

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.references.elastica import cantilever_under_tip_force, roll_up
from tests.references.integrated import end_of
from tests.references.small import cantilever_deflection


def _integrated(alpha):
    """Tip by shooting from the clamp: θ'' = −α cos θ, θ'(L) = 0."""

    def run(curvature):
        def slope(_, z):
            return [np.cos(z[2]), np.sin(z[2]), z[3], -alpha * np.cos(z[2])]

        return end_of(slope, (0, 1), [0, 0, 0, curvature])

    # θ'(0) = α x(L) < α
    return run(brentq(lambda c: run(c)[3], 0.0, alpha, xtol=1e-14))


@pytest.mark.parametrize("alpha", [1e-3, 0.2, 1.0, 3.0, 10.0])
def test_elliptic_integrals_agree_with_direct_integration(alpha):
    tip, integrated = cantilever_under_tip_force(alpha), _integrated(alpha)
    np.testing.assert_allclose([tip.x, tip.y, tip.rotation], integrated[:3], rtol=0, atol=2e-11)


def test_bisshopp_and_druckers_load_of_one():
    """δ/L = 0.302 at PL²/EI = 1, as tables of the large deflection of cantilevers print (Mattiasson 1981)."""
    tip = cantilever_under_tip_force(1.0)
    assert 1.0 - tip.x == pytest.approx(0.05643, abs=6e-6)
    assert tip.y == pytest.approx(0.30172, abs=6e-6)
    assert tip.rotation == pytest.approx(0.46135, abs=6e-6)


def test_mattiassons_load_of_ten():
    """K. Mattiasson, Int. J. Numer. Methods Eng. 17 (1981) 145-153: 0.55500, 0.81061, 1.43029 at 10."""
    tip = cantilever_under_tip_force(10.0)
    assert [1.0 - tip.x, tip.y, tip.rotation] == pytest.approx([0.55500, 0.81061, 1.43029], abs=6e-6)


def test_small_load_is_the_textbook_deflection():
    small = cantilever_deflection(1e-4, 1.0, 1.0)
    assert cantilever_under_tip_force(1e-4).y == pytest.approx(small, rel=1e-7)


def test_the_sign_of_the_load_mirrors():
    up, down = cantilever_under_tip_force(4.0), cantilever_under_tip_force(-4.0)
    assert (down.x, down.y, down.rotation) == (up.x, -up.y, -up.rotation)


@pytest.mark.parametrize("alpha", [401.0, float("nan"), float("inf")])
def test_a_load_out_of_range_is_refused(alpha):
    with pytest.raises(ValueError, match="within"):
        cantilever_under_tip_force(alpha)


def test_roll_up_closes_the_circle_and_goes_on():
    half, full, more = roll_up(np.pi), roll_up(2 * np.pi), roll_up(3 * np.pi)
    assert (half.x, half.y) == (pytest.approx(0, abs=1e-15), pytest.approx(2 / np.pi))
    assert (full.x, full.y, full.rotation) == (
        pytest.approx(0, abs=1e-15),
        pytest.approx(0, abs=1e-15),
        2 * np.pi,
    )
    assert more.y == pytest.approx(2 / (3 * np.pi))
    assert roll_up(0.0).x == 1.0
