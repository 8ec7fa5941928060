"""A scene with contacts of all kinds, and random states of the mechanism."""

from __future__ import annotations

from typing import Any

import numpy as np

from cprbm.chain import add_rows, mechanism_of
from cprbm.contact import contact_geometry, fixed_places, new_counters, settle, sides_at_rest
from cprbm_scene import scene_from

FINDING = 80
"""Iterations of moving places."""

UPPER = ((0.0, 0.01), (0.03, 0.0104), (0.06, 0.0118), (0.09, 0.0141))


def data(angle: float, between: tuple[str, str]) -> dict[str, Any]:
    """The scene, turned by an angle about the origin, with two beams in a contact."""
    c, s = np.cos(angle), np.sin(angle)

    def at(x: float, y: float) -> list[float]:
        return [float(c * x - s * y), float(s * x + c * y)]

    beam = {"width": 0.009, "material": "m"}
    block = {"beam": "upper", "body": "block"}
    ground = {"beam": "lower", "body": "ground"}
    scene = {
        "name": "workshop",
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": 2.1e9, "poisson_ratio": 0.3}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"A": at(0.0, 0.0), "B": at(0.0, 0.01)}},
            "block": {"motion": "free", "points": {"C": at(0.1, 0.0)}},
        },
        "beams": {
            "lower": {
                **beam,
                "curve": {"kind": "line", "start": at(0.0, 0.0), "end": at(0.1, 0.0)},
                "thickness": 0.0021,
                "start": {"joint": "weld", "point": "A"},
                "end": {"joint": "weld", "point": "C"},
            },
            "upper": {
                **beam,
                "curve": {
                    "kind": "spline",
                    "points": [at(0.0, 0.01), at(0.03, 0.0104), at(0.06, 0.0118), at(0.09, 0.0141)],
                },
                "thickness": {"at": [0.0, 1.0], "values": [0.0022, 0.0013]},
                "start": {"joint": "weld", "point": "B"},
                "end": {"joint": "free"},
            },
        },
        "loads": {"F": {"kind": "force", "point": "C", "direction": at(0.0, -1.0)}},
        "contacts": {
            "beams": {"kind": "beam-beam", "between": list(between)},
            "circle": {"kind": "beam-circle", **block, "center": at(0.045, 0.027), "radius": 0.008},
            "line": {
                "kind": "beam-line",
                **block,
                "points": [at(0.06, 0.03), at(0.07, 0.02), at(0.085, 0.033), at(0.06, 0.03)],
                "side": "right",
            },
            "plane": {"kind": "beam-half-plane", **ground, "point": at(0.0, -0.02), "normal": at(0.0, 1.0)},
        },
        "stages": [{"name": "load", "steps": "F", "stations": [1.0]}],
        "probes": [{"of": "C", "quantity": "displacement"}],
    }
    if angle == 0.0:
        scene["contacts"]["graph"] = {
            "kind": "beam-function",
            **ground,
            "axis": "x",
            "coefficients": [-0.0095, 0.13, -1.3],
            "range": [-0.01, 0.11],
            "side": "above",
        }
        ellipse = {"center": [0.02, 0.028], "semi_axes": [0.014, 0.007], "angle": 0.2}
        scene["contacts"]["ellipse"] = {"kind": "beam-ellipse", **block, **ellipse}
        ring = {"center": [0.05, 0.01], "radius": 0.08, "side": "inside"}
        scene["contacts"]["ring"] = {"kind": "beam-circle", **ground, **ring}
    return scene


def mechanism(links: int = 9, angle: float = 0.0, between: tuple[str, str] = ("upper", "lower")):
    """Mechanism, geometry of the contacts, unknowns at rest."""
    return geometry_of(scene_from(data(angle, between)), links)


def geometry_of(scene, links: int):
    """The same of any scene."""
    m = mechanism_of(scene, dict.fromkeys(scene.beams, links), "bending", corrected=True)
    add_rows(m)
    geometry = contact_geometry(m)
    return m, geometry, np.array(m.rest)


def random_state(m, geometry, rest, seed: int, size: float = 3e-3):
    """Nodes and angles moved at random."""
    rng = np.random.default_rng(seed)
    return rest + size * rng.normal(size=rest.shape)


def settled(geometry, z, places, steps: int = 0):
    """Gaps and curvatures of places, feet and moving places found."""
    gaps, curvatures = np.empty(len(places.pair)), np.empty(len(places.pair))
    settle(z, geometry.arrays, places, gaps, curvatures, new_counters(), steps)
    return gaps, curvatures


def all_places(geometry, z, rest):
    """Fixed places of all pairs in a state."""
    sides = sides_at_rest(geometry, rest, new_counters())
    return fixed_places(geometry, z, sides, np.ones(len(geometry.pairs), dtype=bool), new_counters())


def at(curve, z, s):
    """Points (k,) of a curve at arc lengths, from the weights."""
    piece = np.clip(np.searchsorted(curve.arcs, s, side="right") - 1, 0, curve.pieces - 1)
    span = np.where(np.diff(curve.arcs) > 0.0, np.diff(curve.arcs), 1.0)
    xi = (s - curve.arcs[piece]) / span[piece]
    nodes = z[curve.stencil[piece]] + 1j * z[curve.stencil[piece] + 1]
    return np.einsum("ki,kip,kp->k", nodes, curve.weights[piece], xi[:, None] ** np.arange(4))
