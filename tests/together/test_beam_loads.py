"""Forces at points of beams and distributed loads: all solvers beside shooting, in contact beside each other."""

from __future__ import annotations

from functools import cache
from math import hypot

import numpy as np
import pytest

import cprbm
import elastica_reference
import fea_reference
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.quantities import load_unit
from comparisons.verdict import Reason
from cprbm_scene import Ending, Loss, scene_from
from tests.cprbm.scenes import LENGTH, MODULUS, RIGIDITY, THICKNESS, cantilever_data
from tests.elastica_reference.scenes import case
from tests.references.loaded import loaded
from tests.together.bowed import on_a_beam, on_a_circle

FORCE = RIGIDITY / LENGTH**2
UNITS = {"force": 1.0, "density": 1.0 / LENGTH}


def point(at, x, y):
    return {"kind": "beam_force", "beam": "beam", "at": at, "direction": [x, y]}, hypot(x, y) * FORCE


def spread(x, y, along=(0.0, 1.0)):
    load = {"kind": "distributed", "beam": "beam", "direction": [x, y], "along": list(along)}
    return load, hypot(x, y) * FORCE / LENGTH


# what acts, one after the other, and the same for the reference, in EI/L² and EI/L³
CASES = {
    "within": ([point(0.37, 2.0, 9.0)], {"forces": [(0.37, 2.0, 9.0)]}),
    "two": ([point(0.31, 0.0, 14.0), point(1.0, -1.0, -2.0)], {"forces": [(0.31, 0.0, 14.0), (1.0, -1.0, -2.0)]}),
    "weight": ([spread(0.0, -12.0)], {"distributed": [(0.0, 1.0, 0.0, -12.0)]}),
    "part": ([spread(9.0, -9.0, (0.23, 0.81))], {"distributed": [(0.23, 0.81, 9.0, -9.0)]}),
    "both": (
        [spread(0.0, -8.0, (0.4, 1.0)), point(0.57, -1.0, 9.0)],
        {"distributed": [(0.4, 1.0, 0.0, -8.0)], "forces": [(0.57, -1.0, 9.0)]},
    ),
}
BOW = 1.7  # turning of the curved beam, rad


def acting(loads, *, bowed=False):
    """The cantilever, or an arc of its length, with these loads in stages."""
    data = cantilever_data({}, [])
    data["loads"] = {f"P{i}": load for i, (load, _) in enumerate(loads)}
    data["stages"] = [{"name": f"P{i}", "steps": f"P{i}", "stations": [value]} for i, (_, value) in enumerate(loads)]
    if bowed:
        radius = LENGTH / BOW
        tip = [float(radius * np.sin(BOW)), float(radius * (1.0 - np.cos(BOW)))]
        arc = {"kind": "arc", "center": [0.0, radius], "start": [0.0, 0.0], "end": tip, "direction": "counterclockwise"}
        data["beams"]["beam"]["curve"], data["bodies"]["tip"]["points"]["T"] = arc, tip
    return data


@cache
def truth(case, bowed):
    return loaded(**CASES[case][1], curvature=BOW if bowed else 0.0)


def cprbm_answer(scene, n):
    return cprbm.answer(scene, cprbm.Settings(links=n))


def fea_answer(scene, n):
    return fea_reference.answer(scene, fea_reference.Settings(elements=n, kinematics="bending"))


def exact_answer(scene, _):
    return elastica_reference.answer(scene)


