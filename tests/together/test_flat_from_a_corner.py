"""A beam that lies on one side of a wedge from the corner on: held by the corner and by joints beside it at once.

Two curved beams carry a stage that is driven against a wedge; on the way the beam that meets the wedge's corner first
lies down on the side behind it.  The reference is the other solver.
"""

from __future__ import annotations

import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from
from tests.relations.image import Data

STATIONS = (0.007542, 0.01131)
PROBES = ("scene.potential_energy", "wedge.force")


def against_a_wedge() -> Data:
    polynomial = [-6.156579699768744e-05, 0.4133698196785289, 2.9604802157860597, -23.776483740342943]
    return {
        "name": "wedge",
        "materials": {"steel": {"youngs_modulus": 2.07e11, "poisson_ratio": 0.29}},
        "bodies": {
            "wall": {"motion": "fixed",
                     "points": {"R1": [-0.0009263, -0.0021248], "R2": [-0.0362271, 0.01524]}},
            "stage": {"motion": "free",
                      "points": {"T1": [0.040784, 0.0823648], "T2": [0.0107638, 0.0811231],
                                 "Q": [0.0231939, 0.1023711]}},
        },
        "beams": {
            "beam1": {"curve": {"kind": "polynomial", "axis": "y", "coefficients": polynomial,
                                "range": [-0.0021248, 0.0823648]},
                      "thickness": 0.00143, "width": 0.0249, "material": "steel",
                      "start": {"joint": "weld", "point": "R1"}, "end": {"joint": "weld", "point": "T1"}},
            "beam2": {"curve": {"kind": "arc", "center": [-0.2099785665028001, 0.18886725132084603],
                                "start": [-0.0362271, 0.01524], "end": [0.0107638, 0.0811231],
                                "direction": "counterclockwise"},
                      "thickness": 0.00102, "width": 0.0121, "material": "steel",
                      "start": {"joint": "weld", "point": "R2"}, "end": {"joint": "weld", "point": "T2"}},
        },
        "drives": {"push": {"kind": "displacement", "point": "Q", "direction": [-0.232, -0.973]}},
        "contacts": {
            "wedge": {"kind": "beam-line", "beam": "beam2", "body": "wall", "side": "right",
                      "points": [[0.0076775, 0.0514349], [0.0018705, 0.0399443], [0.022162, 0.0601339],
                                 [0.0076775, 0.0514349]]},
        },
        "stages": [{"name": "push", "steps": "push", "stations": list(STATIONS)}],
        "probes": [{"of": "scene", "quantity": "potential_energy"}, {"of": "wedge", "quantity": "force"}],
    }  # fmt: skip


@pytest.fixture(scope="module")
def reference():
    found = fea_reference.answer(
        scene_from(against_a_wedge()), fea_reference.Settings(elements=40, kinematics="bending")
    )
    assert found.completed, found.sentence
    return found


@pytest.mark.parametrize("links", [23, 26, 43])
def test_corner_and_side_hold_together(links, reference):
    answer = cprbm.answer(scene_from(against_a_wedge()), cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    for found, other in zip(answer.stations, reference.stations, strict=True):
        for probe in PROBES:
            # second order in 1/N, and what the reference's own elements leave
            assert found.values[probe] == pytest.approx(other.values[probe], rel=7.0 / links**2 + 5e-4)
