"""First and second derivatives of gaps along a beam, against differences of the gap itself.

The beam's curvature varies at rest, and it has been bent, so that its line is run through at no even speed; and its
thickness varies.
"""

import numpy as np
import pytest

import cprbm
from cprbm.feet import distance_along
from cprbm.kinematics import State, positions, rest_state
from cprbm.mechanism import mechanism_of
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, THICKNESS, cantilever_data, force

STEP = 1e-5
SHAPE = np.polynomial.Polynomial([0.0, 0.31, 5.3, -61.0])
PROFILE = {"at": [0.0, 1.0], "values": [1.9 * THICKNESS, 0.6 * THICKNESS]}


def scene_of(contact, **beams):
    """A cantilever along :data:`SHAPE` and further beams, with one contact."""
    data = cantilever_data(force(0.0, -1.0), [1.0])
    end = [LENGTH, float(SHAPE(LENGTH))]
    curve = {"kind": "polynomial", "axis": "x", "coefficients": SHAPE.coef.tolist(), "range": [0.0, LENGTH]}
    data["bodies"]["tip"]["points"]["T"] = end
    data["beams"]["beam"] |= {"curve": curve, "thickness": PROFILE}
    for name, changes in beams.items():
        data["bodies"]["wall"]["points"][f"of-{name}"] = changes["curve"]["start"]
        weld = {"joint": "weld", "point": f"of-{name}"}
        data["beams"][name] = {**data["beams"]["beam"], "start": weld, "end": {"joint": "free"}, **changes}
    return scene_from({**data, "contacts": {"contact": contact}})


def bent(contact, swing, links=19, **beams):
    """The contact, state, positions, and places, two within each of some elements, where all goes on evenly.

    Every beam is turned by its own share of ``swing`` rad, less and less towards its end.
    """
    mechanism = mechanism_of(scene_of(contact, **beams), cprbm.Settings(links=links))
    model, pair = mechanism.problem.model, mechanism.pairs["contact"]
    rest = rest_state(model)
    theta = rest.theta.copy()
    for chain, part in zip(model.chains, (1.0, -0.37), strict=False):
        theta[chain.links] += swing * part * np.sin(1.7 * chain.borders / chain.borders[-1])
    s = np.concatenate([border + np.array([0.11, 0.4]) * pair.a.h for border in pair.a.borders[2:-1:3]])
    state = State(theta, rest.bodies)
    return pair, state, positions(model, state), s


@pytest.mark.parametrize("swing", [0.83, -1.31])
def test_of_a_circle(swing):
    circle = {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": [0.4 * LENGTH, 0.0], "radius": 0.004}
    pair, state, at, s = bent(circle, swing)
    before, here, behind = (pair.line(state, at).at(s + step) for step in (-STEP, 0.0, STEP))
    seen = pair.seen(here)
    assert seen.course == pytest.approx((pair.distance(behind) - pair.distance(before)) / (2.0 * STEP), abs=1e-8)
    bending = (pair.seen(behind).course - pair.seen(before).course) / (2.0 * STEP)
    assert seen.convexity == pytest.approx(bending, rel=1e-6, abs=1e-8)


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize(("above", "swing"), [(-0.004, 0.23), (0.004, -0.23), (0.004, 0.19)])
def test_of_two_beams_where_they_face_each_other(above, swing, backwards):
    # at joints, since between these the curvature is taken to go on evenly; and as if the edges there were parallel,
    # which is right to the second order of the angle between them
    ends = [[-0.1 * LENGTH, above], [1.2 * LENGTH, above]]
    start, end = ends[::-1] if backwards else ends
    first = {"curve": {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]}, "thickness": PROFILE}
    thickness = {"at": [0.0, 1.0], "values": [0.7 * THICKNESS, 1.7 * THICKNESS]}
    other = {"curve": {"kind": "line", "start": start, "end": end}, "thickness": thickness}
    contact = {"kind": "beam-beam", "between": ["first", "other"]}
    pair, state, at, _ = bent(contact, swing, 38, first=first, other=other)
    s, lines = pair.a.s[2:-2], pair.lines(state, at)
    angle = np.abs(pair.slopes(state, at, s))
    s, angle = s[angle < 0.03], angle[angle < 0.03]
    assert s.size > 2
    before, here, behind = (distance_along(pair, lines, s + step)[0] for step in (-STEP, 0.0, STEP))
    bending = (behind - 2.0 * here + before) / STEP**2
    scale = np.max(np.abs(bending))
    assert np.all(np.abs(pair.parting(state, at, s) - bending) < scale * (angle**2 + 2e-4))
