"""Discretisation error, order and limit of made-up sequences with a known limit and order.

Expected numbers follow from Richardson's formulas, written in each test: with values v = L + C N^−q and a law of order
p through N and 2N, the law's error at N is (v − V)/(1 − 2^−p).
"""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.verdict.uncertainty import error, largest, limit, observed, orders

S = 1.25
THIRD = (56, 64, 112)  # N, 8/7 N and 2N
DOUBLED = (10, 20, 40, 80, 160, 320)


def powers(order, sizes=DOUBLED, limit_=3.0, factor=7.0, next_=0.0):
    n = np.array(sizes, dtype=float)
    return limit_ + factor * n**-order + next_ * n ** -(order + 1.0)


def stated(sizes, values, at=0, order=2.0):
    found = error(sizes, np.reshape(values, (len(sizes), -1)), at, order)
    return found.even, found.uneven


@pytest.mark.parametrize(("order", "own"), [(1.0, 2.0), (2.0, 2.0), (4.0, 4.0), (2.0, 4.0), (1.0, 4.0)])
@pytest.mark.parametrize("at", [0, 1, 2])
def test_three_grids_of_a_pure_power_state_its_error_and_a_quarter(order, own, at):
    even, uneven = stated(THIRD, powers(order, THIRD, factor=7.0), at, own)
    assert even == pytest.approx([S * 7.0 / THIRD[at] ** order], rel=1e-9)
    assert uneven == pytest.approx([0.0], abs=1e-12)


def test_a_higher_order_than_the_assumed_order_is_stated_larger():
    # with (v − V)/C = 15/16 the law of order 2 has the error 5/4 C at N and L = v_∞ − C/4; at 8/7 N the law has
    # −1/4 + 5/4 (7/8)², and the value is (7/8)⁴
    even, uneven = stated(THIRD, powers(4.0, THIRD, factor=THIRD[0] ** 4.0))
    beyond = (7 / 8) ** 4 + 1 / 4 - 5 / 4 * (7 / 8) ** 2
    assert even == pytest.approx([S * 5 / 4], rel=1e-9)
    assert uneven == pytest.approx([S * abs(beyond) * (8 / 7) ** 2], rel=1e-9)


@pytest.mark.parametrize(("order", "assumed"), [(1.45, 1.0), (1.55, 2.0), (2.5, 2.0)])
def test_three_quarters_of_an_order_must_be_shown_for_it(order, assumed):
    # of the change v − V the law of order 1 makes twice the error, the law of order 2 makes 4/3; a value has the order
    # that the grids show, where that is smaller
    values = powers(order, THIRD)
    factor = 1.0 / (1.0 - 2.0 ** -min(order, assumed))
    assert stated(THIRD, values)[0] == pytest.approx([S * factor * (values[0] - values[2])], rel=1e-9)
    assert limit(THIRD, values).assumed == assumed


def test_an_oscillating_term_beside_an_even_error_is_added_to_it():
    values = powers(2.0, THIRD) - np.array([0.0, 1e-4, 0.0])
    even, uneven = stated(THIRD, values)
    assert even == pytest.approx([S * 7.0 / 56**2], rel=1e-9)
    assert uneven == pytest.approx([S * 1e-4 * (8 / 7) ** 2], rel=1e-9)
    # on the finest grid both fall to a quarter of their values at N
    finer = stated(THIRD, values, at=2)
    assert finer[0] == pytest.approx(even / 4.0, rel=1e-9)
    assert finer[1] == pytest.approx(uneven / 4.0, rel=1e-9)


def test_where_the_error_changes_its_sign_the_stage_states_its_largest():
    # C of 3, 0 and −5 at three stations of one stage, and of 1 in another stage
    rows = [("push", 3.0), ("push", 0.0), ("push", -5.0), ("twist", 1.0)]
    found = largest((stage, float(stated(THIRD, powers(2.0, THIRD, factor=C))[0][0])) for stage, C in rows)
    assert found["push"] == pytest.approx(S * 5.0 / 56**2, rel=1e-9)
    assert found["twist"] == pytest.approx(S * 1.0 / 56**2, rel=1e-9)


