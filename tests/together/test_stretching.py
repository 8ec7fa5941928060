"""A linkage without springs that is drawn into one line, and holds from there on.

A cantilever's tip is pinned to a link whose other end slides along the beam, without friction, so that the link carries
nothing until it stands upright.  From there on the tip stays where it is, at the height of the link's length over the
slide, and the slide carries all of the force that is more than 3 E·I y/L³ (small deflections: y/L is 0.8 %, and its
square is what the formula leaves out).
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import Answer, Ending, Loss, scene_from
from tests.relations.image import Data

LENGTH, THICKNESS, WIDTH, YOUNGS_MODULUS = 0.0973, 0.00117, 0.0083, 2.07e11
ASIDE, BELOW = 0.0071, 0.0317
RISE = math.hypot(ASIDE, BELOW) - BELOW
STIFFNESS = 3.0 * YOUNGS_MODULUS * WIDTH * THICKNESS**3 / 12.0 / LENGTH**3
NEEDED = STIFFNESS * RISE
LINKS = 43
SOLVERS = ("cprbm", "bending", "shear")


def lifted(*stations: float) -> Data:
    """The tip is lifted by forces of so many times what lifts it to where the link stands upright."""
    return {
        "name": "lifted",
        "theory": "bending",
        "materials": {"steel": {"youngs_modulus": YOUNGS_MODULUS, "poisson_ratio": 0.29}},
        "bodies": {
            "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
            "tip": {"motion": "free", "points": {"T": [LENGTH, 0.0]}},
            "link": {"motion": "slides", "along": [1.0, 0.0], "turns": True, "about": "K",
                     "points": {"J": [LENGTH, 0.0], "K": [LENGTH - ASIDE, -BELOW]}},
        },
        "pins": {"joint": {"points": ["T", "J"]}},
        "beams": {
            "beam": {"curve": {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]}, "thickness": THICKNESS,
                     "width": WIDTH, "material": "steel", "start": {"joint": "weld", "point": "R"},
                     "end": {"joint": "weld", "point": "T"}},
        },
        "loads": {"up": {"kind": "force", "point": "T", "direction": [0.0, 1.0]}},
        "stages": [{"name": "lift", "steps": "up", "stations": [NEEDED * part for part in stations]}],
        "probes": [{"of": "T", "quantity": "displacement"}, {"of": "link", "quantity": "reaction"}],
    }  # fmt: skip


def _answer(data: Data, solver: str) -> Answer:
    """By links, or by finite elements in a theory."""
    if solver == "cprbm":
        return cprbm.answer(scene_from(data), cprbm.Settings(links=LINKS))
    return fea_reference.answer(scene_from(data), fea_reference.Settings(elements=20, kinematics=solver))


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("stations", [(0.47, 2.3), (2.3,), (0.99, 1.01, 7.9)])
def test_the_slide_carries_what_the_beam_does_not(stations, solver):
    answer = _answer(lifted(*stations), solver)
    # from an inclined link, round-off decides whether Newton's method of the chain passes the dead point
    assert answer.completed or (solver == "cprbm" and answer.ending is Ending.STEP_TOO_SMALL), answer.sentence
    for part, station in zip(stations, answer.stations, strict=answer.completed):
        lift, pull = station.values["T.displacement"][1], station.values["link.reaction"]
        assert lift == pytest.approx(min(part, 1.0) * RISE, rel=1.0 / LINKS**2)
        np.testing.assert_allclose(pull, (0.0, -max(part - 1.0, 0.0) * NEEDED), atol=NEEDED / LINKS**2)


def test_on_the_way_back_a_link_that_would_be_pushed_is_no_minimum():
    # reference: less force than NEEDED leaves a push in the link, which nothing keeps from turning; to which side it
    # folds then nothing says
    data = lifted(2.3)
    data["stages"].append({"name": "back", "steps": "up", "stations": [0.31 * NEEDED]})
    answer = _answer(data, "cprbm")
    # both ends are at the dead point: before the first station, or after it on the way back
    assert answer.ending is (Ending.NOT_A_MINIMUM if answer.stations else Ending.STEP_TOO_SMALL)
    last = float(answer.sentence.rsplit(" ", 1)[1])
    assert last == pytest.approx(NEEDED, rel=1.0 / LINKS**2)
    answer = _answer(data, "bending")
    assert answer.ending is Ending.BRANCH_ENDS, answer.sentence
    assert len(answer.stations) == 1
    (critical,) = answer.critical
    assert critical.loss is Loss.BIFURCATION
    assert critical.value == pytest.approx(NEEDED, rel=1.0 / LINKS**2)
