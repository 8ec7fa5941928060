"""Ends of branches that one answer ends at and another goes on over, or that both do: made-up answers."""

import json
from dataclasses import replace
from math import degrees, radians

import pytest

from comparisons import archive, cases, documents, sheets
from comparisons.verdict.events import Place
from comparisons.choices import Choices
from comparisons.verdict.events import critical_rows
from comparisons.pairing import Solvers, paired
from comparisons.GONE_per_branch import critical_word
from comparisons.sentences import critical_sentence
from comparisons.case import compare
from comparisons.verdict.words import Word
from cprbm_scene import Loss
from tests.comparisons.jumping import FORWARD, Jumping

ENDS, OVER = Jumping("fea", stops=True), Jumping("cprbm", over=0.29)


@pytest.fixture(scope="module")
def scene():
    """The crank forwards alone, and nothing is asked of ends."""
    whole = cases.opened("prestressed")
    (forward, _) = whole.stages
    usual = {"shown": (), "critical_limit": None, "beyond": None}
    stage = forward.model_copy(update={"stations": forward.stations[::5], **usual})
    return whole.model_copy(update={"stages": (stage,), "claims": ()})


def pairs(scene, cprbm, fea):
    return paired(scene, Choices(), Solvers(cprbm, fea))


def told(scene, cprbm, fea):
    return compared(scene, pairs(scene, cprbm, fea))


def rows_of(scene, cprbm, fea):
    return critical_rows(scene, pairs(scene, cprbm, fea))


@pytest.mark.parametrize("which", ["cprbm", "fea"])
def test_an_end_that_one_goes_on_over_and_the_other_ends_at_is_no_contradiction(scene, which):
    pair = (OVER, ENDS) if which == "cprbm" else (replace(ENDS, solver="cprbm"), replace(OVER, solver="fea"))
    (row,) = rows_of(scene, *pair)
    assert row.cprbm is not None
    assert row.fea is not None
    assert {name.split()[0] for name in row.turned} == {which}
    assert set(row.turned.values()) == {0.29}
    # the two are as far apart as they are planted, 0.0043 degrees within one theory, of 0.3 that are allowed
    assert degrees(row.same_theory) == pytest.approx(0.0043, abs=1e-4)
    assert critical_word(row) is Word.UNDECIDED
    said = critical_sentence(row)
    assert " went on over it, to a state beside it turned by 0.290 rad, and others ended there" in said
    assert said.endswith("beyond it: UNDECIDED.")


@pytest.mark.parametrize("fault", [{"late": radians(0.4)}, {"loss": Loss.BIFURCATION}, {"over": 0.0, "jumps": False}])
def test_another_end_or_none_differs_as_ever(scene, fault):
    """0.4 degrees apart where 0.3 are allowed, by another mechanism, or nowhere."""
    (row,) = rows_of(scene, replace(OVER, **fault), ENDS)
    assert row.cprbm is None
    assert not row.turned
    assert critical_word(row) is Word.DIFFER


def test_some_runs_of_one_solver_may_go_on(scene):
    def some(scene, choices):
        return (OVER if choices.links == 40 else replace(ENDS, solver="cprbm"))(scene, choices)

    (row,) = rows_of(scene, some, ENDS)
    assert list(row.turned) == ["cprbm"]
    assert critical_word(row) is Word.UNDECIDED


def test_up_to_there_rows_are_judged_as_ever(scene):
    found = told(scene, OVER, ENDS)
    assert found.verdict.word is Word.UNDECIDED
    assert not found.verdict.completed
    assert found.verdict.sentence.startswith("The branch ends before the last station; up to forward 1.22173: AGREE.")
    assert {row.station for row in found.rows} == {value for value in scene.stages[0].stations if value < FORWARD}
    wrong = told(scene, replace(OVER, stiffness=1.02), ENDS)
    assert wrong.verdict.word is Word.DIFFER


