"""From a fold down to where the decrease of the energy leads, in few steps.

Beyond a fold the potential is a cubic along the way, Π = −b x³, x from the fold, and its curvature −6 b x.  A step with
the drag c times that goes by r x, 2 c r = (1 + r)²: none exists below c = 2, and above it r is what is left of the
growth, r = 0.38 at 2.5 and 0.07 at 8.  A fall by steps of which every other fails, or that stay in a corner of what a
step may be, takes five times as many.
"""

import numpy as np
import pytest

from cprbm_scene import scene_from
from fea_reference import Settings, answer, descent, prepared
from fea_reference.assembly import assemble_ends
from fea_reference.following import follow_branch
from fea_reference.travel import Course, reach
from tests.together import branches

TURNED = 0.75  # rad; the free beam has snapped before


def at_the_fold():
    """The march of the beam that hangs below, at the fold, and how it is lost there."""
    scene = scene_from(branches.snap([[0.5]]))
    march = prepared(scene, Settings(elements=16, kinematics="bending")).march
    assemble_ends(scene, march)
    reach(march, Course(0, TURNED), 0.5)
    return march, follow_branch(march, 0, TURNED, TURNED)


def test_a_fall_beyond_a_fold_takes_few_steps(monkeypatch):
    # reference: the cubic above, by which every step can be made; the one that fails is where it is a cubic no more
    march, lost = at_the_fold()
    failed, step = [], descent._step

    def watched(march, load, anchor, drag, start):
        made = step(march, load, anchor, drag, start)
        failed.extend([] if made or not drag > 0.0 else [drag])
        return made

    monkeypatch.setattr(descent, "_step", watched)
    assert descent.descend(march, 0, TURNED, TURNED, lost) is not None
    assert len(failed) <= 2


@pytest.mark.parametrize("elements", [20, 40])
def test_a_contact_that_closes_in_a_fall_closes_at_the_critical_load(elements):
    # reference: Euler, π² EI/L²; the load stays as it is while the column falls to the peg
    data = branches.column_between_pegs([5.0, 12.0], gap=2e-3, beyond="jump")
    data["probes"].append({"of": "right", "quantity": "closing_load"})
    values = answer(scene_from(data), Settings(elements=elements, kinematics="bending")).stations[-1].values
    assert values["right.closing_load"] == pytest.approx(np.pi**2 * branches.FORCE, rel=1e-5)
