"""Numbers for people: no small one may read as nothing."""

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.formats import number, percent, scaled_unit, vector


@given(st.floats(min_value=1e-300, max_value=1e12), st.booleans())
def test_a_number_is_read_back_to_its_digits(size, negative):
    value = -size if negative else size
    assert float(number(value)) == pytest.approx(value, rel=0.006)


@given(st.floats(min_value=1e-290, max_value=1.0))
def test_no_error_reads_as_zero(fraction):
    assert re.search("[1-9]", percent(fraction))


def test_only_zero_reads_as_zero_and_nothing_as_a_dash():
    assert percent(0.0) == "0 %"
    assert percent(None) == percent(math.nan) == "–"


def test_units_take_the_prefix_that_reads_best():
    assert scaled_unit("m", 0.0123) == (1e-3, "mm")
    assert scaled_unit("Pa", 3.4e7) == (1e6, "MPa")
    assert scaled_unit("rad", 1e-3) == (1.0, "rad")
    assert scaled_unit("N", 0.0) == (1.0, "N")


def test_an_absent_value_is_said_to_be_open():
    assert vector(np.empty(0), 1.0) == "open"
    assert vector(np.array([-3.0, 2.0, 1.0, 0.0]), 1.0) == "max 3.0000"
