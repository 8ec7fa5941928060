"""A beam pinned on the plane that it is tangent to, drawn with few digits: it leaves the pin behind the plane by those.

It is free of stress as drawn.  The two solvers meet, which they would not if one turned the beam to the plane first:
the energies would then be apart by twice the rounding over the rotation, 2e-5.
"""

import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from

DATA = {
    "name": "rounded",
    "materials": {"abs": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
    "bodies": {
        "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
        "tip": {"motion": "free", "points": {"T": [0.037145, 0.0067349]}},
    },
    "beams": {
        "beam": {
            "curve": {
                "kind": "arc",
                "center": [0.027444738348954, -0.045565614109622454],
                "start": [0.0, 0.0],
                "end": [0.037145, 0.0067349],
                "direction": "clockwise",
            },
            "thickness": 0.000131,
            "width": 0.00428,
            "material": "abs",
            "start": {"joint": "pin", "point": "R"},
            "end": {"joint": "weld", "point": "T"},
        }
    },
    "drives": {"press": {"kind": "displacement", "point": "T", "direction": [-0.445, 0.899]}},
    "contacts": {
        "plane": {
            "kind": "beam-half-plane",
            "beam": "beam",
            "body": "wall",
            "point": [0.0, 0.0],
            "normal": [0.515950632989352, -0.8566183189249965],
            "thick": False,
        }
    },
    "stages": [{"name": "press", "steps": "press", "stations": [0.004441]}],
    "probes": [{"of": "scene", "quantity": "potential_energy"}],
}


def energy(answer):
    assert answer.completed, answer.sentence
    return float(answer.stations[-1].values["scene.potential_energy"][0])


def test_both_begin_where_the_beam_is_drawn():
    scene = scene_from(DATA)
    coarse, fine = (energy(cprbm.answer(scene, cprbm.Settings(links=n))) for n in (90, 180))
    elements = energy(fea_reference.answer(scene, fea_reference.Settings(elements=30, kinematics="bending")))
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(elements, rel=1e-6)
