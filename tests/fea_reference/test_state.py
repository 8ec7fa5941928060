"""Numbers in two parts against exact fractions."""

from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fea_reference.state import State, multiplied, squared, summed

numbers = st.floats(-1e6, 1e6).filter(lambda x: x == 0.0 or abs(x) > 1e-100)


@given(numbers, numbers)
def test_a_sum_and_its_error_are_the_sum(a, b):
    value, error = summed(np.array([a]), np.array([b]))
    assert value[0] == a + b
    assert Fraction(float(value[0])) + Fraction(float(error[0])) == Fraction(a) + Fraction(b)


@given(numbers)
def test_a_square_and_its_error_are_the_square(a):
    value, error = squared(np.array([a]))
    assert value[0] == a * a
    assert Fraction(float(value[0])) + Fraction(float(error[0])) == Fraction(a) ** 2


@given(numbers, numbers)
def test_a_product_and_its_error_are_the_product(a, b):
    value, error = multiplied(np.array([a]), np.array([b]))
    assert value[0] == a * b
    assert Fraction(float(value[0])) + Fraction(float(error[0])) == Fraction(a) * Fraction(b)


def test_small_steps_are_not_lost():
    """A thousand steps that plain addition would round away, and the distance of two neighbours."""
    step = np.array([0.0, 1e-18])
    state = State.of(np.array([0.7, 0.7]))
    for _ in range(1000):
        state = state.moved(step)
    got = state.difference(np.array([1]), np.array([0]))
    np.testing.assert_allclose(got, [1e-15], rtol=1e-12)
