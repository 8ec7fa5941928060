"""Contacts by other means: a minimiser that knows no feet, and statics by hand."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, MODULUS, RIGIDITY, THICKNESS, WIDTH


@pytest.mark.parametrize("order", [("upper", "lower"), ("lower", "upper")])
@pytest.mark.parametrize("links", [7, 16])
def test_a_tip_pressed_on_another_beam(order, links):
    """Small deflections: (P − R) a³/3EI − R a³/3EI = gap; the lower's moment falls linearly up to the contact.

    The upper's tip slopes more than the lower beam there, so that it is its end that touches.
    """
    gap = 1e-6 * LENGTH
    closing = 3.0 * RIGIDITY * gap / LENGTH**3
    y, longer = THICKNESS + gap, 1.37 * LENGTH

    def beam(height, length, point, end):
        return {
            "curve": {"kind": "line", "start": [0.0, height], "end": [length, height]},
            "thickness": THICKNESS,
            "width": WIDTH,
            "material": "m",
            "start": {"joint": "weld", "point": point},
            "end": end,
        }

    probes = [("touch", "force"), ("touch", "centre"), ("touch", "closing_load"), ("V", "reaction")]
    scene = scene_from(
        {
            "name": "two",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.31}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"U": [0.0, y], "V": [0.0, 0.0]}},
                "block": {"motion": "free", "points": {"T": [LENGTH, y]}},
            },
            "beams": {
                "upper": beam(y, LENGTH, "U", {"joint": "weld", "point": "T"}),
                "lower": beam(0.0, longer, "V", {"joint": "free"}),
            },
            "loads": {"P": {"kind": "force", "point": "T", "direction": [0.0, -1.0]}},
            "contacts": {"touch": {"kind": "beam-beam", "between": list(order)}},
            "stages": [{"name": "load", "steps": "P", "stations": [0.5 * closing, 3.0 * closing]}],
            "probes": [
                *({"of": of, "quantity": quantity} for of, quantity in probes),
                {"of": "lower", "quantity": "bending_stress", "points": 28},
            ],
        }
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    apart, values = (station.values for station in answer.stations)
    assert apart["touch.force"][0] == 0.0
    # the closing is located at an overlap of 1e-11 longest beams, 1.4e-5 of this gap
    assert values["touch.closing_load"][0] == pytest.approx(closing, rel=2e-5)
    R = values["touch.force"][0]
    assert pytest.approx(closing, rel=1.0 / links**2) == R
    assert values["touch.centre"][0] == pytest.approx(LENGTH, rel=1e-5)
    assert values["V.reaction"][1] == pytest.approx(R, rel=1e-6)
    s = np.linspace(0.0, longer, 28)
    moment = values["lower.bending_stress"] * WIDTH * THICKNESS**2 / 6.0
    assert moment == pytest.approx(-R * np.maximum(LENGTH - s, 0.0), abs=1e-4 * R * LENGTH)
