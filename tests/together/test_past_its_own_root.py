"""A strip whose width varies is rolled up by more than a turn: its end comes past its root, and not through it.

However few stations there are, it is the same state; the chain, an independent solver, says so too.
"""

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from


def rolled(*stations):
    return scene_from(
        {
            "name": "past-its-root",
            "materials": {"steel": {"youngs_modulus": 2.07e11, "poisson_ratio": 0.29}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "free", "points": {"T": [0.0333542, 0.0128739]}},
            },
            "beams": {
                "strip": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.0333542, 0.0128739]},
                    "thickness": 0.000128,
                    "width": {"at": [0.0, 0.3, 0.9, 1.0], "values": [0.00479, 0.00422, 0.00444, 0.00284]},
                    "material": "steel",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "drives": {"roll": {"kind": "rotation", "body": "tip"}},
            "contacts": {"itself": {"kind": "beam-self", "beam": "strip"}},
            "stages": [{"name": "roll", "steps": "roll", "stations": list(stations)}],
            "probes": [{"of": "T", "quantity": "displacement"}, {"of": "itself", "quantity": "force"}],
        }
    )


def last(answer):
    assert answer.completed, answer.sentence
    return np.concatenate(list(answer.stations[-1].values.values()))


@pytest.mark.parametrize("elements", [40, 80])
def test_in_a_long_step_the_end_does_not_go_through_what_is_behind_its_root(elements):
    settings = fea_reference.Settings(elements=elements, kinematics="bending")
    at_once = last(fea_reference.answer(rolled(-7.166), settings))
    by_and_by = last(fea_reference.answer(rolled(-6.33, -6.4, -6.6, -6.9, -7.166), settings))
    chain = [last(cprbm.answer(rolled(-7.166), cprbm.Settings(links=links))) for links in (80, 160)]
    assert at_once == pytest.approx(by_and_by, rel=1e-6)  # as far as penalties are tightened
    assert at_once == pytest.approx(chain[1] + (chain[1] - chain[0]) / 3.0, rel=1e-4)
