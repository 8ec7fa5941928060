"""Work of loads on beams: derivatives against central differences, and balances."""

import numpy as np
import pytest

from cprbm import Settings, smooth
from cprbm.beam_loads import beam_loads, beam_work, kinks
from cprbm.energy import load_work
from cprbm.kinematics import State, positions, pulled_back, rest_state
from cprbm.mechanism import mechanism_of
from cprbm_scene import scene_from
from tests.cprbm.scenes import hinge_data

STEP = 1e-6
LOADS = {
    "start": {"kind": "beam_force", "beam": "bow", "at": 0.0, "direction": [1.0, 2.0]},
    "first": {"kind": "beam_force", "beam": "bow", "at": 0.011, "direction": [1.0, -2.0]},
    "joint": {"kind": "beam_force", "beam": "beam1", "at": 0.5, "direction": [-1.0, 0.3]},
    "within": {"kind": "beam_force", "beam": "bow", "at": 0.6421, "direction": [3.0, 2.0]},
    "end": {"kind": "beam_force", "beam": "bow", "at": 1.0, "direction": [0.0, 2.0]},
    "all": {"kind": "distributed", "beam": "beam1", "direction": [0.3, -1.0]},
    "apart": {"kind": "beam_force", "beam": "further", "at": 0.37, "direction": [1.0, -0.7]},
    "along": {"kind": "distributed", "beam": "further", "direction": [0.4, -1.0], "along": [0.21, 0.84]},
    "part": {"kind": "distributed", "beam": "bow", "direction": [-0.7, -1.0], "along": [0.137, 0.731]},
}


@pytest.fixture(scope="module")
def scene():
    """The hinge with two further beams that begin on the body that moves, a spline and one away from its reference."""
    data = hinge_data()
    points = [[0.051, 0.02625], [0.07, 0.02], [0.08, 0.04], [0.07, 0.06]]
    curve = {"kind": "spline", "points": points}
    weld = {"joint": "weld", "point": "B"}
    data["beams"]["bow"] = {**data["beams"]["beam1"], "curve": curve, "start": weld, "end": {"joint": "free"}}
    data["beams"]["bow"].pop("paper", None)
    straight = {"kind": "line", "start": [0.051, -0.02625], "end": [0.083, -0.031]}
    data["beams"]["further"] = {**data["beams"]["bow"], "curve": straight, "start": {"joint": "weld", "point": "D"}}
    data["loads"] |= LOADS
    return scene_from({**data, "claims": []})


def disturbed(model, seed):
    random = np.random.default_rng(seed)
    rest = rest_state(model)
    theta = rest.theta + 0.1 * random.standard_normal(model.n_links)
    return State(theta, rest.bodies + 0.2 * random.standard_normal(rest.bodies.shape))


def moved(model, state, step):
    return State(state.theta + step[: model.n_links], state.bodies + step[model.n_links :].reshape(-1, 3))


@pytest.mark.parametrize("name", LOADS)
def test_derivatives(scene, name):
    problem = mechanism_of(scene, Settings(links=7)).problem
    model, loads = problem.model, {name: problem.loads[name]}

    def at(state):
        return load_work(model, loads, {name: 0.7}, state, positions(model, state))

    state = disturbed(model, 3)
    here, random = at(state), np.random.default_rng(5)
    for _ in range(6):
        d = random.standard_normal(model.n_unknowns)
        ahead, behind = (at(moved(model, state, sign * STEP * d)) for sign in (1.0, -1.0))
        scale = np.max(np.abs(here.gradient)) * np.linalg.norm(d)
        assert here.gradient @ d == pytest.approx((ahead.value - behind.value) / (2 * STEP), abs=1e-8 * scale)
        over = np.zeros(model.n_unknowns)
        n = model.n_links
        over[:n] = here.diagonal * d[:n]
        over[1:n] += here.off * d[: n - 1]
        over[: n - 1] += here.off * d[1:n]
        over[n + 2 :: 3] += here.second * d[n + 2 :: 3]
        slope = (ahead.gradient - behind.gradient) / (2 * STEP)
        assert over == pytest.approx(slope, abs=1e-7 * scale)


def test_at_rest_nothing_is_done_and_the_resultant_is_the_load(scene):
    model = mechanism_of(scene, Settings(links=9)).problem.model
    rest = rest_state(model)
    for name, load in beam_loads(scene, model).items():
        work = beam_work(model, load, rest, positions(model, rest))
        record = scene.loads[name]
        along = np.array(record.direction) / np.hypot(*record.direction)
        chain = model.chain(record.beam)
        share = record.along[1] - record.along[0] if record.kind == "distributed" else 1.0
        size = share * chain.line.length if record.kind == "distributed" else 1.0
        assert work.value == pytest.approx(0.0, abs=1e-15)
        assert [work.fx.sum(), work.fy.sum()] == pytest.approx(along * size / model.unit_force, rel=1e-12)


def test_a_rigid_motion_does_the_work_of_the_moment(scene):
    """Reference: all angles and the body turned alike about the place where the beam begins."""
    problem = mechanism_of(scene, Settings(links=6)).problem
    model, state = problem.model, disturbed(problem.model, 11)
    at = positions(model, state)
    angle = 1e-6
    for name, load in beam_loads(scene, model).items():
        chain = model.chains[load.chain]
        start = np.array([at.x[chain.first_joint], at.y[chain.first_joint]])
        places = smooth.smooth_line(chain, model.unit_length, state, at).at(load.s)
        arm = np.stack((places.x, places.y), axis=1) - start
        moment = np.sum(arm[:, 0] * load.forces[:, 1] - arm[:, 1] * load.forces[:, 0])
        work = beam_work(model, load, state, at)
        over_theta, over_bodies, _, _ = pulled_back(model, state, at, work.fx, work.fy)
        assert np.sum((over_theta + work.gradient)[chain.links]) == pytest.approx(moment, rel=1e-12), name
        theta = state.theta.copy()
        theta[chain.links] += angle
        turned = State(theta, state.bodies)
        gained = beam_work(model, load, turned, positions(model, turned)).value - work.value
        assert gained / angle == pytest.approx(moment, rel=1e-5, abs=1e-9 * np.abs(load.forces).sum()), name
        if chain.start.body >= 0:
            body = over_bodies[3 * chain.start.body : 3 * chain.start.body + 2]
            assert body == pytest.approx([work.fx.sum(), work.fy.sum()]), name


@pytest.mark.parametrize(("name", "at", "per"), [("apart", [0.37], 0), ("along", [0.21, 0.84], 1)])
def test_the_moment_is_bent_by_what_acts_across(scene, name, at, per):
    # a straight beam that has been turned as it is; what acts across is the part along its left normal
    model = mechanism_of(scene, Settings(links=7)).problem.model
    rest, chain = rest_state(model), model.chain("further")
    theta = rest.theta.copy()
    theta[chain.links] += 0.83
    state = State(theta, rest.bodies)
    angle = np.arctan2(-0.031 + 0.02625, 0.083 - 0.051) + 0.83
    direction = np.array(LOADS[name]["direction"]) / np.hypot(*LOADS[name]["direction"])
    across = direction @ [-np.sin(angle), np.cos(angle)] / model.unit_force * model.unit_length**per
    places, jumps = kinks(model, beam_loads(scene, model)[name], state, positions(model, state))
    length = np.hypot(0.031 - 0.02625, 0.083 - 0.051) / model.unit_length
    assert places == pytest.approx(np.array(at) * length, rel=1e-12)
    assert jumps == pytest.approx(across * np.array([1.0, -1.0][: len(at)]), rel=1e-12)
