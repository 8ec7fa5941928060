"""Two beams whose thickness varies, and that touch by their edges."""

from typing import Any

import numpy as np
import pytest

from fea_reference import Settings, answer
from scene import Ending
from scene.reading import scene_from

YOUNG, WIDTH, LENGTH = 2e9, 0.01, 0.1
THICK, THIN = 0.003, 0.0012
SLOPE = (THIN - THICK) / LENGTH
FORCE = YOUNG * WIDTH * THIN**3 / 12.0 / LENGTH**2
HARD = 1e7  # times as stiff: as good as rigid


def profile(*values: float) -> dict[str, Any]:
    return {"at": np.linspace(0.0, 1.0, len(values)).tolist(), "values": list(values)}


def pressed(contact: dict[str, Any], beams: dict[str, Any], load: float, thickness: Any, points: dict[str, Any]):
    """A level cantilever of varying thickness, pressed down at its tip on something below it."""
    return scene_from(
        {
            "name": "tapered",
            "materials": {
                "m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3},
                "hard": {"youngs_modulus": HARD * YOUNG, "poisson_ratio": 0.3},
            },
            "bodies": {
                "ground": {"motion": "fixed", "points": {"R": [0.0, 0.0], **points}},
                "end": {"motion": "free", "points": {"T": [LENGTH, 0.0]}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]},
                    "thickness": thickness,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                },
                **beams,
            },
            "loads": {"P": {"kind": "force", "point": "T", "direction": [0.0, -1.0]}},
            "contacts": {"c": contact},
            "stages": [{"name": "load", "steps": "P", "stations": [0.5 * load, load]}],
            "probes": [
                *({"of": "c", "quantity": quantity} for quantity in ("force", "centre", "ends", "closing_load")),
                {"of": "T", "quantity": "displacement"},
                {"of": "R", "quantity": "reaction"},
                {"of": "R", "quantity": "reaction_moment"},
            ],
        }
    )


def solved(scene, elements=40, penetration=1e-5):
    got = answer(scene, Settings(elements=elements, kinematics="bending", penetration=penetration))
    assert got.ending is Ending.COMPLETED, got.sentence
    return got.stations[-1].values


def on_an_arc(center, radius: float, load: float, thickness: Any, between=("beam", "arc"), arc_thickness: Any = 0.002):
    """On a stiff arc whose surface has that ``radius`` where its thickness is 2 mm."""
    rho = radius - 0.001
    start, end = ([center[0] + rho * np.cos(a), center[1] + rho * np.sin(a)] for a in (2.4, 0.7))
    curve = {"kind": "arc", "center": list(center), "start": start, "end": end, "direction": "clockwise"}
    arc = {
        "curve": curve,
        "thickness": arc_thickness,
        "width": WIDTH,
        "material": "hard",
        "start": {"joint": "weld", "point": "S"},
        "end": {"joint": "weld", "point": "E"},
    }
    contact = {"kind": "beam-beam", "between": list(between)}
    return pressed(contact, {"arc": arc}, load, thickness, {"S": start, "E": end})


def on_a_circle(center, radius: float, load: float, thickness: Any):
    contact = {"kind": "beam-circle", "beam": "beam", "body": "ground", "center": list(center), "radius": radius}
    return pressed(contact, {}, load, thickness, {})


if __name__ == "__main__":
    center, radius = (0.06, -0.0125), 0.01
    for n in (20, 40, 80):
        a = solved(on_a_circle(center, radius, 8 * FORCE, profile(THICK, THIN)), n)
        b = solved(on_an_arc(center, radius, 8 * FORCE, profile(THICK, THIN)), {"beam": n, "arc": 24})
        for k in a:
            print(n, k, a[k], b[k], np.max(np.abs(a[k] - b[k])) / np.max(np.abs(a[k])))
