"""A foil that is strung between two clamps, and a peg pressed into it: as good as a string, which has no stiffness."""

import numpy as np
import pytest
from scipy.optimize import brentq

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer

LENGTH, THIN, WIDE, YOUNG = 0.107, 0.00003, 0.0123, 3.1e9
RADIUS, PLACE, GAP = 0.0053, 0.041, 0.0004  # m


def strung(depth):
    centre = [PLACE, RADIUS + GAP]
    return scene_from(
        {
            "name": "strung",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.33}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"A": [0.0, 0.0], "B": [LENGTH, 0.0]}},
                "peg": {"motion": "slides", "along": [0.0, 1.0], "points": {"C": centre}},
            },
            "beams": {
                "foil": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]},
                    "thickness": THIN,
                    "width": WIDE,
                    "material": "m",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "weld", "point": "B"},
                }
            },
            "drives": {"press": {"kind": "displacement", "point": "C", "direction": [0.0, -1.0]}},
            "contacts": {
                "touch": {
                    "kind": "beam-circle",
                    "beam": "foil",
                    "body": "peg",
                    "center": centre,
                    "radius": RADIUS,
                    "thick": False,
                }
            },
            "stages": [{"name": "press", "steps": "press", "stations": [depth]}],
            "probes": [{"of": "touch", "quantity": "force"}],
        }
    )


def string(depth):
    """Force of a string without bending stiffness, N: tangents from both clamps to the circle, and the arc between."""
    down = depth - RADIUS - GAP
    length, across = 0.0, 0.0
    for along in (PLACE, LENGTH - PLACE):
        away = np.hypot(along, down)
        slope = np.arctan2(down, along) + np.arcsin(RADIUS / away)
        length += np.sqrt(away**2 - RADIUS**2) + RADIUS * slope
        across += np.sin(slope)
    return YOUNG * WIDE * THIN * (length - LENGTH) / LENGTH * across


def foil(depth):
    """Force of the same with its bending stiffness, N: EI w'''' = N w'' on both sides of the peg, taken for a point.

    Slopes are up to 0.02, and the peg is touched along 1e-4 m, a tenth of √(EI/N).
    """
    down, bending, tension = depth - GAP, YOUNG * WIDE * THIN**3 / 12.0, YOUNG * WIDE * THIN

    def shape(x, length, k, order):
        straight = ([1.0, x], [0.0, 1.0], [0.0, 0.0], [0.0, 0.0])[order]
        return np.array([*straight, (-k) ** order * np.exp(-k * x), k**order * np.exp(k * (x - length))])

    def solved(pull):
        k, lengths, none = np.sqrt(pull / bending), (PLACE, LENGTH - PLACE), np.zeros(4)
        first, second = [lambda x, n, at=at: shape(x, at, k, n) for at in lengths]
        rows = np.array(
            [
                *([*first(0.0, n), *none] for n in (0, 1)),
                *([*none, *second(lengths[1], n)] for n in (0, 1)),
                [*first(lengths[0], 0), *none],
                [*none, *second(0.0, 0)],
                *([*first(lengths[0], n), *-second(0.0, n)] for n in (1, 2)),
            ]
        )
        scale = 1.0 / np.abs(rows).max(axis=1)
        found = np.linalg.solve(scale[:, None] * rows, scale * np.array([0, 0, 0, 0, down, down, 0, 0]))
        force = bending * (second(0.0, 3) @ found[4:] - first(lengths[0], 3) @ found[:4])
        points, weights = np.polynomial.legendre.leggauss(200)
        longer = sum(
            0.25 * length * weights @ np.array([(one(0.5 * length * (1.0 + x), 1) @ c) ** 2 for x in points])
            for length, one, c in zip(lengths, (first, second), (found[:4], found[4:]), strict=True)
        )
        return force, tension * longer / LENGTH

    return solved(brentq(lambda pull: solved(pull)[1] - pull, 1e-3, 1.0))[0]


@pytest.mark.parametrize(("elements", "within"), [(20, 0.02), (40, 0.005), (160, 0.001)])
def test_a_foil_on_a_peg_presses_as_its_tension_asks(elements, within):
    """Of 20 elements a force of 2.8 N was certified, in place of some 3 mN, across a gap of 20 mm."""
    assert string(0.0011) == pytest.approx(2.87e-3, rel=1e-3)
    assert foil(0.0011) == pytest.approx(string(0.0011), rel=0.06)
    found = answer(strung(0.0011), Settings(elements=elements, kinematics="stretch"))
    assert found.ending is Ending.COMPLETED, found.sentence
    assert found.stations[0].values["touch.force"][0] == pytest.approx(foil(0.0011), rel=within)
