"""A long arc that is wound down round the tip of another beam, until its own end is on the other's far side."""

import pytest

import cprbm
import fea_reference
from scene import Ending
from scene.reading import scene_from

THICK, THIN = 9.58e-05, 7.75e-05
BEHIND = 2.304e-05
"""From here on the arc's end presses the other from behind (finite elements)."""


def wound(*moments):
    material, tip = {"material": "m"}, [0.0154861, -0.0032692]
    return scene_from(
        {
            "name": "wound",
            "materials": {"m": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
            "bodies": {"wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "S": tip}}},
            "beams": {
                "arc": {
                    **material,
                    "curve": {
                        "kind": "arc",
                        "center": [0.009368026153168073, 0.005955237838734915],
                        "start": [0.0, 0.0],
                        "end": [0.0147978, 0.0156373],
                        "direction": "clockwise",
                    },
                    "thickness": THICK,
                    "width": 0.00198,
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "free"},
                },
                "tip": {
                    **material,
                    "curve": {"kind": "spline", "points": [tip, [0.0112901, 0.0046755], [0.0075953, 0.0098835]]},
                    "thickness": THIN,
                    "width": 0.00247,
                    "start": {"joint": "weld", "point": "S"},
                    "end": {"joint": "free"},
                },
            },
            "loads": {"M": {"kind": "beam_moment", "beam": "arc", "at": 0.55}},
            "contacts": {"touch": {"kind": "beam-beam", "between": ["arc", "tip"]}},
            "stages": [{"name": "wind", "steps": "M", "stations": [-one for one in moments]}],
            "probes": [{"of": "touch", "quantity": "force"}, {"of": "scene", "quantity": "potential_energy"}],
        }
    )


def test_what_has_come_round_a_tip_does_not_lie_across_it():
    """Reference: the finite elements; errors of the chain fall with the square of the link.

    The arc goes past the tip at half of both thicknesses, aslant: places of it that face the tip's side from behind
    are as near, and a link is twenty times as long.
    """
    scene = wound(2.04e-05, 2.2e-05, 2.29e-05)
    true = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    coarse, fine = (cprbm.answer(scene, cprbm.Settings(links=n)) for n in (40, 80))
    assert {one.ending for one in (true, coarse, fine)} == {Ending.COMPLETED}
    for a, b, known in zip(coarse.stations, fine.stations, true.stations, strict=True):
        for probe, value in known.values.items():
            limit = (4.0 * b.values[probe] - a.values[probe]) / 3.0
            assert limit == pytest.approx(value, rel=2e-3), probe


def test_what_presses_from_behind_is_not_certified():
    """The chain's contacts have one side: beyond the value at which the other would press it ends by name."""
    got = cprbm.answer(wound(2.2e-05, 2.5e-05), cprbm.Settings(links=40))
    assert got.ending is Ending.BEAMS_CROSSED
    assert float(got.sentence.split()[-1]) == pytest.approx(-BEHIND, rel=2e-3)
    assert len(got.stations) == 1
