"""How far a drive may go before a beam would have to become longer."""

from math import acos, asin, hypot, pi, sqrt

import numpy as np
import pytest

from cprbm_scene import scene_from
from tests.robustness.estimate import Barrier, Estimate, State
from tests.robustness.taut import length, slack, tight

CENTER, RADIUS = np.array([0.43, 0.21]), 0.09


def round_circle(apart=0.0):
    return Barrier("beam1", lambda p: np.hypot(*(p - CENTER).T) - RADIUS, apart)


def test_a_line_pulled_tight_round_a_circle_is_two_tangents_and_an_arc():
    # closed form: tangents of √(d² − ρ²) from either end, and between them the angle at the centre less those of both
    line = np.array([[0.0, 0.0], [0.2, 0.5], [0.7, 0.6], [1.0, 0.05]])
    rho, u = RADIUS + 0.02, np.linspace(0.0, 3.0, 49)
    places = np.stack([np.interp(u, np.arange(4), each) for each in line.T], axis=1)
    found = length(tight(places, [round_circle(0.02)]))
    one, other = line[0] - CENTER, line[-1] - CENTER
    d, e = hypot(*one), hypot(*other)
    below = acos(float(one @ other) / (d * e))  # seen from the centre, on the side away from the line
    arc = 2.0 * pi - below - acos(rho / d) - acos(rho / e)
    assert found == pytest.approx(sqrt(d**2 - rho**2) + sqrt(e**2 - rho**2) + rho * arc, rel=2e-3)


def pulled(last, contact):
    """A half ring from the ground to a slide that is drawn away from it, as far as ``last``."""
    data = {
        "name": "pulled",
        "theory": "bending",
        "materials": {"abs": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
        "bodies": {
            "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
            "tip": {"motion": "slides", "along": [1.0, 0.0], "points": {"T": [1.0, 0.0]}},
        },
        "beams": {
            "beam1": {
                "curve": {
                    "kind": "arc", "center": [0.5, 0.0], "direction": "clockwise",
                    "start": [0.0, 0.0], "end": [1.0, 0.0],
                },
                "thickness": 0.004, "width": 0.1, "material": "abs",
                "start": {"joint": "pin", "point": "R"}, "end": {"joint": "pin", "point": "T"},
            }
        },
        "drives": {"act1": {"kind": "displacement", "point": "T", "direction": [1.0, 0.0]}},
        "stages": [{"name": "stage1", "steps": "act1", "stations": [last]}],
        "probes": [{"of": "scene", "quantity": "potential_energy"}],
    }  # fmt: skip
    model = Estimate(scene_from(data))
    # as a chain that has slipped past what is in its way: both ends are where the drive has them, and that alone counts
    states = []
    for share in (0.5, 1.0):
        q = np.zeros(model.unknowns)
        q[model.bodies["tip"]] = share * last
        first, chord = model.turns["beam1"], 1.0 + share * last
        bars = np.diff(model.shape(np.zeros(model.unknowns), "beam1"), axis=0)
        at_rest = np.arctan2(bars[:, 1], bars[:, 0])
        q[first] = _half_turn(chord, float(np.hypot(*bars.T).sum())) - at_rest
        states.append(State(q, {"act1": share * last}))
    return slack(model, states, contact)


def _half_turn(chord, total):
    """Directions of ten bars of a ``total`` length along an arc over a ``chord``."""
    low, high = 1e-6, pi
    for _ in range(60):
        half = 0.5 * (low + high)
        spanned = total / 10.0 * np.cos(half * np.linspace(-0.9, 0.9, 10)).sum()
        low, high = (half, high) if spanned > chord else (low, half)
    return half * np.linspace(0.9, -0.9, 10)


def test_a_drive_goes_no_farther_than_a_beam_round_a_circle_reaches():
    # closed form: the drive at which two tangents and the arc over the circle are 0.97 of the half ring's length
    found = pulled(0.45, [round_circle()])["act1"]
    d, e = hypot(*CENTER), hypot(CENTER[0] - 1.0 - found, CENTER[1])
    tangents = sqrt(d**2 - RADIUS**2) + sqrt(e**2 - RADIUS**2)
    turned = asin(CENTER[1] / d) + asin(RADIUS / d) + asin(CENTER[1] / e) + asin(RADIUS / e)
    assert tangents + RADIUS * turned == pytest.approx(0.97 * 0.5 * pi, rel=0.02)


def test_without_anything_in_its_way_a_drive_goes_where_its_chain_goes():
    assert pulled(0.45, []) == {"act1": 0.45}
