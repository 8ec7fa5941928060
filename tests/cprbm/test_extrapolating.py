"""Solves that begin where the branch leads end where solves from rest end."""

import numpy as np
import pytest

import cprbm
from cprbm import Settings
from cprbm.extrapolating import continued
from cprbm.march import March
from cprbm_scene import scene_from
from tests.cprbm.scenes import cantilever_data, force, hinge

STATIONS = [0.1 * k for k in range(1, 13)]


def test_what_does_not_turn_stays_at_rest_and_the_last_station_is_that_of_a_cold_start():
    # reference: the same load in one step from rest
    data = cantilever_data(force(-0.3, 1.0), STATIONS)
    march = March(scene_from(data), (Settings(links=20),))
    march.run()
    assert march.on.point.state.theta[0] == march.on.mechanism.problem.model.rest[0]
    cold = cprbm.answer(scene_from({**data, "stages": [{**data["stages"][0], "stations": STATIONS[-1:]}]}))
    warm = cprbm.answer(scene_from(data))
    for name, value in cold.stations[-1].values.items():
        assert warm.stations[-1].values[name] == pytest.approx(value, rel=1e-9, abs=1e-9 * np.max(np.abs(value)))


def test_contact_that_travels_is_the_same_from_many_stations_and_from_one():
    # reference: the hinge's full moment in one step from rest
    many = [{"name": "load", "steps": "M", "stations": [0.67 * k / 20 for k in range(1, 21)]}]
    one = [{"name": "load", "steps": "M", "stations": [0.67]}]
    warm, cold = (cprbm.answer(hinge(stages=stages), Settings(links=20)).stations[-1] for stages in (many, one))
    for name, value in cold.values.items():
        assert warm.values[name] == pytest.approx(value, rel=1e-7, abs=1e-7 * np.max(np.abs(value), initial=0.0))


def test_the_guess_is_far_nearer_than_the_last_state():
    march = March(scene_from(cantilever_data(force(0.0, 1.0), STATIONS)), (Settings(links=20),))
    march.run()
    trail = [(one.value, one.point) for one in march.on.trail]
    problem = march.on.mechanism.problem
    guess = continued(problem, {"P": trail[-1][0]}, trail[:-1], trail[-1][0])
    here, before = trail[-1][1].state.theta, trail[-2][1].state.theta
    assert np.max(np.abs(guess.state.theta - here)) < 1e-3 * np.max(np.abs(before - here))
    assert continued(problem, {"P": 9.0}, trail, 9.0) is None  # farther than the states are from each other
    assert continued(problem, {"P": 1.3}, trail[-2:], 1.3) is None  # too few


def test_states_close_to_each_other_are_one_and_between_states_the_guess_is_nearest():
    # reference: the state that is left out
    close = [value * (1.0 + part) for value in STATIONS for part in (-2e-3, 2e-3)]
    march = March(scene_from(cantilever_data(force(0.0, 1.0), close)), (Settings(links=20),))
    march.run()
    trail = [(one.value, one.point) for one in march.on.trail]
    problem = march.on.mechanism.problem

    def off(known, of):
        value, point = of
        guess = continued(problem, {"P": value}, known, value)
        return np.max(np.abs(guess.state.theta - point.state.theta))

    before, last = trail[-3][1].state.theta, trail[-1][1].state.theta
    far = np.max(np.abs(last - before))
    assert off(trail[:-2], trail[-2]) < 1e-2 * far  # of the last pairs one each
    assert off(trail[:-1], trail[-1]) < 1e-4 * far  # its neighbour is known
    assert off([*trail[:-3], trail[-2], trail[-1]], trail[-3]) < 1e-4 * far
