"""Loads stepped together, and drives that begin with a stage."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import scene_from

CANTILEVER = {
    "name": "cantilever",
    "theory": "bending",
    "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
    "bodies": {
        "ground": {"motion": "fixed", "points": {"A": [0.0, 0.0]}},
        "tip": {"motion": "free", "points": {"T": [0.1, 0.0]}},
    },
    "beams": {
        "strip": {
            "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.1, 0.0]},
            "thickness": 1e-3,
            "width": 0.01,
            "material": "steel",
            "start": {"joint": "weld", "point": "A"},
            "end": {"joint": "weld", "point": "T"},
        }
    },
    "loads": {
        "F": {"kind": "force", "point": "T", "direction": [0.0, -1.0]},
        "H": {"kind": "force", "point": "T", "direction": [1.0, 0.0]},
        "R": {"kind": "force", "point": "T", "direction": [1.0, -1.0]},
    },
    "probes": [{"of": "T", "quantity": "displacement"}, {"of": "A", "quantity": "reaction"}],
}


def answered(stages, **records):
    """Stations of the cantilever under other stages."""
    found = cprbm.answer(scene_from(CANTILEVER | records | {"stages": stages}), cprbm.Settings(links=12))
    assert found.completed
    return found.stations


def stage(name, steps, *stations):
    return {"name": name, "steps": steps, "stations": list(stations)}


def test_two_loads_stepped_together_are_their_resultant():
    together = answered([stage("both", ["F", "H"], 5.0, 10.0)])
    resultant = answered([stage("resultant", "R", 5.0 * 2**0.5, 10.0 * 2**0.5)])
    for one, other in zip(together, resultant, strict=True):
        assert one.values["T.displacement"] == pytest.approx(other.values["T.displacement"], abs=1e-12)


def test_a_drive_that_begins_with_a_stage_takes_over_the_load_and_goes_on_from_there():
    clamp = {"kind": "displacement", "point": "T", "direction": [0.0, 1.0], "from": "unload"}
    stages = [stage("press", "F", 10.0), stage("unload", "F", 5.0, 0.0), stage("go", "clamp", -0.02, 0.0)]
    pressed, *unloaded, further, back = answered(stages, drives={"clamp": clamp})
    # statics: the wall balances the load before, and the drive's equal force after
    for station in unloaded:
        assert station.values["T.displacement"] == pytest.approx(pressed.values["T.displacement"], abs=1e-12)
        assert station.values["A.reaction"] == pytest.approx([0.0, 10.0], abs=1e-8)
    assert further.values["T.displacement"][1] == pytest.approx(-0.02)
    assert np.abs(back.values["T.displacement"]).max() < 1e-12
