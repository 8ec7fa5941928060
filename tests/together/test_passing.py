"""The tip of a cantilever pressed past the tip of another, with load steps longer than both are thick."""

import pytest

import cprbm
import fea_reference
from scene.reading import scene_from


def tip_on_tip():
    """Two cantilevers from opposite sides, the upper one's tip 17 mm beyond the lower one's."""
    start, end = [0.155, -0.0088], [0.0831, -0.0082]
    beam = {"thickness": 0.0014, "width": 0.01, "material": "m"}
    return scene_from(
        {
            "name": "passing",
            "materials": {"m": {"youngs_modulus": 2.0e9, "poisson_ratio": 0.35}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "Q": start}},
                "tip": {"motion": "free", "points": {"T": [0.1, 0.0]}},
                "other": {"motion": "free", "points": {"S": end}},
            },
            "beams": {
                "one": {
                    **beam,
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.1, 0.0]},
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                },
                "two": {
                    **beam,
                    "curve": {"kind": "line", "start": start, "end": end},
                    "start": {"joint": "weld", "point": "Q"},
                    "end": {"joint": "weld", "point": "S"},
                },
            },
            "drives": {"P": {"kind": "displacement", "point": "T", "direction": [0.09, -0.99]}},
            "contacts": {"contact": {"kind": "beam-beam", "between": ["one", "two"]}},
            "stages": [{"name": "load", "steps": "P", "stations": [0.004, 0.0205]}],
            "probes": [{"of": "S", "quantity": "displacement"}, {"of": "contact", "quantity": "force"}],
        }
    )


def test_a_tip_does_not_pass_another_in_one_long_step():
    # reference: each other; and the lower tip must lie below where the upper one's edge is
    scene = tip_on_tip()
    fea = fea_reference.answer(scene, fea_reference.Settings(kinematics="bending"))
    links = cprbm.answer(scene, cprbm.Settings(links=40))
    assert fea.completed, fea.sentence
    assert links.completed, links.sentence
    one, other = fea.stations[1], links.stations[1]
    assert one.values["S.displacement"][1] < -0.005
    assert one.values["contact.force"] == pytest.approx(other.values["contact.force"], rel=2e-3)
    assert one.values["S.displacement"] == pytest.approx(other.values["S.displacement"], rel=2e-3, abs=1e-5)
