"""The closing load of a contact in stages that step the load under which the contact closed, and another load."""

import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from

LENGTH, THICKNESS, WIDTH, MODULUS = 0.0931, 0.0011, 0.0083, 7.1e10
GAP, RADIUS = 0.00031, 0.0043


def pressed_twice():
    """A cantilever that a load at the tip brings to a circle below the tip, before a moment acts."""
    return scene_from(
        {
            "name": "pressed twice",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": [0.0, 0.0]}},
                "tip": {"motion": "free", "points": {"B": [LENGTH, 0.0]}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]},
                    "thickness": THICKNESS,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "weld", "point": "B"},
                }
            },
            "contacts": {
                "stop": {
                    "kind": "beam-circle",
                    "beam": "beam",
                    "body": "ground",
                    "center": [0.9 * LENGTH, -GAP - 0.5 * THICKNESS - RADIUS],
                    "radius": RADIUS,
                }
            },
            "loads": {
                "P": {"kind": "force", "point": "B", "direction": [0.0, -1.0]},
                "M": {"kind": "moment", "body": "tip"},
            },
            "stages": [
                {"name": "press", "steps": "P", "stations": [2.0 * closing()]},
                {"name": "turn", "steps": "M", "stations": [1e-3]},
                {"name": "press more", "steps": "P", "stations": [2.2 * closing()]},
            ],
            "probes": [{"of": "stop", "quantity": "closing_load"}, {"of": "stop", "quantity": "force"}],
        }
    )


def closing():
    """Load at which the line at 0.9 L has sunk by the gap: w = P x² (3 L − x)/(6 EI)."""
    x = 0.9 * LENGTH
    return GAP * 6.0 * MODULUS * WIDTH * THICKNESS**3 / 12.0 / (x**2 * (3.0 * LENGTH - x))


@pytest.mark.parametrize("solver", [cprbm, fea_reference], ids=["cprbm", "fea"])
def test_a_closing_load_is_a_value_of_the_load_that_closed_the_contact(solver):
    press, turn, more = solver.answer(pressed_twice()).stations
    assert press.values["stop.closing_load"] == pytest.approx([closing()], rel=1e-3)
    assert turn.values["stop.force"][0] > 0.0
    assert turn.values["stop.closing_load"].size == 0
    assert more.values["stop.closing_load"] == pytest.approx([closing()], rel=1e-3)
