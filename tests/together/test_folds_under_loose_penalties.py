"""A branch that ends with tight penalties and leads on with loose ones is told to end, where it does.

A pinned beam is pressed on an arch, both as lines, until both fold.  With the penalties of a long step the beams sink
into each other by a hundredth of their length instead, and none tighter leads back.  By the chain they fold at 1037.64
with 160 links and at 1038.33 with 320: with errors of second order at 1038.57 N m.
"""

from pathlib import Path

import pytest

from cprbm_scene import Ending, Loss, read
from fea_reference import Settings, answer

SCENE = Path(__file__).parent / "scenes" / "folds-under-loose-penalties.toml"
FOLDS = -1038.334 - (1038.334 - 1037.639) / 3.0


def test_what_cannot_be_tightened_is_followed_with_tight_penalties():
    found = answer(read(SCENE), Settings(elements=40, kinematics="bending"))
    assert found.ending is Ending.BRANCH_ENDS, found.sentence
    (critical,) = found.critical
    assert critical.loss is Loss.FOLD
    assert critical.value == pytest.approx(FOLDS, rel=1e-4)
