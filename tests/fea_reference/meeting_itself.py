"""Scenes in which a beam meets itself: an arch whose neck closes, and a strip that is rolled."""

from __future__ import annotations

from typing import Any

import numpy as np

from cprbm_scene import Scene, scene_from

YOUNG, WIDTH = 2.1e9, 0.01
HALF = 0.1  # m, of the arch
BETA = 0.2
START = HALF * np.sin(BETA) / BETA  # m, from the clamps to the mirror at rest

LENGTH = 0.24  # m, of the strip
AT, SHARES = (0.0, 0.3, 0.9, 1.0), (1.0, 0.75, 0.8, 0.4)


def arch(thickness: float | dict[str, Any], clamps: list[float], *, thick: bool, backwards: bool = False) -> Scene:
    """The clamps pushed together to ``clamps`` (m) from the mirror; ``backwards`` drawn from the other end."""
    left, right, centre = [-START, 0.0], [START, 0.0], [0.0, -START / np.tan(BETA)]
    names = ("B", "A") if backwards else ("A", "B")
    ends = (right, left) if backwards else (left, right)
    turn = "counterclockwise" if backwards else "clockwise"
    return scene_from(
        {
            "name": "neck",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": left}},
                "block": {"motion": "slides", "along": [-1.0, 0.0], "points": {"B": right}},
            },
            "beams": {
                "strip": {
                    "curve": {"kind": "arc", "center": centre, "start": ends[0], "end": ends[1], "direction": turn},
                    "thickness": thickness,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": names[0]},
                    "end": {"joint": "weld", "point": names[1]},
                }
            },
            "drives": {"press": {"kind": "displacement", "point": "B", "direction": [-1.0, 0.0]}},
            "contacts": {"neck": {"kind": "beam-self", "beam": "strip", "thick": thick}},
            "stages": [{"name": "press", "steps": "press", "stations": [2.0 * (START - one) for one in clamps]}],
            "probes": [
                {"of": "neck", "quantity": "force"},
                {"of": "neck", "quantity": "centre"},
                {"of": "neck", "quantity": "ends"},
                {"of": "neck", "quantity": "closing_load"},
                {"of": "B", "quantity": "reaction"},
                {"of": "A", "quantity": "reaction"},
                {"of": "A", "quantity": "reaction_moment"},
                {"of": "scene", "quantity": "potential_energy"},
                {"of": "strip", "quantity": "bending_stress", "points": 41},
            ],
        }
    )


def strip(
    thickness: float,
    rotations: list[float],
    *,
    thick: bool = True,
    backwards: bool = False,
    shares: tuple[float, ...] = SHARES,
) -> Scene:
    """The strip of :mod:`tests.references.rolled` turned by ``rotations``; ``backwards`` drawn from its free end."""
    clamp, tip = [0.0, 0.0], [LENGTH, 0.0]
    at = [1.0 - one for one in reversed(AT)] if backwards else list(AT)
    widths = [WIDTH * one for one in (reversed(shares) if backwards else shares)]
    names, ends = (("T", "C"), (tip, clamp)) if backwards else (("C", "T"), (clamp, tip))
    return scene_from(
        {
            "name": "roll",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"C": clamp}},
                "tip": {"motion": "free", "points": {"T": tip}},
            },
            "beams": {
                "strip": {
                    "curve": {"kind": "line", "start": ends[0], "end": ends[1]},
                    "thickness": thickness,
                    "width": {"at": at, "values": widths},
                    "material": "m",
                    "start": {"joint": "weld", "point": names[0]},
                    "end": {"joint": "weld", "point": names[1]},
                }
            },
            "drives": {"turn": {"kind": "rotation", "body": "tip"}},
            "contacts": {"lap": {"kind": "beam-self", "beam": "strip", "thick": thick}},
            "stages": [{"name": "roll", "steps": "turn", "stations": rotations}],
            "probes": [
                {"of": "lap", "quantity": "force"},
                {"of": "lap", "quantity": "centre"},
                {"of": "lap", "quantity": "ends"},
                {"of": "lap", "quantity": "closing_load"},
                {"of": "T", "quantity": "displacement"},
                {"of": "tip", "quantity": "reaction_moment"},
                {"of": "C", "quantity": "reaction"},
                {"of": "C", "quantity": "reaction_moment"},
                {"of": "scene", "quantity": "potential_energy"},
            ],
        }
    )


MIRROR = {
    "kind": "beam-half-plane",
    "beam": "half",
    "body": "wall",
    "point": [0.0, 0.0],
    "normal": [-1.0, 0.0],
    "thick": False,
}


def half(thickness: float | dict[str, Any], clamps: list[float], mirror: dict[str, Any] | None = None) -> Scene:
    """The left half of the arch, as a line, against a rigid half-plane where the mirror is, or against another."""
    top = [0.0, START * np.tan(0.5 * BETA)]
    centre = [0.0, -START / np.tan(BETA)]
    left = [-START, 0.0]
    return scene_from(
        {
            "name": "half",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"O": [0.0, 0.0]}},
                "clamp": {"motion": "slides", "along": [1.0, 0.0], "points": {"A": left}},
                "apex": {"motion": "slides", "along": [0.0, 1.0], "points": {"S": top}},
            },
            "beams": {
                "half": {
                    "curve": {"kind": "arc", "center": centre, "start": left, "end": top, "direction": "clockwise"},
                    "thickness": thickness,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "weld", "point": "S"},
                }
            },
            "drives": {"press": {"kind": "displacement", "point": "A", "direction": [1.0, 0.0]}},
            "contacts": {"mirror": mirror or MIRROR},
            "stages": [{"name": "press", "steps": "press", "stations": [START - one for one in clamps]}],
            "probes": [
                {"of": "mirror", "quantity": "force"},
                {"of": "mirror", "quantity": "centre"},
                {"of": "A", "quantity": "reaction"},
                {"of": "scene", "quantity": "potential_energy"},
            ],
        }
    )
