"""A strip rolled up by its tip, so that its side comes to lie on the end that is clamped: each solver for itself."""

from functools import cache

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import Ending, scene_from


@cache
def rolled(*, tapered, backwards=False):
    clamp, tip = [0.0, 0.0], [-0.0221345, 0.0949954]
    ends, names = ([clamp, tip], ["R", "T"])
    if backwards:
        ends, names = ends[::-1], names[::-1]
    turn = slice(None, None, -1) if backwards else slice(None)
    thickness = (0.000358, 0.000376) if tapered else (0.000367, 0.000367)
    at, widths = (0.0, 0.3, 0.9, 1.0), (0.0205, 0.0155, 0.0167, 0.0112)
    along = [1.0 - one for one in at[::-1]] if backwards else at
    return scene_from(
        {
            "name": "rolled-past-its-root",
            "materials": {"m": {"youngs_modulus": 114e9, "poisson_ratio": 0.33}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": clamp}},
                "tip": {"motion": "free", "points": {"T": tip}},
            },
            "beams": {
                "strip": {
                    "curve": {
                        "kind": "arc",
                        "center": [0.08437837590941112, 0.06973710534691006],
                        "start": ends[0],
                        "end": ends[1],
                        "direction": "counterclockwise" if backwards else "clockwise",
                    },
                    "thickness": {"at": [0.0, 1.0], "values": thickness[turn]},
                    "width": {"at": along, "values": widths[turn]},
                    "material": "m",
                    "start": {"joint": "weld", "point": names[0]},
                    "end": {"joint": "weld", "point": names[1]},
                }
            },
            "drives": {"roll": {"kind": "rotation", "body": "tip"}},
            "contacts": {"itself": {"kind": "beam-self", "beam": "strip"}},
            "stages": [{"name": "roll", "steps": "roll", "stations": [-6.218]}],
            "probes": [
                {"of": "scene", "quantity": "potential_energy"},
                {"of": "T", "quantity": "displacement"},
                {"of": "itself", "quantity": "force"},
            ],
        }
    )


def whole(answer):
    assert answer.ending is Ending.COMPLETED, answer.sentence
    return answer.stations[-1].values


@cache
def limit(*, tapered):
    """The chain's values, whose error goes with N^-2, led on from two N."""
    coarse, fine = (whole(cprbm.answer(rolled(tapered=tapered), cprbm.Settings(links=links))) for links in (41, 82))
    return {name: fine[name] + (fine[name] - coarse[name]) / 3.0 for name in fine}


@pytest.mark.parametrize(("tapered", "backwards"), [(False, False), (True, False), (True, True)])
def test_its_side_lies_on_the_corner_of_its_clamped_end(tapered, backwards):
    # reference: the other solver
    expected, scene = limit(tapered=tapered), rolled(tapered=tapered, backwards=backwards)
    found = whole(fea_reference.answer(scene, fea_reference.Settings(elements=23, kinematics="bending")))
    assert expected["itself.force"][0] > 0.01
    assert found["itself.force"] == pytest.approx(expected["itself.force"], rel=0.02)
    assert np.hypot(*(found["T.displacement"] - expected["T.displacement"])) < 3e-6  # a hundredth of the thickness
    assert found["scene.potential_energy"] == pytest.approx(expected["scene.potential_energy"], rel=1e-5)
