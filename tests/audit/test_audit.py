"""The audit of answers: no complaint about right answers of both solvers, a complaint about every planted fault.

Faults are planted in right answers.  Crossings without a contact are drawn by plane geometry.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import comparisons
import fea_reference
from comparisons import cases
from comparisons.audit import audit
from comparisons.choices import Choices
from cprbm_scene import SceneError, read, scene_from
from tests.audit.faults import FAULTS
from tests.audit.scenes import SOLVERS, T, answered, arc, asked, crossings, line, on_a_needle, scene_of
from tests.cprbm.scenes import LENGTH, MOMENT, RIGIDITY, cantilever_data, force
from tests.together import branches

CASES = ("hinge", "platform", "rolled", "stack", "tapered", "wrapped")
"""A case for every kind of contact; the word AGREE of tests.together.test_faults_everywhere audits all cases."""
EACH = pytest.mark.parametrize("solver", ["cprbm", "shear"])

RIGHT = [(name, solver) for name in (*CASES, "cam", "dead-point", "moment-at-a-probe") for solver in ("cprbm", "shear")]
RIGHT += [("spiral", "cprbm"), ("needle", "cprbm"), ("ellipse", "cprbm"), ("hole", "cprbm")]
RIGHT += [("strip", "cprbm"), ("strip", "fine"), ("micro-gripper", "default")]


@pytest.mark.parametrize(("name", "solver"), RIGHT)
def test_right_answers_stay_quiet(name, solver):
    """Also for a contact that closes between two stations of a drive, a hump between stations and a step at a moment.

    In the micro-gripper four elements bear the shear between a contact and a load near by.  There γ of the outer
    elements follows the steps of Q, and the CPRBM agrees to 1e-4.
    """
    answer = answered(name, solver)
    found = audit(asked(name), answer)
    assert (found.complaints, found.crossings) == ((), ())
    assert found.stations == len(answer.stations)
    if name in ("ellipse", "hole"):
        assert answer.stations[-1].values["edge.force"][0] > 0.0


PLANTED = [
    (case, fault, ("cprbm", "shear")[(row + column) % 2])
    for row, case in enumerate(CASES[1:])
    for column, fault in enumerate(FAULTS)
]
"""Every fault in the cases whose audit is short, in the answers of both solvers in turn."""
PLANTED += [("spiral", fault, "cprbm") for fault in ("contact pulls", "force probe")]  # a lap pressed from both sides


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


def test_beams_that_are_thicker_than_solved_and_a_beam_that_cuts_a_needle_penetrate():
    scene = asked("hinge")
    thicker = {name: beam.model_copy(update={"thickness": 1.12 * beam.thickness}) for name, beam in scene.beams.items()}
    for solver in ("cprbm", "shear"):
        said = audit(scene.model_copy(update={"beams": thicker}), answered("hinge", solver)).complaints
        assert any("penetrates" in sentence for sentence in said), said
        assert any("its moments make" in sentence for sentence in said), said
    lower = SOLVERS["cprbm"](on_a_needle(0.04))
    said = audit(asked("needle"), lower).complaints
    assert any("penetrates its partner in needle" in sentence for sentence in said), said


@pytest.mark.parametrize("solver", ["cprbm", "fine"])
def test_a_taut_strip_on_a_circle_has_the_moments_of_its_mesh_alone(solver):
    """A moment of half of what the force makes about the circle's middle is none of the mesh."""
    answer = answered("strip", solver)
    last = answer.stations[-1]
    state = replace(last.beams["beam"], M=last.beams["beam"].M + 0.5 * last.value * LENGTH)
    bent = replace(answer, stations=(replace(last, beams={"beam": state}),))
    assert any("its moments make" in sentence for sentence in audit(asked("strip"), bent).complaints)


@pytest.mark.parametrize("solver", ["cprbm", "bending"])
def test_energy_that_a_silent_jump_loses_or_gains_is_a_complaint(solver):
    # the answer states the critical point of the jump; the altered answer states none
    scene = scene_from(branches.snap([[0.0, 0.61, 0.69]]))
    answer = SOLVERS[solver](scene)
    assert answer.completed, answer.sentence
    assert audit(scene, answer).complaints == ()
    silent = replace(answer, critical=(), stations=tuple(replace(station, branch=0) for station in answer.stations))
    assert any("more than the work" in sentence for sentence in audit(scene, silent).complaints)
    # beyond a critical point the energy may gain the work up to the next station
    (critical,) = answer.critical
    station = next(station for station in answer.stations if station.branch == 1)
    moment = station.forces.moment[station.forces.source.index("turn")]
    work = abs(station.value - critical.value) * abs(moment) + 0.01 * abs(critical.energy)
    for gained, quiet in ((0.99 * work, True), (1.01 * work, False)):
        altered = replace(answer, critical=(replace(critical, after=critical.energy + gained),))
        assert (audit(scene, altered).complaints == ()) is quiet, gained


