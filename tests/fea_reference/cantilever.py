"""Scenes of one straight cantilever, and exact answers for them that know nothing of the code under test."""

from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipeinc, ellipk, ellipkinc

from cprbm_scene import Scene, scene_from

LENGTH, THICKNESS, WIDTH, YOUNG, POISSON = 0.3, 0.002, 0.01, 2e9, 0.3
EI = YOUNG * WIDTH * THICKNESS**3 / 12


def cantilever(
    load: dict[str, Any],
    stations: tuple[float, ...],
    *,
    length: float = LENGTH,
    thickness: float = THICKNESS,
    young: float = YOUNG,
    units: float = 1.0,
    angle: float = 0.0,
) -> Scene:
    """A beam from the origin along ``angle``, clamped to the ground, with a rigid tip that carries ``load``.

    ``units`` multiplies every length.
    """
    tip = (units * length * np.cos(angle), units * length * np.sin(angle))
    return scene_from(
        {
            "name": "cantilever",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": young, "poisson_ratio": POISSON}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"root": [0.0, 0.0]}},
                "end": {"motion": "free", "points": {"tip": list(tip)}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": list(tip)},
                    "thickness": units * thickness,
                    "width": units * WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "root"},
                    "end": {"joint": "weld", "point": "tip"},
                }
            },
            "loads": {"P": load},
            "stages": [{"name": "load", "steps": "P", "stations": list(stations)}],
            "probes": [
                {"of": "tip", "quantity": "displacement"},
                {"of": "end", "quantity": "rotation"},
                {"of": "root", "quantity": "reaction"},
                {"of": "root", "quantity": "reaction_moment"},
                {"of": "beam", "quantity": "bending_stress", "points": 11},
                {"of": "scene", "quantity": "potential_energy"},
            ],
        }
    )


def force(x: float, y: float) -> dict[str, Any]:
    """A dead force at the tip."""
    return {"kind": "force", "point": "tip", "direction": [x, y]}


MOMENT = {"kind": "moment", "body": "end"}


def elastica(alpha: float) -> tuple[float, float, float]:
    """Tip of an inextensible cantilever under a dead force P normal to it, alpha = P L²/EI.

    Bisshopp and Drucker, Quarterly of Applied Mathematics 3 (1945) 272: with k² = (1 + sin φ)/2 and
    sin t = 1/(k √2), √alpha = K(k) − F(t, k); x = √(2 sin φ/alpha),
    y = 1 − (2/√alpha) (E(k) − E(t, k)).

    Returns:
        (x, y, φ): the tip's place along and across over the length, and its rotation.
    """

    def missing(phi: float) -> float:
        m = (1 + np.sin(phi)) / 2
        t = np.arcsin(1 / np.sqrt(2 * m))
        return float(ellipk(m) - ellipkinc(t, m) - np.sqrt(alpha))

    phi = brentq(missing, 1e-9, np.pi / 2 - 1e-12, xtol=1e-15, rtol=1e-15)
    m = (1 + np.sin(phi)) / 2
    t = np.arcsin(1 / np.sqrt(2 * m))
    y = 1 - 2 / np.sqrt(alpha) * (ellipeinc(np.pi / 2, m) - ellipeinc(t, m))
    return float(np.sqrt(2 * np.sin(phi) / alpha)), float(y), float(phi)
