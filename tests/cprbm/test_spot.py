"""Places of a line in plain numbers are those in arrays, which are held against closed forms elsewhere."""

import numpy as np
import pytest

import cprbm
from cprbm.kinematics import State, positions, rest_state
from cprbm.kinks import kinked
from cprbm.mechanism import mechanism_of
from cprbm.model import NO_KINKS, Kinks
from cprbm.smooth import smooth_line
from cprbm.spot import spots
from scene.reading import scene_from
from tests.cprbm.scenes import LENGTH, cantilever_data, force

STRAIGHT = {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]}
PARABOLA = {
    "kind": "polynomial",
    "axis": "x",
    "coefficients": [0.0, 0.0, 0.7 / LENGTH],
    "range": [0.0, LENGTH],
}


def line_of(curve, tip):
    """The cantilever's line, bent unevenly."""
    data = cantilever_data(force(0.0, -1.0), [1.0])
    data["beams"]["beam"]["curve"], data["bodies"]["tip"]["points"]["T"] = curve, tip
    model = mechanism_of(scene_from(data), cprbm.Settings(links=11)).problem.model
    chain, rest = model.chains[0], rest_state(model)
    state = State(rest.theta + 0.83 * np.sin(1.7 * chain.borders / chain.borders[-1]) ** 2, rest.bodies)
    return smooth_line(chain, model.unit_length, state, positions(model, state))


@pytest.mark.parametrize("curve", [STRAIGHT, PARABOLA])
@pytest.mark.parametrize("bent", [False, True])
def test_one_by_one_places_are_those_of_arrays(curve, bent):
    line = line_of(curve, [LENGTH, 0.7 * LENGTH if curve is PARABOLA else 0.0])
    end = line.chain.s[-1]
    kinks = Kinks(np.array([0.37, 0.71]) * end, np.array([-2.3, 4.1]), np.array([15.9, -0.7])) if bent else NO_KINKS
    s = np.concatenate((np.linspace(-0.01, 1.01, 137) * end, line.chain.breaks, line.chain.borders))
    among, one_by_one = kinked(line.chain, kinks, line.at(s)), spots(line, kinks)
    assert one_by_one is not None
    found = np.array([one_by_one.at(each) for each in s.tolist()]).T
    expected = among.s, among.x, among.y, among.psi, among.speed, among.bend
    np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-14)


def test_a_line_whose_curve_is_asked_each_time_has_none():
    shares = [(0.0, 0.0), (0.23, 0.04), (0.44, -0.03), (0.61, -0.07), (0.83, 0.01), (1.0, 0.02)]
    points = [[x * LENGTH, y * LENGTH] for x, y in shares]
    assert spots(line_of({"kind": "spline", "points": points}, points[-1]), NO_KINKS) is None
