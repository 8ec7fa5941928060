"""A branch that goes by a bifurcation which is none: an imperfect one, where it comes close to another and turns off.

A stage on three legs, one of them pushed aside: the smallest curvature falls to a twentieth of what it was, near the
value at which the legs of a straight stage would buckle, and rises again.  The straight way on has a negative curvature
from there, and a long step along the branch leads to it.  The chain of links follows its own branch through.
"""

from pathlib import Path

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import read

SCENE = Path(__file__).parent / "scenes" / "beside-a-fork.toml"


# stretch and shear make a hundredth of what so nearly buckles
@pytest.mark.parametrize(("kinematics", "within"), [("bending", 5e-3), ("shear", 2e-2)])
def test_a_step_to_the_branch_beside_tells_no_bifurcation(kinematics, within):
    scene = read(SCENE)
    chain = cprbm.answer(scene, cprbm.Settings(links=40))
    beams = fea_reference.answer(scene, fea_reference.Settings(elements=20, kinematics=kinematics))
    for answer in (chain, beams):
        assert answer.completed, answer.sentence
        assert not answer.critical
    mine, theirs = chain.stations[0].values, beams.stations[0].values
    assert mine["scene.potential_energy"] == pytest.approx(theirs["scene.potential_energy"], rel=within)
    off = np.linalg.norm(mine["T1.displacement"] - theirs["T1.displacement"])
    assert off < within * np.linalg.norm(theirs["T1.displacement"])
