"""A beam beside a rigid circle: what sweeps over it, which ends are clamped on it, how far off its rows begin."""

from dataclasses import replace

import numpy as np
import pytest

import cprbm
from cprbm.circle import reach
from cprbm.kinematics import positions, rest_state
from cprbm.mechanism import mechanism_of
from scene.reading import scene_from
from tests.cprbm.scenes import LENGTH, THICKNESS, cantilever_data
from tests.cprbm.test_circle import scene_of

LINKS = 7


def beside(x, gap, radius):
    """A circle below the straight beam at part ``x`` of its length, ``gap`` of it below its line."""
    length = 0.0973
    return scene_of([1.3], radius=radius * length, center=[x * length, -(gap + radius) * length])


def moved(at, circle, x, y):
    """Positions with the joints of the circle's beam at ``x``, ``y``."""
    xs, ys = at.x.copy(), at.y.copy()
    xs[circle.a.joints], ys[circle.a.joints] = x, y
    return replace(at, x=xs, y=ys)


@pytest.fixture(scope="module")
def rest():
    mechanism = mechanism_of(beside(0.31, 0.0137, 0.07), cprbm.Settings(links=LINKS))
    model = mechanism.problem.model
    return mechanism.pairs["circle"], positions(model, rest_state(model))


@pytest.mark.parametrize("place", [0.03, 0.31, 0.48, 0.97])
@pytest.mark.parametrize("angle", [-2.9, -1.7, 0.3, 1.9, 3.05])
def test_a_beam_that_turns_about_the_centre_does_not_sweep_over_it(rest, place, angle):
    # reference: all its places stay as far from the centre as they are
    circle, at = rest
    x = at.x[circle.a.joints] + circle.x - place
    y = np.full_like(x, circle.y + 0.057)
    turned = np.exp(1j * angle) * (x - circle.x + 1j * (y - circle.y))
    after = moved(at, circle, circle.x + turned.real, circle.y + turned.imag)
    assert not circle.passed(moved(at, circle, x, y), after)


@pytest.mark.parametrize(("place", "sweeps"), [(-0.13, False), (0.03, True), (0.48, True), (0.97, True), (1.09, False)])
def test_a_beam_that_is_shifted_across_sweeps_over_what_is_between_its_ends(rest, place, sweeps):
    circle, at = rest
    x = at.x[circle.a.joints] + circle.x - place
    above, below = (moved(at, circle, x, np.full_like(x, circle.y + y)) for y in (0.057, -0.043))
    assert circle.passed(above, below) is sweeps
    assert circle.passed(below, above) is sweeps


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
