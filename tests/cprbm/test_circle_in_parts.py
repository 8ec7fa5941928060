"""A beam beside a rigid circle: which ends are clamped on it, how far off its rows begin."""

import pytest

import cprbm
from cprbm.circle import reach
from cprbm.kinematics import positions, rest_state
from cprbm.mechanism import mechanism_of
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, THICKNESS, cantilever_data
from tests.cprbm.test_circle import scene_of

LINKS = 7


def beside(x, gap, radius):
    """A circle below the straight beam at part ``x`` of its length, ``gap`` of it below its line."""
    length = 0.0973
    return scene_of([1.3], radius=radius * length, center=[x * length, -(gap + radius) * length])


def clamped_at_both_ends(x):
    """A straight beam, both ends welded to the ground, and a circle that touches it at ``x``."""
    data = cantilever_data({"kind": "beam_force", "beam": "beam", "at": 0.43, "direction": [0.3, -1.0]}, [1.3])
    data["bodies"] = {"wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "T": [LENGTH, 0.0]}}}
    radius = 0.0113
    center = [x, -radius - THICKNESS / 2.0]
    data["contacts"] = {
        "circle": {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": center, "radius": radius}
    }
    data["probes"] = [{"of": "circle", "quantity": "force"}]
    return data


@pytest.mark.parametrize(
    ("x", "start", "end"), [(0.0, True, False), (LENGTH, False, True), (0.37 * LENGTH, False, False)]
)
def test_an_end_is_clamped_on_the_circle_where_it_touches_it(x, start, end):
    mechanism = mechanism_of(scene_from(clamped_at_both_ends(x)), cprbm.Settings(links=LINKS))
    assert mechanism.pairs["circle"].clamped == (start, end)


@pytest.mark.parametrize(("links", "gap", "radius"), [(41, 0.093, 0.73), (5, 0.31, 0.043), (5, 0.083, 0.043)])
def test_a_beam_with_rows_is_within_reach(links, gap, radius):
    # the thickness's half, 0.5 % of the length, is less than the gap leaves
    mechanism = mechanism_of(beside(0.43, gap, radius), cprbm.Settings(links=links))
    model, circle = mechanism.problem.model, mechanism.pairs["circle"]
    state = rest_state(model)
    assert circle.groups(state, positions(model, state))
    assert gap - circle.offset < reach(circle.a, radius)
