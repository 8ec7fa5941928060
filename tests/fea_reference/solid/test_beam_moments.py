"""Moments on a beam of a solid."""

import numpy as np
import pytest

from cprbm_scene.statement import BeamMoment
from fea_reference import solid
from fea_reference.solid.beam_moments import couple
from fea_reference.solid.model import build
from tests.fea_reference.solid.bars import WIDTH, YOUNG, bar, quarter, straight

LENGTH, THICKNESS, AT = 0.31, 0.0016, 0.57
RIGIDITY = YOUNG * WIDTH * THICKNESS**3 / 12.0
PROBES = (("tip", "displacement"), ("block", "rotation"), ("scene", "potential_energy"), ("root", "reaction_moment"))


@pytest.mark.parametrize("turn", [1.3, -4.3])
def test_a_bar_bends_to_a_circle_up_to_the_moment_and_is_straight_beyond(turn):
    # M a/(E I) is the turn; the circle and the straight rest say where the tip is; the work is half of M times the turn
    moment = turn * RIGIDITY / (AT * LENGTH)
    scene = bar(
        straight(LENGTH),
        THICKNESS,
        load={"kind": "beam_moment", "beam": "beam", "at": AT},
        stations=(0.5 * moment, moment),
        probes=PROBES,
    )
    found = solid.answer(scene, solid.Settings(elements=80, across=1))
    assert found.completed, found.sentence
    values = found.stations[-1].values
    radius, rest = AT * LENGTH / turn, (1.0 - AT) * LENGTH
    sin, cos = np.sin(turn), np.cos(turn)
    there = np.array([radius * sin + rest * cos, radius * (1.0 - cos) + rest * sin])
    assert values["block.rotation"][0] == pytest.approx(turn, rel=4e-3)
    assert values["tip.displacement"] == pytest.approx(there - [LENGTH, 0.0], abs=4e-3 * LENGTH)
    assert values["scene.potential_energy"][0] == pytest.approx(-0.5 * moment * turn, rel=4e-3)
    assert values["root.reaction_moment"][0] == pytest.approx(-moment, rel=1e-7)


def test_its_forces_and_tangent_are_the_derivatives_of_the_angle():
    model = build(bar(quarter(0.11), 0.013, probes=PROBES), solid.Settings(elements=5, across=2))
    part = couple("M", BeamMoment(kind="beam_moment", beam="beam", at=0.37), model.mesh, 1.0, from_end=False)
    rng = np.random.default_rng(52)
    drawn = model.mesh.places
    places, way, step = drawn + 0.01 * rng.normal(size=drawn.shape), rng.normal(size=drawn.shape), 1e-6

    def turned(share):
        return part.turned(drawn, places + share * way, 0.0)

    slope = (turned(step) - turned(-step)) / (2.0 * step)
    assert slope == pytest.approx((part.forces(places) * way[part.nodes]).sum(), rel=1e-6)
    change = (part.forces(places + step * way) - part.forces(places - step * way)) / (2.0 * step)
    _, tangent = part.tangent(places)
    assert tangent @ way[part.nodes].ravel() == pytest.approx(change.ravel(), rel=1e-5, abs=1e-6 * np.abs(change).max())
    # and they are a couple, of moment one
    forces, x = part.forces(places), places[part.nodes]
    assert np.abs(forces.sum(axis=0)).max() < 1e-12 * np.abs(forces).max()
    assert (x[:, 0] * forces[:, 1] - x[:, 1] * forces[:, 0]).sum() == pytest.approx(1.0, rel=1e-12)
