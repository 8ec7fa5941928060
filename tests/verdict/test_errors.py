"""Stated errors of made-up sequences with a known limit and order, and true errors beside an exact answer.

Expected numbers follow from Richardson's formulas, written in each test: with values v = L + C N^−q and a law of order
p through N and 2N, the law's error at N is (v − V)/(1 − 2^−p).  The made-up exact answer has no discretisation error;
the solvers' errors of 0.2 % at the default sizes state 0.25 %.
"""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons import cases
from comparisons.cli.main import run
from comparisons.pairing import Solvers, solvers_of
from comparisons.present import json_document
from comparisons.studies import calibration as study
from comparisons.verdict.judge import EXACT_FACTOR, error_ratios, tally
from comparisons.verdict.uncertainty import error, largest, limit, observed, orders
from comparisons.writing import text_of
from cprbm_scene import Ending, Stage
from tests.tables import tables_of
from tests.verdict.comparing import compared, row_of, word_of
from tests.verdict.made_up import MadeUp, with_value

S = 1.25
THIRD = (56, 64, 112)  # N, 8/7 N and 2N
DOUBLED = (10, 20, 40, 80, 160, 320)


def powers(order, sizes=DOUBLED, factor=7.0, next_=0.0):
    n = np.array(sizes, dtype=float)
    return 3.0 + factor * n**-order + next_ * n ** -(order + 1.0)


def stated(sizes, values, at=0, order=2.0):
    found = error(sizes, np.reshape(values, (len(sizes), -1)), at, order)
    return found.even, found.uneven


# -- Stated errors


@pytest.mark.parametrize(("order", "own"), [(1.0, 2.0), (2.0, 2.0), (4.0, 4.0), (2.0, 4.0), (1.0, 4.0)])
@pytest.mark.parametrize("at", [0, 1, 2])
def test_three_grids_of_a_pure_power_state_its_error_and_a_quarter(order, own, at):
    even, uneven = stated(THIRD, powers(order, THIRD), at, own)
    assert even == pytest.approx([S * 7.0 / THIRD[at] ** order], rel=1e-9)
    assert uneven == pytest.approx([0.0], abs=1e-12)


def test_three_grids_of_another_order_and_an_oscillating_term_are_stated_larger():
    # with (v − V)/C = 15/16 the law of order 2 has the error 5/4 C at N and L = v_∞ − C/4; at 8/7 N the law has
    # −1/4 + 5/4 (7/8)², and the value is (7/8)⁴
    even, uneven = stated(THIRD, powers(4.0, THIRD, factor=THIRD[0] ** 4.0))
    beyond = (7 / 8) ** 4 + 1 / 4 - 5 / 4 * (7 / 8) ** 2
    assert even == pytest.approx([S * 5 / 4], rel=1e-9)
    assert uneven == pytest.approx([S * abs(beyond) * (8 / 7) ** 2], rel=1e-9)
    # three quarters of an order must be shown for it: of the change v − V the law of order 1 makes twice the error, the
    # law of order 2 makes 4/3; a value has the order that the grids show, where that is smaller
    for order, assumed in ((1.45, 1.0), (1.55, 2.0), (2.5, 2.0)):
        values = powers(order, THIRD)
        factor = 1.0 / (1.0 - 2.0 ** -min(order, assumed))
        assert stated(THIRD, values)[0] == pytest.approx([S * factor * (values[0] - values[2])], rel=1e-9), order
        assert limit(THIRD, values).assumed == assumed, order
    # an oscillation is added to an even error, and on the finest grid both fall to a quarter of their values at N
    values = powers(2.0, THIRD) - np.array([0.0, 1e-4, 0.0])
    (even, uneven), finer = stated(THIRD, values), stated(THIRD, values, at=2)
    assert even == pytest.approx([S * 7.0 / 56**2], rel=1e-9)
    assert uneven == pytest.approx([S * 1e-4 * (8 / 7) ** 2], rel=1e-9)
    assert np.array(finer) == pytest.approx(np.array([even, uneven]) / 4.0, rel=1e-9)
    # C of 3, 0 and −5 at three stations of one stage, and of 1 in another stage: a stage states its largest error
    rows = [("push", 3.0), ("push", 0.0), ("push", -5.0), ("twist", 1.0)]
    found = largest((stage, float(stated(THIRD, powers(2.0, THIRD, factor=C))[0][0])) for stage, C in rows)
    assert found == pytest.approx({"push": S * 5.0 / 56**2, "twist": S * 1.0 / 56**2}, rel=1e-9)


