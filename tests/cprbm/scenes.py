"""Scenes with textbook answers, with awkward numbers: powers of two hide faults."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cprbm_scene import read, scene_from

LENGTH, THICKNESS, WIDTH, MODULUS = 0.0731, 0.00113, 0.0087, 7.13e9
RIGIDITY = MODULUS * WIDTH * THICKNESS**3 / 12.0
HINGE = Path(__file__).parents[2] / "comparisons" / "cases" / "hinge.toml"


def hinge_data() -> dict[str, Any]:
    return read(HINGE).model_dump(mode="json", exclude_unset=True, exclude={"file", "parameters"})


def hinge(**changes: Any):
    """The hinge with some top-level keys replaced, and without the paper's claims."""
    return scene_from({**hinge_data(), "claims": [], **changes})


def cantilever_data(load: dict[str, Any], stations: list[float]) -> dict[str, Any]:
    return {
        "name": "cantilever",
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.31}},
        "bodies": {
            "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
            "tip": {"motion": "free", "points": {"T": [LENGTH, 0.0]}},
        },
        "beams": {
            "beam": {
                "curve": {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]},
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
            {"of": "R", "quantity": "reaction"},
            {"of": "R", "quantity": "reaction_moment"},
            {"of": "beam", "quantity": "bending_stress", "points": 11},
            {"of": "scene", "quantity": "potential_energy"},
        ],
    }


def force(x: float, y: float) -> dict[str, Any]:
    return {"kind": "force", "point": "T", "direction": [x, y]}


def drives_of(point: str, body: str) -> dict[str, Any]:
    """Three drives, square to each other or not, that hold a body where it stands."""
    return {
        "across": {"kind": "displacement", "point": point, "direction": [0.83, 0.56]},
        "beside": {"kind": "displacement", "point": point, "direction": [-0.31, 0.95]},
        "turn": {"kind": "rotation", "body": body},
    }


MOMENT = {"kind": "moment", "body": "tip"}


def cantilever(load: dict[str, Any], stations: list[float]):
    return scene_from(cantilever_data(load, stations))


def turned(data: dict[str, Any], angle: float, shift: tuple[float, float]) -> dict[str, Any]:
    """The same scene after a rigid motion: every place and every direction turned."""
    from math import cos, sin

    c, s = cos(angle), sin(angle)

    def place(p: list[float]) -> list[float]:
        return [c * p[0] - s * p[1] + shift[0], s * p[0] + c * p[1] + shift[1]]

    out = {**data}
    out["bodies"] = {
        name: {**body, "points": {k: place(p) for k, p in body["points"].items()}}
        for name, body in data["bodies"].items()
    }
    out["beams"] = {
        name: {
            **beam,
            "curve": {k: place(v) if isinstance(v, list) else v for k, v in beam["curve"].items()},
        }
        for name, beam in data["beams"].items()
    }
    out["loads"] = {
        name: {
            **load,
            "direction": [
                c * load["direction"][0] - s * load["direction"][1],
                s * load["direction"][0] + c * load["direction"][1],
            ],
        }
        if "direction" in load
        else load
        for name, load in data["loads"].items()
    }
    return out
