"""A cantilever that lies on the free end of a strut, pressed so hard that loose penalties give way by its thickness."""

import pytest

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer

LENGTH, PLACE, STRUT = 0.107, 0.0981, 0.0211  # m
THIN, WIDE, YOUNG = 0.00009, 0.0123, 117e9
GAP = 0.00002  # m, at rest
BENDING = YOUNG * WIDE * THIN**3 / 12.0


def propped(load):
    top = -GAP - THIN
    return scene_from(
        {
            "name": "propped",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.33}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "S": [PLACE, top - STRUT]}},
                "tip": {"motion": "free", "points": {"T": [LENGTH, 0.0]}},
            },
            "beams": {
                "cantilever": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]},
                    "thickness": THIN,
                    "width": WIDE,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                },
                "strut": {
                    "curve": {"kind": "line", "start": [PLACE, top - STRUT], "end": [PLACE, top]},
                    "thickness": THIN,
                    "width": WIDE,
                    "material": "m",
                    "start": {"joint": "weld", "point": "S"},
                    "end": {"joint": "free"},
                },
            },
            "loads": {"press": {"kind": "force", "point": "T", "direction": [0.0, -1.0]}},
            "contacts": {"prop": {"kind": "beam-beam", "between": ["cantilever", "strut"]}},
            "stages": [{"name": "press", "steps": "press", "stations": [load]}],
            "probes": [
                {"of": "prop", "quantity": "force"},
                {"of": "T", "quantity": "displacement"},
            ],
        }
    )


def test_what_it_bears_is_what_a_propped_cantilever_asks():
    """Reference: the linear theory of a cantilever on a prop; slopes are up to 0.02, and their squares 4e-4."""
    over = LENGTH - PLACE
    load = 0.02 * 4.0 * BENDING / (over * PLACE)
    found = answer(propped(load), Settings(elements=11, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    values = found.stations[-1].values
    expected = 0.5 * load * (3.0 * LENGTH / PLACE - 1.0) - 3.0 * BENDING * GAP / PLACE**3
    assert values["prop.force"] == pytest.approx(expected, rel=2e-3)
