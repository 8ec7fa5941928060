"""A stage of two foils that stands by a contact alone: one long step, and what stands without it is a saddle."""

from __future__ import annotations

import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from

DATA = {
    "name": "held-by-a-contact",
    "materials": {"polypropylene": {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}},
    "bodies": {
        "wall": {"motion": "fixed", "points": {"R1": [3.91e-05, 4.92e-05], "R2": [0.0207465, -0.017016]}},
        "stage": {"motion": "free", "points": {"T1": [-0.0395753, -0.0259526], "T2": [-0.0231584, -0.0387044]}},
    },
    "beams": {
        "foil": {
            "curve": {"kind": "line", "start": [3.91e-05, 4.92e-05], "end": [-0.0395753, -0.0259526]},
            "thickness": 5.01e-05,
            "width": 0.00365,
            "material": "polypropylene",
            "start": {"joint": "weld", "point": "R1"},
            "end": {"joint": "weld", "point": "T1"},
        },
        "bow": {
            "curve": {
                "kind": "arc",
                "center": [0.06970602529359157, -0.1714108161850394],
                "start": [0.0207465, -0.017016],
                "end": [-0.0231584, -0.0387044],
                "direction": "counterclockwise",
            },
            "thickness": 6.2e-05,
            "width": 0.0134,
            "material": "polypropylene",
            "start": {"joint": "weld", "point": "R2"},
            "end": {"joint": "pin", "point": "T2"},
        },
    },
    "loads": {
        "pull": {"kind": "beam_force", "beam": "foil", "at": 0.44, "direction": [0.815, 0.579]},
        "wind": {"kind": "distributed", "beam": "bow", "direction": [0.523, 0.852], "along": [0.0, 1.0]},
    },
    "contacts": {
        "edge": {
            "kind": "beam-line",
            "beam": "foil",
            "body": "wall",
            "points": [[-0.0193605, -0.0117527], [-0.0413747, -0.0234782]],
            "side": "left",
            "thick": False,
        }
    },
    "stages": [
        {"name": "pull", "steps": "pull", "stations": [0.0006791, 0.001358]},
        {"name": "wind", "steps": "wind", "stations": [0.006917]},
    ],
    "probes": [{"of": "edge", "quantity": "force"}, {"of": "T1", "quantity": "displacement"}],
}


def test_a_step_with_loose_penalties_does_not_lead_to_the_saddle_without_the_contact() -> None:
    # reference: the CPRBM, whose rows hold or do not, within the h² of its links
    scene = scene_from(DATA)
    answer = fea_reference.answer(scene, fea_reference.Settings(elements=20, kinematics="bending"))
    assert answer.completed, answer.sentence
    found, known = (each.stations[-1] for each in (answer, cprbm.answer(scene, cprbm.Settings(links=61))))
    assert found.certificate.smallest_curvature > 1.0
    assert found.values["edge.force"][0] == pytest.approx(known.values["edge.force"][0], rel=1e-3)
    assert found.values["T1.displacement"] == pytest.approx(known.values["T1.displacement"], rel=1e-3)
