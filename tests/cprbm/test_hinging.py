"""Pins between bodies: derivatives, and linkages of pinned bodies against statics and geometry."""

import numpy as np
import pytest

import cprbm
from cprbm.closure import closure_rows, closure_second, closure_values
from cprbm.first_contact import NO_ROWS
from cprbm.first_equilibrium import equilibrium
from cprbm.kinematics import State, positions, rest_state
from cprbm.local import local_step
from cprbm.mechanism import mechanism_of
from cprbm.newton import local_system_at, newton_step
from cprbm.point import point_at
from cprbm_scene import scene_from
from tests.together.pivots import FORCE, LENGTH, MATERIALS, MOMENT, STRIP, line, pin, weld

D = (1.1, 0.2)
CRANK, COUPLER, FOLLOWER = 0.4, 0.9, 0.7


def meeting(a, d, r, s):
    """The upper one of the two places at distances r from a and s from d."""
    a, d = np.array(a), np.array(d)
    way = d - a
    size = np.hypot(*way)
    along = (size**2 + r**2 - s**2) / (2.0 * size)
    return a + (along * way + np.sqrt(r**2 - along**2) * np.array([-way[1], way[0]])) / size


def four_bar(*, pinned, spring=False):
    """Crank OA, coupler AB and follower DB, lengths in LENGTH, the crank upright; beside them an idle beam.

    With ``pinned`` the crank is held on the ground by a pin in the place of a pivot; the ``spring`` is a beam that the
    follower drags along.
    """
    a = np.array([0.0, CRANK])
    b = meeting(a, D, COUPLER, FOLLOWER)
    far = b + np.array([1.0, 0.5])

    def at(place):
        return [float(LENGTH * coordinate) for coordinate in place]

    crank = {"points": {"O": at((0.0, 0.0)), "A": at(a)}} | (
        {"motion": "free"} if pinned else {"motion": "turns", "about": "O"}
    )
    bodies = {
        "ground": {"motion": "fixed", "points": {"W": at((-3.0, 0.0)), "O_ground": at((0.0, 0.0)), "S": at(far)}},
        "crank": crank,
        "coupler": {"motion": "free", "points": {"mid": at(0.5 * (a + b)), "A_c": at(a), "B_c": at(b)}},
        "follower": {"motion": "turns", "about": "D", "points": {"D": at(D), "B": at(b)}},
    }
    pins = {"at_A": {"points": ["A", "A_c"]}, "at_B": {"points": ["B_c", "B"]}}
    if pinned:
        pins["at_O"] = {"points": ["O_ground", "O"]}
    start, end = at((-3.0, 0.0)), at((-2.0, 0.0))
    idle = {**STRIP, "curve": line(start, end), "start": weld("W"), "end": {"joint": "free"}}
    drag = {**STRIP, "curve": line(at(b), at(far)), "start": pin("B"), "end": weld("S")}
    return {
        "name": "four-bar",
        "materials": MATERIALS,
        "bodies": bodies,
        "pins": pins,
        "beams": {"idle": idle} | ({"drag": drag} if spring else {}),
    }


@pytest.mark.parametrize("pinned", [False, True])
def test_a_four_bar_linkage_goes_where_its_lengths_say(pinned):
    # reference: where two circles meet
    angles = [0.3, -0.7]
    scene = scene_from(
        {
            **four_bar(pinned=pinned),
            "drives": {"turn": {"kind": "rotation", "body": "crank"}},
            "stages": [{"name": "turn", "steps": "turn", "stations": angles}],
            "probes": [
                {"of": "B", "quantity": "displacement"},
                {"of": "follower", "quantity": "rotation"},
                {"of": "crank", "quantity": "reaction_moment"},
            ],
        }
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=5))
    assert answer.completed, answer.sentence
    drawn = meeting((0.0, CRANK), D, COUPLER, FOLLOWER)
    for station, angle in zip(answer.stations, angles, strict=True):
        b = meeting((-CRANK * np.sin(angle), CRANK * np.cos(angle)), D, COUPLER, FOLLOWER)
        assert station.values["B.displacement"] == pytest.approx(LENGTH * (b - drawn), abs=1e-9 * LENGTH)
        turned = np.arctan2(*(b - D)[::-1]) - np.arctan2(*(drawn - D)[::-1])
        assert station.values["follower.rotation"] == pytest.approx([turned], abs=1e-9)
        assert station.values["crank.reaction_moment"] == pytest.approx([0.0], abs=1e-9 * MOMENT)


