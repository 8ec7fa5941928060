"""The audit of answers: no complaint about right answers of both solvers, a complaint about every planted fault.

Faults are planted in right answers.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest

import cprbm
import fea_reference
from comparisons import cases
from comparisons.audit import audit
from cprbm_scene import read, scene_from
from tests.audit.faults import FAULTS
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, cantilever_data, force
from tests.scenes.rare_scenes import FOLDER
from tests.together import branches

SOLVERS = {
    "cprbm": lambda scene: cprbm.answer(scene, cprbm.Settings(links=20)),
    "shear": lambda scene: fea_reference.answer(scene, fea_reference.Settings(elements=20, kinematics="shear")),
    "bending": lambda scene: fea_reference.answer(scene, fea_reference.Settings(elements=20, kinematics="bending")),
}
CASES = ("hinge", "platform", "rolled", "stack", "tapered", "wrapped")
"""A case for every kind of contact; the word AGREE of tests.together.test_faults_everywhere audits all cases."""
EACH = pytest.mark.parametrize("solver", ["cprbm", "shear"])


@cache
def asked(case):
    """A built-in case at the last stations of its stages."""
    scene = cases.asked(case)
    stages = []
    for stage in scene.stages:
        stations = stage.stations if stage.beyond is None else stage.stations[::20]
        update = {"stations": stations[-2:] if stage.beyond is None else stations, "shown": ()}
        stages.append(stage.model_copy(update=update))
    return scene.model_copy(update={"stages": tuple(stages), "claims": ()})


@cache
def answered(case, solver):
    found = SOLVERS[solver](asked(case))
    assert found.completed, found.sentence
    return found


@EACH
@pytest.mark.parametrize("case", CASES)
def test_right_answers_stay_quiet(case, solver):
    found = audit(asked(case), answered(case, solver))
    assert found.complaints == ()
    assert found.crossings == ()
    assert found.stations == len(answered(case, solver).stations)


PLANTED = [
    (case, fault, ("cprbm", "shear")[(row + column) % 2])
    for row, case in enumerate(CASES[1:])
    for column, fault in enumerate(FAULTS)
]
"""Every fault in the cases whose audit is short, in the answers of both solvers in turn."""


@pytest.mark.parametrize(("case", "fault", "solver"), PLANTED)
def test_a_planted_fault_is_a_complaint(case, fault, solver):
    scene, answer = asked(case), answered(case, solver)
    altered = FAULTS[fault](scene, answer.stations[-1])
    if altered is None:
        pytest.skip("the scene has no place for the fault")
    assert audit(scene, replace(answer, stations=(*answer.stations[:-1], altered))).complaints != ()


@EACH
@pytest.mark.parametrize("case", ["hinge", "stack", "wrapped"])
def test_a_contact_that_the_solver_ignores_is_a_penetration(case, solver):
    scene = cases.asked(case)
    probes = tuple(probe for probe in scene.probes if probe.of not in scene.contacts)
    alone = scene.model_copy(update={"contacts": {}, "probes": probes})
    found = SOLVERS[solver](alone)
    assert audit(alone, found).complaints == ()
    said = audit(scene.model_copy(update={"probes": probes}), found).complaints
    assert any("penetrates" in sentence for sentence in said), said


@EACH
def test_beams_that_are_thicker_than_solved_penetrate(solver):
    scene = asked("hinge")
    thicker = {name: beam.model_copy(update={"thickness": 1.12 * beam.thickness}) for name, beam in scene.beams.items()}
    said = audit(scene.model_copy(update={"beams": thicker}), answered("hinge", solver)).complaints
    assert any("penetrates" in sentence for sentence in said), said
    assert any("its moments make" in sentence for sentence in said), said


@pytest.mark.parametrize("solver", ["cprbm", "bending"])
def test_energy_that_a_silent_jump_loses_is_a_complaint(solver):
    # the answer states the critical point of the jump; the altered answer states none
    scene = scene_from(branches.snap([[0.0, 0.61, 0.69]]))
    answer = SOLVERS[solver](scene)
    assert answer.completed, answer.sentence
    assert audit(scene, answer).complaints == ()
    silent = replace(answer, critical=(), stations=tuple(replace(station, branch=0) for station in answer.stations))
    assert any("more than the work" in sentence for sentence in audit(scene, silent).complaints)


@cache
def cam():
    """A leaf on an eccentric disc that turns: the contact closes at 30 degrees and opens at 150 degrees."""
    data = cantilever_data(force(0.0, -1.0), [1.0])
    eccentric, down = [(0.62 + shift) * LENGTH for shift in (0.0, 0.04)], -0.15 * LENGTH
    data["bodies"]["cam"] = {"motion": "turns", "points": {"O": [eccentric[0], down]}, "about": "O"}
    disc = {"kind": "beam-circle", "beam": "beam", "body": "cam", "center": [eccentric[1], down]}
    disc["radius"] = 0.13 * LENGTH - 0.5 * THICKNESS
    data["contacts"] = {"disc": disc}
    data["loads"] = {}
    data["drives"] = {"turn": {"kind": "rotation", "body": "cam"}}
    stages = {"round": [90.0, 360.0], "back": [180.0, 90.0, 0.0]}
    data["stages"] = [
        {"name": name, "steps": "turn", "stations": np.radians(degrees).tolist()} for name, degrees in stages.items()
    ]
    data["probes"] = [{"of": "disc", "quantity": "force"}, {"of": "cam", "quantity": "reaction_moment"}]
    return scene_from(data)


@EACH
def test_a_contact_that_closes_between_two_stations_of_a_drive_is_no_silent_jump(solver):
    answer = SOLVERS[solver](cam())
    assert answer.completed, answer.sentence
    assert audit(cam(), answer).complaints == ()


@EACH
@pytest.mark.parametrize("name", ["dead-point", "moment-at-a-probe"])
def test_a_hump_between_stations_and_a_step_at_a_moment_are_no_faults(name, solver):
    # reference: statics, the moment of the lever acts on the way back too; the stress at a moment has two values
    scene = read(FOLDER.parent / f"{name}.toml")
    answer = SOLVERS[solver](scene)
    assert answer.completed, answer.sentence
    assert audit(scene, answer).complaints == ()


def test_the_energy_beyond_a_critical_point_may_gain_the_work_up_to_the_next_station():
    scene = scene_from(branches.snap([[0.0, 0.61, 0.69]]))
    answer = SOLVERS["bending"](scene)
    (critical,) = answer.critical
    station = next(station for station in answer.stations if station.branch == 1)
    moment = station.forces.moment[station.forces.source.index("turn")]
    work = abs(station.value - critical.value) * abs(moment) + 0.01 * abs(critical.energy)
    for gained, quiet in ((0.99 * work, True), (1.01 * work, False)):
        altered = replace(answer, critical=(replace(critical, after=critical.energy + gained),))
        assert (audit(scene, altered).complaints == ()) is quiet


@pytest.mark.parametrize(
    "edge",
    [
        {"kind": "beam-ellipse", "center": [0.0, -0.3 - 0.5 * THICKNESS / LENGTH], "semi_axes": [1.0, 0.3]},
        {"kind": "beam-circle", "center": [0.5, 0.5], "radius": 0.8, "side": "inside"},
    ],
    ids=["ellipse", "hole"],
)
def test_round_solids_stay_quiet(edge):
    # the tangent at the ellipse's top is the clamped beam's; the tip presses on the lower side of the hole
    data = cantilever_data(force(0.0, -1.0), [0.7 * RIGIDITY / LENGTH**2])
    scaled = {key: (np.array(value) * LENGTH).tolist() for key, value in edge.items() if key not in ("kind", "side")}
    data["contacts"] = {"edge": {**edge, **scaled, "beam": "beam", "body": "wall"}}
    data["probes"].append({"of": "edge", "quantity": "force"})
    scene = scene_from(data)
    answer = SOLVERS["cprbm"](scene)
    assert answer.completed, answer.sentence
    assert answer.stations[-1].values["edge.force"][0] > 0.0
    assert audit(scene, answer).complaints == ()


def on_a_needle(depth):
    """A beam pressed on a needle at 0.55 of the length, whose tip stands a ``depth`` in lengths below the beam."""
    x, y = 0.55, -depth - 0.5 * THICKNESS / LENGTH
    flanks = LENGTH * np.array([[x - 0.02, y - 0.2], [x, y], [x + 0.02, y - 0.2]])
    data = cantilever_data(force(0.0, -1.0), [])
    needle = {"kind": "beam-line", "beam": "beam", "body": "wall", "points": flanks.tolist(), "side": "left"}
    data["contacts"], data["loads"] = {"needle": needle}, {}
    data["drives"] = {"P": {"kind": "displacement", "point": "T", "direction": [0.0, -1.0]}}
    data["stages"][0]["stations"] = [0.1 * LENGTH, 0.25 * LENGTH]
    return scene_from(data)


def test_a_beam_beside_a_needle_penetrates_only_if_it_cuts_the_needle():
    scene, lower = on_a_needle(0.01), on_a_needle(0.04)
    right, wrong = map(SOLVERS["cprbm"], (scene, lower))
    assert right.completed, right.sentence
    assert audit(scene, right).complaints == ()
    said = audit(scene, wrong).complaints
    assert any("penetrates its partner in needle" in sentence for sentence in said), said


FINE = fea_reference.Settings(elements=160, kinematics="bending")


@pytest.mark.parametrize(
    "solve", [SOLVERS["cprbm"], partial(fea_reference.answer, settings=FINE)], ids=["cprbm", "fea"]
)
def test_a_taut_strip_on_a_circle_has_the_moments_of_its_mesh_alone(solve):
    """Drawn on the circle and pulled along the tangent, by a faint and a larger force: no section bends."""
    angle, radius = 1.571, LENGTH
    tip, data = (
        [radius * np.cos(angle), radius * np.sin(angle)],
        cantilever_data(force(-np.sin(angle), np.cos(angle)), []),
    )
    data["bodies"]["wall"]["points"]["R"], data["bodies"]["tip"]["points"]["T"] = [radius, 0.0], tip
    curve = {"kind": "arc", "center": [0.0, 0.0], "start": [radius, 0.0], "end": tip, "direction": "counterclockwise"}
    data["beams"]["beam"]["curve"] = curve
    disc = {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": [0.0, 0.0]}
    data["contacts"] = {"disc": {**disc, "radius": radius - 0.5 * THICKNESS}}
    data["stages"][0]["stations"] = [share * RIGIDITY / LENGTH**2 for share in (2e-3, 2e-2)]
    scene = scene_from(data)
    answer = solve(scene)
    assert answer.completed, answer.sentence
    assert audit(scene, answer).complaints == ()
    # a moment of half of what the force makes about the circle's middle is none of the mesh
    last = answer.stations[-1]
    state = replace(last.beams["beam"], M=last.beams["beam"].M + 0.5 * last.value * radius)
    bent = replace(answer, stations=(replace(last, beams={"beam": state}),))
    assert any("its moments make" in sentence for sentence in audit(scene, bent).complaints)


def test_answers_of_a_single_element_and_without_internal_forces():
    # Such a beam has no place between its ends.
    scene = scene_from(cantilever_data(force(0.0, 1.0), [1e-3 * RIGIDITY / LENGTH**2]))
    found = audit(scene, fea_reference.answer(scene, fea_reference.Settings(elements=1)))
    assert (found.complaints, found.stations, found.unbalance) == ((), 1, 0.0)
    answer = answered("hinge", "shear")
    bare = replace(answer, stations=tuple(replace(station, beams={}) for station in answer.stations))
    assert audit(asked("hinge"), bare).stations == 0


def wound_spiral():
    """A spiral of 1.6 turns, wound by 1.25 turns: a middle lap is pressed from both sides."""
    way = np.linspace(0.0, 1.6, 33)
    places = ((0.01 + 0.003 * way) * np.exp(2j * np.pi * way)).view(float).reshape(-1, 2).tolist()
    return scene_from(
        {
            "name": "spiral",
            "materials": {"m": {"youngs_modulus": 3e9, "poisson_ratio": 0.4}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": places[0]}},
                "end": {"motion": "free", "points": {"E": places[-1]}},
            },
            "beams": {
                "b": {
                    "curve": {"kind": "spline", "points": places},
                    "thickness": 1e-3,
                    "width": 8e-3,
                    "material": "m",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "weld", "point": "E"},
                }
            },
            "contacts": {"k": {"kind": "beam-self", "beam": "b"}},
            "drives": {"turn": {"kind": "rotation", "body": "end"}},
            "stages": [{"name": "wind", "steps": "turn", "stations": [1.5 * np.pi, 2.5 * np.pi]}],
            "probes": [{"of": "k", "quantity": "force"}],
        }
    )


def test_a_lap_between_two_laps_is_pressed_from_both_sides():
    scene = wound_spiral()
    answer = SOLVERS["cprbm"](scene)
    assert answer.completed, answer.sentence
    assert audit(scene, answer).complaints == ()
    for fault in ("contact pulls", "force probe"):
        altered = FAULTS[fault](scene, answer.stations[-1])
        assert audit(scene, replace(answer, stations=(*answer.stations[:-1], altered))).complaints != ()


def test_places_between_a_contact_and_a_load_nearby_do_not_tell_the_shear():
    # four elements alone bear shear, and γ of the outer elements follows the steps of Q; the CPRBM agrees to 1e-4
    scene = read(FOLDER.parent / "micro-gripper.toml")
    answer = fea_reference.answer(scene)
    assert answer.completed, answer.sentence
    assert audit(scene, answer).complaints == ()
