"""A station just before an end slips off a corner, and behind where the finite elements' penalty ends the branch.

A slider's corner is pushed along a thick beam to 2 μm before its end.  There a penalty that is as stiff as its depth
asks lets the branch fold back 30 μm before.  The chain, which has none, is the reference.
"""

from pathlib import Path

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import read

SCENE = Path(__file__).parent / "scenes" / "just-before-it-slips.toml"


def test_the_station_is_reached_by_a_stiffer_penalty():
    scene = read(SCENE)
    chain = cprbm.answer(scene, cprbm.Settings(links=80))
    beams = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    for answer in (chain, beams):
        assert answer.completed, answer.sentence
    mine, theirs = chain.stations[-1].values, beams.stations[-1].values
    np.testing.assert_allclose(mine["T.displacement"], theirs["T.displacement"], rtol=0.0, atol=2e-7, strict=True)
    assert mine["contact1.force"] == pytest.approx(theirs["contact1.force"], rel=1e-4)
