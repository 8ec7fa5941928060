"""The third column and what it does: true errors, the verdict, and what is told, on made-up answers.

The made-up exact answer is the made-up law without an error of discretisation, so that every true error is known.
"""

import json
from dataclasses import replace

import numpy as np
import pytest

from comparisons import documents, sheets
from comparisons.verdict.calibration import EXACT_FACTOR, error_ratios, tally
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers, paired, solvers_of
from comparisons.studies import calibration as study
from comparisons.studies.calibration_told import told
from comparisons.case import compare
from comparisons.verdict.words import Word
from cprbm_scene import Ending
from tests.comparisons.made_up import MadeUp, with_value

EXACT = MadeUp("cprbm", 0.0)
CPRBM, FEA = MadeUp("cprbm", 2e-3), MadeUp("fea", 8e-3)  # each 0.2 % off at the standard settings, and states 0.25 %


def nobody(scene, choices):
    return replace(EXACT(scene, choices), stations=(), ending=Ending.NOT_COVERED, sentence="It is made up.")


def comparison(scene, exact=EXACT, cprbm=CPRBM, fea=FEA):
    return compared(scene, paired(scene, Choices(), Solvers(cprbm, fea, exact=exact)))


def by_name(rows, name, station=0.67):
    return next(row for row in rows if row.probe.name == name and row.station == station)


def test_a_true_error_is_the_distance_from_the_exact_value(hinge):
    row = by_name(comparison(hinge).rows, "scene.potential_energy")
    # the law of that quantity is proportional to 1 + error
    assert row.true_errors.cprbm == pytest.approx(2e-3 * abs(row.exact[0]), rel=1e-9)
    assert row.true_errors.bending == pytest.approx(2e-3 * abs(row.exact[0]), rel=1e-9)
    assert row.bounds.cprbm == pytest.approx(1.25 * row.true_errors.cprbm, rel=1e-9)


def test_without_an_exact_answer_nothing_is_said(hinge):
    for solvers in (Solvers(CPRBM, FEA), Solvers(CPRBM, FEA, exact=nobody)):
        found = compared(hinge, paired(hinge, Choices(), solvers))
        assert found.runs.exact is None
        assert all(row.exact is None and row.true_errors is None for row in found.rows)
        assert "exact" not in found.verdict.sentence
        assert "exact" not in documents.comparison(found)["solvers"]
        assert not any("exact" in header for sheet in sheets.of_comparison(found) for header in sheet.headers)


def test_where_it_stopped_the_stations_before_count(hinge):
    partly = replace(EXACT, until=4)
    found = comparison(hinge, lambda scene, choices: replace(partly(scene, choices), ending=Ending.NOT_COVERED))
    known = {row.station: row.exact is not None for row in found.rows}
    assert list(known.values()) == [True] * 4 + [False] * 6
    assert found.verdict.word is Word.AGREE


def test_a_number_that_is_none_makes_no_exact_station(hinge):
    found = comparison(hinge, replace(EXACT, spoilt=with_value("BD.rotation", [np.nan])))
    assert {row.station for row in found.rows if row.exact is None} == {0.67}
    assert found.verdict.word is Word.AGREE


def test_right_statements_are_said_to_be_right(hinge):
    verdict = comparison(hinge).verdict
    assert verdict.word is Word.AGREE
    assert "within the stated ones" in verdict.sentence


def test_two_solvers_that_are_wrong_alike_differ_from_the_truth(hinge):
    wrong = replace(CPRBM, stiffness=1.02), replace(FEA, stiffness=1.02)
    assert compared(hinge, paired(hinge, Choices(), Solvers(*wrong))).verdict.word is Word.AGREE
    verdict = comparison(hinge, EXACT, *wrong).verdict
    assert verdict.word is Word.DIFFER
    assert "off the exact answer" in verdict.sentence


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
def test_each_solver_is_held_against_the_truth(hinge, solver):
    """A wrong one whose partner excuses it by a large uncertainty."""
    if solver == "cprbm":
        found = comparison(hinge, EXACT, MadeUp("cprbm", 0.0, stiffness=1.004), MadeUp("fea", 1.6e-2))
    else:
        found = comparison(hinge, EXACT, MadeUp("cprbm", 4e-3), MadeUp("fea", 0.0, stiffness=1.004))
    assert found.verdict.word is Word.DIFFER


def test_a_true_error_somewhat_beyond_is_named_and_changes_no_word(hinge):
    verdict = comparison(hinge, replace(EXACT, stiffness=1.00175)).verdict
    assert verdict.word is Word.AGREE
    assert "off by more than stated" in verdict.sentence
    ratios = [each.ratio for each in held(comparison(hinge, replace(EXACT, stiffness=1.00175)).rows)]
    assert 1.0 < max(ratios) <= FAR


def test_a_contact_that_is_open_in_truth_differs(hinge):
    assert comparison(hinge, replace(EXACT, contact=False)).verdict.word is Word.DIFFER
    forceless = hinge.model_copy(update={"probes": tuple(p for p in hinge.probes if p.name == "contact.centre")})
    assert comparison(forceless, replace(EXACT, contact=False)).verdict.word is Word.UNDECIDED
    assert comparison(forceless).verdict.word is Word.AGREE


