"""Contacts that cannot be touched are neither made nor looked at, and what they leave is the same answer."""

from __future__ import annotations

import numpy as np

import cprbm
from comparisons.cases import opened
from cprbm_scene import CircleContact, Ending, FunctionContact, HalfPlaneContact, LineContact, RigidContact, Scene


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
