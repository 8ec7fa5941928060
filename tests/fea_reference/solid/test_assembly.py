"""Ends of solids that are drawn apart from their points."""

import numpy as np
import pytest

from cprbm_scene import SceneError, scene_from
from fea_reference import solid
from tests.together.features import LENGTH, bowed


def test_an_end_that_is_assembled_turns_freely_about_its_point():
    # no moment acts at the pin: about the root that of its force alone, at the point where the end has been brought
    found = solid.answer(scene_from(bowed()), solid.Settings(elements=12, across=1))
    assert found.completed, found.sentence
    values = found.stations[-1].values
    force, (x, y) = values["T.reaction"], (0.085, 0.04)
    assert values["R.reaction"] == pytest.approx(-force, rel=1e-7)
    assert values["R.reaction_moment"][0] == pytest.approx(y * force[0] - x * force[1], rel=1e-6)
    assert np.hypot(x, y) < LENGTH  # so that it is bowed


def test_a_stop_that_forbids_the_assembly_is_told():
    data = bowed()
    data["bodies"]["wall"]["points"]["W"] = [0.2, 0.04]
    data["stops"] = {"no": {"beam": "beam", "end": "end", "towards": "W", "least": 0.1, "most": 0.2}}
    with pytest.raises(SceneError, match="forbids the assembly"):
        solid.answer(scene_from(data), solid.Settings(elements=12, across=1))
