"""An arch that is pressed flat on a wall, until it stands on two places and bulges off between them.

The contact places travel along the arch: the arch rolls on both places, and stands.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import cprbm
import fea_reference
from comparisons.audit import audit
from cprbm_scene import scene_from

HEIGHT = 71.5e-3
BACK = 0.910  # of the centre of the arc, left of its ends; the arch rises by 0.7 mm
WALL = -13.9e-3
LONG = 6.1e-3, 9.2e-3, 10.2e-3
STATIONS = 6.1e-3, 7.8e-3, *np.linspace(8.0e-3, 10.2e-3, 23).tolist()


def arch(stations=STATIONS):
    """A clamped arc whose upper end is pressed down, beside a wall at ``x = WALL``."""
    material = {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}
    curve = {"kind": "arc", "center": [BACK, 0.5 * HEIGHT], "start": [0.0, 0.0], "end": [0.0, HEIGHT]}
    beam = {
        "curve": {**curve, "direction": "clockwise"},
        "thickness": {"at": [0.0, 1.0], "values": [0.497e-3, 0.388e-3]},
        "width": 15.2e-3,
        "material": "pp",
        "start": {"joint": "weld", "point": "R"},
        "end": {"joint": "weld", "point": "T"},
    }
    bodies = {
        "ground": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
        "tip": {"motion": "slides", "along": [0.0, 1.0], "points": {"T": [0.0, HEIGHT]}},
    }
    plane = {"kind": "beam-half-plane", "beam": "arch", "body": "ground", "point": [WALL, 0.0], "normal": [1.0, 0.0]}
    return scene_from(
        {
            "name": "arch-on-a-wall",
            "theory": "bending",
            "materials": {"pp": material},
            "bodies": bodies,
            "beams": {"arch": beam},
            "drives": {"press": {"kind": "displacement", "point": "T", "direction": [0.0, -1.0]}},
            "contacts": {"wall": plane},
            "stages": [{"name": "press", "steps": "press", "stations": list(stations)}],
            "probes": [{"of": "scene", "quantity": "potential_energy"}, {"of": "wall", "quantity": "force"}],
        }
    )


@cache
def by_finite_elements(elements, stations=STATIONS):
    return fea_reference.answer(arch(stations), fea_reference.Settings(elements=elements, kinematics="bending"))


SOLVERS = {
    "cprbm": lambda: cprbm.answer(arch(), cprbm.Settings(links=80)),
    "fea": lambda: by_finite_elements(80),
}


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_answer_is_in_equilibrium(solver):
    answer = SOLVERS[solver]()
    assert answer.completed, answer.sentence
    assert audit(arch(), answer).complaints == ()


def test_long_steps_come_to_stand_on_the_same_places():
    """Reference: steps of a tenth of a millimetre.

    Where the arch, that lay flat, comes to stand on two places, and its least curvature falls to a fifth, contacts that
    have sunk in since they closed lead on evenly to where it stands on one, at a tenth less energy.
    """
    many, few = by_finite_elements(80), by_finite_elements(80, LONG[-1:])
    assert few.completed, few.sentence
    assert few.gone_over == many.gone_over == ()
    for probe, value in many.stations[-1].values.items():
        assert few.stations[-1].values[probe] == pytest.approx(value, rel=1e-6), probe
