"""Places that a beam goes through in one step."""

import numpy as np
import pytest

import cprbm
from cprbm.kinematics import State, positions, rest_state
from cprbm.mechanism import mechanism_of
from cprbm.smooth import smooth_line
from cprbm.sweeping import swath, swept
from tests.cprbm.test_tiny_bodies import beam_onto
from tests.references.pressed import Pressed


def seen(angle, bend, places, turn=0.0, origin=(0.0, 0.0)):
    """A beam that leaves the origin at some angle, bent evenly, as places see it; and where it ends."""
    model = mechanism_of(beam_onto({}, Pressed(force=1.0), thick=False), cprbm.Settings(links=7)).problem.model
    chain = model.chains[0]
    state = State(angle + bend * np.linspace(0.0, 1.0, model.n_links), rest_state(model).bodies)
    at = positions(model, state)
    line = smooth_line(chain, model.unit_length, state, at)
    beam = swath(line, np.array(places), np.array(origin), turn)
    return beam, beam.course[[0, -1]]


def gone_through(before, after, places, ahead=None, **frame):
    """What a beam goes through, its end straight from one state to the other (k,)."""
    (one, first), (other, last) = (seen(*state, places, **frame) for state in (before, after))
    share = np.linspace(0.0, 1.0, 9)[:, None]
    ends = first[:, None] + share * (last - first)[:, None]
    return swept(one, other, ends, np.array(places), ahead).tolist()


PLACES = [(0.333, -0.05), (0.333, 0.05), (0.95, -0.05), (1.02, -0.05), (-0.01, 0.0)]


@pytest.mark.parametrize("bend", [0.0, 0.3, -0.2])
def test_a_beam_goes_through_what_lies_between_its_two_places(bend):
    # clamped at the origin and straight at first, then turned by a quarter of a radian downwards
    assert gone_through((0.0, 0.0), (-0.25 - 0.5 * bend, bend), PLACES[1:2] + PLACES[3:]) == [False] * 3
    assert gone_through((0.0, 0.0), (-0.25, -abs(bend)), PLACES) == [True, False, True, False, False]
    assert gone_through((-0.25, -abs(bend)), (0.0, 0.0), PLACES) == [True, False, True, False, False]


def test_a_beam_that_rests_on_a_place_is_in_front_of_it():
    on_it, ahead = [(0.4, 0.0)], np.array([[0.1, 1.0]])
    assert gone_through((0.0, 0.0), (-0.1, 0.0), on_it, ahead) == [True]
    assert gone_through((0.0, 0.0), (0.1, 0.0), on_it, ahead) == [False]
    assert gone_through((0.0, 0.0), (0.1, 0.0), on_it, -ahead) == [True]
    assert gone_through((0.1, 0.0), (0.0, 0.0), on_it, ahead) == [False]


def test_it_is_the_same_from_a_body_that_is_elsewhere_and_turned():
    frame = {"turn": 0.7, "origin": (0.3, -0.4)}
    cos, sin = np.cos(0.7), np.sin(0.7)
    inwards = (np.array(PLACES) - (0.3, -0.4)) @ np.array([[cos, -sin], [sin, cos]])
    assert gone_through((0.0, 0.0), (-0.25, -0.1), inwards.tolist(), **frame) == [True, False, True, False, False]


def over_the_centre(frames):
    """Whether a straight beam sweeps over what is at the origin of frames: of each the origin and how it is turned."""
    centre = [(0.0, 0.0)]
    seen_from = [seen(0.0, 0.0, centre, turn, origin) for origin, turn in frames]
    ends = np.stack([end for _, end in seen_from], axis=1)
    return swept(seen_from[0][0], seen_from[-1][0], ends, np.array(centre), None).tolist() == [True]


@pytest.mark.parametrize("place", [0.03, 0.31, 0.48, 0.97])
@pytest.mark.parametrize("angle", [-2.9, -1.7, 0.3, 1.9, 3.05])
def test_a_beam_that_turns_about_the_centre_does_not_sweep_over_it(place, angle):
    # reference: all its places stay as far from the centre as they are
    assert not over_the_centre([((place, -0.057), share * angle) for share in np.linspace(0.0, 1.0, 9)])


@pytest.mark.parametrize(("place", "sweeps"), [(-0.13, False), (0.03, True), (0.48, True), (0.97, True), (1.09, False)])
def test_a_beam_that_is_shifted_across_sweeps_over_what_is_between_its_ends(place, sweeps):
    way = [((place, y), 0.0) for y in np.linspace(-0.057, 0.043, 9)]
    assert over_the_centre(way) is sweeps
    assert over_the_centre(way[::-1]) is sweeps