def test_both_may_go_on_and_agree(scene):
    found = told(scene, OVER, replace(OVER, solver="fea"))
    assert found.verdict.word is Word.AGREE, found.verdict.sentence
    assert found.verdict.completed
    assert not found.criticals
    assert {row.place for row in found.rows} == {Place.COMPARED, Place.NEAR}
    assert {round(degrees(row.station)) for row in found.rows if row.place is Place.NEAR} == {70}


def test_stations_between_the_values_at_which_they_go_on_are_no_difference(scene):
    """The finite elements go on six degrees later: answers at 75 degrees are of two states, and no contradiction."""
    found = told(scene, OVER, replace(OVER, solver="fea", late=radians(6.0)))
    between = {round(degrees(row.station)) for row in found.rows if row.place is Place.BETWEEN}
    assert between == {75}
    assert found.verdict.word is Word.AGREE, found.verdict.sentence


def test_different_states_beyond_differ_and_the_sentence_says_why(scene):
    found = told(scene, OVER, replace(OVER, solver="fea", over=0.12, lands=0.05))
    assert found.verdict.word is Word.DIFFER
    assert "Both went on over an end of the branch and came to different states: the CPRBM at forward 1.22" in (
        found.verdict.sentence
    )
    assert "rad (fold) to a state turned by 0.290 rad; the finite elements at forward" in found.verdict.sentence
    assert "to a state turned by 0.120 rad." in found.verdict.sentence


def test_where_one_alone_goes_on_and_they_differ_from_there_it_is_said(scene):
    found = told(scene, OVER, replace(OVER, solver="fea", over=0.0, jumps=False))
    assert found.verdict.word is Word.DIFFER
    assert "One alone went on over an end of the branch: the CPRBM at forward 1.22" in found.verdict.sentence
    assert "went on over" not in told(scene, replace(OVER, stiffness=1.02), OVER).verdict.sentence


def test_near_an_end_that_one_alone_goes_on_over_what_would_differ_is_undecided(scene):
    """The last station is 71 degrees: the one has gone on at 70.4, and the other may just behind."""
    stations = (*(value for value in scene.stages[0].stations if value < radians(69.0)), radians(71.0))
    short = scene.model_copy(update={"stages": (scene.stages[0].model_copy(update={"stations": stations}),)})
    alone = replace(OVER, solver="fea", over=0.0, jumps=False)
    found = told(short, OVER, alone)
    assert found.verdict.word is Word.UNDECIDED
    assert {row.place for row in found.rows if row.station == stations[-1]} == {Place.DOUBTFUL}
    assert "one solver alone went on over an end of the branch near by" in found.verdict.because
    # before it, they agree
    said = dict.fromkeys(zip((row.station for row in found.rows), found.verdict.words, strict=True))
    assert {word for station, word in said if station != stations[-1]} <= {Word.AGREE, None}
    # and an end that neither has is none
    assert told(short, replace(alone, solver="cprbm"), alone).verdict.word is Word.AGREE


def test_what_was_gone_on_over_is_in_the_json_and_the_archive(scene):
    runs = pairs(scene, OVER, ENDS)
    data = documents.comparison(compared(scene, runs))
    (end,) = data["solvers"]["cprbm"]["gone_over"]
    assert (end["stage"], end["loss"], end["what"], end["turned"]) == ("forward", "fold", None, 0.29)
    assert end["value"] == pytest.approx(FORWARD, abs=1e-3)
    assert end["released"] == pytest.approx(0.3)
    assert data["solvers"]["fea"]["gone_over"] == []
    assert data["critical"][0]["gone_over"]["cprbm"] == 0.29
    packed = json.loads(documents.text(archive.packed(runs.cprbm[0])))
    assert archive.unpacked(packed).gone_over == runs.cprbm[0].gone_over
    (sheet,) = (one for one in sheets.of_answer(scene, runs.cprbm[0]) if one.title.startswith("Critical values"))
    assert [row[3] for row in sheet.rows] == ["fold, gone on over: turned by 0.290 rad"]
    # an archive of before there was such a record
    del packed["gone_over"]
    assert archive.unpacked(packed).gone_over == ()
