"""ΣF and ΣM of a state, and what of the closures is given, by what statics says of them."""

from dataclasses import replace

import numpy as np
import pytest

import cprbm
from cprbm.closure import closure_values
from cprbm.first_contact import NO_ROWS
from cprbm.first_equilibrium import equilibrium, measure
from cprbm.forces import balances
from cprbm.kinematics import rest_state
from cprbm.mechanism import mechanism_of
from cprbm.point import point_at
from cprbm_scene import scene_from
from tests.cprbm.driven import TURN, UNIT_FORCE, driven_cantilever, push
from tests.cprbm.scenes import LENGTH, RIGIDITY, cantilever, cantilever_data, force

SETTINGS = cprbm.Settings(links=7)


def solved(scene, values):
    problem = mechanism_of(scene, SETTINGS).problem
    rest = point_at(problem, {}, rest_state(problem.model), np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    found = equilibrium(problem, values, rest, SETTINGS.tolerance, SETTINGS.iterations)
    assert found.converged
    return problem, found.point


@pytest.mark.parametrize("share", [1.3e-3, 2.7e-6])
def test_a_force_that_is_missing_is_measured_by_the_largest(share):
    # a straight column below its buckling load, along x through the origin: statics leaves the force alone, no moment
    problem, point = solved(cantilever(force(-1.0, 0.0), [1.0]), {"P": 0.83 * UNIT_FORCE})
    assert max(balances(problem, point)) < 1e-12
    mu = point.mu.copy()
    mu[0] *= 1.0 - share  # what the beam does to the body along x
    missing, moment = balances(problem, replace(point, mu=mu))
    assert missing == pytest.approx(share, rel=1e-9)
    assert moment < 1e-12


def two_in_a_row():
    """A cantilever that ends on a free body, on which another begins that ends free, and bears a load."""
    data = cantilever_data(
        {"kind": "distributed", "beam": "further", "direction": [0.3, -1.0], "along": [0.137, 0.831]}, [1.0]
    )
    beam = data["beams"]["beam"]
    curve = {"kind": "line", "start": [LENGTH, 0.0], "end": [1.7 * LENGTH, 0.31 * LENGTH]}
    start = {"joint": "weld", "point": "T"}
    data["beams"]["further"] = {**beam, "curve": curve, "start": start, "end": {"joint": "free"}}
    return scene_from(data)


def test_a_load_on_a_beam_that_begins_on_a_body_is_carried_to_the_ground():
    load = 1.7 * RIGIDITY / LENGTH**3
    problem, point = solved(two_in_a_row(), {"P": load})
    assert max(balances(problem, point)) < 1e-10


def test_what_round_off_leaves_in_multipliers_is_no_load():
    # two straight beams in one line, joined by a body: statics lets them pull each other by any force.  By as little as
    # round-off of 80 springs leaves open they may also pull unlike
    data = cantilever_data(force(0.0, 1.0), [1.0])
    data["bodies"]["wall"]["points"]["F"] = [2.0 * LENGTH, 0.0]
    curve = {"kind": "line", "start": [2.0 * LENGTH, 0.0], "end": [LENGTH, 0.0]}
    data["beams"]["further"] = {**data["beams"]["beam"], "curve": curve, "start": {"joint": "weld", "point": "F"}}
    problem = mechanism_of(scene_from(data), cprbm.Settings(links=80)).problem
    mu = np.zeros(problem.closure.rows)
    mu[[0, 2]] = 1.3e-12, -0.97 * 1.3e-12
    rest = point_at(problem, {}, rest_state(problem.model), mu, np.zeros(0), NO_ROWS)
    left = measure(problem, rest)
    assert left.residual <= left.floor
    assert max(balances(problem, rest)) <= left.floor


def test_what_is_given_is_what_the_closures_are_less():
    # a displacement in m over the longest beam, along its direction; an angle as it is; how far an end is apart, in m
    scene = driven_cantilever(
        {"d": push(0.0, 7.0), "turn": TURN},
        [{"name": "one", "steps": "d", "stations": [1e-3]}, {"name": "two", "steps": "turn", "stations": [0.1]}],
    )
    problem = mechanism_of(scene, SETTINGS).problem
    model, closure = problem.model, problem.closure
    point = point_at(problem, {}, rest_state(model), np.zeros(closure.rows), np.zeros(0), NO_ROWS)
    given = {"d": 0.0137, "turn": 0.31, "beam.apart.x": 0.0017, "beam.apart.y": -0.0023}
    less = closure_values(model, closure, point.state, point.at, given)
    less -= closure_values(model, closure, point.state, point.at, {})
    told = np.zeros(closure.rows)
    told[:2] = np.array([-0.0017, 0.0023]) / LENGTH
    told[closure.first_hold : closure.first_hold + 2] = -0.0137 / LENGTH, -0.31
    assert less == pytest.approx(told, rel=1e-12)


def test_what_is_fixed_does_not_turn():
    data = cantilever_data(force(0.0, 1.0), [0.7 * UNIT_FORCE])
    data["probes"] = [{"of": "wall", "quantity": "rotation"}, {"of": "R", "quantity": "displacement"}]
    (station,) = cprbm.answer(scene_from(data), SETTINGS).stations
    assert station.values["wall.rotation"] == pytest.approx([0.0], abs=0.0)
    assert station.values["R.displacement"] == pytest.approx([0.0, 0.0], abs=0.0)
