"""The peers' own writing of the paper's formulas beside the CPRBM's, and where every optimiser comes to."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from benchmarks.peers import ipopt, slsqp
from benchmarks.peers.expressions import expressions
from benchmarks.peers.formulas import Formulas
from benchmarks.peers.judged import TOLERANCE, judged
from benchmarks.peers.kkt import stationarity
from benchmarks.peers.method import discretised
from benchmarks.peers.solving import LATE, Solved
from comparisons import cases
from comparisons.bench.measures import benchmark_scene
from comparisons.choices import Choices
from comparisons.pairing import cprbm_answer
from cprbm.chain import add_rows, mechanism_of, row_values, strain_energy
from cprbm.contact import contact_geometry, fixed_places, new_counters
from cprbm.equilibrium.system import rest_state, system_of
from cprbm.paper.contacts import paper_geometry
from cprbm_scene import SceneError
from cprbm_scene.frozendict import frozendict
from tests.cprbm.second.systems import gradient

OFFERED = ("hinge", "gripper", "gripper-driven", "wrapped", "platform", "tapered")
COUNT = frozendict({"hinge": 20, "gripper": frozendict({"beam1": 15, "beam2": 20}), "gripper-driven": 20})


def count_of(case):
    return COUNT.get(case, 12)


@cache
def problem(case):
    return discretised(cases.opened(case), count_of(case))


def bent(formulas, seed):
    return formulas.rest + 0.02 * np.random.default_rng(seed).standard_normal(formulas.size)


def system_of_case(case):
    """System of the formulation ``paper``, and targets of the rows at the last loads and drives."""
    scene, links = cases.opened(case), count_of(case)
    counts = dict.fromkeys(scene.beams, links) if isinstance(links, int) else links
    m = mechanism_of(scene, counts, "bending", corrected=False)
    add_rows(m)
    every = contact_geometry(m)
    system = system_of(m, paper_geometry(m, every, 4) if every.pairs else every)
    target = np.zeros(len(m.rows))
    for stage in scene.stages:
        row = m.row(stage.steps)
        target[row] = stage.stations[-1] * m.rows[row].unit
    return system, target


def unknowns(system, formulas, z):
    """The system's unknowns for the peers' unknowns."""
    m, here = system.mechanism, formulas.at(z)
    found = np.concatenate([m.rest, np.zeros(len(m.rows))])
    found[system.angles] = here.theta
    for beam, x, y in zip(m.chains, here.x, here.y, strict=True):
        nodes = m.beam_nodes(beam)
        found[nodes], found[nodes + 1] = x, y
    for name, number in formulas.problem.bodies.items():
        found[m.bodies[name] : m.bodies[name] + 3] = here.bodies[number]
    return found


@pytest.mark.parametrize("case", OFFERED)
@pytest.mark.parametrize("seed", [0, 1])
def test_values_are_those_of_the_cprbm_and_slopes_their_differences(case, seed):
    """The two writings meet in nothing but the record."""
    (system, target), formulas = system_of_case(case), Formulas(problem(case))
    z = bent(formulas, seed)
    ours = unknowns(system, formulas, z)
    state = rest_state(system)
    mu = np.where(state.driven, 0.0, target)
    ours[system.rows.first :] = mu
    energy = strain_energy(ours, system.links, system.joints) + mu @ row_values(ours, system.rows)
    assert formulas.energy(z) == pytest.approx(energy, rel=1e-12, abs=1e-13)
    # the joints of the peers hang on the beams' starts and on links of fixed lengths
    assert np.abs(gradient(system, replace(state, z=ours))[system.links.first[:, None] + [2, 3]]).max() < 1e-14
    held = np.sort(np.abs((row_values(ours, system.rows) - target)[state.driven]))
    mine = np.abs(formulas.closure(z))
    # rows of the starts and of fixed links are no equalities of the peers
    assert np.sort(mine[mine > 1e-14]) == pytest.approx(held[held > 1e-14], abs=1e-14)
    if system.geometry is not None:
        places = fixed_places(system.geometry, ours, state.contacts.sides, np.ones(9, bool), new_counters())
        gaps = replace(state.contacts, places=places, closed=np.zeros(len(places.pair), bool)).gaps(
            system.geometry, ours
        )
        if formulas.problem.fitted or formulas.problem.circles:
            order = np.argsort(
                ~np.isin(places.pair, list(system.geometry.law.boundaries)) if system.geometry.law else places.pair,
                kind="stable",
            )
            assert formulas.contact(z) == pytest.approx(-gaps[order], abs=1e-12)
    step, directions = 1e-6, np.random.default_rng(seed).standard_normal((4, formulas.size))
    for value, slope in (
        (lambda at: np.array([formulas.energy(at)]), formulas.energy_slope(z)[None]),
        (formulas.closure, formulas.closure_slope(z)),
        (formulas.contact, formulas.contact_slope(z)),
    ):
        for d in directions:
            change = (value(z + step * d) - value(z - step * d)) / (2.0 * step)
            np.testing.assert_allclose(slope @ d, change, atol=1e-6 * max(1.0, np.abs(change).max(initial=0.0)))


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
    scene, links = benchmark_scene(cases.opened(case)), count_of(case)
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
    scene, links = benchmark_scene(cases.opened(case)), count_of(case)
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
