"""Critical points, closings and branches on made-up answers.

The planted critical angle is 70.4° on the way forward and 25.3° on the way back, with errors of 1e-4 rad at 40 links, a
quarter of that at 80 elements, a tenth of the step of theory 0.005, and 1e-6 rad of uncertainty of either solver.
"""

from dataclasses import replace
from math import degrees, radians

import pytest

from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.stations import begins_at, event_tolerance, span_of
from comparisons.verdict import Word
from comparisons.verdict.events import critical_rows
from comparisons.verdict.runs import Runs
from cprbm_scene import Answer, Critical, Ending, Loss, Stage
from cprbm_scene.frozendict import frozendict
from tests.verdict.comparing import altered, compared, counted, ending, only, opened, said_of, word_of
from tests.verdict.jumping import FORWARD, Jumping
from tests.verdict.made_up import MadeUp

C, F = Jumping("cprbm"), Jumping("fea")
STOPS = {"stops": True}
BIFURCATES = {"loss": Loss.BIFURCATION}
PASSES = Jumping("cprbm", over=0.29)


@pytest.fixture(scope="session")
def forward(crank):
    """The way forward alone, at every tenth degree."""
    (stage, _) = crank.stages
    return crank.model_copy(update={"stages": (stage.model_copy(update={"stations": stage.stations[::5]}),)})


def between(comparison):
    """Stages and stations, in degrees, between events."""
    rows = (row for row in comparison.rows if row.events.between)
    return list(dict.fromkeys((row.stage, round(degrees(row.station))) for row in rows))


def criticals(scene, cprbm=C, fea=F):
    return critical_rows(paired(scene, Choices(), Solvers(cprbm, fea)))


# -- Critical points


def test_differences_and_uncertainties_of_critical_points_are_planted(crank):
    forward, back = criticals(crank)
    assert (forward.stage, back.stage, forward.unit) == ("forward", "back", "rad")
    assert forward.difference == pytest.approx(0.75e-4, rel=1e-6)
    assert forward.bounds.cprbm == pytest.approx(1.25e-4, rel=1e-6)
    assert forward.bounds.fea == pytest.approx(1.25e-4 / 4.0, rel=1e-6)
    assert forward.theory == pytest.approx(5e-4, rel=1e-6)
    assert forward.bounds.round_off == pytest.approx(2e-6, rel=1e-9)
    assert forward.station == pytest.approx(FORWARD + 1e-4, abs=1e-9)


def unsure(scene, choices):
    return replace(C, loss=Loss.FOLD if choices.links == 40 else Loss.BIFURCATION)(scene, choices)


def in_shear(**change):
    return only(C, replace(C, **change), lambda choices: choices.theory == "shear")