def test_a_constant_and_round_off_show_no_order_and_no_more_error_than_their_own():
    assert stated(THIRD, [0.2, 0.2, 0.2]) == (0.0, 0.0)
    found = limit(DOUBLED, np.zeros(6))
    assert (found.value[0], found.uncertainty[0], found.order) == (0.0, 0.0, None)
    values = 3.0 + 1e-15 * np.array([1.0, -1.0, 0.0, 1.0, -1.0, 0.0])
    found = limit(DOUBLED, values, 2.0, floor=1e-14)
    assert (found.order, found.why) == (None, "the change is round-off")
    assert found.value == pytest.approx([3.0], abs=1e-14)
    assert 1e-14 <= found.uncertainty[0] <= 2e-14


def test_two_grids_state_the_index_of_order_two_or_of_a_known_first_order():
    # (v − V)/(1 − 1/4) = 0.4; the limit is 0.9; of order 1 it is V + (V − v) = 0.7, 0.2 away, and the correction is 0.1
    even, uneven = stated((20, 40), [1.3, 1.0], order=4.0)
    assert even == pytest.approx([S * 0.4])
    assert uneven == pytest.approx([0.0], abs=1e-15)
    found = limit((20, 40), np.array([1.3, 1.0]), 4.0)
    assert (found.order, found.assumed, found.why) == (None, 2.0, "two sizes show no order")
    assert (found.value, found.uncertainty) == (pytest.approx([0.9]), pytest.approx([S * 0.2]))
    # as a penalty's error with the penetration: L = V + (V − v)/3 of sizes 4 and 16
    found = limit((4, 16), np.array([1.3, 1.0]), 1.0)
    assert (found.value, found.uncertainty) == (pytest.approx([0.9]), pytest.approx([S * 0.1]))
    # two sizes: from the limit by 7/N², and the limit is uncertain by S times 2/3 of the change
    values = powers(2.0, (10, 20))
    found = limit((10, 20), values)
    own = S * 2 / 3 * 7.0 * (1 / 100 - 1 / 400)
    assert np.abs(values - found.value) + found.uncertainty == pytest.approx(7.0 / np.array([100.0, 400.0]) + own)


# -- Limits


@pytest.mark.parametrize(
    ("sizes", "order"), [(DOUBLED, 1.0), (DOUBLED, 2.0), (DOUBLED, 4.0), ((10, 15, 30, 100), 2.0), ((40, 46, 80), 2.0)]
)
def test_a_pure_power_is_extrapolated_to_its_limit(sizes, order):
    found = limit(sizes, powers(order, sizes), order)
    assert found.value == pytest.approx([3.0], rel=1e-13)
    assert found.uncertainty[0] < 1e-12
    assert found.order == pytest.approx(order, abs=1e-3)
    assert found.why == ""
    assert orders(sizes, powers(order, sizes)) == pytest.approx([order] * (len(sizes) - 2), abs=1e-3)


@pytest.mark.parametrize("order", [1.6, 2.0, 3.0, 4.0])
def test_the_uncertainty_of_a_limit_is_made_for_the_first_order(order):
    # on grids that double, values C N^−q with a = 2^−q are beyond the law of order p, b = 2^−p, at N/2 by
    # d = (b − a)(1 − a)/(ab) of their error at N, and the limit is off by (a − b)/(1 − b) of it: b/(1 − b) d for q = 1
    found = limit((20, 40, 80), powers(order, (20, 40, 80), factor=40.0**order), 2.0)
    a, b = 2.0**-order, 0.25
    d = abs(b - a) * (1 - a) / (a * b)
    assert abs(found.value[0] - 3.0) == pytest.approx(abs(a - b) / (1 - b), abs=1e-12)
    assert found.uncertainty[0] == pytest.approx(S * b / (1 - b) * d, abs=1e-12)


