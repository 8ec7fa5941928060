"""A beam lets go of another where it cannot stand without it, and comes to rest beside: both solvers go on.

Each is the other's reference; the CPRBM's values, of second order in a link, are extrapolated from two meshes.
"""

from pathlib import Path

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import read

SCENE = Path(__file__).parent / "scenes" / "let-go.toml"


def test_what_lets_go_under_tight_penalties_is_not_pressed_again_by_loose_ones():
    scene = read(SCENE)
    got = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    coarse, fine = (cprbm.answer(scene, cprbm.Settings(links=links)) for links in (40, 80))
    assert got.completed, got.sentence
    assert any("contact1 lets go" in note for note in got.notes)
    for mine, one, two in zip(got.stations, coarse.stations, fine.stations, strict=True):
        for probe, value in mine.values.items():
            expected = two.values[probe] + (two.values[probe] - one.values[probe]) / 3.0
            scale = max(float(np.abs(station.values[probe]).max()) for station in got.stations)
            assert value == pytest.approx(expected, abs=2e-3 * scale), probe
