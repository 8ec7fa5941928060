"""Where a slope goes through zero, beside places at which its own slope jumps."""

import numpy as np
import pytest

from cprbm import wells


def kinked(here):
    """A slope that is 0.011 at a place; up to there it rises by 1.9, and then falls by 0.7."""

    def slope(s):
        D_ss = np.where(s < here, 1.9, -0.7)
        return 0.011 + D_ss * (s - here), D_ss

    return slope


@pytest.mark.parametrize("off", [-1e-15, 0.0, 1e-15])
def test_where_elements_meet_round_off_does_not_say_whether_there_is_a_minimum(off):
    # closed form: D_s = 0.011 + 1.9 (s − 0.37) below 0.37, where it is zero; beyond, it falls and leads nowhere
    here = 0.37
    start = np.array([here + off])
    s, settled = wells.bottom(kinked(here), start, np.stack((start - 0.1, start + 0.1)), 1e-6, 1e-13)
    assert settled.tolist() == [True]
    assert s == pytest.approx([here - 0.011 / 1.9], abs=1e-12)


def test_nothing_settles_where_the_slope_falls_or_has_no_zero_within():
    start = np.array([0.23, 0.41])

    def slope(s):
        D_ss = np.where(s < 0.3, -0.3, 0.5)
        return D_ss * (s - 0.9), D_ss

    _, settled = wells.bottom(slope, start, np.stack((start - 0.1, start + 0.1)), 1e-6, 1e-13)
    assert settled.tolist() == [False, False]


def test_of_no_places_there_is_none():
    nothing = np.zeros(0)
    s, settled = wells.bottom(lambda s: (s, s), nothing, np.zeros((2, 0)), 1e-6, 1e-13)
    assert s.size == settled.size == 0
