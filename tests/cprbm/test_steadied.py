"""Meshes that follow each other, led to the one that follows itself.

Reference: of a linear map x ↦ x* + M (x − x*) the mesh that is sought is x*.
"""

import numpy as np
import pytest

from cprbm.model import Fit, Kinks
from cprbm.steadied import steadied

BORDERS = np.array([0.0, 0.21, 0.47, 0.83, 1.0])
MOVED = np.array([0.0, 0.013, 0.021, -0.017, 0.0])
SLOPES = np.array([-4.1, 11.3])


def fit_at(off, *, ends=None):
    kinks = Kinks(np.array([0.37 + 0.03 * off]), SLOPES[:1] * (1.0 + 0.1 * off), SLOPES[1:] * (1.0 - 0.07 * off))
    return Fit({"beam": BORDERS + off * MOVED}, ends or {}, {"contact": (kinks,)})


@pytest.mark.parametrize("slope", [-1.0, -0.93, -3.7])
def test_of_two_meshes_that_take_turns_the_one_between_is_found(slope):
    off, before = 1.0, None
    for _ in range(2):
        now = fit_at(off), fit_at(slope * off)
        found, before = steadied(now, before), now
        off = slope * off
    expected = fit_at(0.0)
    assert found.borders["beam"] == pytest.approx(expected.borders["beam"], abs=1e-12)
    for of in ("places", "before", "behind"):
        assert getattr(found.kinks["contact"][0], of) == pytest.approx(getattr(expected.kinks["contact"][0], of))


def test_what_has_no_numbers_in_common_is_taken_as_it_is():
    even, other = Fit({}, {}, {}), fit_at(0.4)
    assert steadied((even, other), None) is other
    assert steadied((fit_at(1.0), other), (even, fit_at(1.0))) is other
    # ends of zones are known where a state has them, and between two there is none
    zoned = fit_at(0.4, ends={"contact": np.array([0.47])})
    assert steadied((zoned, zoned), (fit_at(1.0, ends=zoned.ends), zoned)) is zoned


def test_where_nothing_has_changed_nothing_is_mixed():
    same = fit_at(0.2)
    assert steadied((fit_at(0.6), same), (fit_at(0.6), same)) is same
