"""Stability of a column between circles that touch without force: contact forbids a motion in a single sense."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import Ending, Loss, scene_from
from tests.references import columns
from tests.together.branches import FORCE, column_between_pegs
from tests.together.pivots import LENGTH, MATERIALS, THICKNESS, line, pin, weld


@pytest.mark.parametrize("links", [20, 21])
@pytest.mark.parametrize(("sides", "times"), [(("left", "right"), 4.0), (("left",), 1.0), (("right",), 1.0)])
def test_a_touching_circle_forbids_one_sense_of_a_mode(sides, times, links):
    # Euler: a half wave where the middle is free on one side, two half waves between circles on both sides
    euler = columns.critical("pinned")
    scene = scene_from(column_between_pegs([0.5 * euler, 5.0 * euler], sides=sides, beyond="stop"))
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    (critical,) = answer.critical
    assert answer.ending is Ending.BRANCH_ENDS
    assert critical.loss is Loss.BIFURCATION
    assert critical.value == pytest.approx(times * euler * FORCE, rel=1e-3)


@pytest.mark.parametrize("links", [20, 40])
def test_a_pinned_leaf_lies_on_a_slipper_that_touches_as_drawn(links):
    """Without the contact the leaf turns freely about the pin."""
    tip, radius = np.array([1.05, -0.01]) * LENGTH, 0.09 * LENGTH
    across = np.array([-0.21, -1.05]) / np.hypot(0.21, 1.05)
    center = tip - 0.05 * np.array([1.05, -0.21]) * LENGTH + (radius + 0.5 * THICKNESS) * across
    leaf = {"thickness": THICKNESS, "width": 0.01, "material": "m"}
    arms = {
        "l": leaf | {"curve": line([-LENGTH, 0.0], [0.0, 0.2 * LENGTH]), "start": pin("A"), "end": weld("M")},
        "r": leaf | {"curve": line([0.0, 0.2 * LENGTH], tip.tolist()), "start": weld("M"), "end": {"joint": "free"}},
    }
    slipper = {"kind": "beam-circle", "beam": "r", "body": "wall", "center": center.tolist(), "radius": radius}
    scene = scene_from(
        {
            "name": "slipper",
            "theory": "bending",
            "materials": MATERIALS,
            "bodies": {
                "wall": {"motion": "fixed", "points": {"A": [-LENGTH, 0.0]}},
                "middle": {"motion": "free", "points": {"M": [0.0, 0.2 * LENGTH]}},
            },
            "beams": arms,
            "contacts": {"k": slipper},
            "loads": {"F": {"kind": "force", "point": "M", "direction": [0.0, -1.0]}},
            "stages": [{"name": "on", "steps": "F", "stations": [0.1 * FORCE, FORCE]}],
            "probes": [{"of": "A", "quantity": "reaction"}, {"of": "k", "quantity": "force"}],
        }
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    for station, load in zip(answer.stations, (0.1 * FORCE, FORCE), strict=True):
        # statics: the slipper bears the load less the reaction of the pin
        pushed = [0.0, load] - station.values["A.reaction"]
        assert 0.4 * load < pushed[1] < 0.6 * load
        assert station.values["k.force"] == pytest.approx([np.hypot(*pushed)], rel=1e-9)
