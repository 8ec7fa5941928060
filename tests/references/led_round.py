"""A hand leads a beam round the free end of another beam; the beams then press from the other side.

The end of the first beam touches the second beam: two cantilevers in series, F = 3 EI δ/(L₁³ + L₂³).
"""

import numpy as np

from cprbm_scene import Scene, scene_from

YOUNG, THICKNESS, WIDTH = 2e9, 1e-3, 0.01
FIRST, SECOND = 0.1, 0.145
"""Lengths of the beam on the wall, and of the beam in the hand."""
HAND, REST = 0.25, 0.01
"""Distance of the hand from the wall, and height above the first beam as drawn."""
LIFT = 0.5e-3
"""Way of the hand beyond the first touch."""


def led_round(order: tuple[str, str], *, left: float, beneath: float, thick: bool, angle: float) -> Scene:
    """The hand goes down past the end of the first beam, to the ``left`` at a height ``beneath`` the beam, and up.

    Args:
        order: of the two beams in the contact.
        left, beneath: ways, m.
        thick: whether the contact has the beams' thickness.
        angle: of the whole scene, rad.
    """

    def place(x: float, y: float) -> list[float]:
        return [float(np.cos(angle) * x - np.sin(angle) * y), float(np.sin(angle) * x + np.cos(angle) * y)]

    lines = {"first": ([0.0, 0.0], place(FIRST, 0.0)), "second": (place(HAND, REST), place(HAND - SECOND, REST))}
    touch = -REST - (THICKNESS if thick else 0.0)
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
                    "curve": {"kind": "line", "start": start, "end": end},
                    "thickness": THICKNESS,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": point},
                    "end": {"joint": "free"},
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
                {"name": "left", "steps": "x", "stations": [left]},
                {"name": "up", "steps": "y", "stations": [touch + LIFT]},
            ],
            "probes": [{"of": "c", "quantity": "force"}],
        }
    )


def contact_force(left: float) -> float:
    """Contact force after the lift, N."""
    rigidity = YOUNG * WIDTH * THICKNESS**3 / 12.0
    return 3.0 * rigidity * LIFT / (FIRST**3 + (HAND + left - FIRST) ** 3)