@pytest.mark.parametrize("pinned", [False, True])
def test_forces_in_a_linkage_that_a_drive_holds(pinned):
    # reference: statics. A force on the coupler's middle; the follower is a two-force member, along DB
    scene = scene_from(
        {
            **four_bar(pinned=pinned),
            "loads": {"P": {"kind": "force", "point": "mid", "direction": [0.3, -0.7]}},
            "drives": {"turn": {"kind": "rotation", "body": "crank"}},
            "stages": [{"name": "pull", "steps": "P", "stations": [FORCE]}],
            "probes": [
                {"of": "O_ground" if pinned else "O", "quantity": "reaction"},
                {"of": "D", "quantity": "reaction"},
                {"of": "crank", "quantity": "reaction_moment"},
            ],
        }
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=5))
    assert answer.completed, answer.sentence
    values, certificate = answer.stations[0].values, answer.stations[0].certificate
    a, b = np.array([0.0, CRANK]), meeting((0.0, CRANK), D, COUPLER, FOLLOWER)
    load = FORCE * np.array([0.3, -0.7]) / np.hypot(0.3, 0.7)
    along = (b - D) / FOLLOWER

    def cross(one, other):
        return one[0] * other[1] - one[1] * other[0]

    # moments about A of the coupler
    push = -cross(0.5 * (b - a), load) / cross(b - a, along)
    at_o = -load - push * along
    assert values["D.reaction"] == pytest.approx(push * along, abs=1e-9 * FORCE)
    assert values["O_ground.reaction" if pinned else "O.reaction"] == pytest.approx(at_o, abs=1e-9 * FORCE)
    assert values["crank.reaction_moment"] == pytest.approx([cross(a, at_o) * LENGTH], abs=1e-9 * MOMENT)
    assert max(certificate.force_balance, certificate.moment_balance) < 1e-9


def problem_of():
    scene = scene_from(
        {
            **four_bar(pinned=True, spring=True),
            "stops": {"far": {"beam": "drag", "end": "start", "towards": "D", "most": 100.0}},
            "loads": {"M": {"kind": "moment", "body": "crank"}},
            "stages": [{"name": "turn", "steps": "M", "stations": [MOMENT]}],
            "probes": [{"of": "B", "quantity": "displacement"}],
        }
    )
    return mechanism_of(scene, cprbm.Settings(links=5)).problem


def test_rows_of_pins_are_derivatives():
    # reference: central differences
    problem = problem_of()
    model, closure = problem.model, problem.closure
    random = np.random.default_rng(71)
    rest = rest_state(model)
    base = np.concatenate((rest.theta, rest.bodies.ravel())) + 0.3 * random.standard_normal(model.n_unknowns)

    def state(q):
        return State(q[: model.n_links], q[model.n_links :].reshape(-1, 3))

    def values(q):
        return closure_values(model, closure, state(q), positions(model, state(q)), {})

    exact = closure_rows(model, closure, state(base), positions(model, state(base)))
    for i, unit in enumerate(np.eye(model.n_unknowns)):
        slope = (values(base + 1e-6 * unit) - values(base - 1e-6 * unit)) / 2e-6
        assert exact[:, i] == pytest.approx(slope, abs=1e-8)
    # of pins alone: forces at beams' ends have the rest of their second derivatives elsewhere
    mu = np.zeros(closure.rows)
    mu[closure.first_hinge : closure.first_hold] = random.standard_normal(2 * len(closure.hinges))
    second = closure_second(model, closure, state(base), mu)
    for b in range(len(model.free_bodies)):
        unit = np.zeros(model.n_unknowns)
        unit[model.n_links + 3 * b + 2] = 1e-4
        bent = (values(base + unit) - 2.0 * values(base) + values(base - unit)) @ mu / 1e-8
        assert second[b] == pytest.approx(bent, abs=1e-6)


def test_both_forms_of_newtons_system_make_one_step():
    problem = problem_of()
    values = {"M": 0.3 * MOMENT}
    state = rest_state(problem.model)
    rows = problem.formulation(state, positions(problem.model, state), NO_ROWS)
    start = point_at(problem, values, state, np.zeros(problem.closure.rows), np.zeros(1), rows)
    found = equilibrium(problem, values, start, 1e-11, 40)
    assert found.converged
    away = point_at(problem, {"M": 0.4 * MOMENT}, found.point.state, found.point.mu, found.point.lam, rows)
    one, other = newton_step(problem, away), local_step(local_system_at(problem, away), np.zeros(1, dtype=bool))
    for dense, local in zip(one, other, strict=True):
        assert local == pytest.approx(dense, rel=1e-8, abs=1e-9)
