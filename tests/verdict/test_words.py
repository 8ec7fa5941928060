"""Words and reasons of rows and cases on made-up answers, complete and incomplete ones."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from comparisons import cases
from comparisons.audit import audit
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.verdict import Reason, Word, worst_of
from comparisons.verdict.judge import judge_case, judge_rows
from comparisons.verdict.rows import Row
from comparisons.verdict.runs import Bounds
from cprbm_scene import Ending, Probe, Stage
from cprbm_scene.answer import PointForces, frozen_array
from cprbm_scene.frozendict import frozendict
from tests.verdict.comparing import C, F, altered, compared, counted, ending, only, opened, row_of, said_of, word_of
from tests.verdict.made_up import MadeUp, with_value

HINGE = cases.opened("hinge")
RUNS = paired(HINGE, Choices(), Solvers(C, F))
LIMIT = 0.015  # of the hinge
ROTATION = "BD.rotation"


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
@pytest.mark.parametrize(
    ("fault", "word"),
    [
        ({}, "AGREE"),
        ({"stiffness": 1.02}, "DIFFER VALUES"),
        ({"stiffness": 0.98}, "DIFFER VALUES"),
        ({"sign": -1.0}, "DIFFER VALUES"),
        ({"contact": False}, "DIFFER EVENTS"),
        ({"until": 7}, "UNDECIDED RUN_ENDED"),
    ],
    ids=["right", "2 % too stiff", "2 % too soft", "sign of the contact", "contact ignored", "stops"],
)
def test_a_planted_fault_in_a_solver(hinge, solver, fault, word):
    pair = {"cprbm": C, "fea": F}
    pair[solver] = replace(pair[solver], **fault)
    found = compared(hinge, pair["cprbm"], pair["fea"])
    assert word_of(found) == word, found.verdict.sentence
    assert found.verdict.completed is ("until" not in fault)


def test_identical_values_agree_and_a_fault_as_large_as_the_step_of_theory_differs(hinge):
    # 0.5 % too soft is the step of theory: the values in bending equal those in shear.
    found = compared(hinge, MadeUp("cprbm", 1e-4, stiffness=1 / 1.005), MadeUp("fea", -1e-5))
    assert word_of(found) == "DIFFER VALUES"
    found = compared(hinge, MadeUp("cprbm", 0.0), MadeUp("fea", 0.0))
    assert set(counted(found)) == {"AGREE"}


@pytest.mark.parametrize(("limit", "probe", "word"), [(None, None, "COARSE"), (0.2, None, ""), (None, 0.2, "")])
def test_the_limit_of_the_scene_and_of_a_probe(hinge, limit, probe, word):
    """2 % of error state 2.5 %, more than 1.5 % and less than 20 %."""
    probes = tuple(each.model_copy(update={"verdict_limit": probe}) for each in hinge.probes)
    scene = hinge.model_copy(update={"verdict_limit": limit or LIMIT, "probes": probes})
    found = compared(scene, MadeUp("cprbm", 2e-2), F)
    assert word_of(found) == (f"UNDECIDED {word}" if word else "AGREE")
    assert ("20.0 % for C.reaction" in found.verdict.sentence) is (probe is not None)
    assert ("more than 1.50 %" in found.verdict.because) is bool(word)


def in_shear(solver):
    return only(solver, replace(solver, stiffness=1.0 / 1.03), lambda choices: choices.theory == "shear")


def test_a_step_of_theory_beyond_the_limit_names_the_number_to_use(hinge):
    """From bending to shear all values grow by 3.5 %, more than 1.5 %; in shear nothing is left open."""
    found = compared(hinge, in_shear(C), in_shear(F))
    assert (word_of(found), found.runs.theory) == ("UNDECIDED THEORY", "bending")
    assert said_of(found, "scene.potential_energy") == "UNDECIDED THEORY"
    assert "Use the value in shear: `--theory shear`." in found.verdict.because
    sheared = compared(hinge, in_shear(C), in_shear(F), Choices(theory="shear"))
    assert word_of(sheared) == "AGREE"
    assert row_of(sheared, "scene.potential_energy").theory > 0.03 * row_of(sheared, "scene.potential_energy").scale
    assert "In bending the CPRBM's values are at most 4.77 % of the scale away" in sheared.verdict.sentence


def test_an_audit_that_fails_is_undecided_and_hides_no_difference(hinge):
    def look(scene, answer):
        complaints = ("at load 0.67 beam1 is not in balance", "more") if answer.solver == "fea" else ()
        return replace(audit(scene, answer), complaints=complaints)

    agreeing, differing = (
        compare(paired(hinge, Choices(), Solvers(cprbm, F)), look) for cprbm in (C, replace(C, stiffness=1.02))
    )
    assert (word_of(agreeing), word_of(differing)) == ("UNDECIDED AUDIT", "DIFFER VALUES")
    assert agreeing.verdict.completed
    for found in (agreeing, differing):
        assert (
            found.verdict.sentence.count("fea's answer fails: at load 0.67 beam1 is not in balance (and 1 more)") == 1
        )
        assert set(found.audits) == {"cprbm", "fea"}


# -- Rows between events of the runs


def test_rows_between_the_closings_of_runs_are_undecided_and_counted(hinge):
    """The CPRBM is open at 0.268, and both solvers close later: one row of ten by the force, none of the rest."""
    found = compared(hinge, altered(C, opened, 0.201, 0.268), F)
    assert said_of(found, "contact.force", 0.268) == "UNDECIDED EVENT"
    assert said_of(found, "contact.centre", 0.268) == ""  # the force decides
    assert said_of(found, ROTATION, 0.268) == "AGREE"
    assert word_of(found) == "AGREE"
    assert "of contact.force (EVENT)" in found.verdict.because
    # the run at 2N never closes: most rows of the force are between events, and the case is undecided
    unsure = only(C, altered(C, opened), lambda choices: choices.links == 80)
    found = compared(hinge, unsure, F)
    assert (said_of(found, "contact.force"), word_of(found)) == ("UNDECIDED EVENT", "UNDECIDED EVENT")


def test_a_contact_in_one_solver_alone_differs_by_the_force_and_is_undecided_without_a_force(hinge):
    open_, force = replace(C, contact=False), "contact.force"
    found = compared(hinge, open_, F)
    assert said_of(found, force) == "DIFFER EVENTS"
    assert row_of(found, force).fraction(row_of(found, force).difference) == pytest.approx(1.0)
    assert (row_of(found, "contact.centre").bounds, said_of(found, "contact.centre")) == (None, "")
    for quantity in ("centre", "ends", "closing_load"):
        asked = hinge.model_copy(update={"probes": (Probe(of="contact", quantity=quantity),), "claims": ()})
        assert word_of(compared(asked, open_, F)) == "UNDECIDED EVENT", quantity
        assert word_of(compared(asked, open_, replace(F, contact=False))).startswith("UNDECIDED"), quantity


# -- Forces that a clamp and a contact share


def sharing(force, clamp):
    """A contact 1.6 mm from the clamp A, of which an element is 2 mm long, and the force of the clamp."""

    def change(station):
        forces = PointForces(
            ("contact", "A"),
            ("beam1", "beam1"),
            frozen_array([0.0016, 0.0]),
            frozen_array(np.zeros((2, 2))),
            frozen_array([[0.0, force], [0.0, clamp]]),
            frozen_array([0.0, 0.0]),
        )
        return replace(with_value("contact.force", [abs(force)])(station), forces=forces)

    return change


@pytest.mark.parametrize(
    ("clamp", "word", "case"), [(-32.0, "UNDECIDED NOT_UNIQUE", "AGREE"), (-30.0, "DIFFER VALUES", "DIFFER VALUES")]
)
def test_a_shared_force_is_not_unique_if_the_sums_are_equal(hinge, clamp, word, case):
    """9 N and −29 N in one solver, 12 N and −32 N in the other have one sum; −30 N have another."""
    pair = altered(C, sharing(9.0, -29.0), 0.603, 0.67), altered(F, sharing(12.0, clamp), 0.603, 0.67)
    found = compared(hinge, *pair)
    assert [said_of(found, "contact.force", at) for at in (0.603, 0.67)] == [word] * 2
    assert word_of(found) == case
    assert ("2 of contact.force (NOT_UNIQUE)" in found.verdict.because) is (case == "AGREE")


def test_shared_forces_widen_no_other_station_and_do_not_agree_alone(hinge):
    """The share moves from 9 N to 12 N between N and 2N; the other stations keep their small uncertainty."""
    coarse, fine = (altered(C, sharing(force, -20.0 - force), 0.603) for force in (9.0, 12.0))
    cprbm = only(coarse, fine, lambda choices: choices.links == 80)
    found = compared(hinge, cprbm, altered(F, sharing(12.0, -32.0), 0.603))
    assert said_of(found, "contact.force", 0.603) == "UNDECIDED NOT_UNIQUE"
    assert said_of(found, "contact.force", 0.67) == "AGREE"
    stage = Stage(name="load", steps="M", stations=(0.603, 0.67))
    probes = (Probe(of="contact", quantity="force"),)
    scene = hinge.model_copy(update={"stages": (stage,), "probes": probes, "claims": ()})
    found = compared(scene, altered(C, sharing(9.0, -29.0)), altered(F, sharing(12.0, -32.0)))
    assert word_of(found) == "UNDECIDED NOT_UNIQUE"


# -- Rows and cases by definition

SHARES = st.floats(min_value=0.0, max_value=0.1)


def judged(word, reason):
    return replace(row(0.0, 0.0, None), word=word, reason=reason)


def row(difference, theory, bounds):
    value = frozen_array([1.0])
    probe = Probe(of="BD", quantity="rotation")
    own = {"difference": difference, "theory": theory, "bounds": bounds}
    return Row(probe, "load", 0.67, "rad", value, value, 1.0, 1.0, **own)


@settings(max_examples=300)
@given(SHARES, SHARES | st.just(math.nan), SHARES, SHARES, SHARES)
def test_a_word_follows_from_the_inequality(difference, theory, c, f, r):
    """|v_c − v_f| ≤ u_c + u_f + r with the sum and θ within the limit; without θ the sum alone counts."""
    (found,) = judge_rows(RUNS, [row(difference, theory, Bounds(c, f, r))])
    total = c + f + r
    if difference > total:
        expected = (Word.DIFFER, Reason.VALUES)
    elif total > LIMIT:
        expected = (Word.UNDECIDED, Reason.COARSE)
    elif theory > LIMIT:
        expected = (Word.UNDECIDED, Reason.THEORY)
    else:
        expected = (Word.AGREE, None)
    assert (found.word, found.reason) == expected


WORDS = {
    "D": (Word.DIFFER, Reason.VALUES),
    "E": (Word.DIFFER, Reason.EVENTS),
    "C": (Word.UNDECIDED, Reason.COARSE),
    "V": (Word.UNDECIDED, Reason.EVENT),
    "T": (Word.UNDECIDED, Reason.THEORY),
    "R": (Word.UNDECIDED, Reason.RUN_ENDED),
    "B": (Word.UNDECIDED, Reason.BRANCH),
    "N": (Word.UNDECIDED, Reason.NOT_UNIQUE),
    "A": (Word.AGREE, None),
    "-": (None, None),
}


@pytest.mark.parametrize(
    ("rows", "case"),
    [
        ("AAA", "A"),
        ("A-A", "A"),
        ("", "R"),
        ("--", "R"),
        ("ADC", "D"),
        ("EDA", "D"),
        ("CAA", "A"),
        ("CVAAA", "A"),
        ("CVA", "V"),
        ("CA", "C"),
        ("CCAAAA", "A"),
        ("TAAA", "T"),
        ("RAAA", "R"),
        ("BAAA", "B"),
        ("BRA", "R"),
        ("NNNA", "A"),
        ("NN", "N"),
        ("NC", "C"),
    ],
)
def test_words_of_rows_of_one_probe_make_the_word_of_the_case(rows, case):
    """A contradiction decides; a minority of unresolved rows, and rows that are not unique, decide nothing."""
    assert judge_case(RUNS.scene, [judged(*WORDS[each]) for each in rows]) == WORDS[case]


def test_a_coarse_row_beyond_the_limit_and_a_minority_that_is_the_majority_of_a_probe_decide():
    for difference, word in ((0.99 * LIMIT, "A"), (1.01 * LIMIT, "C")):
        coarse = replace(judged(*WORDS["C"]), difference=difference)
        assert judge_case(HINGE, [coarse, *[judged(*WORDS["A"])] * 6]) == WORDS[word]
    rows = [("a", "A")] * 10 + [("b", "C"), ("b", "C"), ("b", "A")]
    found = [replace(judged(*WORDS[word]), probe=Probe(of=of, quantity="rotation")) for of, word in rows]
    assert judge_case(HINGE, found) == WORDS["C"]


def test_rows_without_a_value_or_a_statement_and_the_worst_of_words():
    assert worst_of([Word.AGREE, None, Word.DIFFER, Word.UNDECIDED]) is Word.DIFFER
    assert worst_of([Word.AGREE, Word.UNDECIDED]) is Word.UNDECIDED
    assert worst_of([None]) is None
    found = judge_rows(RUNS, [row(math.nan, math.nan, None), row(0.0, 0.0, None)])
    assert [(each.word, each.reason) for each in found] == [(None, None), (Word.UNDECIDED, Reason.RUN_ENDED)]


# -- Answers that are not complete


def certified(**fields):
    return lambda station: replace(station, certificate=replace(station.certificate, **fields))


def without(probe):
    def change(station):
        return replace(station, values=frozendict({k: v for k, v in station.values.items() if k != probe}))

    return change


def drawn(**fields):
    """The first beam's shape with non-finite numbers, or no shape."""

    def change(station):
        shape = station.shapes["beam1"]
        spoilt = {name: frozen_array(np.full(shape.x.shape, value)) for name, value in fields.items()}
        shapes = {"beam2": station.shapes["beam2"]} | ({"beam1": replace(shape, **spoilt)} if fields else {})
        return replace(station, shapes=frozendict(shapes))

    return change


