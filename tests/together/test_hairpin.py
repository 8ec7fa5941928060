"""A curled strip, clamped at one end, whose other end is pressed down on it, turns upright and slips along it.

The tip passes three quarters of a turn against what it presses, and comes to lie lower than the clamp.
"""

import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from

PROBES = {"T": ["displacement"], "neck": ["force", "centre", "closing_load"], "scene": ["potential_energy"]}
POINTS = [[0.0, 0.0], [0.05, -0.004], [0.08, 0.012], [0.05, 0.034], [0.005, 0.03]]
HAIRPIN = {
    "name": "hairpin",
    "materials": {"m": {"youngs_modulus": 2e9, "poisson_ratio": 0.3}},
    "bodies": {
        "ground": {"motion": "fixed", "points": {"C": POINTS[0]}},
        "tip": {"motion": "free", "points": {"T": POINTS[-1]}},
    },
    "beams": {
        "strip": {
            "curve": {"kind": "spline", "points": POINTS, "start_direction": [1.0, 0.0]},
            "thickness": 0.001,
            "width": 0.01,
            "material": "m",
            "start": {"joint": "weld", "point": "C"},
            "end": {"joint": "weld", "point": "T"},
        }
    },
    "contacts": {"neck": {"kind": "beam-self", "beam": "strip"}},
    "loads": {"squeeze": {"kind": "force", "point": "T", "direction": [0.1, -1.0]}},
    "stages": [{"name": "load", "steps": "squeeze", "stations": [0.1, 0.4, 1.0, 2.2]}],
    "probes": [{"of": of, "quantity": quantity} for of, quantities in PROBES.items() for quantity in quantities],
}


def test_both_solvers_agree_on_a_tip_that_slips_along_its_own_beam():
    # reference: finite elements of the same theory; the CPRBM by two N and its second order
    scene = scene_from(HAIRPIN)
    coarse, fine = (cprbm.answer(scene, cprbm.Settings(links=n)) for n in (20, 40))
    truth = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    assert coarse.completed, coarse.sentence
    assert fine.completed, fine.sentence
    assert truth.completed, truth.sentence
    assert [station.values["neck.force"][0] > 0.0 for station in truth.stations] == [False, True, True, True]
    for of, quantities in PROBES.items():
        for name in (f"{of}.{quantity}" for quantity in quantities):
            for one, other, reference in zip(coarse.stations, fine.stations, truth.stations, strict=True):
                limit = (4.0 * other.values[name] - one.values[name]) / 3.0
                assert limit == pytest.approx(reference.values[name], rel=5e-3, abs=5e-5 if of == "T" else 0.0), name