def test_a_constant_and_round_off_show_no_order_and_no_more_error_than_their_own():
    assert stated(THIRD, [0.2, 0.2, 0.2]) == (0.0, 0.0)
    found = limit(DOUBLED, np.zeros(6))
    assert (found.value[0], found.uncertainty[0], found.order) == (0.0, 0.0, None)
    values = 3.0 + 1e-15 * np.array([1.0, -1.0, 0.0, 1.0, -1.0, 0.0])
    found = limit(DOUBLED, values, 2.0, floor=1e-14)
    assert found.order is None
    assert found.why == "the change is round-off"
    assert found.value == pytest.approx([3.0], abs=1e-14)
    assert 1e-14 <= found.uncertainty[0] <= 2e-14


def test_two_grids_state_the_index_of_order_two_or_of_a_known_first_order():
    # (v − V)/(1 − 1/4) = 0.4; the limit is 0.9; of order 1 it is V + (V − v) = 0.7, 0.2 away, and the correction is 0.1
    even, uneven = stated((20, 40), [1.3, 1.0], order=4.0)
    assert even == pytest.approx([S * 0.4])
    assert uneven == pytest.approx([0.0], abs=1e-15)
    found = limit((20, 40), np.array([1.3, 1.0]), 4.0)
    assert found.value == pytest.approx([0.9])
    assert found.uncertainty == pytest.approx([S * 0.2])
    assert (found.order, found.assumed, found.why) == (None, 2.0, "two sizes show no order")
    # as a penalty's error with the penetration: L = V + (V − v)/3 of sizes 4 and 16
    found = limit((4, 16), np.array([1.3, 1.0]), 1.0)
    assert found.value == pytest.approx([0.9])
    assert found.uncertainty == pytest.approx([S * 0.1])
    # two sizes: from the limit by 7/N², and the limit is uncertain by S times 2/3 of the change
    values = powers(2.0, (10, 20))
    found = limit((10, 20), values)
    own = S * 2 / 3 * 7.0 * (1 / 100 - 1 / 400)
    assert np.abs(values - found.value) + found.uncertainty == pytest.approx(7.0 / np.array([100.0, 400.0]) + own)


@pytest.mark.parametrize(
    ("sizes", "order"), [(DOUBLED, 1.0), (DOUBLED, 2.0), (DOUBLED, 4.0), ((10, 15, 30, 100), 2.0), ((40, 46, 80), 2.0)]
)
def test_a_pure_power_is_extrapolated_to_its_limit(sizes, order):
    found = limit(sizes, powers(order, sizes), order)
    assert found.value == pytest.approx([3.0], rel=1e-13)
    assert found.uncertainty[0] < 1e-12
    assert found.order == pytest.approx(order, abs=1e-3)
    assert found.why == ""
    assert orders(sizes, powers(order, sizes)) == pytest.approx([order] * (len(sizes) - 2), abs=1e-3)


@pytest.mark.parametrize("order", [1.6, 2.0, 3.0, 4.0])
def test_the_uncertainty_of_a_limit_is_made_for_the_first_order(order):
    # on grids that double, values C N^−q with a = 2^−q are beyond the law of order p, b = 2^−p, at N/2 by
    # d = (b − a)(1 − a)/(ab) of their error at N, and the limit is off by (a − b)/(1 − b) of it: b/(1 − b) d for q = 1
    found = limit((20, 40, 80), powers(order, (20, 40, 80), factor=40.0**order), 2.0)
    a, b = 2.0**-order, 0.25
    d = abs(b - a) * (1 - a) / (a * b)
    assert abs(found.value[0] - 3.0) == pytest.approx(abs(a - b) / (1 - b), abs=1e-12)
    assert found.uncertainty[0] == pytest.approx(S * b / (1 - b) * d, abs=1e-12)


@given(
    order=st.floats(1.0, 5.0),
    own=st.sampled_from([1.0, 2.0, 4.0]),
    sizes=st.sampled_from([DOUBLED, (20, 40, 80), (10, 15, 30), (40, 46, 80), (10, 20, 30, 40)]),
)
def test_the_limit_is_as_near_as_stated_whatever_the_order(order, own, sizes):
    found = limit(sizes, powers(order, sizes), own)
    assert abs(found.value[0] - 3.0) <= found.uncertainty[0] + 1e-14


@given(order=st.floats(1.0, 5.0), own=st.sampled_from([2.0, 4.0]))
def test_a_value_is_as_near_as_stated_whatever_the_order(order, own):
    even, uneven = stated(THIRD, powers(order, THIRD), order=own)
    assert 7.0 / 56**order <= (even + uneven)[0] + 1e-14


