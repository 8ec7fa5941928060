"""Beams of varying curvature: at rest the smooth line is the stress-free line, whatever the number of elements."""

import numpy as np
import pytest
from scipy.optimize import brentq

import cprbm
from cprbm.curves import neutral_line
from cprbm.excess import Asked, Tabulated
from cprbm.kinematics import positions, rest_state
from cprbm.mechanism import mechanism_of
from cprbm.smooth import smooth_line
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, cantilever_data, force

STEEP = 0.7 / LENGTH  # y = STEEP x²


def at_rest(curve, links):
    """The beam's smooth line at rest and its chain; where it is asked, in metres."""
    data = cantilever_data(force(0.0, -1.0), [1.0])
    data["beams"]["beam"]["curve"] = curve
    end = curve["points"][-1] if curve["kind"] == "spline" else (curve["range"][1], STEEP * curve["range"][1] ** 2)
    data["bodies"]["tip"]["points"]["T"] = list(end)
    scene = scene_from(data)
    model = mechanism_of(scene, cprbm.Settings(links=links)).problem.model
    chain, state = model.chains[0], rest_state(model)
    s = chain.s[-1] * np.linspace(0.0, 1.0, 7 * links + 3)
    return scene, chain, model.unit_length, smooth_line(chain, model.unit_length, state, positions(model, state)).at(s)


@pytest.mark.parametrize("links", [5, 13, 41])
def test_a_parabola(links):
    # reference: s(x) = ½x√(1 + 4a²x²) + arsinh(2ax)/(4a), κ = 2a/(1 + 4a²x²)^(3/2)
    a, end = STEEP, 0.9 * LENGTH
    curve = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, 0.0, a], "range": [0.0, end]}
    _, chain, unit, found = at_rest(curve, links)
    assert isinstance(chain.excess, Tabulated)

    def arc(x):
        return 0.5 * x * np.hypot(1.0, 2.0 * a * x) + np.arcsinh(2.0 * a * x) / (4.0 * a)

    x = np.array([brentq(lambda x, s=s: arc(x) - s, -1e-9, 1.001 * end, xtol=1e-18) for s in found.s * unit])
    np.testing.assert_allclose(found.x * unit, x, rtol=0.0, atol=1e-13 * LENGTH)
    np.testing.assert_allclose(found.y * unit, a * x**2, rtol=0.0, atol=1e-13 * LENGTH)
    np.testing.assert_allclose(found.psi, np.arctan(2.0 * a * x), rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(found.speed, 1.0, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(found.bend / unit, 2.0 * a / (1.0 + (2.0 * a * x) ** 2) ** 1.5, rtol=1e-11)


def test_cubics_that_meet_within_an_element():
    # reference: the stress-free line by arc length, which is asked for its places one by one
    shares = [(0.0, 0.0), (0.23, 0.04), (0.44, -0.03), (0.61, -0.07), (0.83, 0.01), (1.0, 0.02)]
    points = [[x * LENGTH, y * LENGTH] for x, y in shares]
    scene, chain, unit, found = at_rest({"kind": "spline", "points": points}, 11)
    assert isinstance(chain.excess, Asked)
    x, y = neutral_line(scene.beams["beam"].curve).position(found.s * unit)
    np.testing.assert_allclose(found.x * unit, x, rtol=0.0, atol=1e-13 * LENGTH)
    np.testing.assert_allclose(found.y * unit, y, rtol=0.0, atol=1e-13 * LENGTH)
