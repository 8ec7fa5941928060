"""Made-up sequences whose limit and order are known."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.converging.limits import limit, observed, orders

NS = (10, 20, 40, 80, 160, 320)


def _sequence(order, ns=NS, limit_=3.0, factor=7.0, next_=0.0):
    n = np.array(ns, dtype=float)
    return limit_ + factor * n**-order + next_ * n ** -(order + 1.0)


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
def test_a_pure_power_is_extrapolated_to_its_limit(order):
    found = limit(NS, _sequence(order), order)
    assert found.value == pytest.approx([3.0], rel=1e-14)
    assert found.uncertainty[0] < 1e-13
    assert found.order == pytest.approx(order, abs=1e-3)
    assert found.why == ""


@pytest.mark.parametrize("ns", [(10, 15, 30, 100), (40, 46, 80)])
def test_sizes_need_not_double(ns):
    values = _sequence(2.0, ns)
    assert limit(ns, values, 2.0).value == pytest.approx([3.0], rel=1e-13)
    assert orders(ns, values) == pytest.approx([2.0] * (len(ns) - 2), abs=1e-6)


@given(
    order=st.floats(1.0, 5.0),
    assumed=st.sampled_from([1.0, 2.0, 4.0]),
    ns=st.sampled_from([NS, (20, 40, 80), (10, 15, 30), (40, 46, 80), (10, 20, 30, 40)]),
)
def test_the_uncertainty_holds_whatever_the_order_is(order, assumed, ns):
    found = limit(ns, _sequence(order, ns), assumed)
    assert abs(found.value[0] - 3.0) <= found.uncertainty[0] + 1e-14


@pytest.mark.parametrize(("order", "assumed"), [(4.0, 4.0), (3.0, 4.0), (2.0, 2.0), (1.0, 2.0)])
def test_a_high_order_is_assumed_only_where_the_values_bear_it_out(order, assumed):
    assert limit(NS, _sequence(order), 4.0).assumed == assumed


@pytest.mark.parametrize("next_", [-50.0, -5.0, 5.0, 50.0])
def test_a_term_of_higher_order_lies_within_the_uncertainty_and_does_not_drown_in_it(next_):
    found = limit(NS, _sequence(2.0, next_=next_), 2.0)
    error = abs(found.value[0] - 3.0)
    assert error <= found.uncertainty[0] <= 20.0 * error
    assert found.order == pytest.approx(2.0, abs=0.1)


def test_an_uneven_error_lies_within_the_uncertainty_nearly_always():
    # the error's factor is another at each size, by up to a half, as where a contact falls between joints
    random = np.random.default_rng(1)
    n = np.array(NS, dtype=float)
    met = 0
    for _ in range(400):
        found = limit(NS, 3.0 + 7.0 * random.uniform(0.5, 1.5, n.size) / n**2, 2.0)
        met += abs(found.value[0] - 3.0) <= found.uncertainty[0]
    assert met >= 380


def test_round_off_shows_no_order_and_leaves_what_it_leaves():
    values = 3.0 + 1e-15 * np.array([1.0, -1.0, 0.0, 1.0, -1.0, 0.0])
    found = limit(NS, values, 2.0, floor=1e-14)
    assert found.order is None
    assert found.why == "the change is round-off"
    assert found.value == pytest.approx([3.0], abs=1e-14)
    assert 1e-14 <= found.uncertainty[0] <= 2e-14


def test_a_constant_is_its_own_limit():
    found = limit(NS, np.zeros(6), 2.0)
    assert (found.value[0], found.uncertainty[0], found.order) == (0.0, 0.0, None)


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ([1.0, 2.0, 1.5], "the change turns back"),
        ([1.0, 2.0, 3.0], "the change does not fall"),
        ([1.0, 2.0, 4.0], "the change does not fall"),
        ([1.0, 2.0, 2.0 + 1e-6], "the change falls faster than any order"),
    ],
)
def test_where_there_is_no_order_it_is_said_why(values, why):
    assert observed((10, 20, 40), np.array(values)) == (None, why)


def test_a_sequence_that_turns_back_keeps_its_last_step_as_uncertainty():
    found = limit((10, 20, 40), np.array([1.0, 2.0, 1.5]), 2.0)
    assert found.uncertainty[0] >= 0.5
    assert 1.0 < found.value[0] < 2.0


def test_a_vector_converges_as_one():
    # the second component passes through its limit, and alone shows no order
    n = np.array((10.0, 20.0, 40.0))
    values = np.column_stack([1.0 + 5.0 / n**2, 2.0 + 1e-4 * np.array([1.0, -1.0, 0.5])])
    together = limit((10, 20, 40), values, 2.0)
    assert together.order == pytest.approx(2.0, abs=0.01)
    assert together.value.shape == together.uncertainty.shape == (2,)
    assert limit((10, 20, 40), values[:, 1], 2.0).order is None


def test_two_sizes_show_no_order_and_the_correction_is_the_uncertainty():
    found = limit((20, 40), np.array([1.3, 1.0]), 2.0)
    assert found.value == pytest.approx([0.9])
    assert found.uncertainty == pytest.approx([0.1])
    assert found.order is None


def test_the_error_of_each_size_counts_the_limits_own():
    values = _sequence(2.0, (10, 20))
    found = limit((10, 20), values, 2.0)
    assert found.errors(values.reshape(2, 1))[:, 0] == pytest.approx(7.0 / np.array([100.0, 400.0]) + 7.0 / 400.0)


@pytest.mark.parametrize(
    ("ns", "values", "order"),
    [
        ((10,), [1.0], 2.0),
        ((20, 10), [1.0, 2.0], 2.0),
        ((10, 20), [1.0, math.nan], 2.0),
        ((10, 20), [1.0], 2.0),
        ((10, 20), [1.0, 2.0], 0.0),
    ],
)
def test_what_cannot_be_extrapolated_is_refused(ns, values, order):
    with pytest.raises(ValueError, match=r"sizes|values|order"):
        limit(ns, np.array(values), order)
