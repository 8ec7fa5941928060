"""A slider with a round nose on a leaf spring under a dead force: only the contact holds the slider."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve, minimize_scalar

import cprbm
from cprbm_scene import Ending, Loss, scene_from
from tests.cprbm.scenes import cantilever_data

LENGTH, PLACE, RADIUS, HALF = 0.1, 0.07, 0.005, 0.0005
RIGIDITY = 2e11 * 0.01 * (2.0 * HALF) ** 3 / 12.0


def scene_of(**stages):
    data = cantilever_data({"kind": "force", "point": "N", "direction": [0.0, -1.0]}, [1.0])
    data["materials"]["m"]["youngs_modulus"] = 2e11
    data["bodies"]["tip"]["points"]["T"] = [LENGTH, 0.0]
    data["bodies"]["slider"] = {"motion": "slides", "along": [0.0, 1.0], "points": {"N": [PLACE, 0.01]}}
    data["beams"]["beam"] |= {"thickness": 2.0 * HALF, "width": 0.01}
    data["beams"]["beam"]["curve"]["end"] = [LENGTH, 0.0]
    data["contacts"] = {
        "nose": {
            "kind": "beam-circle",
            "beam": "beam",
            "body": "slider",
            "center": [PLACE, RADIUS + 1.2 * HALF],
            "radius": RADIUS,
        }
    }
    (load,) = data["loads"]
    data["stages"] = [{"name": name, "steps": load, "stations": values} for name, values in stages.items()]
    data["probes"] = [{"of": "N", "quantity": "displacement"}, {"of": "nose", "quantity": "force"}]
    return scene_from(data)


@pytest.fixture(scope="module")
def largest_weight():
    """Largest weight of the equilibria, by shooting from the contact to the clamp for a tangent angle there."""
    offset = RADIUS + HALF
    start = [10.0, PLACE]

    def weight(angle):
        def clamp(unknowns):
            force, arc = unknowns
            across, down = force * np.tan(angle), -force

            def rates(_, state):
                _, _, tangent, moment = state
                cos, sin = np.cos(tangent), np.sin(tangent)
                return [-cos, -sin, -moment / RIGIDITY, cos * down - sin * across]

            x, _, tangent, _ = solve_ivp(rates, [0.0, arc], [0.0, 0.0, angle, 0.0], "DOP853", rtol=1e-8, atol=1e-10).y[
                :, -1
            ]
            return [tangent, (-x - offset * np.sin(angle) - PLACE) / PLACE]

        start[:] = fsolve(clamp, start)
        return start[0]

    for angle in -np.radians([10.0, 20.0, 30.0, 36.0]):
        weight(angle)
    found = minimize_scalar(lambda angle: -weight(angle), bounds=(-0.77, -0.63), options={"xatol": 1e-3})
    return -found.fun


@pytest.mark.parametrize("links", [20, 40, 80])
def test_the_branch_ends_at_the_largest_weight(links, largest_weight):
    # reference: the shooting above; beyond it two joints on the nose hold the slider like a valley, at any weight
    answer = cprbm.answer(scene_of(press=[5.0, 30.0, 34.0]), cprbm.Settings(links=links))
    (end,) = answer.critical
    assert answer.ending is Ending.BRANCH_ENDS
    assert end.loss is Loss.FOLD
    assert end.value == pytest.approx(largest_weight, rel=3e-4)


def test_a_pull_ends_the_branch_where_the_contact_opens():
    # reference: statics, since nothing but the contact holds the slider
    answer = cprbm.answer(scene_of(press=[1.0], pull=[-0.5]), cprbm.Settings(links=20))
    (end,) = answer.critical
    assert answer.ending is Ending.BRANCH_ENDS
    assert (end.loss, end.what) == (Loss.CONTACT, "nose")
    assert abs(end.value) < 1e-4
