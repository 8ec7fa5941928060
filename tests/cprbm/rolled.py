"""A straight strip bent until it comes back to itself: shapes without equilibrium, for geometry and derivatives."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

import cprbm
from cprbm.kinematics import State, rest_state
from cprbm.mechanism import mechanism_of
from scene.reading import scene_from
from tests.references.pressed_column import closing

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
