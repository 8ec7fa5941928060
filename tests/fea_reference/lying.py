"""A curved beam clamped tangent on a straight one and pressed flat on it by a force at its tip."""

import numpy as np

from cprbm_scene import Scene, scene_from

YOUNG, WIDTH, LENGTH = 2e9, 0.01, 0.1
UPPER, LOWER = 0.001, 0.0014
RADIUS = 0.25


def lying(between: tuple[str, str], stations: tuple[float, ...]) -> Scene:
    """Clamped side by side at the origin, half the thicknesses apart; ``upper`` bends away upwards."""
    y = 0.5 * (UPPER + LOWER)
    angle = LENGTH / RADIUS
    tip = [RADIUS * np.sin(angle), y + RADIUS * (1.0 - np.cos(angle))]

    def beam(curve, thickness, point, end):
        return {
            "curve": curve,
            "thickness": thickness,
            "width": WIDTH,
            "material": "m",
            "start": {"joint": "weld", "point": point},
            "end": end,
        }

    arc = {
        "kind": "arc",
        "center": [0.0, y + RADIUS],
        "start": [0.0, y],
        "end": tip,
        "direction": "counterclockwise",
    }
    line = {"kind": "line", "start": [0.0, 0.0], "end": [1.1 * LENGTH, 0.0]}
    return scene_from(
        {
            "name": "lying",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"U": [0.0, y], "V": [0.0, 0.0]}},
                "end": {"motion": "free", "points": {"tip": tip}},
            },
            "beams": {
                "upper": beam(arc, UPPER, "U", {"joint": "weld", "point": "tip"}),
                "lower": beam(line, LOWER, "V", {"joint": "free"}),
            },
            "loads": {"P": {"kind": "force", "point": "tip", "direction": [0.0, -1.0]}},
            "contacts": {"touch": {"kind": "beam-beam", "between": list(between)}},
            "stages": [{"name": "load", "steps": "P", "stations": list(stations)}],
            "probes": [
                {"of": "touch", "quantity": "force"},
                {"of": "touch", "quantity": "centre"},
                {"of": "touch", "quantity": "ends"},
                {"of": "tip", "quantity": "displacement"},
                {"of": "U", "quantity": "reaction"},
                {"of": "V", "quantity": "reaction"},
                {"of": "V", "quantity": "reaction_moment"},
                {"of": "upper", "quantity": "bending_stress", "points": 41},
                {"of": "lower", "quantity": "bending_stress", "points": 41},
            ],
        }
    )
