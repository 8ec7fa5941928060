"""A straight strip that comes back to itself: bent to shapes without equilibrium, and rolled by its end."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

import cprbm
from cprbm.kinematics import State, rest_state
from cprbm.mechanism import mechanism_of
from cprbm_scene import scene_from
from tests.references.pressed_column import closing

MODULUS, WIDTH, THICKNESS = 3.0e9, 0.02, 0.005  # the latter two over the length
NARROWS = (0.0, 0.3, 0.9, 1.0), (1.0, 0.75, 0.75, 0.4)  # of a strip's width, which make a roll a spiral


def strip(angle, thickness, *, thick=True, held="C", links=40):
    """A mechanism of one straight strip of length one, and a state in which it is bent.

    Args:
        angle: tangent angles of arc lengths.
        thickness: over the length.
        thick: whether edges touch.
        held: "C" clamps the start to the ground and the end to a body that moves, "T" the other way round.
        links: N.
    """
    scene = scene_from(
        {
            "name": "strip",
            "materials": {"m": {"youngs_modulus": 2.0e9, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"C": [0.0, 0.0] if held == "C" else [1.0, 0.0]}},
                "tip": {"motion": "free", "points": {"T": [1.0, 0.0] if held == "C" else [0.0, 0.0]}},
            },
            "beams": {
                "strip": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [1.0, 0.0]},
                    "thickness": thickness,
                    "width": 0.01,
                    "material": "m",
                    "start": {"joint": "weld", "point": held},
                    "end": {"joint": "weld", "point": "T" if held == "C" else "C"},
                }
            },
            "loads": {"M": {"kind": "moment", "body": "tip"}},
            "contacts": {"lap": {"kind": "beam-self", "beam": "strip", "thick": thick}},
            "stages": [{"name": "load", "steps": "M", "stations": [1e-3]}],
            "probes": [{"of": "lap", "quantity": "force"}],
        }
    )
    mechanism = mechanism_of(scene, cprbm.Settings(links=links))
    model = mechanism.problem.model
    # each link has the tangent of the border that lies on it
    return mechanism, State(model.rest + angle(model.chains[0].borders), rest_state(model).bodies)


def neck(s):
    """A column of thickness 0.01 as its neck closes: turned by -π between the places that touch."""
    found = closing(0.01)
    half = solve_ivp(
        lambda _, z: [z[1], -found.force * np.sin(z[0])],
        (0.0, 0.5),
        [0.0, found.moment],
        "DOP853",
        rtol=1e-10,
        atol=1e-10,
        dense_output=True,
    )
    mirrored = np.where(s <= 0.5, s, 1.0 - s)
    return np.where(s <= 0.5, 1.0, -1.0) * half.sol(mirrored)[0]


def coil(s):
    """More than a turn, whose last part lies inside the first: turned by 2π between the places that are closest."""
    fine = np.linspace(0.0, 1.0, 4001)
    slope = 1.0 / np.interp(0.5 * (fine[1:] + fine[:-1]), *NARROWS)
    turned = np.concatenate(([0.0], np.cumsum(slope)))
    return 7.8 * np.interp(s, fine, turned / turned[-1])


def hooked(s):
    """Its end comes back to its middle at an angle."""
    return 5.8 * np.maximum(s - 0.3, 0.0) ** 1.2 / 0.7**1.2


def nearly_closed(s):
    """Its ends are before each other."""
    return 5.9 * s


def roll(stations, narrows=NARROWS, *, thick=True, backwards=False):
    """A scene of a strip of length one, its end turned to ``stations``, rad; ``backwards`` drawn from that end."""
    at, shares = narrows
    profile = (
        {"at": [1.0 - one for one in at[::-1]], "values": [WIDTH * one for one in shares[::-1]]}
        if backwards
        else {"at": list(at), "values": [WIDTH * one for one in shares]}
    )
    clamp, tip = ({"joint": "weld", "point": name} for name in ("C", "T"))
    places = {"C": [0.0, 0.0], "T": [1.0, 0.0]}
    ends = ("T", "C") if backwards else ("C", "T")
    return scene_from(
        {
            "name": "rolled",
            "materials": {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"C": places["C"]}},
                "tip": {"motion": "free", "points": {"T": places["T"]}},
            },
            "beams": {
                "strip": {
                    "curve": {"kind": "line", "start": places[ends[0]], "end": places[ends[1]]},
                    "thickness": THICKNESS,
                    "width": profile,
                    "material": "m",
                    "start": tip if backwards else clamp,
                    "end": clamp if backwards else tip,
                }
            },
            "drives": {"turn": {"kind": "rotation", "body": "tip"}},
            "contacts": {"lap": {"kind": "beam-self", "beam": "strip", "thick": thick}},
            "stages": [{"name": "roll", "steps": "turn", "stations": list(stations)}],
            "probes": [
                {"of": "T", "quantity": "displacement"},
                {"of": "tip", "quantity": "reaction_moment"},
                {"of": "lap", "quantity": "force"},
                {"of": "lap", "quantity": "centre"},
                {"of": "lap", "quantity": "closing_load"},
                {"of": "scene", "quantity": "potential_energy"},
            ],
        }
    )
