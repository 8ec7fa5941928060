"""A hand leads a beam round the free end of another beam; the beams then press from the other side."""

import numpy as np
import pytest

from cprbm_scene import scene_from
from fea_reference import Settings, answer

YOUNG, T, WIDTH = 2e9, 1e-3, 0.01
FIRST, SECOND = 0.1, 0.145
"""Lengths of the beam on the wall, and of the beam in the hand."""
HAND, REST, LEFT = 0.25, 0.01, -0.02
LIFT = 0.5e-3
"""Way of the hand beyond the first touch."""


def led_round(order, *, thick, beneath, angle):
    """The hand goes down past the end of the first beam, to the left ``beneath`` the beam, and up."""

    def place(x, y):
        return [float(np.cos(angle) * x - np.sin(angle) * y), float(np.sin(angle) * x + np.cos(angle) * y)]

    beam = {"thickness": T, "width": WIDTH, "material": "m", "end": {"joint": "free"}}
    lines = {"first": ([0.0, 0.0], place(FIRST, 0.0)), "second": (place(HAND, REST), place(HAND - SECOND, REST))}
    touch = -REST - (T if thick else 0.0)
    return scene_from(
        {
            "name": "round",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"W": [0.0, 0.0]}},
                "hand": {"motion": "free", "points": {"H": place(HAND, REST)}},
            },
            "beams": {
                name: {
                    **beam,
                    "curve": {"kind": "line", "start": start, "end": end},
                    "start": {"joint": "weld", "point": point},
                }
                for (name, (start, end)), point in zip(lines.items(), "WH", strict=True)
            },
            "drives": {
                "x": {"kind": "displacement", "point": "H", "direction": place(1.0, 0.0)},
                "y": {"kind": "displacement", "point": "H", "direction": place(0.0, 1.0)},
                "turn": {"kind": "rotation", "body": "hand"},
            },
            "contacts": {"c": {"kind": "beam-beam", "between": list(order), "thick": thick}},
            "stages": [
                {"name": "down", "steps": "y", "stations": [-REST - beneath]},
                {"name": "left", "steps": "x", "stations": [LEFT]},
                {"name": "up", "steps": "y", "stations": [touch + LIFT]},
            ],
            "probes": [{"of": "c", "quantity": "force"}],
        }
    )


@pytest.mark.parametrize("order", [("first", "second"), ("second", "first")])
@pytest.mark.parametrize("angle", [0.0, 0.65])
@pytest.mark.parametrize(("thick", "beneath"), [(True, 10e-3), (True, 1.5e-3), (False, 10e-3), (False, 0.8e-3)])
def test_a_beam_that_came_round_the_end_presses_from_the_other_side(order, angle, thick, beneath):
    """The end of the first beam touches the second beam: two cantilevers in series, 3 EI δ/(L₁³ + L₂³)."""
    got = answer(led_round(order, thick=thick, beneath=beneath, angle=angle), Settings(elements=20))
    assert got.completed, got.sentence
    rigidity = YOUNG * WIDTH * T**3 / 12.0
    force = 3.0 * rigidity * LIFT / (FIRST**3 + (HAND + LEFT - FIRST) ** 3)
    assert [station.values["c.force"][0] for station in got.stations] == pytest.approx([0.0, 0.0, force], rel=1e-3)