def test_the_json_has_the_value_and_both_true_errors(hinge):
    data = json.loads(documents.text(documents.comparison(comparison(hinge, replace(EXACT, until=9)))))
    assert data["solvers"]["exact"]["stations"] == 9
    rows = {(row["probe"], row["station"]): row for row in data["rows"]}
    row, missing = rows["BD.rotation", 0.603], rows["BD.rotation", 0.67]
    # 0.9 reach − 0.1 push of the made-up law, with a reach that is 0.2 % too large, over the finite elements in shear
    off = 0.8 * 0.603 * 2e-3 / row["fea"]
    assert row["true_error"] == {"cprbm": pytest.approx(off), "fea_bending": pytest.approx(off)}
    assert row["exact"] == pytest.approx(0.9 * 0.603 - 0.1 * 0.403)
    assert missing["exact"] is missing["true_error"]["cprbm"] is missing["true_error"]["fea_bending"] is None
    assert rows["contact.centre", 0.067]["exact"] is None


def test_the_tables_show_the_exact_value_and_what_is_beyond(hinge):
    found = {sheet.title: sheet for sheet in sheets.of_comparison(comparison(hinge, replace(EXACT, stiffness=1.02)))}
    values, errors = next(iter(found.values())), found["True errors in bending, beside the exact answer"]
    assert "exact (bending)" in values.headers
    assert all(len(row) == len(sheet.headers) for sheet in found.values() for row in sheet.rows)
    assert {row[4] for row in errors.rows} == {"far beyond"}
    assert {row[8] for row in errors.rows} == {"far beyond"}


def test_the_real_run_has_the_exact_answers_beside_it():
    assert solvers_of(None).exact is not None
    assert Solvers().exact is None


def test_solve_asks_the_exact_one(capsys):
    assert run(["solve", "hinge", "--solver", "exact", "--json", "-"], Solvers(CPRBM, FEA, exact=EXACT)) == 0
    assert json.loads(capsys.readouterr().out)["cases"][0]["rows"][0]["cprbm"][0] == pytest.approx(0.01 * 0.067)
    assert run(["solve", "hinge", "--solver", "exact"], Solvers(CPRBM, FEA, exact=nobody)) == 1
    assert f"{Ending.NOT_COVERED.value}. It is made up." in capsys.readouterr().err


def test_a_tally_counts_and_orders(hinge):
    exact = replace(EXACT, stiffness=1.00175)
    mine = tally(held(comparison(hinge, exact).rows), "cprbm")
    assert mine.rows > 100
    assert mine.within < 0.5 * mine.rows
    assert not mine.holds
    assert [each.ratio for each in mine.worst] == sorted((each.ratio for each in mine.worst), reverse=True)
    assert tally((), "fea").holds


def test_a_closing_load_counts_once_however_many_stations_repeat_it(hinge):
    rows = comparison(hinge).rows
    repeated = [row for row in rows if row.probe.quantity == "closing_load" and row.true_errors is not None]
    assert len(repeated) > 5
    counted = [each.row for each in held(rows) if each.row.probe.quantity == "closing_load"]
    assert [row.station for row in counted] == [repeated[0].station] * 2  # of either solver


@pytest.mark.parametrize("error", [2e-3, 0.0])
def test_no_error_is_worth_no_name(hinge, error):
    mine = tally(held(comparison(hinge, EXACT, MadeUp("cprbm", error)).rows), "cprbm")
    assert mine.holds
    assert (mine.rows > 0) is (error > 0.0)


def test_an_excuse_is_none(hinge):
    """The truth lies by a twentieth of the stated error from the value: so much is stated without need."""
    near = replace(EXACT, stiffness=1.0 / 1.0019)
    mine = tally(held(comparison(hinge, near).rows), "cprbm")
    assert mine.within == mine.rows
    assert mine.over > 10.0
    assert not mine.holds


def measured(hinge, exact):
    solvers = Solvers(CPRBM, FEA, exact=exact)
    return study.with_piece(study.Calibration(), study.Piece(hinge, ((17, 40), (40, 80))), solvers)


def test_the_study_says_what_it_found(hinge):
    found = told(measured(hinge, EXACT))
    (case,) = json.loads(documents.text(found.data))["cases"]
    assert [(trial["links"], trial["elements"]) for trial in case["trials"]] == [(17, 40), (40, 80)]
    for trial in case["trials"]:
        for mine in trial["solvers"].values():
            assert mine["within"] == mine["rows"] > 50
            assert mine["share"] == 1.0
            assert 1.0 <= mine["stated_over_true"] <= 10.0
    assert "It is kept by both" in found.words[0]
    (picture,) = found.pictures
    assert picture.svg.startswith(b"<?xml")
    assert all(len(row) == len(sheet.headers) for sheet in found.sheets for row in sheet.rows)


def test_the_study_names_who_breaks_the_rule_and_what_is_not_covered(hinge):
    assert "broken by the CPRBM on hinge" in told(measured(hinge, replace(EXACT, stiffness=1.02))).words[0]
    silent = told(measured(hinge, nobody))
    assert silent.pictures == silent.sheets == ()
    assert silent.words == ("hinge: an exact answer is known for no station. It is made up.",)


def test_the_study_is_a_command(monkeypatch, capsys, hinge, tmp_path):
    monkeypatch.setattr(study, "pieces", lambda: (study.Piece(hinge, ((17, 40),)),))
    solvers = Solvers(CPRBM, FEA, exact=EXACT)
    assert run(["study", "calibration", "--out", str(tmp_path)], solvers) == 0
    assert "Calibration" in capsys.readouterr().out
    assert (tmp_path / "calibration.html").exists()
    wrong = replace(solvers, exact=replace(EXACT, stiffness=1.02))
    assert run(["study", "calibration", "--quiet"], wrong) == 1