def test_answers_of_a_single_element_and_without_internal_forces():
    # Such a beam has no place between its ends.
    scene = scene_from(cantilever_data(force(0.0, 1.0), [1e-3 * RIGIDITY / LENGTH**2]))
    found = audit(scene, fea_reference.answer(scene, fea_reference.Settings(elements=1)))
    assert (found.complaints, found.stations, found.unbalance) == ((), 1, 0.0)
    answer = answered("hinge", "shear")
    bare = replace(answer, stations=tuple(replace(station, beams={}) for station in answer.stations))
    assert audit(asked("hinge"), bare).stations == 0


# -- Crossings without a contact

BESIDE = {"a": ((0.0, 0.05), (0.05, 0.05)), "b": ((0.0, 0.0), (0.1, 0.0))}
"""Two parallel beams, 50 mm apart."""


def dropped(depth):
    """The beam ``a`` upright above the middle of ``b``, with the free end ``depth`` below the line of ``b``."""
    return {"a": line((0.05, 0.05 - depth), (0.05, -depth))}


def rolled(turns):
    """The beam ``b``, 100 thicknesses long, that a moment at the end rolls up to a circle."""
    return {"b": arc(0.1 / (2.0 * np.pi * turns), 0.1, 401)}


def beside(gap):
    """The beam ``a`` above ``b``, parallel, with a ``gap`` of the faces."""
    return {"a": line((0.0, T + gap), (0.05, T + gap))}


def arcs(gap):
    """Two concentric arcs; a chord of the outer one between two of 21 places cuts 0.06 mm off, more than the floor."""
    return {"a": arc(0.05, 0.05, 41), "b": arc(0.05 + gap, 0.1, 21)}


def at_the_start(*values):
    """Beams of linear thickness that lie side by side at their starts, two thicknesses apart."""
    thickness = {"at": [0.0, 1.0], "values": [T * value for value in values]}
    near = {"a": line((0.0, 2.0 * T), (-0.05, 2.0 * T)), "b": line((0.0, 0.0), (0.1, 0.0))}
    return scene_of(BESIDE, thickness=thickness), near


def hairpin():
    """Two straight legs of ``b`` about a radius of 0.8 thicknesses."""
    s = np.linspace(0.0, 0.1, 2001)
    turn = np.clip((s - 0.04) / (0.8 * T), 0.0, np.pi)
    return {"b": np.column_stack([np.cumsum(of) * s[1] for of in (np.cos(turn), np.sin(turn))])}


def triangle():
    """A closed triangle of ``b``."""
    places = (-0.02, 0.0), (0.0, 0.02), (0.005, -0.02), (-0.02, 0.015)
    legs = [line(*ends) for ends in pairwise(places)]
    return {"b": np.concatenate((legs[0], legs[1][1:], legs[2][1:]))}


BOTH = {"both": {"kind": "beam-beam", "between": ["a", "b"]}}
OWN = {"own": {"kind": "beam-self", "beam": "b"}}
LINE_B = ((0.0, 0.0), (0.1, 0.0))
CROSSINGS = {
    "touch": (scene_of(BESIDE), beside(0.0), 0),
    "within the floor": (scene_of(BESIDE), beside(-0.04 * T), 0),
    "overlap": (scene_of(BESIDE), beside(-0.1 * T), 1),
    "arcs that touch": (scene_of(BESIDE), arcs(T), 0),
    "arcs that overlap": (scene_of(BESIDE), arcs(0.5 * T), 1),
    "thick here": (*at_the_start(4.0, 0.4), 1),
    "thick elsewhere": (*at_the_start(0.4, 4.0), 0),
    "a pair may cross": (scene_of(BESIDE, may_cross=[["b", "a"]]), dropped(0.007), 0),
    "a pair has a contact": (scene_of(BESIDE, BOTH), dropped(0.007), 0),
    "common joint": (scene_of({"a": ((0.0, 0.0), (0.0, 0.05)), "b": LINE_B}), dropped(0.007), 0),
    "crossing at rest": (scene_of({"a": ((0.03, -0.02), (0.03, 0.03)), "b": LINE_B}), dropped(0.007), 0),
    "touch at rest": (scene_of({"a": ((0.0, T), (0.05, T)), "b": LINE_B}), dropped(0.007), 0),
    "0.9 turns": (scene_of(BESIDE), rolled(0.9), 0),
    "0.98 turns": (scene_of(BESIDE), rolled(0.98), 0),  # both ends are two thicknesses apart
    "1 turn": (scene_of(BESIDE), rolled(1.0), 1),
    "1.3 turns": (scene_of(BESIDE), rolled(1.3), 1),
    "hairpin": (scene_of(BESIDE), hairpin(), 0),
    "triangle": (scene_of(BESIDE), triangle(), 1),
    "a beam may cross itself": (scene_of(BESIDE, may_cross=[["b", "b"]]), rolled(1.3), 0),
    "a beam has a contact with itself": (scene_of(BESIDE, OWN), rolled(1.3), 0),
    "a beam has a contact with another beam": (scene_of(BESIDE, BOTH), rolled(1.3), 1),
}


