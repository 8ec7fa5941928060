"""Shallow arcs that are pressed onto what is flat: several equilibria are minima, and one belongs to the way from rest.

An arc that hardly rises resists its own shortening at first and soon gives way: its links' rates at rest make of a way
ten times what the links turn by.  On the way it lies down on the plane, comes off it in the middle and stands on two
places.  The references are the other solver, in steps so short that none leads elsewhere.
"""

from __future__ import annotations

import numpy as np
import pytest

import cprbm
import fea_reference
from comparisons.relations.image import Data
from scene import Ending
from scene.answer import Loss
from scene.reading import scene_from

FIRST, SECOND = 0.00937, 0.0113  # on the branch; beyond its end
END = 0.01085  # of the branch, by the finite elements (40 elements, `beyond = "stop"`)
SHORT = np.linspace(0.0, FIRST, 13)[1:]


def pressed(*stations: float) -> Data:
    """An arc with a rise of 1/100 whose pinned end is pressed towards the clamped one, beside a half-plane."""
    return {
        "name": "pressed",
        "materials": {"abs": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
        "bodies": {
            "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
            "tip": {"motion": "slides", "along": [0.6971, -0.717], "points": {"T": [-0.206506, 0.212404]}},
        },
        "beams": {
            "beam": {
                "curve": {"kind": "arc", "direction": "counterclockwise", "start": [0.0, 0.0],
                          "end": [-0.206506, 0.212404], "center": [-1.9015239945920641, -1.64213489577046]},
                "thickness": 0.0018,
                "width": 0.0648,
                "material": "abs",
                "start": {"joint": "weld", "point": "R"},
                "end": {"joint": "pin", "point": "T"},
            }
        },
        "drives": {"press": {"kind": "displacement", "point": "T", "direction": [0.6971, -0.717]}},
        "contacts": {
            "plane": {"kind": "beam-half-plane", "beam": "beam", "body": "wall",
                      "point": [-0.090096, 0.118993], "normal": [-0.717, -0.6971]}
        },
        "stages": [{"name": "press", "steps": "press", "stations": list(stations)}],
        "probes": [{"of": "scene", "quantity": "potential_energy"}, {"of": "plane", "quantity": "force"}],
    }  # fmt: skip


@pytest.fixture(scope="module")
def in_short_steps():
    return fea_reference.answer(scene_from(pressed(*SHORT)))


# before two of these the rows that press follow each other in a circle of four
@pytest.mark.parametrize("stations", [(FIRST,), (0.0041, FIRST), (0.00571, FIRST), (0.00586, FIRST)])
def test_a_long_step_ends_where_short_ones_do(stations, in_short_steps):
    answer = cprbm.answer(scene_from(pressed(*stations)))
    assert answer.completed
    found, reference = answer.stations[-1].values, in_short_steps.stations[-1].values
    # both are known to 1.5 %; another branch has a quarter of the energy
    for probe in ("scene.potential_energy", "plane.force"):
        np.testing.assert_allclose(found[probe], reference[probe], rtol=0.03)


def test_where_one_of_two_places_lets_go_the_branch_ends():
    answer = cprbm.answer(scene_from(pressed(FIRST, SECOND)))
    assert answer.ending is Ending.BRANCH_ENDS
    (lost,) = answer.critical
    assert (lost.loss, lost.what) == (Loss.CONTACT, "plane")
    assert lost.value == pytest.approx(END, rel=0.015)
