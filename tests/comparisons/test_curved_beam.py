"""The curved beam's inner edge beside the formula in its textbook form, and beside a textbook's table."""

import math

import numpy as np
import pytest

from comparisons.studies.curved_beam import inner_edge_factor


@pytest.mark.parametrize("bentness", [0.02, 0.08, 0.1999, 0.2001, 0.5, 1.0, 1.9])
def test_it_is_the_quotient_of_the_two_stresses(bentness):
    """σ_i = M (r_n − r_i)/(A e r_i) and 6 M/(w t²), with R = M = w = 1."""
    t = bentness
    r_i, r_o = 1.0 - 0.5 * t, 1.0 + 0.5 * t
    r_n = t / math.log(r_o / r_i)
    curved = (r_n - r_i) / (t * (1.0 - r_n) * r_i)
    # where the beam is slender, 1 − r_n loses digits here
    assert inner_edge_factor(np.array([t]))[0] == pytest.approx(curved / (6.0 / t**2), rel=1e-13 / t**2)


@pytest.mark.parametrize("bentness", [0.08, 1.0])
def test_it_is_the_stress_of_sections_that_stay_plane(bentness):
    """Winkler's assumption and no more: ε = a + b/r without a force, its moment about R = 1 being 1, by quadrature."""
    points, weights = np.polynomial.legendre.leggauss(40)
    r = 1.0 + 0.5 * bentness * points
    dA = 0.5 * bentness * weights
    force = [np.sum(dA), np.sum(dA / r)]
    moment = [np.sum(dA * (r - 1.0)), np.sum(dA * (r - 1.0) / r)]
    a, b = np.linalg.solve([force, moment], [0.0, 1.0])
    inner = abs(a + b / (1.0 - 0.5 * bentness))
    assert inner_edge_factor(np.array([bentness]))[0] == pytest.approx(inner / (6.0 / bentness**2), rel=1e-9)


@pytest.mark.parametrize("bentness", [1e-7, 1e-4, 1e-2])
def test_of_a_slender_beam_it_is_a_third_of_thickness_over_radius(bentness):
    """K = 1 + x/3 + O(x²), and 1 for a straight beam."""
    assert inner_edge_factor(np.array([bentness]))[0] - 1.0 == pytest.approx(bentness / 3.0, rel=bentness, abs=1e-15)
    assert inner_edge_factor(np.zeros(2)).tolist() == [1.0, 1.0]


@pytest.mark.parametrize("bentness", [-0.1, 2.0, math.nan])
def test_an_inner_edge_beyond_the_centre_is_refused(bentness):
    with pytest.raises(ValueError, match="less than 2"):
        inner_edge_factor(np.array([0.1, bentness]))