@given(
    order=st.floats(1.0, 5.0),
    own=st.sampled_from([1.0, 2.0, 4.0]),
    sizes=st.sampled_from([DOUBLED, (20, 40, 80), (10, 15, 30), (40, 46, 80), (10, 20, 30, 40)]),
)
def test_a_limit_and_a_value_are_as_near_as_stated_whatever_the_order(order, own, sizes):
    found = limit(sizes, powers(order, sizes), own)
    assert abs(found.value[0] - 3.0) <= found.uncertainty[0] + 1e-14
    even, uneven = stated(THIRD, powers(order, THIRD), order=max(own, 2.0))
    assert 7.0 / 56**order <= (even + uneven)[0] + 1e-14


def test_the_limit_of_no_pure_power_lies_within_an_uncertainty_that_is_not_much_larger():
    for next_ in (-50.0, -5.0, 5.0, 50.0):
        found = limit(DOUBLED, powers(2.0, next_=next_))
        apart = abs(found.value[0] - 3.0)
        assert apart <= found.uncertainty[0] <= 20.0 * apart, next_
        assert found.order == pytest.approx(2.0, abs=0.1), next_
    # the factor of the error varies by up to a half from size to size, as with a contact between joints
    random = np.random.default_rng(1)
    n = np.array(DOUBLED, dtype=float)
    uneven = (limit(DOUBLED, 3.0 + 7.0 * random.uniform(0.5, 1.5, n.size) / n**2) for _ in range(400))
    assert sum(abs(found.value[0] - 3.0) <= found.uncertainty[0] for found in uneven) >= 380


@pytest.mark.parametrize(
    ("values", "why", "assumed"),
    [
        ([1.0, 2.0, 1.5], "the change turns back", 1.0),
        ([1.0, 2.0, 1.8], "the change turns back", 2.0),
        ([1.0, 2.0, 3.0], "the change does not fall", 1.0),
        ([1.0, 2.0, 4.0], "the change does not fall", 1.0),
        ([1.0, 2.0, 2.0 + 1e-6], "the change falls faster than any order", 2.0),
        *(
            (powers(order), "", assumed)
            for order, assumed in ((4.5, 2.0), (4.3, 4.0), (3.7, 4.0), (3.5, 2.0), (1.0, 1.0))
        ),
    ],
)
def test_a_high_order_is_assumed_only_where_the_values_bear_it_out(values, why, assumed):
    order, reason = observed((10, 20, 40), np.array(values[:3]))
    assert (order is None, reason) == (why != "", why)
    assert limit(DOUBLED[: len(values)], np.array(values), 4.0).assumed == assumed


@pytest.mark.parametrize(("last", "order"), [(1.5, 1.0), (1.8, 2.0)])
def test_a_sequence_that_turns_back_keeps_its_last_step_as_uncertainty(last, order):
    # the changes 1 and 1/2 fall with order 1, the changes 1 and 1/5 with order 2.3.  With b = 2^−p the law has
    # E = (2 − last)/(1 − b) at 20 and E/b at 10, where the value is beyond it by d.  An uneven error moves the limit by
    # 2b²/(1 − b) d, values of order 1 (beside p = 1 of 3/4) by a b/((1 − a)(1 − b)) d
    found = limit((10, 20, 40), np.array([1.0, 2.0, last]))
    a, b = 2.0 ** -min(1.0, 0.75 * order), 2.0**-order
    coarse = (2.0 - last) / (1.0 - b)
    d = abs(1.0 - (2.0 - coarse) - coarse / b)
    assert found.value == pytest.approx([2.0 - coarse])
    assert found.uncertainty == pytest.approx([S * d * max(2 * b * b / (1 - b), a * b / ((1 - a) * (1 - b)))])
    assert found.uncertainty[0] >= 2.0 - last


