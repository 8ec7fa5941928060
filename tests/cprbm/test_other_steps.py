"""An answer hangs on its load, not on the loads before.

The gripper on nine elements has a contact beside a border of elements at 12.8 N, where meshes take turns, and one that
closes where the mesh fits its other contact to a part of an element.
"""

from pathlib import Path

import numpy as np
import pytest

import cprbm
from comparisons import cases
from cprbm_scene import scene_from

GRIPPER = Path(__file__).parents[2] / "comparisons" / "cases" / "gripper.toml"


def at_the_end(stations):
    data = cases.data("gripper")
    data["claims"] = []
    data["stages"] = [{"name": "load", "steps": "F", "stations": stations}]
    answer = cprbm.answer(scene_from(data), cprbm.Settings(links=9))
    assert answer.completed, answer.sentence
    return answer.stations[-1].values


def test_a_load_split_otherwise_leads_to_the_same_state():
    # reference: the same load at once; each probe by the largest of its numbers
    at_once, by_steps = at_the_end([12.8]), at_the_end([4.8, 9.6, 11.3, 12.8])
    assert at_once["contact.closing_load"].size == 1
    for probe, value in at_once.items():
        scale = float(np.max(np.abs(value), initial=0.0))
        assert by_steps[probe] == pytest.approx(value, rel=0.0, abs=1e-7 * scale), probe
