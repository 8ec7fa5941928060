"""A strip that comes back to the clamped end that it began with, from behind and across it, and is pushed on to it."""

from __future__ import annotations

import numpy as np

from cprbm_scene import Scene, scene_from

BEHIND = -0.006  # m, where the strip passes the clamp


def hook(lean: float, thickness: tuple[float, float], stations: list[float], *, backwards: bool) -> Scene:
    """The clamp is at the origin, the strip begins there at the angle ``lean``, with the first ``thickness``, m.

    Its other end is pushed along x by ``stations``, m; ``backwards`` is the same drawn from there.
    """
    x, y = float(np.cos(lean)), float(np.sin(lean))
    points = [[0.0, 0.0], [0.05 * x, 0.05 * y], [0.09, 0.045], [0.05, 0.09], [0.01, 0.065]]
    points += [[BEHIND, 0.0], [BEHIND - 0.002, -0.033]]
    clamp, tip = ({"joint": "weld", "point": name} for name in ("R", "T"))
    turn = slice(None, None, -1) if backwards else slice(None)
    direction = {"end_direction": [-x, -y]} if backwards else {"start_direction": [x, y]}
    start, end = (clamp, tip)[turn]
    return scene_from(
        {
            "name": "hook",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": 114e9, "poisson_ratio": 0.33}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": points[0]}},
                "tip": {"motion": "free", "points": {"T": points[-1]}},
            },
            "beams": {
                "strip": {
                    "curve": {"kind": "spline", "points": points[turn], **direction},
                    "thickness": {"at": [0.0, 1.0], "values": thickness[turn]},
                    "width": 0.011,
                    "material": "m",
                    "start": start,
                    "end": end,
                }
            },
            "drives": {"push": {"kind": "displacement", "point": "T", "direction": [1.0, 0.0]}},
            "contacts": {"itself": {"kind": "beam-self", "beam": "strip"}},
            "stages": [{"name": "push", "steps": "push", "stations": stations}],
            "probes": [
                {"of": "scene", "quantity": "potential_energy"},
                {"of": "T", "quantity": "displacement"},
                {"of": "itself", "quantity": "force"},
            ],
        }
    )