@pytest.mark.parametrize(
    ("cprbm", "fea", "word"),
    [
        (C, F, "AGREE"),
        (C, replace(F, late=radians(0.2)), "AGREE"),
        (replace(C, late=-radians(0.2)), F, "AGREE"),
        (C, replace(F, late=radians(0.4)), "DIFFER EVENTS"),
        (replace(C, late=-radians(0.4)), F, "DIFFER EVENTS"),
        (replace(C, **BIFURCATES), F, "UNDECIDED BRANCH"),
        (C, replace(F, **BIFURCATES), "UNDECIDED BRANCH"),
        (replace(C, late=radians(0.02), **BIFURCATES), F, "DIFFER EVENTS"),
        (replace(C, loss=Loss.CONTACT, what="contact"), F, "DIFFER EVENTS"),
        (replace(C, loss=Loss.STOP, what="stopB"), replace(F, loss=Loss.STOP, what="stopB"), "AGREE"),
        (replace(C, loss=Loss.STOP, what="stopB"), replace(F, loss=Loss.STOP, what="stopC"), "DIFFER EVENTS"),
        (replace(C, loss=Loss.CONTACT, what="left"), replace(F, loss=Loss.CONTACT, what="right"), "UNDECIDED BRANCH"),
        (C, replace(F, jumps=False), "DIFFER EVENTS"),
        (replace(C, jumps=False), F, "DIFFER EVENTS"),
        (unsure, F, "UNDECIDED BRANCH"),
        (only(C, replace(C, jumps=False), lambda choices: choices.links == 80), F, "UNDECIDED BRANCH"),
        (C, only(F, replace(F, jumps=False), lambda choices: choices.elements == 160), "UNDECIDED BRANCH"),
        (replace(C, critical_error=radians(0.5)), F, "UNDECIDED COARSE"),
        (in_shear(late=radians(1.0)), F, "AGREE"),
        (in_shear(late=radians(1.5)), F, "UNDECIDED THEORY"),
        (in_shear(jumps=False), F, "UNDECIDED THEORY"),
        (in_shear(**BIFURCATES), F, "UNDECIDED THEORY"),
    ],
    ids=[
        "same",
        "0.2° late",
        "0.2° early",
        "0.4° late",
        "0.4° early",
        "kind",
        "kind in the finite elements",
        "kind at another load",
        "contact",
        "same stop",
        "another stop",
        "another contact",
        "missing in the finite elements",
        "missing in the CPRBM",
        "mechanisms of one solver",
        "missing at 2N",
        "missing at 2n",
        "coarse",
        "theory within 1.5 % of the span",
        "theory beyond",
        "missing in shear",
        "mechanism in shear",
    ],
)
def test_the_word_of_a_critical_point(crank, cprbm, fea, word):
    """0.3° are allowed within a theory, and 1.5 % of 90° by theory; no row differs for a critical point."""
    found = compared(crank, cprbm, fea)
    assert word_of(found) == word, found.verdict.sentence
    said = {" ".join(each.value for each in row.judged if each is not None) for row in found.criticals}
    assert said == {word}
    assert set(counted(found)) == {"AGREE"}


def test_the_sentence_names_both_kinds_at_one_load(forward):
    sentence = compared(forward, replace(C, **BIFURCATES), F).verdict.sentence
    assert "(bifurcation) in the CPRBM and" in sentence
    assert "(fold) in the finite elements" in sentence
    assert "the loads agree, the mechanisms do not: UNDECIDED" in sentence


@pytest.mark.parametrize(("beyond", "word"), [(0, "UNDECIDED RUN_ENDED"), (1, "DIFFER EVENTS")])
@pytest.mark.parametrize("solver", ["cprbm", "fea"])
def test_a_run_that_ends_before_a_critical_point_says_nothing_of_it(forward, solver, beyond, word):
    """The run without the critical point has ``beyond`` stations behind 70.4°."""
    reached = beyond + sum(station < FORWARD for station in forward.stages[0].stations)
    runs = {"cprbm": C, "fea": F}
    runs[solver] = ending(replace(runs[solver], jumps=False), reached)
    (row,) = criticals(forward, *runs.values())
    assert " ".join(each.value for each in row.judged) == word


@pytest.mark.parametrize(
    ("limit", "off", "word"), [(0.5, 0.4, Word.AGREE), (0.1, 0.2, Word.DIFFER), (0.008, 0.0, Word.UNDECIDED)]
)
def test_a_stage_may_allow_more_or_less(crank, limit, off, word):
    """0.009° are stated."""
    stages = tuple(stage.model_copy(update={"critical_limit": radians(limit)}) for stage in crank.stages)
    found = criticals(crank.model_copy(update={"stages": stages}), replace(C, late=radians(off)))
    assert {(row.allowed, row.word) for row in found} == {(radians(limit), word)}


def loads(solver, *values):
    critical = tuple(Critical("load", value, 0.0, Loss.FOLD, "", 0.0, 0.0, 1.0, None) for value in values)
    return Answer(solver, "hinge", frozendict(), Ending.COMPLETED, "", (), critical=critical)


@pytest.mark.parametrize(
    ("cprbm", "fea", "words"),
    [
        ((0.3,), (0.306,), [Word.AGREE]),
        ((0.3,), (0.307,), [Word.DIFFER]),
        ((0.3, 0.5), (0.3,), [Word.AGREE, Word.DIFFER]),
        ((0.3, 0.5), (0.5,), [Word.DIFFER, Word.DIFFER]),
    ],
)
def test_of_a_load_one_per_cent_of_the_span_is_allowed_and_the_first_is_compared_with_the_first(
    hinge, cprbm, fea, words
):
    """The span is 0.67 N·m."""
    first, second = loads("cprbm", *cprbm), loads("fea", *fea)
    answers = {"cprbm": first, "cprbm finer": first, "fea": second, "fea finer": second}
    rows = critical_rows(Runs(hinge, "bending", answers))
    assert [row.word for row in rows] == words
    assert [row.place for row in rows] == list(range(len(words)))


