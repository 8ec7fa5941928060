"""A straight column between two clamps that are pressed together until its neck closes; whole, and half of it."""

from __future__ import annotations

from typing import Any

from cprbm_scene import Scene, scene_from

LENGTH, WIDTH, MODULUS = 0.0973, 0.0087, 7.13e9
NUDGE = 0.5  # E·I/L², on the middle, to choose on which side it buckles; it goes away before anything is asked
BENT = 45.0  # E·I/L² that hold the column bent meanwhile


def rigidity(thickness: float) -> float:
    """E·I, N·m², of a column ``thickness`` times its length thick."""
    return MODULUS * WIDTH * (thickness * LENGTH) ** 3 / 12.0


def _column(
    thickness: float,
    bodies: dict[str, Any],
    half: float,
    push: dict[str, Any],
    contact: dict[str, Any],
    nudged: dict[str, Any],
    stations: list[float],
    probes: list[dict[str, Any]],
) -> Scene:
    unit = rigidity(thickness) / LENGTH**2
    return scene_from(
        {
            "name": "neck",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.31}},
            "bodies": bodies,
            "beams": {
                "column": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [half * LENGTH, 0.0]},
                    "thickness": thickness * LENGTH,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "loads": {"nudge": nudged, "push": push},
            "contacts": {"neck": contact},
            "stages": [
                {"name": "nudge", "steps": "nudge", "stations": [2.0 * half * NUDGE * unit]},
                {"name": "bend", "steps": "push", "stations": [BENT * unit]},
                {"name": "let", "steps": "nudge", "stations": [0.0]},
                {"name": "close", "steps": "push", "stations": [force * unit for force in stations]},
            ],
            "probes": [
                *probes,
                {"of": "neck", "quantity": "force"},
                {"of": "neck", "quantity": "centre"},
                {"of": "neck", "quantity": "ends"},
                {"of": "neck", "quantity": "closing_load"},
                {"of": "scene", "quantity": "potential_energy"},
            ],
        }
    )


def whole(thickness: float, stations: list[float], *, thick: bool = True) -> Scene:
    """The column pressed by ``stations``, E·I/L²; its thickness is over its length."""
    return _column(
        thickness,
        {
            "ground": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
            "shoe": {"motion": "slides", "along": [1.0, 0.0], "points": {"T": [LENGTH, 0.0]}},
        },
        1.0,
        {"kind": "force", "point": "T", "direction": [-1.0, 0.0]},
        {"kind": "beam-self", "beam": "column", "thick": thick},
        {"kind": "beam_force", "beam": "column", "at": 0.5, "direction": [0.0, 1.0]},
        stations,
        [
            {"of": "T", "quantity": "displacement"},
            {"of": "R", "quantity": "reaction_moment"},
            {"of": "column", "quantity": "bending_stress", "points": 41},
        ],
    )


def half(thickness: float, stations: list[float], *, thick: bool = True) -> Scene:
    """Its left half, clamped to a shoe that is pressed towards the line along which its middle slides.

    The wall in which the neck is mirrored goes along with the middle, below it: the middle itself lies on its line.
    """
    middle = 0.5 * LENGTH
    return _column(
        thickness,
        {
            "shoe": {"motion": "slides", "along": [1.0, 0.0], "points": {"R": [0.0, 0.0]}},
            "middle": {"motion": "slides", "along": [0.0, 1.0], "points": {"T": [middle, 0.0]}},
        },
        0.5,
        {"kind": "force", "point": "R", "direction": [1.0, 0.0]},
        {
            "kind": "beam-line",
            "beam": "column",
            "body": "middle",
            "points": [[middle, -0.4 * LENGTH], [middle, -0.1 * LENGTH]],
            "side": "left",
            "thick": thick,
        },
        {"kind": "force", "point": "T", "direction": [0.0, 1.0]},
        stations,
        [{"of": "R", "quantity": "displacement"}],
    )