def test_a_vector_converges_as_one_and_wrong_sizes_and_values_are_refused():
    # the second component passes through its limit, and alone shows no order
    n = np.array((10.0, 20.0, 40.0))
    values = np.column_stack([1.0 + 5.0 / n**2, 2.0 + 1e-4 * np.array([1.0, -1.0, 0.5])])
    together = limit((10, 20, 40), values)
    assert together.order == pytest.approx(2.0, abs=0.01)
    assert together.value.shape == together.uncertainty.shape == (2,)
    assert limit((10, 20, 40), values[:, 1]).order is None
    for sizes, wrong in (((10,), [1.0]), ((20, 10), [1.0, 2.0]), ((10, 20), [1.0, math.nan]), ((10, 20), [1.0])):
        with pytest.raises(ValueError, match=r"sizes|values"):
            limit(sizes, np.array(wrong), 2.0)
        with pytest.raises(ValueError, match=r"sizes|values"):
            error(sizes, np.reshape(wrong, (-1, 1)), 0, 2.0)


# -- True errors beside an exact answer

EXACT = MadeUp("cprbm", 0.0)
C, F = MadeUp("cprbm", 2e-3), MadeUp("fea", 8e-3)
ENERGY = "scene.potential_energy"  # proportional to 1 + error


def short(scene, choices, until=4):
    return replace(replace(EXACT, until=until)(scene, choices), ending=Ending.NOT_COVERED, sentence="It is made up.")


def nobody(scene, choices):
    return short(scene, choices, until=0)


def beside(hinge, exact=EXACT, cprbm=C, fea=F):
    return compared(hinge, cprbm, fea, exact=exact)


def test_true_errors_are_distances_from_the_exact_value_in_rows_the_json_and_tables(hinge):
    found = beside(hinge, replace(EXACT, until=9))
    energy = row_of(found, ENERGY, 0.603)
    assert energy.true_errors.cprbm == pytest.approx(2e-3 * abs(energy.exact[0]), rel=1e-9)
    assert energy.true_errors.fea == pytest.approx(2e-3 * abs(energy.exact[0]), rel=1e-9)
    last = row_of(beside(hinge), ENERGY)
    assert last.bounds.cprbm == pytest.approx(1.25 * last.true_errors.cprbm, rel=1e-9)
    data = json.loads(text_of(json_document.comparison(found)))
    assert data["solvers"]["exact"]["stations"] == 9
    rows = {(row["probe"], row["station"]): row for row in data["rows"]}
    row, missing = rows["BD.rotation", 0.603], rows["BD.rotation", 0.67]
    off = 0.8 * 0.603 * 2e-3 / row["fea"]  # 0.9 reach − 0.1 push
    assert row["true_error"] == {"cprbm": pytest.approx(off), "fea_bending": pytest.approx(off)}
    assert row["exact"] == pytest.approx(0.9 * 0.603 - 0.1 * 0.403)
    assert missing["exact"] is missing["true_error"]["cprbm"] is missing["true_error"]["fea_bending"] is None
    assert rows["contact.centre", 0.067]["exact"] is None
    sheets = {sheet.title: sheet for sheet in tables_of(beside(hinge, replace(EXACT, stiffness=1.02)))}
    assert any("exact" in sheet.headers for sheet in sheets.values())
    assert all(len(row) == len(sheet.headers) for sheet in sheets.values() for row in sheet.rows)
    errors = sheets["True errors in bending, beside the exact answer"]
    assert {row[4] for row in errors.rows} == {row[8] for row in errors.rows} == {"far beyond"}


@pytest.mark.parametrize("exact", [None, nobody])
def test_without_an_exact_answer_nothing_is_said(hinge, exact):
    found = beside(hinge, exact)
    assert "exact" not in found.runs.answers
    assert all(row.exact is None and row.true_errors is None for row in found.rows)
    assert "exact" not in found.verdict.sentence
    assert "exact" not in json_document.comparison(found)["solvers"]
    assert not any("exact" in header for sheet in tables_of(found) for header in sheet.headers)


@pytest.mark.parametrize(
    ("exact", "known"), [(short, 4), (replace(EXACT, spoilt=with_value("BD.rotation", [np.nan])), 9)]
)
def test_stations_with_an_exact_value_count(hinge, exact, known):
    found = beside(hinge, exact)
    of_energy = [row.exact is not None for row in found.rows if row.probe.name == ENERGY]
    assert of_energy == [True] * known + [False] * (10 - known)
    assert word_of(found) == "AGREE"


