"""A good equilibrium, spoilt in one way at a time: the certificate names what was spoilt."""

from dataclasses import replace

import numpy as np
import pytest

import cprbm
from cprbm.certifying import certify
from cprbm.first_contact import NO_ROWS
from cprbm.first_equilibrium import equilibrium
from cprbm.kinematics import rest_state
from cprbm.mechanism import mechanism_of
from cprbm.point import point_at
from cprbm_scene import Ending, scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, cantilever_data, force, hinge

MOMENT = 0.67
SETTINGS = cprbm.Settings(links=37)


def solved(problem, load="M", value=MOMENT):
    rest = point_at(problem, {}, rest_state(problem.model), np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    found = equilibrium(problem, {load: value}, rest, SETTINGS.tolerance, SETTINGS.iterations)
    assert found.converged
    return found


@pytest.fixture(scope="module")
def mechanism():
    return mechanism_of(hinge(), SETTINGS)


@pytest.fixture(scope="module")
def good(mechanism):
    return solved(mechanism.problem)


def judged(mechanism, found):
    certificate, ending = certify(mechanism, SETTINGS, found)
    return " | ".join(certificate.failures), ending


def test_what_is_not_spoilt_is_certified(mechanism, good):
    assert judged(mechanism, good) == ("", Ending.COMPLETED)
    stage = {"name": "load", "steps": "M", "stations": [MOMENT]}
    (station,) = cprbm.answer(hinge(stages=[stage]), SETTINGS).stations
    # on the mesh fitted to where the contact is, some more
    assert station.certificate.iterations >= good.iterations


@pytest.mark.parametrize("value", [1e-9, float("nan")])
@pytest.mark.parametrize(
    ("what", "said"),
    [("residual", "the residual is"), ("violation", "closures are open"), ("complementarity", "gap times force")],
)
def test_a_measure_beyond_what_is_asked(mechanism, good, what, said, value):
    value = 1e4 * value if what == "complementarity" else value
    failures, ending = judged(mechanism, replace(good, measure=replace(good.measure, **{what: value})))
    assert said in failures
    assert ending is Ending.NOT_CERTIFIED


def test_a_solve_that_did_not_settle(mechanism, good):
    assert judged(mechanism, replace(good, converged=False))[1] is Ending.NOT_CERTIFIED


def test_forces_that_do_not_balance(mechanism, good):
    # a millionth of the largest multiplier more on one of them: the free body is no longer in equilibrium
    mu = good.point.mu.copy()
    mu[0] += 1e-6 * np.max(np.abs(mu))
    point = replace(good.point, mu=mu)
    failures, ending = judged(mechanism, replace(good, point=point))
    assert "ΣF is" in failures
    assert "ΣM is" in failures
    assert ending is Ending.NOT_CERTIFIED


def test_beams_that_nothing_holds_apart(mechanism):
    failures, ending = judged(mechanism, solved(mechanism.without("contact")))
    assert "overlap by" in failures
    assert ending is Ending.BEAMS_CROSSED


@pytest.mark.parametrize(("overlap", "ending"), [(0.01, Ending.BEAMS_CROSSED), (-0.01, Ending.COMPLETED)])
def test_what_is_open_does_not_overlap_by_a_hundredth_of_a_thickness(overlap, ending):
    # closed form: the force F at its end bends a cantilever by F x²(3L − x)/6EI, here 0.3 % of its length
    load, at, radius = 0.01 * RIGIDITY / LENGTH**2, 0.79 * LENGTH, 0.27 * LENGTH
    down = load * at**2 * (3.0 * LENGTH - at) / (6.0 * RIGIDITY)
    data = cantilever_data(force(0.0, -1.0), [load])
    center = [at, -(radius + 0.5 * THICKNESS + down - overlap * THICKNESS)]
    circle = {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": center, "radius": radius}
    data["contacts"] = {"circle": circle}
    whole = mechanism_of(scene_from(data), SETTINGS)
    # its row is missing
    mechanism = replace(whole, problem=whole.without("circle"))
    certificate, how = certify(mechanism, SETTINGS, solved(mechanism.problem, "P", load))
    assert certificate.penetration == pytest.approx(max(overlap, 0.0), abs=2e-3)
    assert how is ending


def test_an_element_bent_too_far(mechanism, good):
    theta = good.point.state.theta.copy()
    theta[5:] += 1.01
    point = replace(good.point, state=replace(good.point.state, theta=theta))
    assert "one element turns by" in judged(mechanism, replace(good, point=point))[0]
