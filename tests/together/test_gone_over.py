"""An end of a branch that nothing asks for, beside which there is a state: both solvers go on over it alike.

A bent beam that leans on a corner and on another beam folds.  On the way from there to the state beside, tangents turn
by 0.32 rad and more, as the motion is damped, and by 0.29 rad in that state.  Each solver is the other's reference.
"""

from pathlib import Path

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import Loss, read

SCENE = Path(__file__).parent / "scenes" / "gone-over.toml"


def test_both_measure_alike_how_far_the_state_is_that_they_go_on_to():
    scene = read(SCENE)
    chain = cprbm.answer(scene, cprbm.Settings(links=80))
    beams = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    for answer in (chain, beams):
        assert answer.completed, answer.sentence
        assert not answer.critical
        assert {station.branch for station in answer.stations} == {0}
    (mine,), (theirs,) = chain.gone_over, beams.gone_over
    assert mine.end.stage == theirs.end.stage == "stage2"
    assert mine.end.loss is theirs.end.loss is Loss.FOLD
    assert mine.end.value == pytest.approx(theirs.end.value, rel=1e-4)
    assert mine.turned == pytest.approx(theirs.turned, rel=5e-3)
    assert mine.turned < 0.3
    for gone in (mine, theirs):
        assert gone.end.after < 0.95 * gone.end.energy
    assert mine.end.after == pytest.approx(theirs.end.after, rel=5e-3)
    for one, other in zip(chain.stations, beams.stations, strict=True):
        assert one.values["scene.potential_energy"] == pytest.approx(other.values["scene.potential_energy"], rel=5e-3)
        np.testing.assert_allclose(
            one.values["T.displacement"], other.values["T.displacement"], rtol=0.0, atol=1e-5, strict=True
        )


@pytest.mark.parametrize("links", [40, 160])
def test_how_far_it_is_goes_with_no_mesh(links):
    scene = read(SCENE)
    (gone,) = cprbm.answer(scene, cprbm.Settings(links=links)).gone_over
    (finer,) = fea_reference.answer(scene, fea_reference.Settings(elements=80, kinematics="bending")).gone_over
    assert gone.turned == pytest.approx(finer.turned, rel=0.01)
