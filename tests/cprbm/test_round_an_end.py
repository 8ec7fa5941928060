"""A beam is led round the end of another beam and presses from the other side, against slender beams in series."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import scene_from

YOUNG, THICKNESS, WIDTH = 2e9, 1e-3, 0.01
FIRST, SECOND = 0.1, 0.145
"""Lengths of the beam on the wall, and of the beam in the hand."""
HAND, REST = 0.25, 0.01
LIFT = 0.5e-3
"""Way of the hand beyond the first touch."""


def led_round(left, *, thick, angle, exchanged):
    """The hand goes down past the end of the first beam, to the left beneath the beam, and up; turned by an angle."""

    def place(x, y):
        return [float(np.cos(angle) * x - np.sin(angle) * y), float(np.sin(angle) * x + np.cos(angle) * y)]

    beam = {"thickness": THICKNESS, "width": WIDTH, "material": "m", "end": {"joint": "free"}}
    first = {"kind": "line", "start": [0.0, 0.0], "end": place(FIRST, 0.0)}
    second = {"kind": "line", "start": place(HAND, REST), "end": place(HAND - SECOND, REST)}
    along = {"kind": "displacement", "point": "H"}
    touch = -REST - (THICKNESS if thick else 0.0)
    names = ["second", "first"] if exchanged else ["first", "second"]
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
                "first": {**beam, "curve": first, "start": {"joint": "weld", "point": "W"}},
                "second": {**beam, "curve": second, "start": {"joint": "weld", "point": "H"}},
            },
            "drives": {
                "x": {**along, "direction": place(1.0, 0.0)},
                "y": {**along, "direction": place(0.0, 1.0)},
                "turn": {"kind": "rotation", "body": "hand"},
            },
            "contacts": {"c": {"kind": "beam-beam", "between": names, "thick": thick}},
            "stages": [
                {"name": "down", "steps": "y", "stations": [-0.02]},
                {"name": "left", "steps": "x", "stations": [left]},
                {"name": "up", "steps": "y", "stations": [touch + LIFT]},
            ],
            "probes": [{"of": "c", "quantity": "force"}],
        }
    )


@pytest.mark.parametrize("exchanged", [False, True])
@pytest.mark.parametrize("angle", [0.0, 0.65])
@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("left", [-0.02, -0.045])
def test_a_beam_that_came_round_the_end_presses_from_the_other_side(left, thick, angle, exchanged):
    scene = led_round(left, thick=thick, angle=angle, exchanged=exchanged)
    answer = cprbm.answer(scene, cprbm.Settings(links=41))
    assert answer.completed, answer.sentence
    # the end of the first beam touches the second beam: two cantilevers in series
    rigidity = YOUNG * WIDTH * THICKNESS**3 / 12.0
    force = 3.0 * rigidity * LIFT / (FIRST**3 + (HAND + left - FIRST) ** 3)
    forces = [station.values["c.force"][0] for station in answer.stations]
    assert forces == pytest.approx([0.0, 0.0, force], rel=2e-3)
