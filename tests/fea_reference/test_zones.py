"""Where a gap is negative, against the roots of the polynomial that it is."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from fea_reference.zones import Gap, negative


def gap_of(f):
    """A polynomial as a gap that is known everywhere."""
    slope, bend = f.deriv(), f.deriv(2)

    def at(zeta, guess):
        return Gap(f(zeta), slope(zeta), bend(zeta), guess, np.ones(len(zeta), dtype=bool))

    return at


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("depth", [0.031, 0.0007, 1.3e-7])
def test_a_zone_between_two_places_with_slopes_of_one_sign_is_found(turned, depth):
    # the slope rises, falls and rises again: the least value is at the second of its roots
    slope = 5.7 * Polynomial.fromroots([0.13, 0.71])
    gap = slope.integ()
    gap = gap - gap(0.71) - depth
    low, high = (float(root.real) for root in np.sort(gap.roots())[-2:])
    if turned:
        gap, low, high = gap(Polynomial([1.0, -1.0])), 1.0 - high, 1.0 - low
    at, places = gap_of(gap), np.array([0.0, 1.0])
    zones = negative(at, places, at(places, np.zeros(2)), np.array([True]))
    assert zones.least == pytest.approx(-depth, rel=1e-9)
    assert zones.intervals == pytest.approx(np.array([[low, high]]), abs=1e-7)
