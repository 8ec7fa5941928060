"""By which law curvature falls to zero: evenly, as towards a bifurcation, or by its square, as towards a fold."""

import pytest

from cprbm.critical import Minimum, _falls_evenly
from cprbm_scene import Certificate


def at(value, curvature):
    return Minimum(value, None, Certificate(*(0.0,) * 7, smallest_curvature=curvature, iterations=0))


@pytest.mark.parametrize("left", [(1.0, 0.5, 0.25, 0.125), (1.0, 0.02, 4e-4, 8e-6)])
@pytest.mark.parametrize(("power", "evenly"), [(1.0, True), (0.5, False)])
@pytest.mark.parametrize("more", [-0.3, 0.0, 0.3])
def test_the_law_is_told_by_what_it_foretells(left, power, evenly, more):
    # reference: kappa = (v_c - v)^power but for a higher term, v_c = 3, as bifurcations (1) and folds (1/2) have it
    trail = [at(3.0 - far, (far + more * far**2) ** power) for far in left]
    assert _falls_evenly(trail, trail[-2], 3.0) is evenly
    assert not _falls_evenly(trail[-2:], trail[-2], 3.0)
