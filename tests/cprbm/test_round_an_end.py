"""A beam is led round the end of another beam and presses from the other side, against slender beams in series."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import scene_from

YOUNG, THICKNESS, WIDTH = 2e9, 1e-3, 0.01
LENGTHS = 0.1, 0.145
DOWN, LEFT, LIFT = -0.02, -0.02, 0.5e-3
"""Ways of the hand: past the end, beneath the first beam, and up beyond the first touch."""


def led_round(*, thick, mirror):
    """The first beam stands on a wall; the hand holds the second beam 10 mm above, 5 mm beyond the end of the first."""
    rest, sign = 0.01, -1.0 if mirror else 1.0
    touch = -rest - (THICKNESS if thick else 0.0)
    line = {"kind": "line", "start": [0.0, 0.0], "end": [LENGTHS[0], 0.0]}
    other = {"kind": "line", "start": [0.25, sign * rest], "end": [0.25 - LENGTHS[1], sign * rest]}
    beam = {"thickness": THICKNESS, "width": WIDTH, "material": "m", "end": {"joint": "free"}}
    along = {"kind": "displacement", "point": "H"}
    return scene_from(
        {
            "name": "round",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"W": [0.0, 0.0]}},
                "hand": {"motion": "free", "points": {"H": [0.25, sign * rest]}},
            },
            "beams": {
                "first": {**beam, "curve": line, "start": {"joint": "weld", "point": "W"}},
                "second": {**beam, "curve": other, "start": {"joint": "weld", "point": "H"}},
            },
            "drives": {
                "x": {**along, "direction": [1.0, 0.0]},
                "y": {**along, "direction": [0.0, sign]},
                "turn": {"kind": "rotation", "body": "hand"},
            },
            "contacts": {"c": {"kind": "beam-beam", "between": ["first", "second"], "thick": thick}},
            "stages": [
                {"name": "down", "steps": "y", "stations": [DOWN]},
                {"name": "left", "steps": "x", "stations": [LEFT]},
                {"name": "up", "steps": "y", "stations": [touch + LIFT]},
            ],
            "probes": [{"of": "c", "quantity": "force"}, {"of": "H", "quantity": "reaction"}],
        }
    )


@pytest.mark.parametrize("links", [20, 41])
@pytest.mark.parametrize("mirror", [False, True])
@pytest.mark.parametrize("thick", [False, True])
def test_a_beam_that_came_round_the_end_presses_from_the_other_side(thick, mirror, links):
    answer = cprbm.answer(led_round(thick=thick, mirror=mirror), cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    last = answer.stations[-1]
    # the end of the first beam touches the second beam, 0.13 m from the hand: two cantilevers in series
    stiffness = 3.0 * YOUNG * WIDTH * THICKNESS**3 / 12.0
    force = stiffness * LIFT / (LENGTHS[0] ** 3 + (0.25 + LEFT - LENGTHS[0]) ** 3)
    assert last.values["c.force"][0] == pytest.approx(force, rel=1e-3)
    assert last.values["H.reaction"][1] == pytest.approx(force * (-1.0 if mirror else 1.0), rel=1e-3)
    assert np.abs([station.values["c.force"] for station in answer.stations[:2]]).max() == 0.0
