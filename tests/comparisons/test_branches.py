"""Branches beside branches: made-up answers that jump, with critical values and faults that are known."""

from dataclasses import replace
from math import degrees, radians

import numpy as np
import pytest

from comparisons import archive, cases, documents, sheets
from comparisons.GONE_branches import branches_of, margin_of, spots_of
from comparisons.stages import begins_at, span_of
from comparisons.verdict.events import Place
from comparisons.choices import Choices
from comparisons.verdict.bounds import bounds_of
from comparisons.verdict.rows import build_rows
from comparisons.pairing import Solvers, paired
from comparisons.verdict.completeness import problems
from comparisons.case import compare
from comparisons.verdict.words import Word
from cprbm_scene import Stage
from tests.comparisons.jumping import BACK, FORWARD, Jumping
from tests.comparisons.made_up import MadeUp

C, F = Jumping("cprbm"), Jumping("fea", error=-5e-4)


@pytest.fixture(scope="module")
def scene():
    """The case at every second degree, with the two probes that the made-up jump is of."""
    whole = cases.opened("prestressed")
    usual = {"shown": (), "critical_limit": None}
    stages = tuple(stage.model_copy(update={"stations": stage.stations[::2], **usual}) for stage in whole.stages)
    probes = tuple(probe for probe in whole.probes if probe.name in ("crank.reaction_moment", "scene.potential_energy"))
    return whole.model_copy(update={"stages": stages, "probes": probes, "claims": ()})


def told(scene, cprbm=C, fea=F):
    return compared(scene, paired(scene, Choices(), Solvers(cprbm, fea)))


def at(comparison, place):
    """Stages and stations in degrees at a place."""
    return list(dict.fromkeys((r.stage, round(degrees(r.station))) for r in comparison.rows if r.place is place))


def test_solvers_that_jump_at_one_angle_agree_branch_by_branch(scene):
    found = told(scene)
    assert found.verdict.word is Word.AGREE, found.verdict.sentence
    assert [(each.stage, each.number, each.word) for each in found.verdict.branches] == [
        ("forward", 0, Word.AGREE),
        ("forward", 1, Word.AGREE),
        ("back", 1, Word.AGREE),
        ("back", 2, Word.AGREE),
    ]
    ends = [(round(degrees(each.first)), round(degrees(each.last))) for each in found.verdict.branches]
    assert ends == [(0, 70), (72, 90), (89, 27), (25, 1)]
    assert "back 1.55334 to 0.471239 AGREE" in found.verdict.sentence


def test_stations_within_a_degree_are_listed_and_take_no_part(scene):
    """Jumps at 70.4° and 25.3°: of the even and odd degrees that are asked, 70° and 25° are within a degree."""
    found = told(scene)
    assert at(found, Place.NEAR) == [("forward", 70), ("back", 25)]
    words = dict(zip(map(id, found.rows), found.verdict.words, strict=True))
    near = [row for row in found.rows if row.place is Place.NEAR]
    assert {words[id(row)] for row in near} == {None}
    assert all(row.bounds is None and row.difference >= 0.0 for row in near)
    assert "Listed as near a critical value: forward 1.22173, back 0.436332." in found.verdict.sentence


def test_stations_between_the_critical_values_are_no_difference(scene):
    """Five degrees late: the critical values differ, and no row does for that."""
    found = told(scene, fea=replace(F, late=radians(5.0)))
    assert at(found, Place.BETWEEN) == [("forward", 72), ("forward", 74), ("back", 25), ("back", 23), ("back", 21)]
    assert {word for word in found.verdict.words if word is not None} == {Word.AGREE}
    assert found.verdict.word is Word.DIFFER
    assert found.verdict.sentence.startswith("The branch ends in forward at 1.22")
    for row in found.rows:
        if row.place is Place.BETWEEN:
            assert row.branch is None
            assert row.bounds is None
            assert np.isnan(row.difference)


def test_a_solver_that_never_jumps_differs_from_one_that_does(scene):
    found = told(scene, fea=replace(F, jumps=False))
    assert found.verdict.word is Word.DIFFER
    assert ("forward", 90) in at(found, Place.APART)
    assert "on different branches" in found.verdict.sentence
    assert "nowhere in the finite elements" in found.verdict.sentence


