"""Newton's step where only a contact keeps the energy convex: still Newton's, it squares the distance."""

from dataclasses import replace

import numpy as np
import pytest

import cprbm
from cprbm.energy import spring_moments
from cprbm.first_contact import NO_ROWS
from cprbm.first_equilibrium import _settled, equilibrium, measure
from cprbm.kinematics import rest_state
from cprbm.mechanism import mechanism_of
from cprbm.newton import newton_step, own_system
from cprbm.point import point_at
from cprbm_scene import scene_from
from tests.cprbm.driven import UNIT_FORCE
from tests.cprbm.scenes import LENGTH, THICKNESS, cantilever_data, force

SETTINGS = cprbm.Settings(links=11)


@pytest.fixture(scope="module")
def leaning():
    """A column beyond its buckling load, which leans on a circle beside its tip."""
    data = cantilever_data(force(-1.0, -0.0137), [1.0])
    radius = 0.071 * LENGTH
    center = [0.937 * LENGTH, -radius - THICKNESS / 2.0]
    data["contacts"] = {
        "circle": {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": center, "radius": radius}
    }
    problem = mechanism_of(scene_from(data), SETTINGS).problem
    point = point_at(problem, {}, rest_state(problem.model), np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    # closed forms: it buckles at π²/4 = 2.47 alone, and at 20 where its tip is held
    for load in (0.7, 1.9, 4.3, 7.1):
        found = equilibrium(problem, {"P": load * UNIT_FORCE}, point, SETTINGS.tolerance, SETTINGS.iterations)
        assert found.converged
        point = found.point
    return problem, {"P": 7.1 * UNIT_FORCE}, point


def test_a_step_squares_the_distance_where_a_contact_alone_keeps_the_energy_convex(leaning):
    problem, values, there = leaning
    assert np.count_nonzero(there.lam) == 1
    assert not own_system(problem, there).convex
    random = np.random.default_rng(7)
    n = problem.model.n_links
    away = random.standard_normal(there.state.theta.size + 3)
    away[problem.closure.fixed] = 0.0
    left = []
    for size in (1e-3, 1e-4):
        state = there.state.moved(size * away, n)
        point = point_at(problem, values, state, there.mu, there.lam, there.rows)
        step, _, _ = newton_step(problem, point)
        after = state.moved(step, n)
        left.append(np.max(np.abs(after.theta - there.state.theta)))
    assert left[0] / left[1] == pytest.approx(100.0, rel=0.3)


def test_an_equilibrium_is_its_own_and_what_is_near_is_not(leaning):
    problem, values, there = leaning
    n = problem.model.n_links
    again = equilibrium(problem, values, there, SETTINGS.tolerance, 1)
    assert again.converged
    assert np.max(np.abs(again.point.state.theta - there.state.theta)) <= 1e-12
    away = np.random.default_rng(5).standard_normal(there.state.theta.size + 3)
    away[problem.closure.fixed] = 0.0
    for size in (1e-8, 3e-11):
        state = there.state.moved(size * away, n)
        start = point_at(problem, values, state, there.mu, there.lam, there.rows)
        back = equilibrium(problem, values, start, SETTINGS.tolerance, 4)
        assert back.converged
        assert np.max(np.abs(back.point.state.theta - there.state.theta)) <= 2e-12


def test_what_presses_across_a_gap_and_what_overlaps_is_measured(leaning):
    # reference: force times gap over the largest of the terms that balance, by hand
    problem, values, there = leaning
    random = np.random.default_rng(11)
    away = 0.0037 * random.standard_normal(there.state.theta.size + 3)
    away[problem.closure.fixed] = 0.0
    for sign in (1.0, -1.0):
        state = there.state.moved(sign * away, problem.model.n_links)
        point = point_at(problem, values, state, there.mu, there.lam, there.rows)
        found, gaps = measure(problem, point), point.rows.values
        terms = np.abs(point.gradient) + np.abs(point.lam @ point.slopes) + np.abs(point.mu @ point.A_E)
        scale = max(np.max(terms), np.max(np.abs(spring_moments(problem.model, state))))
        assert found.complementarity == pytest.approx(np.max(np.abs(point.lam * gaps)) / scale, rel=1e-12)
        assert found.complementarity > 1e6 * found.floor
        assert found.overlap == max(np.max(gaps), 0.0)


@pytest.mark.parametrize("what", ["residual", "violation", "overlap"])
def test_a_state_with_something_left_is_not_settled(leaning, what):
    problem, _, there = leaning
    good = measure(problem, there)
    assert _settled(good, 0.0, SETTINGS.tolerance)
    assert not _settled(good, 1.3e-5, SETTINGS.tolerance)
    assert not _settled(replace(good, **{what: 1.7 * max(SETTINGS.tolerance, good.floor)}), 0.0, SETTINGS.tolerance)