@pytest.mark.parametrize(("order", "assumed"), [(4.5, 2.0), (4.3, 4.0), (3.7, 4.0), (3.5, 2.0), (1.0, 1.0)])
def test_a_high_order_is_assumed_only_where_the_values_bear_it_out(order, assumed):
    assert limit(DOUBLED, powers(order), 4.0).assumed == assumed


@pytest.mark.parametrize("next_", [-50.0, -5.0, 5.0, 50.0])
def test_a_term_of_higher_order_lies_within_the_uncertainty_and_does_not_drown_in_it(next_):
    found = limit(DOUBLED, powers(2.0, next_=next_))
    apart = abs(found.value[0] - 3.0)
    assert apart <= found.uncertainty[0] <= 20.0 * apart
    assert found.order == pytest.approx(2.0, abs=0.1)


def test_an_uneven_error_lies_within_the_uncertainty_nearly_always():
    # the factor of the error varies by up to a half from size to size, as with a contact between joints
    random = np.random.default_rng(1)
    n = np.array(DOUBLED, dtype=float)
    met = 0
    for _ in range(400):
        found = limit(DOUBLED, 3.0 + 7.0 * random.uniform(0.5, 1.5, n.size) / n**2)
        met += abs(found.value[0] - 3.0) <= found.uncertainty[0]
    assert met >= 380


@pytest.mark.parametrize(
    ("values", "why", "assumed"),
    [
        ([1.0, 2.0, 1.5], "the change turns back", 1.0),
        ([1.0, 2.0, 1.8], "the change turns back", 2.0),
        ([1.0, 2.0, 3.0], "the change does not fall", 1.0),
        ([1.0, 2.0, 4.0], "the change does not fall", 1.0),
        ([1.0, 2.0, 2.0 + 1e-6], "the change falls faster than any order", 2.0),
    ],
)
def test_the_reason_of_a_missing_order(values, why, assumed):
    assert observed((10, 20, 40), np.array(values)) == (None, why)
    assert limit((10, 20, 40), np.array(values), 4.0).assumed == assumed


@pytest.mark.parametrize(("last", "order"), [(1.5, 1.0), (1.8, 2.0)])
def test_a_sequence_that_turns_back_keeps_its_last_step_as_uncertainty(last, order):
    # the changes 1 and 1/2 fall with order 1, the changes 1 and 1/5 with order 2.3.  With b = 2^−p the law has
    # E = (2 − last)/(1 − b) at 20 and E/b at 10, where the value is beyond it by d.  An uneven error moves the limit by
    # 2b²/(1 − b) d, values of order 1 (beside p = 1 of 3/4) by a b/((1 − a)(1 − b)) d
    found = limit((10, 20, 40), np.array([1.0, 2.0, last]))
    a, b = 2.0 ** -min(1.0, 0.75 * order), 2.0**-order
    coarse = (2.0 - last) / (1.0 - b)
    d = abs(1.0 - (2.0 - coarse) - coarse / b)
    assert found.value == pytest.approx([2.0 - coarse])
    assert found.uncertainty == pytest.approx([S * d * max(2 * b * b / (1 - b), a * b / ((1 - a) * (1 - b)))])
    assert found.uncertainty[0] >= 2.0 - last


def test_a_vector_converges_as_one():
    # the second component passes through its limit, and alone shows no order
    n = np.array((10.0, 20.0, 40.0))
    values = np.column_stack([1.0 + 5.0 / n**2, 2.0 + 1e-4 * np.array([1.0, -1.0, 0.5])])
    together = limit((10, 20, 40), values)
    assert together.order == pytest.approx(2.0, abs=0.01)
    assert together.value.shape == together.uncertainty.shape == (2,)
    assert limit((10, 20, 40), values[:, 1]).order is None


@pytest.mark.parametrize(
    ("sizes", "values", "order"),
    [
        ((10,), [1.0], 2.0),
        ((20, 10), [1.0, 2.0], 2.0),
        ((10, 20), [1.0, math.nan], 2.0),
        ((10, 20), [1.0], 2.0),
    ],
)
def test_wrong_sizes_and_values_are_refused(sizes, values, order):
    with pytest.raises(ValueError, match=r"sizes|values"):
        limit(sizes, np.array(values), order)
    with pytest.raises(ValueError, match=r"sizes|values"):
        error(sizes, np.reshape(values, (-1, 1)), 0, order)