@pytest.mark.parametrize(
    ("exact", "cprbm", "fea", "word", "sentence"),
    [
        (EXACT, C, F, "AGREE", "are within the stated ones"),
        (None, replace(C, stiffness=1.02), replace(F, stiffness=1.02), "AGREE", ""),
        (EXACT, replace(C, stiffness=1.02), replace(F, stiffness=1.02), "DIFFER EXACT", "from the exact answer"),
        (EXACT, MadeUp("cprbm", 0.0, stiffness=1.004), MadeUp("fea", 1.6e-2), "DIFFER EXACT", "the CPRBM lie"),
        (EXACT, MadeUp("cprbm", 4e-3), MadeUp("fea", 0.0, stiffness=1.004), "DIFFER EXACT", "the finite elements lie"),
        (replace(EXACT, stiffness=1.00175), C, F, "AGREE", "exceed the stated error"),
        (replace(EXACT, contact=False), C, F, "DIFFER EXACT", "from the exact answer"),
    ],
    ids=["right", "alike, unseen", "alike", "CPRBM excused", "finite elements excused", "beyond", "open in truth"],
)
def test_words_beside_the_exact_answer(hinge, exact, cprbm, fea, word, sentence):
    """Beyond twice the stated error a row differs; 0.375 % against 0.25 % is named and changes no word."""
    found = beside(hinge, exact, cprbm, fea)
    assert word_of(found) == word, found.verdict.sentence
    assert sentence in found.verdict.sentence


@pytest.mark.parametrize(
    ("exact", "cprbm", "fea", "word"),
    [
        (1.0, 1e-6, 1e-6, "AGREE"),
        (0.0, 1e-6, 1e-6, "AGREE"),
        (1.0, 0.0, 1e-6, "DIFFER EXACT"),
        (1.0, 1e-4, 1e-4, "DIFFER EXACT"),
        (0.5, 1e-6, 1e-6, "DIFFER EXACT"),
    ],
)
def test_an_exact_place_at_an_end_of_a_beam_is_known_to_the_root_of_round_off(hinge, exact, cprbm, fea, word):
    """Unless a solver has the place at the end as well; ``cprbm`` and ``fea`` are shares of the length beside."""
    length = np.pi * 0.025
    true, *found = (with_value("contact.centre", [length * abs(exact - off)]) for off in (0.0, cprbm, fea))
    solvers = (MadeUp(solver, 0.0, spoilt=spoilt) for solver, spoilt in zip(("cprbm", "fea"), found, strict=True))
    compared = beside(hinge, replace(EXACT, spoilt=true), *solvers)
    assert word_of(compared) == word, compared.verdict.sentence


def test_a_place_in_truth_alone_is_undecided(hinge):
    place = hinge.model_copy(update={"probes": tuple(p for p in hinge.probes if p.name == "contact.centre")})
    assert word_of(beside(place, replace(EXACT, contact=False))) == "UNDECIDED EVENT"
    assert word_of(beside(place)) == "AGREE"


@pytest.mark.parametrize(
    ("stiffness", "ratio", "holds"),
    [(1.0, 1.0 / 1.25, True), (1.00175, 3.75 / 2.5, False), (1 / 1.0019, 1e-4 / 2.5e-3, False)],
    ids=["right", "beyond", "stated without need"],
)
def test_a_tally_counts_a_statement_once_by_its_largest_error(hinge, stiffness, ratio, holds):
    """The energy at 0.67 carries the largest error of its statement: early rows are conservative, and do not count."""
    found = beside(hinge, replace(EXACT, stiffness=stiffness))
    of_energy = [each for each in error_ratios(found.rows) if each.row.probe.name == ENERGY]
    mine = tally(of_energy, "cprbm")
    assert mine.rows == 10
    assert mine.over == pytest.approx(1.0 / ratio, rel=5e-3)
    assert [each.ratio for each in mine.worst] == sorted((each.ratio for each in mine.worst), reverse=True)
    assert mine.worst[0].row.station == 0.67
    assert mine.worst[0].ratio == pytest.approx(ratio, rel=5e-3)
    assert (mine.within == mine.rows) is (ratio <= 1.0)
    assert mine.holds is holds
    assert max(each.ratio for each in error_ratios(found.rows)) <= EXACT_FACTOR