def test_the_load_axis_of_stages(crank, hinge):
    forward, back = crank.stages
    assert (begins_at(crank, forward), begins_at(crank, back)) == (0.0, forward.stations[-1])
    assert span_of(crank, back) == pytest.approx(radians(89.0))
    assert event_tolerance(crank, back) == radians(0.3)
    assert event_tolerance(hinge, hinge.stages[0]) == pytest.approx(0.0067)
    both = Stage(name="more", steps="M", stations=(-0.33, 0.5))
    assert span_of(hinge.model_copy(update={"stages": (*hinge.stages, both)}), both) == pytest.approx(0.67 + 0.33)


# -- Branches


def test_rows_are_compared_branch_by_branch(crank):
    """70° and 25° are no farther than 0.3° from the critical angles only in the second case."""
    found = compared(crank, C, F)
    assert [(each.stage, each.number, each.word) for each in found.verdict.branches] == [
        ("forward", 0, Word.AGREE),
        ("forward", 1, Word.AGREE),
        ("back", 1, Word.AGREE),
        ("back", 2, Word.AGREE),
    ]
    ends = [(round(degrees(each.first)), round(degrees(each.last))) for each in found.verdict.branches]
    assert ends == [(0, 70), (72, 90), (89, 27), (25, 1)]
    nearer = compared(crank, replace(C, late=radians(-0.2)), replace(F, late=radians(-0.2)))
    assert (between(found), between(nearer)) == ([("back", 25)], [("forward", 70)])
    assert all(row.bounds is None for row in nearer.rows if row.events.between)


def test_stations_between_the_critical_angles_take_no_part(crank):
    """The finite elements jump 5° later: their stations between 70.4° and 75.4° are on the branch before."""
    found = compared(crank, C, replace(F, late=radians(5.0)))
    assert between(found) == [("forward", 72), ("forward", 74), ("back", 25), ("back", 23), ("back", 21)]
    assert {row.branch for row in found.rows if row.station == radians(74.0)} <= {None}
    assert set(counted(found)) == {"AGREE"}


def test_a_fault_and_an_uncertainty_stay_on_their_branch(crank):
    soft = altered_on(1, C, replace(C, stiffness=1.02))
    found = compared(crank, soft, F)
    assert [each.word for each in found.verdict.branches] == [Word.AGREE, Word.DIFFER, Word.DIFFER, Word.AGREE]
    assert word_of(found) == "DIFFER VALUES"
    # Four times the error on the second branch alone.
    both = [compared(crank, one, F).rows for one in (C, altered_on(1, C, replace(C, error=4e-3)))]
    stated = [
        {row.branch: row.bounds.cprbm for row in rows if row.bounds and row.probe.quantity == "reaction_moment"}
        for rows in both
    ]
    assert stated[1][0] == stated[0][0]
    assert stated[1][1] == pytest.approx(4.0 * stated[0][1], rel=0.01)


def altered_on(branch, solver, other):
    def answer(scene, choices):
        first, second = solver(scene, choices), other(scene, choices)
        pairs = zip(first.stations, second.stations, strict=True)
        return replace(first, stations=tuple(b if a.branch == branch else a for a, b in pairs))

    return answer


def test_a_mesh_that_jumps_early_states_no_jump_as_an_uncertainty(crank):
    early = only(C, replace(C, late=radians(-3.0)), lambda choices: choices.links == 40)
    found = compared(crank, early, F)
    assert between(found)[:2] == [("forward", 68), ("forward", 70)]
    assert max(row.bounds.cprbm / row.scale for row in found.rows if row.bounds) < 0.01
    assert word_of(found) == "UNDECIDED COARSE"  # by the critical angle itself
    assert found.criticals[0].bounds.cprbm > radians(3.0)


