"""A beam that comes to lean on the held end of another, which stands on the same ground but far from its own clamp.

What the beam sees of the other is a circle of half its thickness about that end, which is the reference: the
differential equations that the room exact integrates.  From rest on both beams have an end over the other's inside.
"""

import pytest

import cprbm
import elastica_reference
import fea_reference
from cprbm_scene import scene_from

STUB = 0.00235


def data():
    return {
        "name": "lean",
        "materials": {"titanium": {"youngs_modulus": 114e9, "poisson_ratio": 0.33}},
        "bodies": {
            "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "Q": [-0.054196, -0.046605]}},
            "tip": {"motion": "free", "points": {"T": [-0.058629, -0.081119]}},
        },
        "beams": {
            "beam": {
                "curve": {
                    "kind": "polynomial",
                    "axis": "y",
                    "coefficients": [0.0, 1.9454687347806967, 15.073111629378207],
                    "range": [0.0, -0.081119],
                },
                "thickness": 0.00226,
                "width": 0.0212,
                "material": "titanium",
                "start": {"joint": "weld", "point": "R"},
                "end": {"joint": "weld", "point": "T"},
            }
        },
        "drives": {"turn": {"kind": "rotation", "body": "tip"}},
        "stages": [{"name": "turn", "steps": "turn", "stations": [0.051, 0.073]}],
        "probes": [{"of": "T", "quantity": "displacement"}, {"of": "lean", "quantity": "force"}],
    }


def on_a_stub(first, second):
    found = data()
    found["beams"]["stub"] = found["beams"]["beam"] | {
        "curve": {"kind": "line", "start": [-0.054196, -0.046605], "end": [-0.0434, -0.0974]},
        "thickness": STUB,
        "start": {"joint": "weld", "point": "Q"},
        "end": {"joint": "free"},
    }
    found["contacts"] = {"lean": {"kind": "beam-beam", "between": [first, second]}}
    return scene_from(found)


@pytest.fixture(scope="module")
def truth():
    found = data()
    circle = {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": [-0.054196, -0.046605]}
    found["contacts"] = {"lean": circle | {"radius": 0.5 * STUB}}
    answer = elastica_reference.answer(scene_from(found))
    assert answer.completed, answer.sentence
    return answer.stations


@pytest.mark.parametrize("between", [("beam", "stub"), ("stub", "beam")])
@pytest.mark.parametrize("solver", ["cprbm", "fea"])
def test_it_is_held_there(solver, between, truth):
    scene = on_a_stub(*between)
    answer = (
        cprbm.answer(scene, cprbm.Settings(links=40))
        if solver == "cprbm"
        else fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    )
    assert answer.completed, answer.sentence
    for station, true in zip(answer.stations, truth, strict=True):
        assert true.values["lean.force"][0] > 1.0
        assert station.values["lean.force"][0] == pytest.approx(true.values["lean.force"][0], rel=5e-3)
        assert station.values["T.displacement"] == pytest.approx(true.values["T.displacement"], rel=2e-3)
