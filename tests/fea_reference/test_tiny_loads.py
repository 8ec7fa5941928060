"""A beam that lies along a floor, pressed at the tip: the floor bears the whole force, however small.

And one whose tip is moved by however little.
"""

import numpy as np
import pytest

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer

YOUNG, WIDTH, THICK, LENGTH = 7.13e9, 0.0087, 0.00113, 0.0731
UNIT = YOUNG * WIDTH * THICK**3 / 12.0 / LENGTH**2


def pressed(share):
    wall = {"motion": "fixed", "points": {"R": (0.0, 0.0)}}
    tip = {"motion": "free", "points": {"P": (LENGTH, 0.0)}}
    beam = {
        "curve": {"kind": "line", "start": (0.0, 0.0), "end": (LENGTH, 0.0)},
        "thickness": THICK,
        "width": WIDTH,
        "material": "m",
        "start": {"joint": "weld", "point": "R"},
        "end": {"joint": "weld", "point": "P"},
    }
    floor = {
        "kind": "beam-half-plane",
        "beam": "b",
        "body": "wall",
        "point": (0.01, -0.5 * THICK),
        "normal": (0.0, 1.0),
    }
    return scene_from(
        {
            "name": "pressed",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.31}},
            "bodies": {"wall": wall, "tip": tip},
            "beams": {"b": beam},
            "loads": {"F": {"kind": "force", "point": "P", "direction": (0.0, -1.0)}},
            "contacts": {"k": floor},
            "stages": [{"name": "press", "steps": "F", "stations": [share * UNIT]}],
            "probes": [{"of": "k", "quantity": "force"}, {"of": "tip", "quantity": "rotation"}],
        }
    )


@pytest.mark.parametrize("share", [1e-6, 1.7e-3, 0.043])
@pytest.mark.parametrize("kinematics", ["bending", "shear"])
def test_what_presses_goes_through(share, kinematics):
    """The contact's zone is sought alike under any load, for nothing about a light beam on a floor has a scale."""
    found = answer(pressed(share), Settings(elements=80, kinematics=kinematics))
    assert found.ending is Ending.COMPLETED, found.sentence
    values = found.stations[0].values
    assert values["k.force"][0] == pytest.approx(share * UNIT, rel=1e-2)
    assert abs(values["tip.rotation"][0]) < 1e-2 * share


@pytest.mark.parametrize("share", [1.3e-9, 1e-12])
def test_what_round_off_drowns_is_no_answer(share):
    """At 80 elements round-off leaves forces of 3e-8 EI/L²: what would press is that, 2.2 and 2314 times the load."""
    found = answer(pressed(share), Settings(elements=80, kinematics="bending"))
    assert found.ending is Ending.NOT_CERTIFIED
    assert "the loads cannot be distinguished from round-off" in found.sentence


def test_no_load_is_told():
    found = answer(pressed(0.0), Settings(elements=80, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    assert found.stations[0].values["k.force"][0] == 0.0


def driven(distance, root):
    """A straight beam whose tip is moved across by so much of its length, its root welded or pinned."""
    return scene_from(
        {
            "name": "driven",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.31}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": (0.0, 0.0)}},
                "tip": {"motion": "free", "points": {"P": (LENGTH, 0.0)}},
            },
            "beams": {
                "b": {
                    "curve": {"kind": "line", "start": (0.0, 0.0), "end": (LENGTH, 0.0)},
                    "thickness": THICK,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": root, "point": "R"},
                    "end": {"joint": "weld", "point": "P"},
                }
            },
            "drives": {"d": {"kind": "displacement", "point": "P", "direction": (0.0, -1.0)}},
            "stages": [{"name": "press", "steps": "d", "stations": [distance * LENGTH]}],
            "probes": [{"of": "P", "quantity": "reaction"}, {"of": "tip", "quantity": "rotation"}],
        }
    )


@pytest.mark.parametrize("share", [1e-5, 1.7e-3])
def test_a_small_drive_meets_what_a_cantilever_resists(share):
    """Reference: 3 EI/L³, but for the square of the slope."""
    found = answer(driven(share, "weld"), Settings(elements=80, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    assert -found.stations[0].values["P.reaction"][1] == pytest.approx(3.0 * share * UNIT, rel=1e-4)


@pytest.mark.parametrize("share", [1.3e-10, 1e-12])
def test_what_a_drive_meets_below_round_off_is_no_answer(share):
    found = answer(driven(share, "weld"), Settings(elements=80, kinematics="bending"))
    assert found.ending is Ending.NOT_CERTIFIED
    assert "the reactions of drives cannot be distinguished from round-off" in found.sentence


@pytest.mark.parametrize("share", [1e-12, 0.53])
def test_a_drive_that_bends_nothing_is_one_at_any_size(share):
    """Reference: the beam turns about its pin as it is, by an angle whose sine is the way over the length."""
    found = answer(driven(share, "pin"), Settings(elements=80, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    assert found.stations[0].values["tip.rotation"][0] == pytest.approx(-np.arcsin(share), rel=1e-9)
