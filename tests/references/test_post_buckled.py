"""The post-buckled column beside an independent integration, a small-deflection limit and the work of its load."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from tests.references.integrated import end_of
from tests.references.post_buckled import post_buckled, small_deflection
from tests.references.small import euler_load_clamped

EULER = euler_load_clamped(1.0, 1.0)


def integrated(load):
    """Half of the column by shooting from the clamp's moment to a level tangent in the middle, no force across."""

    def half(moment):
        def slope(_, z):
            return [np.cos(z[2]), np.sin(z[2]), z[3], -load * np.sin(z[2]), 0.5 * z[3] ** 2]

        return end_of(slope, (0.0, 0.5), [0.0, 0.0, 0.0, moment, 0.0], rtol=1e-13, atol=1e-14)

    # the tangent in the middle is level at no moment too; between, the first moment at which it is again
    moment = brentq(lambda m: half(m)[2], 0.4 * np.sqrt(load), 1.9 * np.sqrt(load), xtol=1e-14)
    x, y, _, _, energy = half(moment)
    return 1.0 - 2.0 * x, y, moment, 2.0 * energy


@pytest.mark.parametrize("factor", [1.05, 1.3, 1.7])
def test_elliptic_integrals_agree_with_direct_integration(factor):
    # reference: an explicit Runge-Kutta method of order eight on Euler's equation
    found = post_buckled(factor * EULER)
    expected = integrated(factor * EULER)
    assert [found.shortening, found.deflection, found.moment, found.strain_energy] == pytest.approx(expected, rel=1e-9)


def test_small_deflections_begin_at_eulers_load():
    # reference: Euler's load of the clamped column, 4 π² EI/L², and the first terms of K; the next is as factor − 1
    for factor in (1.0 + 1e-4, 1.0 + 1e-6):
        assert post_buckled(factor * EULER).deflection == pytest.approx(
            small_deflection(factor * EULER), rel=2.0 * (factor - 1.0)
        )


def test_the_load_does_the_work_that_is_stored():
    # reference: conservation of energy, P dδ = dU
    work = quad(lambda p: post_buckled(p).shortening, EULER * (1 + 1e-13), 1.6 * EULER, epsabs=1e-12)[0]
    end = post_buckled(1.6 * EULER)
    assert end.load * end.shortening - work == pytest.approx(end.strain_energy, rel=1e-9)


@pytest.mark.parametrize("load", [EULER, 0.0, -50.0, 90.0, float("nan")])
def test_a_load_out_of_range_is_refused(load):
    with pytest.raises(ValueError, match="must lie between"):
        post_buckled(load)
