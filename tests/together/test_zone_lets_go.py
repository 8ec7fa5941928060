"""An arch pressed flat between two walls, on one of which it comes to stand with two places: one lets go, and it snaps.

Each solver is the other's reference: the CPRBM's value, which converges with the square of a link's length, is
extrapolated from two meshes.
"""

import pytest

import cprbm
import fea_reference
from cprbm_scene import Ending, Loss, scene_from


def between_walls():
    return scene_from(
        {
            "name": "between-walls",
            "materials": {"polypropylene": {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "slides", "along": [0.899, -0.438], "points": {"T": [0.341965, -0.166622]}},
            },
            "beams": {
                "arch": {
                    "curve": {
                        "kind": "arc",
                        "center": [2.0022196697169115, 3.675010342573272],
                        "start": [0.0, 0.0],
                        "end": [0.341965, -0.166622],
                        "direction": "counterclockwise",
                    },
                    "thickness": 0.00263,
                    "width": {"at": [0.0, 1.0], "values": [0.0545, 0.0934]},
                    "material": "polypropylene",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "drives": {"press": {"kind": "displacement", "point": "T", "direction": [-0.899, 0.438]}},
            "contacts": {
                "floor": {
                    "kind": "beam-half-plane",
                    "beam": "arch",
                    "body": "wall",
                    "point": [0.155696, -0.114683],
                    "normal": [0.438, 0.899],
                }
            },
            "stages": [{"name": "press", "steps": "press", "stations": [0.02119, 0.03178]}],
            "probes": [{"of": "floor", "quantity": "force"}],
        }
    )


def ended(answer):
    """At which value a contact lets go."""
    assert answer.ending is Ending.BRANCH_ENDS, answer.sentence
    (critical,) = answer.critical
    assert critical.loss is Loss.CONTACT
    assert critical.what == "floor"
    assert answer.stations[-1].values["floor.force"][0] > 0.0
    return critical.value


@pytest.fixture(scope="module")
def value():
    scene = between_walls()
    coarse, fine = (ended(cprbm.answer(scene, cprbm.Settings(links=links))) for links in (80, 160))
    return fine + (fine - coarse) / 3.0


@pytest.mark.parametrize("elements", [40, 80])
def test_the_value_at_which_one_place_of_two_lets_go_is_told(value, elements):
    got = fea_reference.answer(between_walls(), fea_reference.Settings(elements=elements, kinematics="bending"))
    assert ended(got) == pytest.approx(value, rel=5e-5)
