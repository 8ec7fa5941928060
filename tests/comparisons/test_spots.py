"""Which places of a stress are compared, at places worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons.choices import Choices
from comparisons.geometry import nearest, nearest_of_two_laps
from comparisons.verdict.point_forces import away_from_point_forces, zone_ends
from cprbm_scene import Scene, Shape, StationAnswer
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.comparisons.made_up import MadeUp

LENGTH = math.pi * 0.025
S = np.linspace(0.0, LENGTH, 801)
THICKNESS = 0.002


def touched(hinge: Scene, *fractions: float) -> StationAnswer:
    """An answer whose contact touches at these fractions of the first beam, which it draws in 40 steps."""
    station = MadeUp("cprbm", 0.0, contact=False)(hinge, Choices()).stations[-1]
    shape = station.shapes["beam1"]
    s = LENGTH * np.array(fractions)
    places = np.stack([np.interp(s, shape.s, shape.x), np.interp(s, shape.s, shape.y)], axis=1)
    return replace(station, touching=frozendict({"contact": frozen_array(places)}))


def compared_at(hinge: Scene, *stations: StationAnswer) -> np.ndarray:
    return clear_of_spots(hinge, "beam1", S, stations)


def away_from(*places: float) -> np.ndarray:
    """The definition once more: a thickness from both clamps and from these places."""
    return np.all([np.abs(S - place) >= THICKNESS for place in (0.0, LENGTH, *places)], axis=0)


def test_a_point_is_a_spot(hinge):
    np.testing.assert_array_equal(compared_at(hinge, touched(hinge, 0.4)), away_from(0.4 * LENGTH))


def test_of_a_zone_only_the_ends_are_spots(hinge):
    zone = touched(hinge, *np.linspace(0.2, 0.7, 31))
    expected = away_from(0.2 * LENGTH, 0.7 * LENGTH)
    np.testing.assert_array_equal(compared_at(hinge, zone), expected)
    assert expected.sum() > 0.8 * S.size


def test_two_points_far_from_each_other_are_two_spots_with_nothing_left_out_between(hinge):
    found = compared_at(hinge, touched(hinge, 0.3, 0.6))
    np.testing.assert_array_equal(found, away_from(0.3 * LENGTH, 0.6 * LENGTH))


def test_two_zones_have_four_ends(hinge):
    two = touched(hinge, *np.linspace(0.1, 0.3, 15), *np.linspace(0.6, 0.8, 15))
    np.testing.assert_array_equal(compared_at(hinge, two), away_from(*(LENGTH * np.array([0.1, 0.3, 0.6, 0.8]))))


def test_joints_that_do_not_press_leave_no_hole_in_a_zone_that_another_answer_has(hinge):
    sparse, dense = touched(hinge, 0.21, 0.25, 0.5, 0.68), touched(hinge, *np.linspace(0.2, 0.7, 101))
    expected = away_from(*(LENGTH * np.array([0.2, 0.21, 0.68, 0.7])))
    np.testing.assert_array_equal(compared_at(hinge, sparse, dense), expected)
    alone = away_from(*(LENGTH * np.array([0.21, 0.25, 0.5, 0.68])))
    np.testing.assert_array_equal(compared_at(hinge, sparse), alone)


def test_the_same_point_in_several_answers_is_a_spot_in_each(hinge):
    stations = [touched(hinge, place) for place in (0.48, 0.49, 0.5, 0.52)]
    expected = away_from(*(LENGTH * np.array([0.48, 0.49, 0.5, 0.52])))
    np.testing.assert_array_equal(compared_at(hinge, *stations), expected)


def test_an_open_contact_leaves_the_clamps(hinge):
    np.testing.assert_array_equal(compared_at(hinge, touched(hinge)), away_from())


@pytest.mark.parametrize(
    ("places", "apart", "expected"),
    [
        ([[]], 1.0, []),
        ([[3.0]], 1.0, [3.0, 3.0]),
        ([[3.0, 1.0, 2.0]], 1.0, [1.0, 3.0]),
        ([[1.0, 2.0, 4.0]], 1.5, [1.0, 2.0, 4.0, 4.0]),
        ([[1.0, 4.0], [2.0, 3.0]], 1.0, [1.0, 4.0, 2.0, 3.0]),
        ([[1.0, 9.0], [], [2.0]], 1.0, [1.0, 1.0, 9.0, 9.0, 2.0, 2.0]),
    ],
)
def test_ends_of_zones(places, apart, expected):
    assert ends_of_zones([np.array(own) for own in places], apart) == expected


def test_a_beam_that_touches_itself_does_so_at_two_places():
    """Between two strands of a hairpin, a polyline: the two nearest places are straight across, 3 and 17 along it."""
    shape = Shape(
        s=np.array([0.0, 5.0, 10.0, 15.0, 20.0]),
        x=np.array([0.0, 5.0, 7.0, 5.0, 0.0]),
        y=np.array([0.0, 0.0, 0.5, 1.0, 1.0]),
    )
    (places,) = nearest_of_two_laps(shape, np.array([[3.0, 0.4]]))
    assert places == pytest.approx([3.0, 17.0])
    assert nearest(shape, np.array([[3.0, 0.4]])) == pytest.approx([3.0])
    assert nearest_of_two_laps(shape, np.empty((0, 2))).shape == (0, 2)
    # where the polyline is bent, the nearest places of both sides of a node are one lap's
    (places,) = nearest_of_two_laps(shape, np.array([[5.0, 0.4]]))
    assert places == pytest.approx([5.0 + 5.0 * 0.8 / 17.0, 10.0 + 5.0 * 15.8 / 17.0])