def touching(station):
    return replace(station, touching=frozendict({"contact": frozen_array([[0.0, np.nan]])}))


def last(size, value):
    return [0.0] * (size - 1) + [value]


STATIONS = {
    "missing probe": (without("BD.rotation"), "BD.rotation is missing"),
    "shape of a probe": (with_value("A.reaction", [1.0, 2.0, 3.0]), "A.reaction has the shape (3,)"),
    "empty probe": (with_value("BD.rotation", []), "BD.rotation has the shape (0,)"),
    "descending ends": (with_value("contact.ends", [0.05, 0.02]), "contact.ends are not ascending"),
    "certificate": (certified(failures=("not in balance",)), "its certificate does not hold: not in balance"),
    "number of the certificate": (certified(residual=np.nan), "its certificate holds a number that is not finite"),
    "shape": (drawn(x=np.nan), "beam1 has no shape of finite numbers"),
    "no shape": (drawn(), "beam1 has no shape of finite numbers"),
    "place of contact": (touching, "a place of contact is not finite"),
} | {
    f"{probe} {value}": (with_value(probe, last(size, value)), f"{probe} is not finite")
    for probe, size in (("B.displacement", 2), ("contact.force", 1), ("beam2.bending_stress", 81))
    for value in (np.nan, np.inf, -np.inf)
}


