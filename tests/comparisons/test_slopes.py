"""Derivatives from stations: beside functions whose derivative is known."""

import numpy as np
import pytest

from comparisons.slopes import FEWEST, MOST, slope

STATIONS = np.array([0.0, 0.1, 0.17, 0.3, 0.41, 0.5, 0.58, 0.7, 0.81, 0.93, 1.0, 1.1, 1.2])


@pytest.mark.parametrize("count", range(FEWEST, MOST + 1))
def test_a_polynomial_through_all_stations_is_exact(count):
    x = STATIONS[:count]
    powers = np.arange(count)
    f = np.sum(x[:, None] ** powers / (1.0 + powers), axis=1)
    for place in range(count):
        exact = np.sum(powers[1:] * x[place] ** (powers[1:] - 1) / (1.0 + powers[1:]))
        assert slope(x, f, np.zeros(count), place).value == pytest.approx(exact, rel=1e-10)


def test_what_two_orders_are_apart_is_more_than_the_value_is_off():
    for place, x in enumerate(STATIONS):
        found = slope(STATIONS, np.exp(STATIONS), np.zeros(13), place)
        off = abs(found.value - np.exp(x))
        assert off < 1e-7
        assert off < found.truncation < 1e-4


def test_round_off_is_what_the_worst_signs_make_of_it():
    """The five weights are 1/12, −8/12, 0, 8/12, −1/12 over h."""
    x, h = np.arange(5) * 0.25, 0.25
    assert slope(x, x, np.full(5, 1e-3), 2).round_off == pytest.approx(1e-3 * 1.5 / h, rel=1e-12)


def test_a_kink_shows_in_two_orders():
    x = np.arange(-10.0, 11.0) + 0.3
    found = [slope(x, np.abs(x) * x / 2.0, np.zeros(21), place) for place in range(21)]
    assert max(each.truncation for each in found[8:13]) > 1e-2
    assert all(each.truncation < 1e-12 for each in (found[5], found[16]))  # nothing of it within four stations


def test_too_few_tell_nothing():
    assert slope(STATIONS[: FEWEST - 1], STATIONS[: FEWEST - 1], np.zeros(FEWEST - 1), 1) is None