def test_statements_count_per_stage_closing_loads_once_and_no_error_not_at_all(hinge):
    """The error of the second stage, at a tenth of the load, is within a tenth of its statement."""
    stages = (*hinge.stages, Stage(name="back", steps="M", stations=(0.067,)))
    rows = beside(hinge.model_copy(update={"stages": stages, "claims": ()})).rows
    ratios = error_ratios(rows)
    mine = tally([each for each in ratios if each.row.probe.name == ENERGY], "cprbm")
    assert mine.over == pytest.approx(1.25, rel=5e-3)
    repeated = [row for row in rows if row.probe.quantity == "closing_load" and row.true_errors is not None]
    assert len(repeated) > 5
    counted = [each.row.station for each in ratios if each.row.probe.quantity == "closing_load"]
    assert counted == [repeated[0].station] * 2, "once for each solver"
    right, empty = tally(error_ratios(beside(hinge, EXACT, MadeUp("cprbm", 0.0)).rows), "cprbm"), tally((), "fea")
    assert (right.holds, right.rows) == (True, 0)
    assert (empty.holds, empty.over) == (True, None)
    whole = tally(ratios, "cprbm")
    assert whole.holds
    assert whole.rows > 0


def test_the_exact_solver_takes_part_in_a_real_run_and_answers_alone(capsys):
    assert solvers_of(None).exact is not None
    assert Solvers().exact is None
    assert run(["solve", "hinge", "--solver", "exact", "--json", "-"], Solvers(C, F, exact=EXACT)) == 0
    assert json.loads(capsys.readouterr().out)["cases"][0]["rows"][0]["cprbm"][0] == pytest.approx(0.01 * 0.067)
    assert run(["solve", "hinge", "--solver", "exact"], Solvers(C, F, exact=nobody)) == 1
    assert f"{Ending.NOT_COVERED.value}. It is made up." in capsys.readouterr().err


@pytest.mark.usefixtures("unprinted")
def test_the_study_and_its_command_say_whose_statements_hold(hinge, monkeypatch, capsys, tmp_path):
    def measured(exact):
        return study.with_case(study.Calibration(), hinge, Solvers(C, F, exact=exact), sizes=((17, 40), (40, 80)))

    right, silent = measured(EXACT), measured(nobody)
    (case,) = json.loads(text_of(study.result_of(right).data))["cases"]
    assert [(trial["links"], trial["elements"]) for trial in case["trials"]] == [(17, 40), (40, 80)]
    for mine in (mine for trial in case["trials"] for mine in trial["solvers"].values()):
        assert (mine["within"], mine["share"]) == (mine["rows"], 1.0)
        assert mine["rows"] > 50
        assert 1.0 <= mine["stated_over_true"] <= 10.0
    (figure,) = study.pictures(right)
    assert figure.svg.startswith(b"<?xml")
    assert all(len(row) == len(sheet.headers) for sheet in study.result_of(right).tables for row in sheet.rows)
    assert "broken by the CPRBM on hinge" in study.result_of(measured(replace(EXACT, stiffness=1.02))).sentences[0]
    assert (study.pictures(silent), study.result_of(silent).tables) == ((), ())
    (sentence,) = study.result_of(silent).sentences
    assert sentence == "hinge: an exact answer is known for no station. It is made up."
    monkeypatch.setattr(cases, "scenes", lambda: ("hinge",))
    monkeypatch.setattr(cases, "opened", lambda name: hinge)
    solvers = Solvers(C, F, exact=EXACT)
    assert run(["study", "calibration", "--out", str(tmp_path)], solvers) == 0
    assert "Calibration" in capsys.readouterr().out
    assert (tmp_path / "calibration.html").exists()
    assert run(["study", "calibration", "--quiet"], replace(solvers, exact=replace(EXACT, stiffness=1.02))) == 1
