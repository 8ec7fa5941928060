"""An end that slips off another's end in one long step: it is told where, and the way beyond it is none.

A beam's end, with a force on an arm, is turned along another beam until it comes past the end of that.  By the chain it
slips at 29.575 N with 40 links and at 29.615 N with 80: with errors of second order at 29.629 N.
"""

from pathlib import Path

import pytest

from cprbm_scene import Ending, Loss, read
from fea_reference import Settings, answer

SCENE = Path(__file__).parent / "scenes" / "slips-in-a-long-step.toml"
SLIPS = 29.6154 + (29.6154 - 29.5746) / 3.0


# on 20 elements the way over the fold at 7.08 N leads through the other beam, but for a stiffer penalty
@pytest.mark.parametrize("elements", [20, 40, 80])
def test_what_is_followed_does_not_go_past_an_end(elements):
    found = answer(read(SCENE), Settings(elements=elements, kinematics="bending"))
    assert found.ending is Ending.BRANCH_ENDS, found.sentence
    (critical,) = found.critical
    assert critical.loss is Loss.SLIP
    assert critical.value == pytest.approx(SLIPS, rel=5e-5)