@pytest.mark.parametrize(("scene", "drawn", "count"), CROSSINGS.values(), ids=CROSSINGS)
def test_beams_cross_if_they_overlap_by_more_than_the_floor_and_the_scene_does_not_permit_it(scene, drawn, count):
    assert len(crossings(scene, drawn)) == count


def test_a_crossing_is_named_once_with_the_first_load():
    (said,) = crossings(scene_of(BESIDE), {}, dropped(0.007), dropped(0.011))
    assert "a and b pass through each other from push 2 N on, and no contact" in said
    assert "add a contact of a and b" in said
    assert 'may_cross = [["a", "b"]]' in said
    (said,) = crossings(scene_of(BESIDE), rolled(0.5), rolled(1.1), rolled(1.3))
    assert "b passes through itself from push 2 N on" in said
    assert 'may_cross = [["b", "b"]]' in said


EDGES = {
    "disc": {"kind": "beam-circle", "center": [0.05, -0.03], "radius": 0.01},
    "wall": {"kind": "beam-line", "points": [[0.0, -0.02], [0.1, -0.02]], "side": "left"},
    "floor": {"kind": "beam-half-plane", "point": [0.0, -0.02], "normal": [0.0, 2.0]},
    "graph": {"kind": "beam-function", "axis": "x", "coefficients": [-0.02, 0.0], "range": [0.0, 0.1], "side": "above"},
}
AWAY = {"b": line((0.0, 0.0), (-0.1, 0.0))}


@pytest.mark.parametrize("edge", EDGES)
@pytest.mark.parametrize("allowed", [False, True])
def test_a_beam_passes_through_a_rigid_edge_that_another_beam_may_touch(edge, allowed):
    keys = {"may_cross": [["a", edge]]} if allowed else {}
    scene = scene_of(BESIDE, {edge: {**EDGES[edge], "body": "ground", "beam": "b"}}, **keys)
    assert crossings(scene, dropped(0.019) | AWAY) == ()  # 0.5 mm above the edge
    assert len(crossings(scene, dropped(0.025) | AWAY)) == (0 if allowed else 1)


def test_an_edge_moves_with_the_body_and_an_edge_twice_is_a_mistake():
    scene = scene_of(BESIDE, {"disc": {**EDGES["disc"], "body": "slide", "beam": "b"}})
    path = dropped(0.025) | AWAY
    assert len(crossings(scene, path)) == 1
    assert crossings(scene, path, slide=(0.02, 0.0, 0.0)) == ()
    # half a turn about S, 80 mm above the centre, takes the disc above both beams
    assert crossings(scene, path, slide=(0.0, 0.0, np.pi)) == ()
    with pytest.raises(SceneError, match="two different names, or a beam twice"):
        scene_of(BESIDE, {"disc": {**EDGES["disc"], "body": "ground", "beam": "b"}}, may_cross=[["disc", "disc"]])


UNDECLARED = read(Path(__file__).parents[1] / "scenes" / "undeclared-contact.toml")
ROLLED = scene_from(cantilever_data(MOMENT, [turns * 2.0 * np.pi * RIGIDITY / LENGTH for turns in (0.9, 1.3)]))


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        # at 5 N the upper beam, 10 mm above, moves down by about F L³/(3 E I) = 10 mm and touches the lower one; at
        # 10 N it moves by almost 20 mm
        (UNDECLARED, ["up and lo pass through each other", "from undeclared-contact 10 N on", '[["up", "lo"]]']),
        (UNDECLARED.model_copy(update={"may_cross": (("lo", "up"),)}), []),
        # a moment of 2 pi E I/L rolls the cantilever to a full circle
        (ROLLED, [f"beam passes through itself from load {ROLLED.stages[0].stations[1]:.6g} N·m on"]),
    ],
    ids=["two beams", "permitted", "rolled"],
)
def test_a_comparison_with_an_undeclared_contact_is_undecided(scene, said):
    verdict = comparisons.compare(scene, Choices(links=10, elements=10)).verdict
    expected = ("UNDECIDED", "UNDECLARED_CONTACT") if said else ("AGREE", None)
    assert (verdict.word.value, verdict.reason and verdict.reason.value) == expected
    assert [part for part in said if part not in verdict.because] == []