@pytest.mark.parametrize(
    ("cprbm", "fea", "word", "completed"),
    [
        (STOPS, STOPS, "AGREE", True),
        (STOPS, {**STOPS, "late": radians(0.4)}, "DIFFER EVENTS", False),
        (STOPS, {**STOPS, **BIFURCATES}, "UNDECIDED BRANCH", False),
        ({**STOPS, "stiffness": 1.02}, STOPS, "DIFFER VALUES", True),
        (STOPS, {}, "DIFFER EVENTS", False),
    ],
    ids=["same", "later", "kind", "fault before", "one goes on"],
)
def test_solvers_that_stop_at_a_critical_point(crank, cprbm, fea, word, completed):
    found = compared(crank, replace(C, **cprbm), replace(F, **fea))
    assert (word_of(found), found.verdict.completed) == (word, completed), found.verdict.sentence
    assert {round(degrees(row.station)) for row in found.rows} == set(range(0, 71, 2))


def test_an_ending_without_its_critical_point_is_no_critical_point(crank):
    def unsaid(scene, choices):
        return replace(replace(C, stops=True)(scene, choices), critical=())

    found = compared(crank, unsaid, unsaid)
    assert (word_of(found), found.verdict.completed) == ("UNDECIDED RUN_ENDED", False)


# -- Passed critical points


@pytest.mark.parametrize(
    ("cprbm", "fea", "word", "turned"),
    [
        (PASSES, replace(F, **STOPS), "UNDECIDED BRANCH", {"cprbm"}),
        (replace(C, **STOPS), replace(PASSES, solver="fea"), "UNDECIDED BRANCH", {"fea"}),
        (
            only(replace(C, **STOPS), PASSES, lambda c: c.links == 40),
            replace(F, **STOPS),
            "UNDECIDED BRANCH",
            {"cprbm"},
        ),
        (replace(PASSES, late=radians(0.4)), replace(F, **STOPS), "DIFFER EVENTS", set()),
        (replace(PASSES, **BIFURCATES), replace(F, **STOPS), "DIFFER EVENTS", set()),
        (replace(C, jumps=False), replace(F, **STOPS), "DIFFER EVENTS", set()),
    ],
    ids=["in the CPRBM", "in the finite elements", "in one run", "elsewhere", "mechanism", "nowhere"],
)
def test_a_passed_critical_point_stands_in_for_a_missing_one(forward, cprbm, fea, word, turned):
    (row,) = criticals(forward, cprbm, fea)
    assert " ".join(each.value for each in row.judged if each) == word
    assert {name.split()[0] for name in row.turned} == turned
    assert set(row.turned.values()) <= {0.29}


def test_rows_before_a_passed_critical_point_are_judged(forward):
    found = compared(forward, PASSES, replace(F, **STOPS))
    assert (word_of(found), found.verdict.completed) == ("UNDECIDED RUN_ENDED", False)
    assert {round(degrees(row.station)) for row in found.rows} == set(range(0, 71, 10))
    assert found.verdict.sentence.count("went on along a state turned by 0.290 rad") == 1
    assert word_of(compared(forward, replace(PASSES, stiffness=1.02), replace(F, **STOPS))) == "DIFFER VALUES"


@pytest.mark.parametrize(
    ("fea", "word", "sentence"),
    [
        ({}, "AGREE", ""),
        ({"late": radians(15.0)}, "AGREE", ""),
        ({"over": 0.12, "lands": 0.05}, "DIFFER VALUES", "the finite elements passed a critical point (fold)"),
        ({"over": 0.0, "jumps": False}, "DIFFER EVENTS", "the CPRBM passed a critical point (fold)"),
    ],
    ids=["both", "later", "another state", "one alone"],
)
def test_solvers_that_pass_a_critical_point(forward, fea, word, sentence):
    """15° later 80° lies between: answers there are of two states and no contradiction."""
    found = compared(forward, PASSES, replace(PASSES, solver="fea", **fea))
    assert (word_of(found), found.verdict.completed, found.criticals) == (word, True, ()), found.verdict.sentence
    assert between(found) == ([("forward", 80)] if "late" in fea else [])
    assert sentence in found.verdict.sentence
    assert ("Before that" in found.verdict.sentence) is bool(sentence)


