"""The peers' own writing of the paper's formulas beside the CPRBM's, and where every optimiser comes to."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import cprbm
from benchmarks.peers import ipopt, slsqp
from benchmarks.peers.expressions import expressions
from benchmarks.peers.formulas import Formulas
from benchmarks.peers.judged import TOLERANCE, judged
from benchmarks.peers.kkt import stationarity
from benchmarks.peers.method import discretised
from benchmarks.peers.solving import LATE, Solved
from comparisons import cases
from comparisons.bench.question import asked
from comparisons.choices import Choices
from comparisons.pairing import cprbm_answer
from cprbm.closure import closure_rows, closure_values
from cprbm.energy import load_work, spring_moments, strain_energy, strain_gradient
from cprbm.first_contact import NO_ROWS
from cprbm.kinematics import State, positions
from cprbm.mechanism import mechanism_of
from cprbm.point import contact_gradient, point_at
from cprbm_scene import SceneError
from cprbm_scene.frozendict import frozendict

OFFERED = ("hinge", "gripper", "gripper-driven", "wrapped", "platform", "tapered")
COUNT = frozendict({"hinge": 20, "gripper": frozendict({"beam1": 15, "beam2": 20}), "gripper-driven": 20})


def count_of(case):
    return COUNT.get(case, 12)


@cache
def problem(case):
    return discretised(cases.opened(case), count_of(case))


def bent(formulas, seed):
    return formulas.rest + 0.02 * np.random.default_rng(seed).standard_normal(formulas.size)


@pytest.mark.parametrize("case", OFFERED)
@pytest.mark.parametrize("seed", [0, 1])
def test_values_and_slopes_are_those_of_the_cprbm(case, seed):
    """The two writings meet in nothing but the record."""
    scene, formulas = cases.opened(case), Formulas(problem(case))
    links = count_of(case)
    settings = cprbm.Settings(links=links if isinstance(links, int) else dict(links), formulation="paper")
    ours = mechanism_of(scene, settings).problem
    model, z = ours.model, bent(formulas, seed)
    values = {stage.steps: stage.stations[-1] for stage in scene.stages}
    here = formulas.at(z)
    state = State(here.theta, here.bodies)
    at = positions(model, state)
    work = load_work(model, ours.loads, values, state, at)
    free = np.append(formulas.turning, model.n_links + np.arange(here.bodies.size))
    assert formulas.energy(z) == pytest.approx(strain_energy(model, state) - work.value, rel=1e-12, abs=1e-13)
    slope = np.append(strain_gradient(spring_moments(model, state)), np.zeros(here.bodies.size)) - work.gradient
    np.testing.assert_allclose(formulas.energy_slope(z), slope[free], atol=1e-11)
    np.testing.assert_allclose(formulas.closure(z), closure_values(model, ours.closure, state, at, values), atol=1e-14)
    np.testing.assert_allclose(
        formulas.closure_slope(z), closure_rows(model, ours.closure, state, at)[:, free], atol=1e-14
    )
    rows = ours.formulation(state, at, NO_ROWS)
    # in the record fitted curves come first
    order = np.argsort(
        [name not in {one.name for one in formulas.problem.fitted} for name in rows.contact], kind="stable"
    )
    assert formulas.contact(z) == pytest.approx(rows.values[order], abs=1e-12)
    closed = np.zeros(ours.closure.rows)
    slopes = np.array(
        [contact_gradient(model, point_at(ours, values, state, closed, pull, rows))[free] for pull in np.eye(rows.size)]
    ).reshape(-1, formulas.size)
    np.testing.assert_allclose(formulas.contact_slope(z), slopes[order], atol=1e-10)


@pytest.mark.parametrize("case", OFFERED)
def test_the_expressions_are_the_same(case):
    ca = pytest.importorskip("casadi")
    formulas = Formulas(problem(case))
    z, energy, rows = expressions(formulas)
    both = ca.Function("both", [z], [energy, rows])
    at = bent(formulas, 5)
    theirs = both(at)
    assert float(theirs[0]) == pytest.approx(formulas.energy(at), rel=1e-12, abs=1e-13)
    ours = np.concatenate((formulas.closure(at), formulas.contact(at)))
    np.testing.assert_allclose(np.array(theirs[1]).ravel(), ours, atol=1e-12)


OPTIMISERS = (
    pytest.param(slsqp.prepared, id="slsqp"),
    pytest.param(
        ipopt.prepared, id="ipopt", marks=pytest.mark.skipif(not ipopt.there(), reason="CasADi is not installed")
    ),
)


@pytest.mark.parametrize("optimiser", OPTIMISERS)
@pytest.mark.parametrize("case", ["hinge", "tapered"])
def test_every_optimiser_comes_to_the_minimum_of_the_cprbm(optimiser, case):
    scene, links = asked(cases.opened(case)), count_of(case)
    energy = next(probe for probe in cases.opened("hinge").probes if probe.quantity == "potential_energy")
    scene = scene.model_copy(update={"probes": (*scene.probes, energy)})
    ours = cprbm_answer(scene, Choices(links=links, formulation="paper"))
    assert ours.completed
    values = ours.stations[-1].values
    formulas = Formulas(problem(case))
    solved = optimiser(formulas.problem, 60.0)()
    found = judged(scene, formulas.problem, solved)
    assert (found.ended, found.why) == ("COMPLETED", "")
    assert found.residual <= TOLERANCE
    unit = formulas.problem.unit_moment
    assert unit * formulas.energy(solved.z) == pytest.approx(float(values[energy.name][0]), rel=1e-6)
    assert found.values
    for name, value in found.values.items():
        of = next(probe for probe in scene.probes if probe.name == name)
        size = max(np.linalg.norm(value), np.linalg.norm(values[name]))
        allowed = 1e-3 if of.quantity == "force" else 1e-5
        assert np.linalg.norm(value - values[name]) <= allowed * size


@pytest.mark.skipif(not ipopt.there(), reason="CasADi is not installed")
@pytest.mark.parametrize("case", ["gripper", "gripper-driven", "platform"])
def test_circles_slides_drives_and_forces_come_to_the_same(case):
    scene, links = asked(cases.opened(case)), count_of(case)
    values = cprbm_answer(scene, Choices(links=links, formulation="paper")).stations[-1].values
    found = judged(scene, problem(case), ipopt.prepared(problem(case), 60.0)())
    assert found.ended == "COMPLETED"
    assert set(found.values) == set(values)
    for name, value in found.values.items():
        np.testing.assert_allclose(value, values[name], rtol=1e-4, atol=1e-6 * np.max(np.abs(value)))


def test_the_residual_sees_what_is_no_minimum():
    """At the state without stress the load is not balanced; beyond a contact the gap is negative; NaN is nothing."""
    formulas = Formulas(problem("hinge"))
    assert stationarity(formulas, formulas.rest).residual > 0.01
    assert stationarity(formulas, np.full(formulas.size, np.nan)).residual == float("inf")
    solved = slsqp.prepared(formulas.problem, 60.0)()
    pulled = solved.z + 1e-4 * np.eye(formulas.size)[-1]
    assert stationarity(formulas, pulled).residual > 10.0 * TOLERANCE


@pytest.mark.parametrize(
    ("why", "z", "ended"),
    [(LATE, 0.0, "TIME_IS_UP"), ("restoration failed", 0.0, "GAVE_UP"), ("", 0.1, "NOT_STATIONARY")],
)
def test_what_is_no_answer_has_no_values(why, z, ended):
    formulas = Formulas(problem("hinge"))
    found = judged(cases.opened("hinge"), formulas.problem, Solved(formulas.rest + z, 3, why))
    assert (found.ended, dict(found.values)) == (ended, {})
    assert found.why


@pytest.mark.parametrize("optimiser", OPTIMISERS)
def test_a_solve_ends_when_its_time_is_up(optimiser):
    assert optimiser(problem("gripper"), 1e-3)().why == LATE


@pytest.mark.parametrize(
    ("case", "key"),
    [
        ("prestressed", "assembly"),
        ("prestressed", "stops.stopB"),
        ("five-bar", "contacts.link1"),
        ("rolled", "contacts.lap.kind"),
        ("stack", "contacts.first.paper"),
    ],
)
def test_what_the_problem_has_no_place_for_is_refused_by_name(case, key):
    with pytest.raises(SceneError) as refused:
        discretised(cases.opened(case), 40)
    assert key in [mistake.key for mistake in refused.value.mistakes]


def test_without_casadi_it_is_said_plainly(monkeypatch):
    monkeypatch.setattr(ipopt, "there", lambda: False)
    assert ipopt.contender().absence == "CasADi is not installed (the extra 'peers')"
    assert slsqp.contender().absence == ""
