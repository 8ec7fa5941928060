"""An arch pressed by a couple onto a sharp edge and then onto its stop: what sinks into the edge before comes out.

When the stop closes, the edge's penalty is tightened.  By that the arch moves more than by the step, aside of where the
branch leads under either penalty, and it is on its branch all the same.
"""

import pytest

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer


def arch(stations):
    ends = {"R": [0.0, 0.0], "S": [-0.0659271, -0.0161827], "W": [-0.0404423, -0.0448768]}
    wedge = [[-0.0611755, 0.0009473], [-0.0621409, 0.0076941], [-0.0819555, -0.0038272]]
    return scene_from(
        {
            "name": "arch",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": 207e9, "poisson_ratio": 0.29}},
            "bodies": {"wall": {"motion": "fixed", "points": ends}},
            "beams": {
                "arch": {
                    "curve": {
                        "kind": "arc",
                        "center": [-0.02987365706448743, -0.020679340913063386],
                        "start": ends["R"],
                        "end": ends["S"],
                        "direction": "counterclockwise",
                    },
                    "thickness": 0.00151,
                    "width": 0.00664,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "pin", "point": "S"},
                }
            },
            "stops": {"stop": {"beam": "arch", "end": "end", "towards": "W", "most": 2.385}},
            "loads": {"couple": {"kind": "beam_moment", "beam": "arch", "at": 0.63}},
            "contacts": {
                "plane": {
                    "kind": "beam-half-plane",
                    "beam": "arch",
                    "body": "wall",
                    "point": [-0.0627474, 0.0013543],
                    "normal": [0.7192, -0.6948],
                    "thick": False,
                },
                "wedge": {
                    "kind": "beam-line",
                    "beam": "arch",
                    "body": "wall",
                    "points": [*wedge, wedge[0]],
                    "side": "right",
                },
            },
            "stages": [{"name": "press", "steps": "couple", "stations": stations}],
            "probes": [{"of": "scene", "quantity": "potential_energy"}, {"of": "wedge", "quantity": "force"}],
        }
    )


def test_a_tightened_edge_is_no_other_branch():
    # 130 iterations lead there; nearly a thousand do where the steps onto the closing are refused
    at_once = answer(arch([-53.57]), Settings(elements=40, iteration_limit=300))
    assert at_once.ending is Ending.COMPLETED, at_once.sentence
    # without friction it does not matter how one has come
    bit_by_bit = answer(arch([-21.3, -38.7, -39.1, -53.57]), Settings(elements=40))
    assert bit_by_bit.ending is Ending.COMPLETED, bit_by_bit.sentence
    for name in ("scene.potential_energy", "wedge.force"):
        one, other = (each.stations[-1].values[name].item() for each in (at_once, bit_by_bit))
        assert one == pytest.approx(other, rel=1e-5)