def test_within_a_tolerance_of_a_passed_point_a_contradiction_is_undecided(forward):
    """At 70.6° a solver has passed the point at 70.4°; the other solver may pass the point just behind."""
    (stage,) = forward.stages
    stations = (*(value for value in stage.stations if value < radians(69.0)), radians(70.6))
    short = forward.model_copy(update={"stages": (stage.model_copy(update={"stations": stations}),)})
    alone = replace(F, jumps=False)
    found = compared(short, PASSES, alone)
    assert said_of(found, "crank.reaction_moment", stations[-1]) == "UNDECIDED BRANCH"
    assert said_of(found, "crank.reaction_moment", stations[-2]) == "AGREE"
    assert word_of(compared(short, replace(C, jumps=False), alone)) == "AGREE"


@pytest.mark.parametrize(
    ("fea", "word"),
    [
        ({**BIFURCATES, "side": -1.0}, "UNDECIDED BRANCH"),
        ({**BIFURCATES, "stiffness": 1.02}, "DIFFER VALUES"),
        ({"side": -1.0}, "UNDECIDED BRANCH"),
        ({"side": -1.0, "late": radians(0.02)}, "DIFFER EVENTS"),
    ],
    ids=["image", "fault", "image behind a fold", "image behind a fold elsewhere"],
)
def test_mirror_images_behind_a_bifurcation_are_no_contradiction(crank, fea, word):
    found = compared(crank, replace(C, **BIFURCATES), replace(F, **fea))
    assert word_of(found) == word, found.verdict.sentence


def test_mirror_images_behind_a_fold_differ_and_a_run_on_an_image_states_no_uncertainty(crank):
    # The image is on the other side in the run at 2N: no uncertainty of twice the moment excuses a fault.
    image = only(replace(C, **BIFURCATES), replace(C, **BIFURCATES, side=-1.0), lambda choices: choices.links == 80)
    found = compared(crank, image, replace(F, **BIFURCATES))
    before, behind = ([each for each in found.verdict.branches if bool(each.number) is late] for late in (False, True))
    assert ({each.word for each in before}, {each.word for each in behind}) == ({Word.AGREE}, {Word.UNDECIDED})
    assert word_of(found) == "UNDECIDED BRANCH"
    assert word_of(compared(crank, C, replace(F, side=-1.0))) == "DIFFER VALUES"


# -- Closings


def later(solver, by):
    """A solver with closings that are stated later, and no other change."""

    def answer(scene, choices):
        found = solver(scene, choices)
        return replace(found, events=tuple(replace(each, value=each.value + by) for each in found.events))

    return answer


@pytest.mark.parametrize(("by", "word"), [(0.005, "AGREE"), (0.01, "DIFFER EVENTS"), (-0.01, "DIFFER EVENTS")])
def test_closings_are_compared_on_the_load_axis(hinge, by, word):
    """One per cent of 0.67 N·m is allowed; the made-up closings are 0.0004 N·m apart within one theory."""
    found = compared(hinge, MadeUp("cprbm", 2e-3), later(MadeUp("fea", -5e-4), by))
    assert word_of(found) == word, found.verdict.sentence
    assert ("contact closes in load" in found.verdict.sentence) is (word != "AGREE")


def test_a_closing_that_moves_with_the_mesh_excuses_as_much(hinge):
    """0.02 N·m between N and 2N: S·4/3·0.02 N·m are stated, and a closing 0.02 N·m apart is none."""
    coarse = only(MadeUp("cprbm", 2e-3), later(MadeUp("cprbm", 2e-3), 0.02), lambda choices: choices.links == 40)
    assert "contact closes" not in compared(hinge, coarse, MadeUp("fea", -5e-4)).verdict.sentence


@pytest.mark.parametrize(
    ("at", "word"),
    [
        ((0.201,), "AGREE"),
        ((0.201, 0.268), "AGREE"),
        ((0.201, 0.268, 0.335, 0.402, 0.469, 0.536), "UNDECIDED EVENT"),
        ((0.603, 0.67), "DIFFER EVENTS"),
    ],
    ids=["a station later", "two", "half of the stage", "opens again"],
)
def test_contacts_that_close_at_other_stations(hinge, at, word):
    """Rows between the closings are undecided; a solver that alone opens again contradicts."""
    found = compared(hinge, altered(MadeUp("cprbm", 2e-3), opened, *at), MadeUp("fea", -5e-4))
    assert word_of(found) == word, found.verdict.sentence