def errors(solve, case, n, *, bowed=False):
    """Of the tip's place and angle, the clamp's moment, the energy, and the largest of the moment along the beam."""
    true, data = truth(case, bowed), acting(CASES[case][0], bowed=bowed)
    answer = solve(scene_from(data), n)
    assert answer.ending is Ending.COMPLETED, answer.sentence
    found = answer.stations[-1].values
    rest = np.array(data["bodies"]["tip"]["points"]["T"]) / LENGTH
    s = np.linspace(0.0, 1.0, len(found["beam.bending_stress"]))
    moment = found["beam.bending_stress"] * 2.0 * LENGTH / (MODULUS * THICKNESS)
    assert found["R.reaction"] / FORCE == pytest.approx(true.clamp_force, abs=1e-8)
    return np.array(
        [
            hypot(*(found["T.displacement"] / LENGTH + rest - true.tip)),
            abs(found["tip.rotation"][0] + bowed * BOW - true.angle),
            abs(found["R.reaction_moment"][0] * LENGTH / RIGIDITY - true.clamp_moment),
            abs(found["scene.potential_energy"][0] * LENGTH / RIGIDITY - true.energy),
            np.max(np.abs(moment - true.moment(s))),
        ]
    )


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("bowed", [False, True])
def test_the_cprbms_fourth_order(case, bowed):
    """Under a force at a place, whose error is uneven in their number, and of third order where it is largest."""
    found = np.array([errors(cprbm_answer, case, n, bowed=bowed) for n in (20, 160)])
    order = 3.5 if case in ("weight", "part") else 2.4
    assert np.all(np.log2(found[0] / found[-1]) / 3.0 > order)
    assert np.all(found[-1] < 4e-7)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("bowed", [False, True])
def test_the_finite_elements_fourth_order(case, bowed):
    """Within elements too: over a factor of sixteen, for there the error is uneven in their number."""
    found = np.array([errors(fea_answer, case, n, bowed=bowed) for n in (8, 128)])
    assert np.all(np.log2(found[0] / found[-1])[:4] / 4.0 > 3.4)
    assert np.all(found[-1][:4] < 2e-8)
    # the place at which a moment is asked follows the arc length to third order
    assert found[-1][4] < 3e-7


@pytest.mark.parametrize(("at", "load"), [(0.011, 27.0), (0.043, 7.0)])
def test_a_force_beside_the_clamp(at, load):
    """It bends a short span, whose energy is all there is."""
    data, true = acting([point(at, 0.0, load)]), loaded(forces=[(at, 0.0, load)])
    for solve in (cprbm_answer, fea_answer):
        found = solve(scene_from(data), 80).stations[-1].values
        tip = found["T.displacement"] / LENGTH + [1.0, 0.0] - true.tip
        energy = found["scene.potential_energy"][0] * LENGTH / RIGIDITY
        assert energy == pytest.approx(true.energy, rel=1e-3)
        assert hypot(*tip) < 1e-4 * true.tip[1]


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("bowed", [False, True])
def test_the_third_solver(case, bowed):
    assert np.all(errors(exact_answer, case, 0, bowed=bowed) < 1e-9)


@pytest.mark.parametrize("solve", [cprbm_answer, fea_answer, exact_answer])
def test_a_force_at_the_end_is_one_on_what_holds_it(solve):
    """At a body's point, at the end of a beam that is welded there, and at a free end."""
    load, value = point(1.0, -1.0, 5.0)
    data = acting([(load, value)])
    found = [solve(scene_from(data), 40).stations[-1].values]
    data["loads"]["P0"] = {"kind": "force", "point": "T", "direction": [-1.0, 5.0]}
    found.append(solve(scene_from(data), 40).stations[-1].values)
    data["loads"]["P0"], data["beams"]["beam"]["end"] = load, {"joint": "free"}
    del data["bodies"]["tip"]
    data["probes"] = [probe for probe in data["probes"] if probe["of"] in ("R", "beam", "scene")]
    found.append(solve(scene_from(data), 40).stations[-1].values)
    for name in found[-1]:
        size = np.max(np.abs(found[0][name]))
        for other in found[1:]:
            assert other[name] == pytest.approx(found[0][name], rel=1e-9, abs=1e-9 * size), name


@pytest.mark.parametrize("solve", [cprbm_answer, fea_answer])
def test_many_forces_are_a_distributed_load(solve):
    """Reference: the midpoint rule, whose error falls with the square of the number of forces."""
    _, value = spread(3.0, -9.0)
    weight = solve(scene_from(acting([spread(3.0, -9.0)])), 40).stations[-1].values
    gaps = []
    for count in (5, 10):
        loads = [(point((i + 0.5) / count, 3.0, -9.0)[0], value * LENGTH / count) for i in range(count)]
        found = solve(scene_from(acting(loads)), 40).stations[-1].values
        gaps.append(hypot(*(found["T.displacement"] - weight["T.displacement"])) / LENGTH)
    assert gaps[0] / gaps[1] == pytest.approx(4.0, abs=0.5)


