"""Bodies that are pinned to each other: what a pin does is what a pivot does, and inputs do the work that is stored."""

import numpy as np
import pytest

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.system import assemble
from tests.cprbm_scene.editing import LINKAGE, edited

COARSE = Settings(elements=8, kinematics="bending")
PROBES = [
    {"of": "A", "quantity": "displacement"},
    {"of": "B", "quantity": "displacement"},
    {"of": "crank", "quantity": "rotation"},
    {"of": "O", "quantity": "reaction"},
    {"of": "D", "quantity": "reaction"},
    {"of": "scene", "quantity": "potential_energy"},
]


def linkage(*edits):
    return scene_from(edited(("probes", PROBES), *edits, base=LINKAGE))


def driven(*stations, body="crank"):
    edits = [("loads", {}), ("drives", {"phi": {"kind": "rotation", "body": body}}), ("stages/0/steps", "phi")]
    probes = [*PROBES, {"of": body, "quantity": "reaction_moment"}]
    return linkage(*edits, ("stages/0/stations", list(stations)), ("probes", probes))


def test_the_whole_tangent():
    model = build(linkage(), Settings(elements=2))
    z = model.start.values + 0.05 * np.random.default_rng(1).standard_normal(model.size)
    z[model.multipliers] = np.random.default_rng(2).standard_normal(model.multipliers.size)

    def at(z):
        return assemble(model, {}, 6, np.array([0.3]), State.of(z), model.initial_constraints)

    tangent = at(z).tangent.matrix.toarray()
    assert tangent == pytest.approx(tangent.T, abs=1e-12 * np.abs(tangent).max())
    for i in range(model.size):
        step = np.zeros(model.size)
        step[i] = 1e-6
        slope = (at(z + step).residual - at(z - step).residual) / 2e-6
        assert tangent[:, i] == pytest.approx(slope, abs=1e-6 * np.abs(tangent).max())


def test_the_linkage_stays_together():
    """The four bars keep their lengths, and the forces of the ground balance the load."""
    found = answer(linkage(("stages/0/stations", [0.5, -0.5])), COARSE)
    assert found.ending is Ending.COMPLETED, found.sentence
    for station in found.stations:
        values = station.values
        A, B = values["A.displacement"] + (0.0, 0.05), values["B.displacement"] + (0.15, 0.1)
        assert np.hypot(*values["A.displacement"]) > 1e-3
        assert np.hypot(*A) == pytest.approx(0.05, rel=1e-9)
        assert np.hypot(*(B - A)) == pytest.approx(np.hypot(0.15, 0.05), rel=1e-9)
        assert np.hypot(*(B - (0.15, 0.0))) == pytest.approx(0.1, rel=1e-9)
        turn = values["crank.rotation"][0]
        assert pytest.approx(A, abs=1e-10) == [-0.05 * np.sin(turn), 0.05 * np.cos(turn)]
        assert station.certificate.force_balance < 1e-8
        assert station.certificate.moment_balance < 1e-8


def test_a_pin_to_the_ground_is_a_pivot():
    """A body pinned to the ground, and one that turns about its own point."""
    pivoted = [
        ("bodies/crank", {"motion": "turns", "about": "O1", "points": LINKAGE["bodies"]["crank"]["points"]}),
        ("pins", {name: pin for name, pin in LINKAGE["pins"].items() if name != "at_O"}),
        ("probes", [{**probe, "of": "O1"} if probe["of"] == "O" else probe for probe in PROBES]),
    ]
    one, other = (answer(linkage(*edits), COARSE).stations[-1].values for edits in ([], pivoted))
    for name, value in one.items():
        assert other[name.replace("O.", "O1.")] == pytest.approx(value, rel=1e-8, abs=1e-12)


def test_the_input_does_the_work_that_is_stored():
    h = 1e-3
    found = answer(driven(0.4 - h, 0.4, 0.4 + h), COARSE)
    assert found.ending is Ending.COMPLETED, found.sentence
    before, at, behind = (station.values for station in found.stations)
    rate = (behind["scene.potential_energy"][0] - before["scene.potential_energy"][0]) / (2 * h)
    assert abs(rate) > 1e-2
    assert at["crank.reaction_moment"][0] == pytest.approx(rate, rel=1e-5)
