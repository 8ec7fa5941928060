"""An imperfection of a beam: a part of the curve, for every solver."""

from math import cos, pi, sin

import numpy as np
import pytest

import cprbm
import elastica_reference
import fea_reference
from cprbm_scene import scene_from
from cprbm_scene.curve_records import shape_of
from fea_reference import solid
from tests.cprbm_scene.editing import edited, mistakes

L, T, WIDTH, E = 0.1, 1e-3, 0.01, 2e9
EULER = pi**2 * E * WIDTH * T**3 / 12.0 / L**2
AMPLITUDE = 1e-4 * L


def column(half_waves, **beam):
    """A pinned column under half of Euler's load, with an imperfection."""
    strip = {
        "curve": {"kind": "line", "start": [0.0, 0.0], "end": [L, 0.0]},
        "thickness": T,
        "width": WIDTH,
        "material": "m",
        "start": {"joint": "pin", "point": "A"},
        "end": {"joint": "pin", "point": "B"},
        "imperfection": {"amplitude": AMPLITUDE, "half_waves": half_waves},
    }
    return {
        "name": "column",
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": E, "poisson_ratio": 0.3}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"A": [0.0, 0.0]}},
            "slider": {"motion": "slides", "along": [1.0, 0.0], "points": {"B": [L, 0.0]}},
        },
        "beams": {"strip": strip | beam},
        "loads": {"P": {"kind": "force", "point": "B", "direction": [-1.0, 0.0]}},
        "stages": [{"name": "press", "steps": "P", "stations": [0.5 * EULER]}],
        "probes": [{"of": "strip", "quantity": "bending_stress", "points": 81}],
    }


@pytest.mark.parametrize(
    ("solve", "off"),
    [
        (cprbm.answer, 1e-3),
        (lambda scene: fea_reference.answer(scene, fea_reference.Settings(kinematics="bending")), 1e-6),
        (elastica_reference.answer, 1e-6),
        (lambda scene: solid.answer(scene, solid.Settings(elements=32, across=1)), 1e-3),
    ],
    ids=["cprbm", "fea", "exact", "solid"],
)
def test_every_solver_answers_an_imperfect_column(solve, off):
    # reference: a sine of n half waves grows by 1/(1 - P/(n² P_E)) in a column with pinned ends (Timoshenko and Gere,
    # Theory of Elastic Stability, 1.12); the bending moment is P times the deflection
    answer = solve(scene_from(column(2)))
    moment = 0.5 * EULER * AMPLITUDE / (1.0 - 0.5 / 4.0)
    stress = answer.stations[0].values["strip.bending_stress"]
    assert stress[20] == pytest.approx(-stress[60], rel=1e-3)
    assert np.abs(stress).max() == pytest.approx(6.0 * moment / (WIDTH * T**2), rel=off)


def test_the_offset_is_along_the_left_normal_of_any_curve():
    # reference: a circle; its left normal points to the centre where it runs counter-clockwise
    end = [L * cos(1.0), L * sin(1.0)]
    arc = {"kind": "arc", "center": [0.0, 0.0], "start": [L, 0.0], "end": end, "direction": "counterclockwise"}
    data = edited(("bodies/ground/points/A", [L, 0.0]), ("bodies/slider/points/B", end), base=column(3, curve=arc))
    beam = scene_from(data).beams["strip"]
    assert (beam.curve.kind, beam.imperfection) == ("spline", None)
    u = np.linspace(0.0, 1.0, 50)
    x, y = shape_of(beam.curve).point(u).T
    turn = np.arctan2(y, x)
    assert np.hypot(x, y) == pytest.approx(L - AMPLITUDE * np.sin(3.0 * pi * turn), abs=1e-6 * AMPLITUDE)


def test_amplitude_and_half_waves_are_checked():
    base = column(1)
    assert "at least 1" in mistakes(("beams/strip/imperfection/half_waves", 0), base=base).popitem()[1]
    assert "at most 15" in mistakes(("beams/strip/imperfection/half_waves", 16), base=base).popitem()[1]
    sharp = {"amplitude": 0.01, "half_waves": 15}
    assert list(mistakes(("beams/strip/imperfection", sharp), base=base)) == ["beams.strip.thickness"]
