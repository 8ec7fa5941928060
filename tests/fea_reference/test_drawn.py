"""Beams that bend and do not stretch, drawn taut: it is told where, and no end of a branch is seen there."""

import re

import numpy as np
import pytest

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer
from fea_reference.drawn import taut_at

LENGTH, THICKNESS, WIDTH, E = 0.1037, 0.00113, 0.0087, 2.07e11


@pytest.mark.parametrize(("rise", "elements"), [(0.03, 40), (0.2, 10)])
def test_an_arc_that_is_drawn_straight_says_where_forces_have_no_limit(rise, elements):
    # reference: an arc of radius R and angle θ is R θ long, and its ends are no farther apart when it is straight
    half = 2.0 * np.arctan(2.0 * rise)
    radius = 0.5 * LENGTH / np.sin(half)
    longer = float(2.0 * half * radius - LENGTH)
    scene = scene_from(
        {
            "name": "arc",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": E, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "car": {"motion": "slides", "along": [1.0, 0.0], "points": {"T": [LENGTH, 0.0]}},
            },
            "beams": {
                "arc": {
                    "curve": {
                        "kind": "arc",
                        "center": [0.5 * LENGTH, float(-radius * np.cos(half))],
                        "start": [0.0, 0.0],
                        "end": [LENGTH, 0.0],
                        "direction": "clockwise",
                    },
                    "thickness": THICKNESS,
                    "width": WIDTH,
                    "material": "steel",
                    "start": {"joint": "pin", "point": "R"},
                    "end": {"joint": "pin", "point": "T"},
                }
            },
            "drives": {"pull": {"kind": "displacement", "point": "T", "direction": [1.0, 0.0]}},
            "stages": [{"name": "pull", "steps": "pull", "stations": [0.5 * longer, 1.3 * longer]}],
            "probes": [{"of": "T", "quantity": "displacement"}],
        }
    )
    found = answer(scene, Settings(elements=elements, kinematics="bending"))
    assert found.ending is Ending.STEP_TOO_SMALL, found.sentence
    assert len(found.stations) == 1
    assert not found.critical
    said = re.search(r"forces grow without limit as pull = (\S+) is neared", found.sentence)
    assert said is not None, found.sentence
    assert float(said[1]) == pytest.approx(longer, rel=1e-3)


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_power_is_told_from_three_values(power, sense):
    values = sense * np.array([0.3, 0.9, 1.15, 1.2175])
    limit = sense * 1.22
    pulls = [(float(v), float(abs(limit - v) ** -power)) for v in values]
    assert taut_at(pulls) == pytest.approx(limit, rel=1e-9)


@pytest.mark.parametrize(
    "force",
    [
        lambda v: 3.0 * v,
        lambda v: v**3,
        lambda v: np.exp(4.0 * v),
        lambda v: 5.0 - np.sqrt(1.3 - v),  # a fold
        lambda v: 0.7 + 0.0 * v,
    ],
)
@pytest.mark.parametrize("values", [(0.1, 0.3, 0.7, 1.2), (0.1, 0.9, 1.1, 1.15, 1.1625)])
def test_what_has_a_limit_is_not_taut(force, values):
    assert taut_at([(v, float(force(v))) for v in values]) is None
