"""The solid on the paper's mechanisms, coarse, beside the finite elements that shear, and where it once went wrong.

The full runs are commands: ``cprbm compare hinge gripper --solver cprbm,fea,solid``.
"""

import numpy as np

import fea_reference
from comparisons.cases import opened
from fea_reference import solid
from fea_reference.solid.passing import lines_cross_on_way


def at_last(name):
    """A case with its last station alone."""
    scene = opened(name)
    stage = scene.stages[-1]
    return scene.model_copy(
        update={"stages": (stage.model_copy(update={"stations": stage.stations[-1:], "shown": ()}),)}
    )


def values(answer):
    assert answer.completed, answer.sentence
    return answer.stations[-1].values


def off(ours, theirs):
    return float(np.linalg.norm(ours - theirs) / np.linalg.norm(theirs))


def test_the_gripper_at_full_load_moves_as_the_shear_beams():
    scene = at_last("gripper")
    ours = values(solid.answer(scene, solid.Settings(elements=20, across=1)))
    beams = values(fea_reference.answer(scene, fea_reference.Settings(elements=60, kinematics="shear")))
    for probe in ("A.displacement", "B.displacement", "O.displacement"):
        assert off(ours[probe], beams[probe]) < 3e-3
    # sought within one long step, made with looser penalties: stations just before and after it show it open and closed
    closing = float(ours["contact.closing_load"][0])
    beside = [share * closing for share in (1.0 - 3e-6, 1.0 + 3e-6)]
    scene = scene.model_copy(update={"stages": (scene.stages[0].model_copy(update={"stations": beside}),)})
    before, after = solid.answer(scene, solid.Settings(elements=20, across=1)).stations
    assert before.values["contact.force"][0] == 0.0
    assert after.values["contact.force"][0] > 0.0


def test_a_line_that_goes_through_anothers_end_is_seen_on_its_way():
    held = np.array([[0.51, 0.0], [1.1, 0.003], [1.9, 0.0]])
    above, below = (np.array([[0.0, y], [0.43, y + 0.004], [1.0, y - 0.02]]) for y in (0.17, -0.13))
    assert lines_cross_on_way(above, below, held, held)
    assert not lines_cross_on_way(above, above - [0.0, 0.1], held, held)