@pytest.mark.parametrize(("change", "problem"), STATIONS.values(), ids=STATIONS)
def test_a_station_with_a_problem_in_a_solver_is_not_reached(hinge, change, problem):
    """A problem at 0.603 in the CPRBM and at 0.335 in the finite elements, in every run: both are told once."""
    asked = hinge.model_copy(update={"probes": (*hinge.probes, Probe(of="contact", quantity="ends"))})
    found = compared(asked, altered(C, change, 0.603), altered(F, change, 0.335))
    assert (word_of(found), found.verdict.completed) == ("UNDECIDED RUN_ENDED", False)
    for solver, station in (("cprbm", "0.603"), ("fea", "0.335")):
        assert found.verdict.sentence.count(f"at load {station} N·m {problem}") == 1, solver
        assert f"{solver}, {solver} finer, {solver} beside: at load {station} N·m {problem}" in found.verdict.sentence
    reached = list(dict.fromkeys(row.station for row in found.rows))
    assert reached == [station for station in hinge.stages[0].stations if station not in (0.335, 0.603)]


def ended(scene, choices):
    return replace(C(scene, choices), ending=Ending.STEP_TOO_SMALL, sentence="The step is too small.")


def repeated(scene, choices):
    found = C(scene, choices)
    return replace(found, stations=(*found.stations, found.stations[-1]))


@pytest.mark.parametrize(
    ("cprbm", "problem", "stations", "word"),
    [
        (replace(C, until=7), "it has no station load 0.536 N·m (and 2 more)", 7, "UNDECIDED RUN_ENDED"),
        (replace(C, until=0), "it has no station load 0.067 N·m (and 9 more)", 0, "UNDECIDED RUN_ENDED"),
        (ended, "it ended early: The step is too small.", 10, "UNDECIDED RUN_ENDED"),
        (ending(C, 4), "it ended early: It stuck.", 4, "UNDECIDED RUN_ENDED"),
        (repeated, "it has 11 stations where 10 were asked", 10, "UNDECIDED RUN_ENDED"),
        (replace(C, stiffness=1.02, until=7), "it has no station load 0.536 N·m (and 2 more)", 7, "DIFFER VALUES"),
    ],
    ids=["stops unsaid", "nothing", "says so", "stops", "more stations", "fault before the end"],
)
def test_a_compared_run_without_all_stations_is_not_complete(hinge, cprbm, problem, stations, word):
    found = compared(hinge, cprbm, F)
    assert (word_of(found), found.verdict.completed) == (word, False)
    assert found.verdict.sentence.count(problem) == 1
    assert len({row.station for row in found.rows}) == stations
