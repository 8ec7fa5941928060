"""A small scene with a slide, a driven point, a driven body and a load, for both solvers."""

from __future__ import annotations

from typing import Any

from cprbm_scene import Scene, scene_from
from tests.cprbm.scenes import LENGTH, THICKNESS, cantilever_data


def gripper_like() -> Scene:
    """A quarter of an arch whose root slides, pushed by its tip; then its tip is turned back, then loaded across.

    Without contact, so that what is compared is the slide and the drives alone.
    """
    beam = {"thickness": 0.0021, "width": 0.0083, "material": "m"}
    data: dict[str, Any] = {
        "name": "driven",
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"C": [0.153, 0.011]}},
            "shoe": {"motion": "slides", "along": [2.0, 0.0], "points": {"S": [0.01, 0.02], "O": [0.0, 0.0]}},
            "block": {"motion": "free", "points": {"M": [0.095, 0.06], "A": [0.09, 0.05], "B": [0.1, 0.05]}},
        },
        "beams": {
            "straight": {
                **beam,
                "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.09, 0.05]},
                "start": {"joint": "weld", "point": "O"},
                "end": {"joint": "weld", "point": "A"},
            },
            "post": {
                **beam,
                "curve": {"kind": "line", "start": [0.153, 0.011], "end": [0.1, 0.05]},
                "start": {"joint": "weld", "point": "C"},
                "end": {"joint": "pin", "point": "B"},
            },
        },
        "drives": {
            "push": {"kind": "displacement", "point": "M", "direction": [1.0, -3.0]},
            "turn": {"kind": "rotation", "body": "block"},
        },
        "loads": {"pull": {"kind": "force", "point": "S", "direction": [1.0, 1.0]}},
        "stages": [
            {"name": "push", "steps": "push", "stations": [0.001, 0.008]},
            {"name": "turn", "steps": "turn", "stations": [0.15]},
            {"name": "pull", "steps": "pull", "stations": [0.5]},
        ],
        "probes": [
            {"of": "A", "quantity": "displacement"},
            {"of": "S", "quantity": "displacement"},
            {"of": "block", "quantity": "rotation"},
            {"of": "shoe", "quantity": "rotation"},
            {"of": "M", "quantity": "reaction"},
            {"of": "block", "quantity": "reaction_moment"},
            {"of": "C", "quantity": "reaction"},
            {"of": "C", "quantity": "reaction_moment"},
            {"of": "straight", "quantity": "bending_stress"},
            {"of": "scene", "quantity": "potential_energy"},
        ],
    }
    return scene_from(data)


GAP = 0.002  # m: of the punch over the beam


def punched() -> Scene:
    """A cantilever that a circle on a driven slide, held by no beam, presses down and lets go again."""
    data = cantilever_data({}, [])
    radius = 0.02
    middle = [0.6 * LENGTH, radius + THICKNESS / 2 + GAP]
    contact = {"kind": "beam-circle", "beam": "beam", "body": "punch", "center": middle, "radius": radius}
    data["bodies"]["punch"] = {"motion": "slides", "along": [0.0, 1.0], "points": {"K": middle}}
    return scene_from(
        {
            **data,
            "loads": {},
            "drives": {"down": {"kind": "displacement", "point": "K", "direction": [0.0, -1.0]}},
            "contacts": {"circle": contact},
            "stages": [
                {"name": "down", "steps": "down", "stations": [0.001, 0.003, 0.012]},
                {"name": "up", "steps": "down", "stations": [0.005, 0.0]},
            ],
            "probes": [
                {"of": "T", "quantity": "displacement"},
                {"of": "K", "quantity": "displacement"},
                {"of": "R", "quantity": "reaction"},
                {"of": "K", "quantity": "reaction"},
                {"of": "circle", "quantity": "force"},
                {"of": "circle", "quantity": "closing_load"},
            ],
        }
    )


RISE, HALF_SPAN = 0.01, 0.05


def snapping() -> Scene:
    """A shallow arch on two pins, its crown driven down and held from turning and from going aside.

    Under a load it would jump at its limit point, which a drive goes through; the reaction changes its sign.
    """
    radius = (HALF_SPAN**2 + RISE**2) / (2.0 * RISE)
    arc = {"kind": "arc", "center": [0.0, RISE - radius], "direction": "clockwise"}
    beam = {"thickness": 0.0005, "width": 0.008, "material": "m"}  # slender: a stout shallow arch also shortens
    crown, left, right = [0.0, RISE], [-HALF_SPAN, 0.0], [HALF_SPAN, 0.0]
    pin, weld = {"joint": "pin"}, {"joint": "weld", "point": "T"}
    return scene_from(
        {
            "name": "snapping",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": left, "B": right}},
                "top": {"motion": "free", "points": {"T": crown}},
            },
            "beams": {
                "left": {
                    **beam,
                    "curve": {**arc, "start": left, "end": crown},
                    "start": {**pin, "point": "A"},
                    "end": weld,
                },
                "right": {
                    **beam,
                    "curve": {**arc, "start": crown, "end": right},
                    "start": weld,
                    "end": {**pin, "point": "B"},
                },
            },
            "drives": {
                "down": {"kind": "displacement", "point": "T", "direction": [0.0, -1.0]},
                "aside": {"kind": "displacement", "point": "T", "direction": [1.0, 0.0]},
                "turn": {"kind": "rotation", "body": "top"},
            },
            "stages": [{"name": "down", "steps": "down", "stations": [0.002, 0.006, 0.012, 0.016]}],
            "probes": [
                {"of": "T", "quantity": "reaction"},
                {"of": "A", "quantity": "reaction"},
                {"of": "scene", "quantity": "potential_energy"},
            ],
        }
    )
