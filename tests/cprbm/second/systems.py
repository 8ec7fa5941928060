"""Systems and states of scenes for tests of the chain's formulas, and the dense matrix of their Hessian."""

from dataclasses import replace

import numpy as np

from cprbm.chain import add_rows, mechanism_of
from cprbm.contact import contact_geometry
from cprbm.equilibrium.factors import pulls
from cprbm.equilibrium.linear import add_gradient
from cprbm.equilibrium.system import rest_state, system_of
from cprbm_scene import scene_from
from tests.cprbm_scene.editing import edited

STEEL = {"youngs_modulus": 2.07e11, "poisson_ratio": 0.3}


def loop(theory="shear", links=5, *, corrected=True, turn=0.0, shift=(0.0, 0.0), fixed_ends=2):
    """System of a curved, tapered beam between the ground and a lever, and of a straight beam beside it."""

    def placed(x, y):
        return [np.cos(turn) * x - np.sin(turn) * y + shift[0], np.sin(turn) * x + np.cos(turn) * y + shift[1]]

    data = {
        "name": "loop",
        "theory": theory,
        "materials": {"steel": STEEL},
        "bodies": {
            "wall": {"motion": "fixed", "points": {"R": placed(0.0, 0.0), "S": placed(0.0, 0.03)}},
            "lever": {"motion": "free", "points": {"A": placed(0.1, 0.02), "B": placed(0.1, 0.05)}},
        },
        "beams": {
            "bent": {
                "curve": {"kind": "spline", "points": [placed(0.0, 0.0), placed(0.05, 0.018), placed(0.1, 0.02)]},
                "thickness": {"at": [0.0, 0.4, 1.0], "values": [0.002, 0.0011, 0.0017]},
                "width": 0.01,
                "material": "steel",
                "start": {"joint": "weld", "point": "R"},
                "end": {"joint": "pin", "point": "A"},
            },
            "straight": {
                "curve": {"kind": "line", "start": placed(0.0, 0.03), "end": placed(0.1, 0.05)},
                "thickness": 0.0013,
                "width": 0.01,
                "material": "steel",
                "start": {"joint": "pin", "point": "S"},
                "end": {"joint": "weld", "point": "B"},
            },
        },
        "loads": {
            "q": {"kind": "distributed", "beam": "bent", "direction": placed(0.0, -1.0), "along": [0.2, 0.7]},
            "m": {"kind": "moment", "body": "lever"},
            "k": {"kind": "beam_moment", "beam": "straight", "at": 0.37},
        },
        "stages": [{"name": "turn", "steps": "m", "stations": [0.5]}],
        "probes": [{"of": "A", "quantity": "displacement"}],
    }
    if turn or any(shift):
        data["loads"]["q"]["direction"] = [float(-np.sin(turn)) * -1.0, float(np.cos(turn)) * -1.0]
    return built(scene_from(data), links, corrected=corrected), scene_from(data)


def built(scene, links, *, corrected=True):
    """System of a scene."""
    mechanism = mechanism_of(scene, dict.fromkeys(scene.beams, links), scene.theory, corrected=corrected)
    add_rows(mechanism)
    return system_of(mechanism, contact_geometry(mechanism))


def disturbed(system, seed, size):
    """A state near rest, every unknown moved by a random amount, forces of links by a hundred times as much."""
    state, random = rest_state(system), np.random.default_rng(seed)
    z = state.z + size * random.normal(size=len(state.z))
    z[system.links.first[:, None] + [2, 3]] *= 100.0
    return replace(state, z=z)


def gradient(system, state):
    """Gradient of the Lagrangian."""
    found = np.zeros(system.size)
    add_gradient(state.z, system.numbers, state.driven, state.target, *pulls(system, None), found)
    return found


def dense_hessian(system, state):
    """Dense Hessian of the Lagrangian by central differences of the gradient; undriven rows stand for themselves."""
    n, step = system.size, 1e-6
    matrix = np.zeros((n, n))
    for i in range(n):
        sides = [gradient(system, replace(state, z=state.z + sign * step * np.eye(n)[i])) for sign in (1.0, -1.0)]
        matrix[:, i] = (sides[0] - sides[1]) / (2.0 * step)
    forced = system.rows.first + np.flatnonzero(~state.driven)
    matrix[forced], matrix[:, forced] = 0.0, 0.0
    matrix[forced, forced] = 1.0
    return 0.5 * (matrix + matrix.T)


__all__ = ["built", "dense_hessian", "disturbed", "edited", "gradient", "loop"]
