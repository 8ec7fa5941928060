"""Where a gap is negative, against the roots of the polynomial that it is."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from fea_reference.hermite import NeutralLine
from fea_reference.zones import Gap, Survey, negative, survey_pair


def gap_of(f):
    """A polynomial as a gap that is known everywhere."""
    slope, bend = f.deriv(), f.deriv(2)

    def at(zeta, guess):
        return Gap(f(zeta), slope(zeta), bend(zeta), guess, np.ones(len(zeta), dtype=bool))

    return at


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("depth", [0.031, 0.0007, 1.3e-7])
def test_a_zone_between_two_places_with_slopes_of_one_sign_is_found(turned, depth):
    # the slope rises, falls and rises again: the least value is at the second of its roots
    slope = 5.7 * Polynomial.fromroots([0.13, 0.71])
    gap = slope.integ()
    gap = gap - gap(0.71) - depth
    low, high = (float(root.real) for root in np.sort(gap.roots())[-2:])
    if turned:
        gap, low, high = gap(Polynomial([1.0, -1.0])), 1.0 - high, 1.0 - low
    at, places = gap_of(gap), np.array([0.0, 1.0])
    zones = negative(at, places, at(places, np.zeros(2)), np.array([True]))
    assert zones.least == pytest.approx(-depth, rel=1e-9)
    assert zones.intervals == pytest.approx(np.array([[low, high]]), abs=1e-7)


@pytest.mark.parametrize("width", [0.11, 3e-3, 2e-5, 7e-8])
def test_a_zone_is_as_narrow_as_it_is_and_found_at_once(width):
    # g = (ζ − c)² − w² between two places that are a quarter apart: its ends are c ± w
    centre, asked = 0.1371, []
    gap = Polynomial([centre**2 - width**2, -2.0 * centre, 1.0])
    at, places = gap_of(gap), np.array([0.0, 0.25])

    def counted(zeta, guess):
        asked.append(zeta.size)
        return at(zeta, guess)

    zones = negative(counted, places, at(places, np.zeros(2)), np.array([True]))
    assert zones.least == pytest.approx(-(width**2), rel=1e-6, abs=3e-18)
    assert np.concatenate([zones.intervals[0, :1], zones.intervals[-1, 1:]]) == pytest.approx(
        [centre - width, centre + width], abs=1e-3 * width
    )
    assert len(asked) < 9


@pytest.mark.parametrize("width", [0.11, 3e-3])
def test_ends_of_a_zone_are_found_by_what_the_gap_bends_by(width):
    # g = ((ζ − c)² − w²)(1 + ζ), whose third derivative leaves parabolas off: two looks at both ends are enough
    centre, asked = 0.1371, []
    gap = Polynomial([centre**2 - width**2, -2.0 * centre, 1.0]) * Polynomial([1.0, 1.0])
    at, places = gap_of(gap), np.array([0.0, centre, 0.25])

    def counted(zeta, guess):
        asked.append(zeta.size)
        return at(zeta, guess)

    there = at(places, np.zeros(3))
    seen_so_far = Survey(counted, places, there, np.array([True, True]), (), float(there.g.min()))
    intervals = seen_so_far.below(0.0).intervals
    assert [intervals[0, 0], intervals[-1, 1]] == pytest.approx([centre - width, centre + width], abs=1e-13)
    assert len(asked) <= 2


def test_a_zone_that_a_largest_value_parts_is_two():
    # g = w² − (ζ − c)²: both places are below zero, and what is between c − w and c + w is not
    centre, width = 0.1371, 0.043
    gap = Polynomial([width**2 - centre**2, 2.0 * centre, -1.0])
    at, places = gap_of(gap), np.array([0.0, 0.25])
    zones = negative(at, places, at(places, np.zeros(2)), np.array([True]))
    expected = np.array([[0.0, centre - width], [centre + width, 0.25]])
    assert zones.intervals == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_gap_is_seen_as_far_as_the_other_beam_reaches(sense):
    # two level straight lines, of which the second begins later and ends earlier: the gap is their distance there
    def level(begin, end, y, n):
        s = np.linspace(begin, end, n + 1)[:: int(sense)]
        along, none = np.full(n + 1, 0.0 if sense > 0.0 else np.pi), np.zeros(n)
        return NeutralLine.through(
            np.stack([s, np.full(n + 1, y)]), along, none + (end - begin) / n, np.zeros((2, n + 1)), none, none
        )

    first, second = level(0.0, 2.0, 0.3, 12), level(0.53, 1.63, 0.0, 7)
    found = survey_pair(first, second, sense, 0.01)
    assert found.least == pytest.approx(0.29, rel=1e-14)
    ends = found.zeta[[0, -1]] * 2.0 / 12
    assert (ends if sense > 0.0 else 2.0 - ends[::-1]) == pytest.approx([0.53, 1.63], rel=1e-12)
    assert found.there.g == pytest.approx(np.full(found.zeta.size, 0.29), rel=1e-12)
