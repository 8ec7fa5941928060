"""Scenes of a beam that is a parabola when free of stress."""

from __future__ import annotations

from typing import Any

YOUNG, THICKNESS, WIDTH = 2.3e9, 2e-3, 8e-3
RIGIDITY = YOUNG * WIDTH * THICKNESS**3 / 12.0
PARABOLA = {"kind": "polynomial", "axis": "y", "coefficients": [0.05, 0.0, 14.64], "range": [0.0, 0.05]}
CLAMP, TIP = [0.05, 0.0], [0.0866, 0.05]


def cantilever(load: dict[str, Any], stations: list[float], curve: dict[str, Any] = PARABOLA) -> dict[str, Any]:
    """The parabola x = 14.64 y² + 0.05 m, or another curve between its ends, clamped at R, with a rigid tip at T."""
    return {
        "name": "bowed",
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.35}},
        "bodies": {
            "wall": {"motion": "fixed", "points": {"R": CLAMP}},
            "tip": {"motion": "free", "points": {"T": TIP}},
        },
        "beams": {
            "beam": {
                "curve": curve,
                "thickness": THICKNESS,
                "width": WIDTH,
                "material": "m",
                "start": {"joint": "weld", "point": "R"},
                "end": {"joint": "weld", "point": "T"},
            }
        },
        "loads": {"P": load},
        "stages": [{"name": "load", "steps": "P", "stations": stations}],
        "probes": [
            {"of": "T", "quantity": "displacement"},
            {"of": "tip", "quantity": "rotation"},
            {"of": "R", "quantity": "reaction_moment"},
            {"of": "beam", "quantity": "bending_stress", "points": 9},
        ],
    }


def force(x: float, y: float) -> dict[str, Any]:
    """A dead force at the tip."""
    return {"kind": "force", "point": "T", "direction": [x, y]}


MOMENT = {"kind": "moment", "body": "tip"}


def on_a_circle(load: float) -> dict[str, Any]:
    """The parabola pulled onto a rigid circle inside its bow."""
    data = cantilever(force(-1.0, 0.3), [load])
    data["contacts"] = {
        "touch": {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": [0.045, 0.03], "radius": 0.0125}
    }
    data["probes"].append({"of": "touch", "quantity": "force"})
    return data


def on_a_beam(load: float) -> dict[str, Any]:
    """The parabola pulled onto a straight cantilever inside its bow."""
    data = cantilever(force(-1.0, 0.3), [load])
    data["bodies"]["wall"]["points"]["Q"] = [0.035, 0.06]
    data["beams"]["straight"] = {
        **data["beams"]["beam"],
        "curve": {"kind": "line", "start": [0.035, 0.06], "end": [0.050, 0.025]},
        "start": {"joint": "weld", "point": "Q"},
        "end": {"joint": "free"},
    }
    data["contacts"] = {"touch": {"kind": "beam-beam", "between": ["straight", "beam"]}}
    data["probes"].append({"of": "touch", "quantity": "force"})
    return data