def test_a_solver_whose_runs_are_of_two_minds_is_undecided(scene):
    def unsure(scene, choices):
        return replace(C, jumps=choices.links == 40)(scene, choices)

    found = told(scene, cprbm=unsure)
    assert found.verdict.word is Word.UNDECIDED, found.verdict.sentence
    assert ("forward", 90) in at(found, Place.UNSETTLED)
    assert not at(found, Place.APART)


def test_a_fault_on_one_branch_is_told_of_that_branch(scene):
    """Two per cent of the moment, after the first jump only."""

    def soft(scene, choices):
        right, wrong = C(scene, choices), replace(C, stiffness=1.02)(scene, choices)
        pairs = zip(right.stations, wrong.stations, strict=True)
        return replace(right, stations=tuple(w if r.branch == 1 else r for r, w in pairs))

    found = told(scene, cprbm=soft)
    said = [each.word for each in found.verdict.branches]
    assert said == [Word.AGREE, Word.DIFFER, Word.DIFFER, Word.AGREE]
    assert found.verdict.word is Word.DIFFER


def test_an_uncertainty_does_not_leak_into_another_branch(scene):
    """Coarse on the second branch alone: what is stated of the first stays as it was."""

    def coarse(scene, choices):
        fine, rough = C(scene, choices), replace(C, error=4e-3)(scene, choices)
        pairs = zip(fine.stations, rough.stations, strict=True)
        return replace(fine, stations=tuple(r if f.branch else f for f, r in pairs))

    both = [rows_of(scene, paired(scene, Choices(), Solvers(one, F))) for one in (C, coarse)]
    first = [
        [row.bounds.cprbm for row in rows if row.bounds and (row.stage, row.branch) == ("forward", 0)] for rows in both
    ]
    assert first[0] == first[1]
    second = [max(row.bounds.cprbm for row in rows if row.bounds and row.branch == 1) for rows in both]
    assert second[1] == pytest.approx(4.0 * second[0], rel=0.01)


def test_coarse_and_fine_on_different_branches_state_no_nonsense(scene):
    """The coarse run jumps three degrees before the fine one; no uncertainty is that of a jump."""

    def jumps_early(scene, choices):
        return replace(C, late=radians(-3.0) if choices.links == 40 else 0.0)(scene, choices)

    found = told(scene, cprbm=jumps_early)
    assert at(found, Place.BETWEEN)[:2] == [("forward", 68), ("forward", 70)]
    stated = [row.bounds.cprbm / row.scale for row in found.rows if row.bounds]
    assert max(stated) < 0.01
    assert found.verdict.word is Word.UNDECIDED  # the critical value itself is too uncertain
    assert found.criticals[0].bounds.cprbm > radians(3.0)


def test_margins_are_a_degree_of_a_rotation_and_a_share_of_any_other_span(scene, hinge):
    forward, back = scene.stages
    assert margin_of(scene, back) == pytest.approx(radians(1.0))
    assert (begins_at(scene, forward), begins_at(scene, back)) == (0.0, forward.stations[-1])
    assert span_of(scene, back) == pytest.approx(radians(89.0))
    assert margin_of(hinge, hinge.stages[0]) == pytest.approx(0.0067)
    both = Stage(name="more", steps="M", stations=(-0.33, 0.5))
    twice = hinge.model_copy(update={"stages": (*hinge.stages, both)})
    assert span_of(twice, both) == pytest.approx(0.67 + 0.33)


def test_without_critical_values_all_is_one_branch(hinge, right):
    runs = paired(hinge, Choices(), right)
    spots = spots_of(hinge, dict(runs.everything()), (runs.cprbm[0], runs.reference))
    (branch,) = branches_of(spots)
    assert (branch.number, branch.stations) == (0, hinge.stages[0].stations)
    found = compared(hinge, runs)
    assert "ranch" not in found.verdict.sentence
    data = documents.comparison(found)
    assert data["critical"] == []
    assert [each["verdict"] for each in data["branches"]] == ["AGREE"]
    assert not any("ritical" in sheet.title or "ranch" in sheet.title for sheet in sheets.of_comparison(found))


