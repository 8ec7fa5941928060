"""The five-bar of section 3.5: two inputs, and beams that lie on a link up to the pins.

No published number exists; the tests compare a solver on several ways, and both solvers in the limit.
"""

from functools import cache
from math import radians

import numpy as np
import pytest

import cprbm
import fea_reference
from comparisons import cases
from comparisons.audit import audit

WAYS = {
    "first": [("alpha1", [20.0]), ("alpha2", [30.0, 50.0, 70.0])],
    "back": [("alpha1", [20.0]), ("alpha2", [70.0, 50.0, 30.0, 0.0]), ("alpha1", [0.0])],
}
SOLVERS = {
    "cprbm": lambda scene: cprbm.answer(scene, cprbm.Settings(links=40)),
    "fea": lambda scene: fea_reference.answer(scene, fea_reference.Settings(elements=14)),
}


def on_the_way(parts):
    """The five-bar on another way: angles of the cranks in degrees from the start."""
    scene = cases.opened("five-bar")
    stages = []
    for i, (drive, angles) in enumerate(parts):
        stage = next(stage for stage in scene.stages if stage.steps == drive)
        stations = tuple(radians(angle) for angle in angles)
        stages.append(stage.model_copy(update={"name": f"{i}", "stations": stations, "shown": ()}))
    return scene.model_copy(update={"stages": tuple(stages)})


def states(solve, parts):
    """Values of every state by both angles, degrees."""
    answer = solve(on_the_way(parts))
    assert answer.completed, answer.sentence
    angles, found = dict.fromkeys(("alpha1", "alpha2"), 0.0), {}
    drives = [drive for drive, stations in parts for _ in stations]
    for drive, station in zip(drives, answer.stations, strict=True):
        angles[drive] = np.degrees(station.value)
        found[round(angles["alpha1"]), round(angles["alpha2"])] = station.values
        assert station.certificate.smallest_curvature > 0.0
    return found


@pytest.fixture(scope="module", params=["fea", "cprbm"])
def ways(request):
    """The states on a way by the way's name, for a solver."""
    return cache(lambda name: states(SOLVERS[request.param], WAYS[name]))


def test_the_way_does_not_matter(ways, request):
    if "cprbm" in request.node.name:
        # open: joints and a moving place on the circle are two certified states, 3e-5 of the energy apart
        request.applymarker(pytest.mark.xfail(strict=True))
    first, other = ways("first"), ways("back")
    met = [at for at in other if at in first and at[1] > 0]
    assert len(met) == 3
    for at in met:
        energy = first[at]["scene.potential_energy"]
        assert other[at]["scene.potential_energy"] == pytest.approx(energy, rel=1e-6)
        for probe in ("OA.reaction_moment", "CD.reaction_moment"):
            assert other[at][probe] == pytest.approx(
                first[at][probe], abs=1e-5 * first[20, 70]["CD.reaction_moment"][0]
            )


def test_it_comes_home(ways):
    energies = [values["scene.potential_energy"][0] for values in ways("back").values()]
    assert energies[-1] == pytest.approx(0.0, abs=1e-12 * max(energies))


def test_both_solvers_have_one_limit():
    """In bending, as a share of the largest value; the chain of fourth order reaches the limit with the finest mesh."""
    scene = cases.opened("five-bar")
    fine = cprbm.answer(scene, cprbm.Settings(links=120)).stations
    reference = fea_reference.answer(scene, fea_reference.Settings(elements=120, kinematics="bending")).stations
    probes = ("scene.potential_energy", "OA.reaction_moment", "CD.reaction_moment", "contact.force", "link1.moment")
    for probe in probes:
        chain, true = (np.array([station.values[probe][0] for station in each]) for each in (fine, reference))
        assert chain == pytest.approx(true, abs=5e-4 * np.max(np.abs(true))), probe


def test_forces_balance_where_a_penalty_is_so_stiff_that_gaps_are_rounded_to_a_force():
    # the audit sums an answer up anew.  At 50° link1 presses beside the joint, with a penalty of 2e13: round-off of the
    # gap left 8e-7 of the largest force unbalanced
    scene = on_the_way([("alpha1", [20.0]), ("alpha2", [45.0, 50.0])])
    answer = fea_reference.answer(scene, fea_reference.Settings(elements=80))
    assert answer.completed, answer.sentence
    assert audit(scene, answer).complaints == ()
    for station in answer.stations:
        assert station.certificate.residual < 1e-10