def weighed(data, q):
    """A scene of the bowed beam with a weight beside its other load, which comes first."""
    data["loads"]["q"] = {"kind": "distributed", "beam": "beam", "direction": [-0.2, -1.0], "along": [0.15, 0.9]}
    data["loads"]["F"] = {"kind": "beam_force", "beam": "beam", "at": 0.777, "direction": [-1.0, 0.0]}
    data["stages"] = [
        {"name": "weight", "steps": "q", "stations": [q]},
        *data["stages"],
        {"name": "push", "steps": "F", "stations": [2.0]},
    ]
    data["probes"].append({"of": "scene", "quantity": "potential_energy"})
    return data


def test_the_solvers_agree_on_a_circle_but_for_the_theory():
    # the beam is thick: shear changes the clamp's moment by more than the scene allows
    scene = scene_from(weighed(on_a_circle(8.0), 40.0))
    found = compare(paired(scene, Choices(kinematics="bending"), Solvers()))
    assert {row.reason for row in found.rows} == {None, Reason.THEORY}, found.verdict.sentence
    assert [load_unit(scene, stage.name) for stage in scene.stages] == ["N/m", "N", "N"]


def test_the_third_solver_in_contact_in_a_point():
    scene = scene_from(weighed(on_a_circle(8.0), 40.0))
    found, reference = (solve(scene, 80) for solve in (exact_answer, fea_answer))
    assert found.ending is Ending.COMPLETED, found.sentence
    for name, value in reference.stations[-1].values.items():
        size = np.max(np.abs(value), initial=0.0)
        assert found.stations[-1].values[name] == pytest.approx(value, rel=2e-4, abs=2e-4 * size), name


def test_the_third_solver_has_no_equations_for_a_weight_along_a_circle():
    data = case("wrapped")
    data["loads"]["q"] = {"kind": "distributed", "beam": "beam", "direction": [0.0, -1.0]}
    data["stages"].insert(0, {"name": "weight", "steps": "q", "stations": [0.01]})
    answer = exact_answer(scene_from(data), 0)
    assert answer.ending is Ending.NOT_COVERED
    assert "beam lies along the circle of contact under a distributed load" in answer.sentence


def test_a_weight_on_a_beam_that_presses_another():
    scene = scene_from(weighed(on_a_beam(8.0), 40.0))
    reference, found = (solve(scene, n).stations[-1].values for solve, n in ((fea_answer, 40), (cprbm_answer, 80)))
    assert reference["touch.force"][0] > 1.0
    for name in ("T.displacement", "touch.force", "scene.potential_energy", "R.reaction_moment"):
        size = np.linalg.norm(reference[name])
        assert np.linalg.norm(found[name] - reference[name]) < 1e-3 * size, name


@pytest.mark.parametrize("solve", [cprbm_answer, fea_answer, exact_answer])
def test_a_free_column_under_its_own_weight_buckles_where_greenhill_says(solve):
    """Reference: A. G. Greenhill (1881), q L³/EI = 7.8373 for a column that is clamped below and free above."""
    for q, stands in ((7.75, True), (7.95, False)):
        answer = solve(scene_from(acting([spread(-q, 0.0)])), 40)
        assert (answer.ending is Ending.COMPLETED) is stands, q


@pytest.mark.parametrize("links", [20, 40, 80])
def test_a_column_close_to_its_load_has_a_bifurcation_and_no_fold(links):
    """From a station at 0.998 of the load (Greenhill): round-off leans the column there, and no jump may follow."""
    data = acting([spread(-7.8373, 0.0)])
    whole = data["stages"][0]["stations"][0]
    data["stages"][0]["stations"] = [0.998 * whole, 1.14 * whole]
    answer = cprbm_answer(scene_from(data), links)
    assert answer.ending is Ending.BRANCH_ENDS
    assert [point.loss for point in answer.critical] == [Loss.BIFURCATION]
    assert answer.critical[0].value == pytest.approx(whole, rel=1e-4)
