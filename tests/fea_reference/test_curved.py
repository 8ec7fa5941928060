"""A curved cantilever at a load so small that only the first order counts."""

import numpy as np
import pytest

from cprbm_scene import scene_from
from fea_reference import Settings, answer

YOUNG, POISSON, WIDTH, T, R = 2e9, 0.3, 0.01, 0.01, 0.06
P = 1e-3


def quarter_circle(direction):
    end = [0.0, R] if direction == "counterclockwise" else [0.0, -R]
    return scene_from(
        {
            "name": "quarter",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": POISSON}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"root": [R, 0.0]}},
                "end": {"motion": "free", "points": {"tip": end}},
            },
            "beams": {
                "beam": {
                    "curve": {
                        "kind": "arc",
                        "center": [0.0, 0.0],
                        "start": [R, 0.0],
                        "end": end,
                        "direction": direction,
                    },
                    "thickness": T,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "root"},
                    "end": {"joint": "weld", "point": "tip"},
                }
            },
            "loads": {"P": {"kind": "force", "point": "tip", "direction": [0.0, 1.0]}},
            "stages": [{"name": "load", "steps": "P", "stations": [P]}],
            "probes": [
                {"of": "tip", "quantity": "displacement"},
                {"of": "beam", "quantity": "bending_stress", "points": 9},
            ],
        }
    )


@pytest.mark.parametrize("direction", ["counterclockwise", "clockwise"])
def test_castigliano(direction):
    """δ = P π/4 (R³/EI + R/EA + R/kGA): M = P R cos φ, N = P cos φ, V = P sin φ over the quarter circle."""
    EI, EA, kGA = (
        YOUNG * WIDTH * T**3 / 12,
        YOUNG * WIDTH * T,
        5 / 6 * YOUNG / (2 * (1 + POISSON)) * WIDTH * T,
    )
    parts = {"bending": R**3 / EI, "stretch": R / EA, "shear": R / kGA}
    expected = 0.0
    for kinematics, part in parts.items():
        expected += P * np.pi / 4 * part
        got = answer(quarter_circle(direction), Settings(elements=40, kinematics=kinematics))
        values = got.stations[0].values
        # The error left is a small part even of the smallest share.
        share = P * np.pi / 4 * min(part, R / EA)
        assert values["tip.displacement"][1] == pytest.approx(expected, abs=2e-3 * share)

        moment = -P * R * np.cos(np.linspace(0.0, np.pi / 2, 9))
        stress = values["beam.bending_stress"] * WIDTH * T**2 / 6
        assert stress == pytest.approx(moment, abs=1e-5 * P * R)
