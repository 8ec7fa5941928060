"""How deeply beams overlap, against a search of all of them."""

import numpy as np
import pytest

import cprbm
from cprbm.feet import distance_along
from cprbm.kinematics import State, positions, rest_state
from cprbm.mechanism import mechanism_of
from cprbm.overlap import may_be_beyond, never_beyond, overlap
from tests.cprbm.test_nearest import beams, line

THICKNESS = 2e-3


def bent(apart, wave):
    """Two straight beams 100 mm long, ``apart`` on average, the first in waves: pair, state, positions."""
    scene = beams(line([0.0, apart], [0.1, apart]), line([0.0, 0.0], [0.1, 0.0]), THICKNESS)
    mechanism = mechanism_of(scene, cprbm.Settings(links={"A": 40, "B": 43}))
    pair, state = mechanism.pairs["c"], rest_state(mechanism.problem.model)
    theta = state.theta.copy()
    theta[pair.a.links] += wave * np.sin(9.0 * pair.a.borders + 0.4)
    theta[pair.b.links] += 0.3 * wave * np.sin(4.0 * pair.b.borders)
    state = State(theta, state.bodies)
    return pair, state, positions(mechanism.problem.model, state)


def searched(pair, state, at):
    """The same by twenty thousand places, and the other's ends."""
    lines = pair.lines(state, at)
    D, _, foot = distance_along(pair, lines, np.linspace(0.0, pair.a.s[-1], 20_001))
    return max(0.0, pair.offset - float(D[foot].min()))


@pytest.mark.parametrize("apart", [0.0025, 0.004, 0.006, 0.0085, 0.02])
@pytest.mark.parametrize("wave", [0.05, 0.2, -0.2])
def test_the_largest_overlap_of_two_beams(apart, wave):
    pair, state, at = bent(apart, wave)
    assert overlap(pair, state, at) == pytest.approx(searched(pair, state, at), rel=1e-3, abs=1e-9)


def test_beams_of_which_one_went_through_the_other():
    pair, state, at = bent(0.004, -0.5)
    assert overlap(pair, state, at) > 3.0 * pair.thickness
    assert overlap(pair, state, at) == pytest.approx(searched(pair, state, at), rel=1e-3)


@pytest.mark.parametrize("wave", [0.05, -0.05, 0.5, -0.5, 1.5])
def test_springs_never_deny_that_a_beam_is_beyond(wave):
    pair, state, at = bent(0.004, wave)
    assert may_be_beyond(pair, state, at) >= pair.gone_round(state, at)


@pytest.mark.parametrize("allowed", [0.003, 0.01, 0.03, 0.1])
@pytest.mark.parametrize("wave", [0.05, -0.05, 0.3, -0.3, -0.5, 1.5])
def test_joints_never_deny_that_a_joint_is_beyond(wave, allowed):
    pair, state, at = bent(0.004, wave)
    D, _, foot = distance_along(pair, pair.lines(state, at), pair.a.s)
    if never_beyond(pair, [(state, at)], allowed):
        assert np.all(D[foot] >= -allowed)


def test_joints_tell_that_none_is_beyond():
    pair, state, at = bent(0.004, 0.2)
    assert never_beyond(pair, [(state, at)], 0.01)
    # from a fifth of a radian on the waves reach the other beam, and go through it
    beyond = bent(0.004, -0.5)
    assert not never_beyond(*beyond[:1], [beyond[1:]], 0.01)
    assert not never_beyond(pair, [(state, at), beyond[1:]], 0.01)


@pytest.mark.parametrize("end", [0.0304, 0.0337, 0.0372, 0.0425, 0.0456, 0.0531])
def test_a_tip_that_stands_out_between_two_springs_is_seen(end):
    # a few long elements 4 mm above many short ones, of which the last seventh has turned up by 0.9 rad
    scene = beams(line([0.0, 0.004], [0.1, 0.004]), line([-0.033, 0.0], [end, 0.0]), 0.5 * THICKNESS)
    mechanism = mechanism_of(scene, cprbm.Settings(links={"A": 4, "B": 67}))
    model, pair = mechanism.problem.model, mechanism.pairs["c"]
    state = rest_state(model)
    theta = state.theta.copy()
    theta[pair.b.links] += 0.9 * np.clip((pair.b.borders / pair.b.borders[-1] - 0.85) / 0.03, 0.0, 1.0)
    state = State(theta, state.bodies)
    at = positions(model, state)
    assert at.y[pair.b.joints][-1] * model.unit_length > 0.0065
    assert may_be_beyond(pair, state, at)
