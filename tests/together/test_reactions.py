"""Reactions at points that are more than an end of a beam: pivots, driven points and stops, against statics."""

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH
from tests.together.pivots import FORCE, MATERIALS, STRIP, line, pin, weld

AB = ("A.reaction", "B.reaction")
SOLVERS = pytest.mark.parametrize("answer", [cprbm.answer, fea_reference.answer], ids=["cprbm", "fea"])


def values(answer, probes, bodies, start, end, load, stops=None):
    """Values of the only station of a strip from the ground's point A to a point of another body."""
    kind = "drives" if load["kind"] == "displacement" else "loads"
    scene = scene_from(
        {
            "name": "reactions",
            "theory": "shear",
            "materials": MATERIALS,
            "bodies": {"ground": {"motion": "fixed", "points": {"A": [0.0, 0.0], "W": [0.0, LENGTH]}}, **bodies},
            "beams": {"strip": {**STRIP, "curve": line([0.0, 0.0], [LENGTH, 0.0]), "start": start, "end": end}},
            kind: {"F": load},
            "stops": stops or {},
            "stages": [{"name": "load", "steps": "F", "stations": [0.01 * LENGTH if kind == "drives" else FORCE]}],
            "probes": [dict(zip(("of", "quantity"), probe.split("."), strict=True)) for probe in probes],
        }
    )
    solved = answer(scene)
    assert solved.completed, solved.sentence
    return solved.stations[0].values


@SOLVERS
def test_a_pivot_bears_the_lever_and_the_beam_that_is_welded_to_it(answer):
    # reference: statics, A + B + F = 0
    lever = {"motion": "turns", "about": "B", "points": {"B": [LENGTH, 0.0], "C": [LENGTH, 0.3 * LENGTH]}}
    load = {"kind": "force", "point": "C", "direction": [1.0, 0.0]}
    found = values(answer, AB, {"body": lever}, weld("A"), weld("B"), load)
    assert np.hypot(*found["A.reaction"]) > FORCE
    assert found["B.reaction"] == pytest.approx(-found["A.reaction"] - [FORCE, 0.0], abs=1e-5 * FORCE)


@SOLVERS
@pytest.mark.parametrize("about", [{"about": "B"}, {}], ids=["about", "first point"])
def test_a_driven_pin_in_a_slot_has_the_force_of_its_drive(answer, about):
    # reference: statics; the slot bears the force across, and the drive the force along
    slot = {"motion": "slides", "along": [0.6, 0.8], "turns": True, "points": {"B": [LENGTH, 0.0]}, **about}
    load = {"kind": "displacement", "point": "B", "direction": [0.6, 0.8]}
    found = values(answer, AB, {"body": slot}, weld("A"), weld("B"), load)
    along = np.array([0.6, 0.8])
    pull = -along @ found["A.reaction"]
    assert pull > FORCE
    assert found["B.reaction"] == pytest.approx(pull * along, abs=1e-5 * pull)


@SOLVERS
def test_the_ground_holds_a_pinned_end_by_the_moment_of_its_stop(answer):
    # reference: moments about the pin
    load = {"kind": "force", "point": "T", "direction": [0.0, 1.0]}
    stops = {"stop": {"beam": "strip", "end": "start", "towards": "W", "most": -0.5 * np.pi}}
    probes = ("A.reaction_moment", "T.displacement", "stop.moment")
    found = values(answer, probes, {}, pin("A"), {"joint": "free", "point": "T"}, load, stops)
    moment = FORCE * (LENGTH + found["T.displacement"][0])
    assert found["A.reaction_moment"] == pytest.approx([-moment], rel=1e-5)
    assert found["stop.moment"] == pytest.approx([moment], rel=1e-5)
