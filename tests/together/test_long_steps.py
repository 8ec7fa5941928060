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
from cprbm_scene import Ending, Loss, scene_from
from tests.relations.image import Data

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


# the chain and the finite elements, both in the theory of bending, in steps of 0.1 mm: of these, which cannot pass it,
# with 160 elements the squares of the smallest curvature at 25.3 and 25.4 mm come to nothing at 25.427 mm
FOLDS = 0.025427


def uneven() -> Data:
    """An arc with a rise of 1/90 whose thickness varies, and which stands on two places of a plane before it folds."""
    data = pressed(0.02016, 0.03024)
    data["beams"]["beam"] |= {
        "curve": {"kind": "arc", "direction": "counterclockwise", "start": [0.0, 0.0],
                  "end": [-0.165874, -0.202581], "center": [2.1392229414476525, -1.9208024884277788]},
        "thickness": {"at": [0.0, 0.4, 1.0], "values": [0.00171, 0.00126, 0.00163]},
        "width": 0.0256,
    }  # fmt: skip
    data["materials"]["abs"] = {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}
    data["bodies"]["tip"] |= {"along": [-0.6335, -0.7737], "points": {"T": [-0.165874, -0.202581]}}
    data["drives"]["press"]["direction"] = [0.6335, 0.7737]
    data["contacts"]["plane"] |= {"point": [-0.112711, -0.076911], "normal": [0.7737, -0.6335]}
    return data


@pytest.mark.parametrize(("links", "within"), [(40, 0.006), (80, 0.003)])
def test_what_joints_of_even_elements_hold_does_not_hide_a_fold(links, within):
    # two joints beside a place hold it as the place itself does not, up to 26.3 mm, where one of them lets go
    answer = cprbm.answer(scene_from(uneven()), cprbm.Settings(links=links))
    assert answer.ending is Ending.BRANCH_ENDS, answer.sentence
    (lost,) = answer.critical
    assert lost.loss is Loss.FOLD
    assert lost.value == pytest.approx(FOLDS, rel=within)


def test_loose_penalties_do_not_lead_past_a_fold():
    # from loose penalties at 26 mm tight ones lead to another branch, that folds at 26.4 mm
    settings = fea_reference.Settings(elements=80, kinematics="bending")
    answer = fea_reference.answer(scene_from(uneven()), settings)
    assert answer.ending is Ending.BRANCH_ENDS, answer.sentence
    (lost,) = answer.critical
    assert lost.loss is Loss.FOLD
    assert lost.value == pytest.approx(FOLDS, rel=0.001)


# chains of 40, 80 and 160 links let go at 2.62714, 2.59212 and 2.58351 mm, by ratios of 4: at 2.5807 mm in the limit
LETS_GO = 0.0025807


def slender() -> Data:
    """An arc with a rise of 1/180, of which the plane is let go while all that holds it is stiff."""
    data = pressed(0.002343, 0.003515)
    data["materials"]["abs"] = {"youngs_modulus": 2.07e11, "poisson_ratio": 0.29}
    data["beams"]["beam"] |= {
        "curve": {"kind": "arc", "direction": "counterclockwise", "start": [0.0, 0.0],
                  "end": [0.0182938, 0.0222294], "center": [-0.49997700863687505, 0.43010086066206304]},
        "thickness": 0.000166,
        "width": 0.0042,
        "end": {"joint": "weld", "point": "T"},
    }  # fmt: skip
    data["bodies"]["tip"] |= {"along": [0.6354, 0.7721], "points": {"T": [0.0182938, 0.0222294]}}
    data["drives"]["press"]["direction"] = [-0.6354, -0.7721]
    data["contacts"]["plane"] |= {"point": [0.0112758, 0.0093627], "normal": [-0.7721, 0.6354]}
    return data


def test_a_contact_that_no_step_follows_to_its_end_is_foreseen_to_let_go():
    # what its penalty leaves folds just before
    settings = fea_reference.Settings(elements=40, kinematics="bending")
    answer = fea_reference.answer(scene_from(slender()), settings)
    assert answer.ending is Ending.BRANCH_ENDS, answer.sentence
    (lost,) = answer.critical
    assert (lost.loss, lost.what) == (Loss.CONTACT, "plane")
    assert lost.value == pytest.approx(LETS_GO, rel=1e-3)
    assert lost.curvature > 0.0 > lost.left
