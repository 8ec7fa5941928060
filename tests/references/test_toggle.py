"""The lever beside an independent integration of its beam, the work of its moment, and values around its fold."""

from __future__ import annotations

import numpy as np
import pytest

from tests.references.rod import carried, stored
from tests.references.toggle import Toggle

TOGGLE = Toggle(arc=0.6, base=1.3, arm=0.45)


def along_the_line_of_pins(state):
    """The beam from pin to pin, bowed to the left, its thrust along x."""
    return np.array([0.0, 0.0, state.pin_angle, 0.0]), np.array([-state.thrust, 0.0])


@pytest.mark.parametrize("thrust", [-4.0, 0.0, 3.0, TOGGLE.fold().thrust])
def test_quadrature_agrees_with_direct_integration(thrust):
    # reference: an explicit Runge-Kutta method of order eight
    state = TOGGLE.under(thrust)
    end, _ = carried(*along_the_line_of_pins(state), 1.0, -TOGGLE.arc)
    assert end == pytest.approx([state.distance, 0.0, -state.pin_angle, 0.0], abs=1e-12)


def test_at_rest_it_is_an_arc():
    # reference: a circle's chord
    assert TOGGLE.under(0.0).distance == pytest.approx(2.0 * np.sin(0.3) / 0.6, rel=1e-14)


@pytest.mark.parametrize("thrust", [-4.0, 3.0, 5.0])
def test_the_moment_does_the_work_that_is_stored(thrust):
    # reference: dU = −M dψ, by an extrapolated difference
    def slope(h):
        above, below = TOGGLE.under(thrust + h), TOGGLE.under(thrust - h)
        U = [stored(*along_the_line_of_pins(state), 1.0, -TOGGLE.arc) for state in (above, below)]
        return (U[0] - U[1]) / (above.lever - below.lever)

    assert (4.0 * slope(0.01) - slope(0.02)) / 3.0 == pytest.approx(-TOGGLE.under(thrust).moment, rel=1e-8)


def test_the_fold_is_the_largest_moment():
    fold = TOGGLE.fold()
    around = [TOGGLE.under(fold.thrust + more).moment for more in (-0.3, -0.1, 0.1, 0.3)]
    assert fold.moment > max(around[1:3]) > max(around[0], around[3])
    assert 0.0 < fold.lever < TOGGLE.under(0.0).lever


def test_beyond_the_fold_the_beam_is_pulled():
    fold = TOGGLE.fold()
    after = TOGGLE.beyond(fold.moment)
    assert after.moment == pytest.approx(fold.moment, rel=1e-12)
    assert after.thrust < 0.0
    assert after.lever < -TOGGLE.under(0.0).lever
