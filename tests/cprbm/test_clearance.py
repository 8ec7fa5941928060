"""Contacts that cannot be touched are neither made nor looked at, and what they leave is the same answer."""

from __future__ import annotations

import numpy as np
import pytest

import cprbm
from comparisons.cases import opened
from cprbm import mechanism
from cprbm.kinematics import State, positions, rest_state
from cprbm.mechanism import mechanism_of
from cprbm_scene import CircleContact, Ending, FunctionContact, HalfPlaneContact, LineContact, RigidContact, Scene

SMALL = cprbm.Settings(links=12)


def obstacles(scene: Scene, distance: float, many: int, body: str) -> dict[str, RigidContact]:
    """Rigid things of every kind all round a mechanism, ``distance`` times its size from its middle."""
    points = np.array([at for one in scene.bodies.values() for at in one.points.values()])
    middle, size, beams = points.mean(axis=0), float(np.ptp(points, axis=0).max()), list(scene.beams)
    found: dict[str, RigidContact] = {}
    for i in range(many):
        angle = 2.0 * np.pi * i / many + 0.1
        out = np.array([np.cos(angle), np.sin(angle)])
        along, (x, y) = np.array([out[1], -out[0]]), middle + distance * size * out
        of = {"beam": beams[i % len(beams)], "body": body}
        match i % 4:
            case 0:
                found[f"far{i}"] = CircleContact(kind="beam-circle", center=(x, y), radius=0.1 * size, **of)
            case 1:
                normal = (-out[0], -out[1])
                found[f"far{i}"] = HalfPlaneContact(kind="beam-half-plane", point=(x, y), normal=normal, **of)
            case 2:
                ends = ((x, y) - 0.2 * size * along, (x, y) + 0.01 * size * out, (x, y) + 0.2 * size * along)
                line = tuple((float(px), float(py)) for px, py in ends)
                found[f"far{i}"] = LineContact(kind="beam-line", points=line, side="right", **of)
            case _:
                side = "above" if y < middle[1] else "below"
                shape = (y - 2.0 * x, 2.0) if (y < middle[1]) == (x > middle[0]) else (y + 2.0 * x, -2.0)
                ends = (x - 0.1 * size, x + 0.1 * size)
                found[f"far{i}"] = FunctionContact(
                    kind="beam-function", axis="x", coefficients=shape, range=ends, side=side, **of
                )
    return found


def with_more(scene: Scene, more: dict[str, RigidContact]) -> Scene:
    return scene.model_copy(update={"contacts": {**scene.contacts, **more}})


def last_station(name: str) -> Scene:
    scene = opened(name)
    stages = tuple(stage.model_copy(update={"stations": stage.stations[-1:]}) for stage in scene.stages)
    return scene.model_copy(update={"stages": stages})


def test_far_obstacles_change_nothing():
    scene, settings = last_station("hinge"), cprbm.Settings(links=21)
    alone = cprbm.answer(scene, settings)
    crowded = cprbm.answer(with_more(scene, obstacles(scene, 2.0, 50, "AC")), settings)
    assert crowded.ending is Ending.COMPLETED
    (one,), (other,) = alone.stations, crowded.stations
    for name, value in one.values.items():
        np.testing.assert_allclose(value, other.values[name], rtol=1e-9, atol=1e-12, err_msg=name)


@pytest.mark.parametrize("body", ["AC", "BD"])
def test_a_clearance_is_less_than_any_gap(body):
    scene = opened("hinge")
    made = mechanism_of(with_more(scene, obstacles(scene, 0.9, 24, body)), SMALL)
    model, clearances, rng = made.problem.model, made.clearances, np.random.default_rng(5)
    proved = 0
    for _ in range(6):
        rest = rest_state(model)
        bent = np.concatenate([np.cumsum(rng.normal(0.0, 0.05, chain.n + 1)) for chain in model.chains])
        state = State(rest.theta + bent, rest.bodies + rng.normal(0.0, 0.3, rest.bodies.shape))
        at = positions(model, state)
        least = clearances.at(state, at) - clearances.half
        near = clearances.near(state, at)
        for name, bound in zip(clearances.names, least, strict=True):
            if bound <= 0.0:
                continue
            proved += 1
            assert bound <= made.pairs[name].least_gap(state, at) + 1e-12, name
            if name not in near:
                assert not made.pairs[name].groups(state, at), name
    assert proved > 50


def test_what_moves_less_than_a_clearance_passes_through_nothing():
    scene = opened("hinge")
    made = mechanism_of(with_more(scene, obstacles(scene, 0.9, 24, "BD")), SMALL)
    model, clearances, rng = made.problem.model, made.clearances, np.random.default_rng(6)
    start = rest_state(model)
    proved = 0
    for _ in range(3):
        turned = np.concatenate([np.cumsum(rng.normal(0.0, 0.02, chain.n + 1)) for chain in model.chains])
        end = State(start.theta + turned, start.bodies + rng.normal(0.0, 0.1, start.bodies.shape))
        both = [(state, positions(model, state)) for state in (start, end)]
        possible = clearances.may_pass(both[0], both[1])
        for part in np.linspace(0.0, 1.0, 5):
            state = State(start.theta + part * turned, start.bodies + part * (end.bodies - start.bodies))
            at = positions(model, state)
            for name in set(clearances.names) - set(possible):
                proved += 1
                assert made.pairs[name].least_gap(state, at) > 0.0, name
    assert proved > 50


def test_what_is_far_at_first_presses_once_it_is_reached():
    scene = opened("wrapped")
    under = scene.contacts["contact"].model_copy(update={"center": (0.085, -0.055), "radius": 0.02})
    scene = scene.model_copy(update={"contacts": {"contact": under}})
    made = mechanism_of(scene, SMALL)
    rest = rest_state(made.problem.model)
    assert made.near(rest, positions(made.problem.model, rest)) == []
    answer = cprbm.answer(scene, SMALL)
    assert answer.ending is Ending.COMPLETED
    forces = [float(station.values["contact.force"][0]) for station in answer.stations]
    assert forces[0] == 0.0
    assert forces[-1] > 0.0
    assert not answer.stations[0].touching
    assert "contact" in answer.stations[-1].touching
