"""Refusals of solvers by name, and scenes with rounded coordinates or dead points."""

import re
import tomllib
from math import asin, hypot
from pathlib import Path

import pytest

import cprbm
import elastica_reference
import fea_reference
from comparisons import cases
from comparisons.cli.main import run
from cprbm_scene import Ending, SceneError, scene_from
from fea_reference import solid
from tests.cprbm_scene.editing import LINKAGE, edited, two_lines
from tests.robustness.toml import toml_of
from tests.together.features import ELLIPSE, INSIDE, RAIL, held_by, resting, three_points

HINGE = Path(cases.__file__).parent / "hinge.toml"
T = 0.002
OPTIONS = {solver: ["--solver", solver] for solver in ("fea", "exact", "solid")} | {
    formulation: ["--formulation", formulation] for formulation in ("auto", "paper")
}


def test_a_theory_with_contacts_is_answered_in_both_formulations():
    scene = scene_from({"theory": "shear", **tomllib.loads(HINGE.read_text(encoding="utf-8"))})
    assert cprbm.answer(scene, cprbm.Settings(links=20, formulation="paper")).completed
    assert cprbm.answer(scene, cprbm.Settings(links=20)).completed
    assert fea_reference.answer(scene, fea_reference.Settings(elements=8)).completed


def stacked(share):
    """Two parallel cantilevers that overlap by a ``share`` of their thickness; a force lifts the lower one."""
    data = edited(("probes/1", {"of": "touch", "quantity": "force"}), base=two_lines(T * (1 - share)))
    hints = {"boundary": "upper", "related": {"lower": {"x": [0.01, 0.09]}, "upper": {"x": [0.0, 0.1]}}}
    data["contacts"]["touch"]["paper"] = hints
    return scene_from(data)


@pytest.mark.parametrize(
    "solve",
    [
        pytest.param(
            lambda scene: cprbm.answer(scene, cprbm.Settings(links=20)),
            marks=pytest.mark.xfail(
                strict=True, reason="all joints overlap at once, and the closed set does not settle"
            ),
        ),
        lambda scene: cprbm.answer(scene, cprbm.Settings(links=20, formulation="paper")),
        lambda scene: fea_reference.answer(scene, fea_reference.Settings(elements=10)),
    ],
    ids=["auto", "paper", "fea"],
)
def test_beams_that_overlap_by_rounding_answer_as_beams_that_touch(solve):
    # reference: the same beams, drawn in touch; 0.1 % of the thickness moves them by less than 1e-5 of the length
    touching, overlapping = (solve(stacked(share)).stations[0].values for share in (0.0, 0.99e-3))
    for name, value in touching.items():
        assert overlapping[name] == pytest.approx(value, rel=1e-3, abs=1e-6), name


def test_the_exact_solution_and_the_solid_do_not_answer_an_overlap():
    for solver in (elastica_reference, solid):
        with pytest.raises(SceneError, match=r"^contacts\.touch: found beams that overlap .*, for the "):
            solver.answer(stacked(0.99e-3))


@pytest.mark.parametrize(
    ("data", "key", "solver"),
    [
        *((three_points(), "beams.beam", solver) for solver in OPTIONS),
        *((resting(), "bodies.slider", solver) for solver in OPTIONS if solver != "auto"),
    ],
)
def test_a_command_refuses_parts_that_contacts_and_loads_hold(data, key, solver, tmp_path, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(toml_of(data), encoding="utf-8")
    assert run(["solve", str(path), *OPTIONS[solver]]) == 2
    assert re.search(rf"{path}: {re.escape(key)}: found .*; allowed: .* hold it, for the ", capsys.readouterr().err)


def test_the_cprbm_answers_a_slider_that_a_contact_holds():
    # reference: statics.  The slide has no friction, so the wall carries all of the weight and what the nose pushes
    scene = scene_from(resting())
    (station,) = cprbm.answer(scene).stations
    reaction = station.values["R.reaction"]
    assert reaction[1] == pytest.approx(station.value, rel=1e-9)
    assert station.values["c.force"][0] == pytest.approx(hypot(*reaction), rel=1e-9)


@pytest.mark.parametrize(
    "edge",
    [INSIDE, ELLIPSE, RAIL],
    ids=["inside", "ellipse", "spline"],
)
def test_edges_that_the_cprbm_alone_answers(edge):
    scene = scene_from(held_by(edge))
    # reference: statics, as of the slider; a force on nothing but the wall is the edge's
    (station,) = cprbm.answer(scene).stations
    x, y = station.values["R.reaction"]
    assert station.values["c.force"][0] == pytest.approx(hypot(x, y - station.value), abs=1e-9 * station.value)
    for solver in (fea_reference, elastica_reference, solid):
        with pytest.raises(SceneError, match=rf"^contacts\.c: found '{edge['kind']}'.* or a function, for the "):
            solver.answer(scene)


@pytest.mark.parametrize("solver", [cprbm, fea_reference])
def test_a_solver_ends_at_the_dead_point_of_a_linkage(solver):
    # reference: at its farthest angle the rocker makes a triangle with the ground, and crank and coupler in one line
    far = asin((0.15**2 + 0.1**2 - (0.05 + hypot(0.15, 0.05)) ** 2) / (2 * 0.15 * 0.1))
    drive = [("loads", {}), ("drives/phi", {"kind": "rotation", "body": "rocker"})]
    turn = {"name": "turn", "steps": "phi", "stations": [-0.2, -1.0]}
    answer = solver.answer(scene_from(edited(*drive, ("stages/0", turn), base=LINKAGE)))
    assert (answer.ending, len(answer.stations)) == (Ending.STEP_TOO_SMALL, 1)
    assert float(re.search(r"phi (?:is|=) (-?[\d.]+\d)", answer.sentence)[1]) == pytest.approx(far, abs=1e-4)
