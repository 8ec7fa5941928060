"""A beam that lies on a floor along its whole length at rest: pressed on it, lifted off it, left alone."""

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, cantilever_data, force
from tests.fea_reference.cantilever import elastica

SOLVERS = {
    "cprbm": lambda scene: cprbm.answer(scene, cprbm.Settings(links=40)),
    "fea": lambda scene: fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending")),
}
FLOORS = {
    "half-plane": {"kind": "beam-half-plane", "point": [0.013, -0.5 * THICKNESS], "normal": [0.0, 1.0]},
    "line": {
        "kind": "beam-line",
        "points": [[-0.1 * LENGTH, -0.5 * THICKNESS], [1.1 * LENGTH, -0.5 * THICKNESS]],
        "side": "left",
    },
}
PRESSED, LIFTED = 0.7, 0.43  # F L²/(E I)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("floor", FLOORS)
def test_it_is_pressed_then_lifted(solver, floor):
    # reference: where it is pressed at its tip the floor takes all of the force and nothing moves; lifted it is the
    # elastica of Bisshopp and Drucker; with no load at all every number is nought
    unit = RIGIDITY / LENGTH**2
    data = cantilever_data(force(0.0, 1.0), [0.0, -PRESSED * unit, LIFTED * unit])
    data["contacts"] = {"floor": {**FLOORS[floor], "beam": "beam", "body": "wall"}}
    data["probes"] += [{"of": "floor", "quantity": "force"}]
    answer = SOLVERS[solver](scene_from(data))
    assert answer.completed, answer.sentence
    rest, pressed, lifted = (station.values for station in answer.stations)
    assert all(np.max(np.abs(value), initial=0.0) <= 1e-15 * LENGTH for value in rest.values())
    # the finite elements let the last of them sink in by what the penetration asked allows, a ten-thousandth
    assert np.max(np.abs(pressed["T.displacement"])) < 2e-4 * THICKNESS
    assert pressed["floor.force"][0] == pytest.approx(PRESSED * unit, rel=5e-3)
    x, y, turned = elastica(LIFTED)
    assert lifted["floor.force"][0] == 0.0
    assert lifted["T.displacement"] == pytest.approx([LENGTH * (x - 1.0), LENGTH * y], rel=1e-3)
    assert lifted["tip.rotation"][0] == pytest.approx(turned, rel=1e-3)