def test_the_document_marks_every_row_and_holds_the_critical_values(scene):
    data = documents.comparison(told(scene))
    assert {row["place"] for row in data["rows"]} == {"compared", "near a critical value"}
    near = next(row for row in data["rows"] if row["place"] != "compared")
    assert (near["verdict"], near["uncertainty"]["cprbm"]) == (None, None)
    assert {row["branch"] for row in data["rows"]} == {0, 1, 2}
    forward, back = data["critical"]
    assert forward["cprbm"] == pytest.approx(FORWARD + 1e-4)
    assert back["fea"] == pytest.approx(BACK - 1e-4 / 4 - 5e-4)
    assert forward["released"] == {"cprbm": pytest.approx(0.3), "fea": pytest.approx(0.3)}
    assert forward["verdict"] == "AGREE"
    own = data["solvers"]["cprbm"]["critical"]
    assert [each["loss"] for each in own] == ["fold", "fold"]
    solved = documents.solution(scene, C(scene, Choices()))
    assert solved["solvers"]["cprbm"]["critical"] == own
    assert documents.text({"cases": [data, solved]})


def test_an_answer_survives_the_archive_with_its_branches(scene):
    answer = C(scene, Choices())
    again = archive.unpacked(archive.packed(answer))
    assert again.critical == answer.critical
    assert [station.branch for station in again.stations] == [station.branch for station in answer.stations]
    stopped = replace(C, stops=True)(scene, Choices())
    assert archive.unpacked(archive.packed(stopped)).critical[0].after is None


def test_branches_must_end_at_the_critical_values(scene):
    answer = C(scene, Choices())
    assert complaints(scene, answer) == ()
    first, second = answer.critical
    for wrong in ((), (first,), (second, first), (replace(first, value=1.0), second)):
        found = complaints(scene, replace(answer, critical=wrong))
        assert found
        assert "critical values say otherwise" in found[0]
    assert "not finite" in complaints(scene, replace(answer, critical=(replace(first, value=np.nan), second)))[0]


def test_a_branch_that_ends_without_a_jump_is_compared_up_to_there(scene):
    """Both stop at 70.4°: what was reached agrees, the critical values agree, and the rest has no answer."""
    found = told(scene, replace(C, stops=True), replace(F, stops=True))
    assert found.verdict.word is Word.UNDECIDED
    assert not found.verdict.completed
    assert found.verdict.sentence.startswith("The branch ends before the last station; up to forward 1.22173: AGREE.")
    assert len(found.rows) == 36 * len(scene.probes)
    assert [each.fea is not None and each.bounds is not None for each in found.criticals] == [True]
    data = documents.comparison(found)
    assert data["critical"][0]["released"] == {"cprbm": None, "fea": None}
    assert sheets.of_comparison(found)[0].title.startswith("Critical values")


def test_a_fault_before_the_branch_ends_differs(scene):
    wrong = told(scene, replace(C, stops=True, stiffness=1.02), replace(F, stops=True))
    assert wrong.verdict.word is Word.DIFFER


def test_an_answer_that_ends_for_another_reason_is_not_whole(scene):
    found = told(scene, replace(C, stops=True), MadeUp("fea", 0.0, until=10))
    assert found.verdict.word is Word.UNDECIDED
    assert found.rows == ()
    unsaid = Solvers(lambda scene, choices: replace(replace(C, stops=True)(scene, choices), critical=()), F)
    assert compared(scene, paired(scene, Choices(), unsaid)).rows == ()


def test_bounds_are_the_same_whether_of_a_row_or_by_hand(scene):
    runs = paired(scene, Choices(), Solvers(C, F))
    values = {name: np.array([each.critical[0].value]) for name, each in runs.everything()}
    bounds = bounds_of(runs, values, lambda d: float(np.linalg.norm(d)), 0.0)
    assert bounds.cprbm == pytest.approx(1.25 * 1e-4, rel=1e-6)
    assert bounds.bending == pytest.approx(1.25 * 1e-4 / 4.0, rel=1e-6)
    assert bounds.theory == pytest.approx(0.1 * 0.005, rel=1e-6)
