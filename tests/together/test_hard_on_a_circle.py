"""A bent strip pushed hard on a circle that is small beside its elements: what sinks in deeply has not gone through."""

import pytest

import elastica_reference
import fea_reference
from cprbm_scene import Ending, scene_from


def strip_on_a_circle():
    along = [-0.6362, -0.7715]
    return scene_from(
        {
            "name": "hard",
            "materials": {"m": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "slides", "along": along, "turns": True, "points": {"T": [-0.167908, 0.097748]}},
            },
            "beams": {
                "strip": {
                    "curve": {
                        "kind": "arc",
                        "center": [-0.03947028058440444, 0.12528653385883926],
                        "start": [0.0, 0.0],
                        "end": [-0.167908, 0.097748],
                        "direction": "clockwise",
                    },
                    "thickness": 0.00102,
                    "width": 0.0441,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "loads": {"M": {"kind": "moment", "body": "tip"}},
            "drives": {"P": {"kind": "displacement", "point": "T", "direction": along}},
            "contacts": {
                "circle": {
                    "kind": "beam-circle",
                    "beam": "strip",
                    "body": "wall",
                    "center": [-0.180338, 0.073124],
                    "radius": 0.0104,
                }
            },
            "stages": [
                {"name": "turn", "steps": "M", "stations": [-0.8465]},
                {"name": "push", "steps": "P", "stations": [0.01353]},
            ],
            "probes": [{"of": "circle", "quantity": "force"}, {"of": "scene", "quantity": "potential_energy"}],
        }
    )


def test_loose_penalties_press_out_what_sinks_in_on_the_way():
    """Reference: the exact answer, to what 80 elements leave: they overlap by a twentieth of the thickness at most."""
    scene = strip_on_a_circle()
    true = elastica_reference.answer(scene)
    got = fea_reference.answer(scene, fea_reference.Settings(elements=80, kinematics="bending"))
    assert got.ending is Ending.COMPLETED, got.sentence
    for mine, its in zip(got.stations, true.stations, strict=True):
        for probe, value in its.values.items():
            assert mine.values[probe] == pytest.approx(value, rel=1e-2)
