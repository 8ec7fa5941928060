"""Families of sizes and the search for N: made-up answers with known limits, and the commands that print the limits."""

from __future__ import annotations

import json
from dataclasses import replace

import click
import numpy as np
import pytest

from comparisons import cases
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.cli.main import commands, run
from comparisons.cli.options import tolerance
from comparisons.executor import ALONE
from comparisons.opinions import solid_limit
from comparisons.pairing import Solvers, solid_answer, solvers_of
from comparisons.studies import convergence
from comparisons.studies import convergence_tables as tables
from comparisons.studies.convergence import convergence_of
from comparisons.tolerances import LARGEST, limits_of, runs_within, solve_within
from comparisons.verdict import Word
from comparisons.verdict.rows import rows_of
from comparisons.verdict.runs import Runs
from comparisons.writing import text_of
from cprbm_scene import Ending, Probe
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.comparisons.laws import Falling, Noting, Scattered, changed, of_stage, with_value
from tests.fea_reference.solid.bars import WIDTH, YOUNG, bar, straight
from tests.verdict.made_up import THEORY, MadeUp

SIZES = (10, 20, 40, 80)
LAST = 0.67


def _found(hinge, solvers, sizes=SIZES, theory=None):
    return convergence_of(hinge, sizes, Choices(theory=theory), solvers, ALONE)


def _family(found, probe, station=LAST, method="cprbm"):
    return next(one for one in found.families if (one.probe, one.station, one.solver) == (probe, station, method))


@pytest.fixture(scope="module")
def found(hinge, right):
    """All families of the hinge."""
    return _found(hinge, right)


def quiet(text):
    """A listener that prints no progress."""


def test_the_limit_is_the_limit_of_the_made_up_law_also_in_document_and_tables(hinge, found):
    # the law of the made-up solvers without any error: made_up.MadeUp._station
    family = _family(found, "B.displacement")
    reach, push = LAST, LAST - 0.2
    assert family.found.value == pytest.approx([0.01 * reach, 0.02 * reach - 0.005 * push], rel=1e-9)
    assert family.orders == pytest.approx([2.0, 2.0], abs=1e-6)
    assert family.component_order(0) == pytest.approx(2.0, abs=1e-6)
    for n in SIZES:
        true = np.linalg.norm(family.values[n] - family.found.value)
        assert family.apart(n) == pytest.approx(true)
        assert np.all(family.error(n) >= np.abs(family.values[n] - family.found.value))
    stress = _family(found, "beam1.bending_stress")
    ((place,),) = (stress.components,)
    thickness = hinge.beams["beam1"].thickest
    assert thickness <= place <= np.pi * 0.025 - thickness
    assert stress.found.value.shape == (1,)
    # the document has the promised keys, and the tables have whole rows
    data = json.loads(text_of(tables.document(found)))
    assert data["case"] == "hinge"
    entry = next(one for one in data["families"] if one["probe"] == "B.displacement" and one["component"] == "y")
    assert entry["n"] == list(SIZES)
    assert len(entry["values"]) == len(entry["errors"]) == len(SIZES)
    for key in ("solver", "settings", "stage", "station", "order", "limit", "limit_uncertainty"):
        assert entry[key] is not None
    assert entry["settings"]["kinematics"] == "bending"
    assert len(data["runs"]) == 2 * len(SIZES)
    for sheet in tables.tables_of(found):
        assert sheet.rows
        assert {len(row) for row in sheet.rows} == {len(sheet.headers)}


@pytest.mark.parametrize("theory", ["bending", "shear"])
def test_both_limits_meet_in_one_theory(hinge, right, theory):
    """The made-up theories make the rotation before contact 0.9·0.067 and, in shear, 0.5 % more."""
    found = _found(hinge, right, theory=theory)
    assert [(one.method, one.variant, one.theory) for one in found.series] == [
        ("cprbm", "auto", theory),
        ("fea", theory, theory),
    ]
    for pair in tables.pairs_of(found.families):
        cprbm, apart = pair.cprbm, pair.apart
        assert apart is None or apart[0] <= 1e-5 * cprbm.scale
    first = hinge.stages[0].stations[0]
    limits = [_family(found, "BD.rotation", first, method).found.value for method in ("cprbm", "fea")]
    assert limits == [pytest.approx([0.9 * first * (1.0 + THEORY[theory])], rel=1e-9)] * 2


def test_a_contact_that_is_open_at_some_sizes_or_at_every_size(hinge, right, found):
    opened = changed(right.cprbm, with_value("contact.force", [0.0]), at_most=10)
    family = _family(_found(hinge, Solvers(opened, right.fea)), "contact.force")
    assert family.used == (20, 40, 80)
    assert family.found is not None
    opened = changed(right.cprbm, with_value("contact.centre", []), at_most=40)
    family = _family(_found(hinge, Solvers(opened, right.fea)), "contact.centre")
    assert (family.used, family.found, family.why) == ((80,), None, "the contact is open at N = 40")
    first = hinge.stages[0].stations[0]
    family = _family(found, "contact.force", first)
    assert (family.why, family.found.order) == ("the contact is open", None)
    assert _family(found, "contact.centre", first).found is None


def test_incomplete_runs_are_left_out_and_named_and_the_command_ends_with_1(hinge, right, capsys):
    short = lambda answer: replace(answer, stations=answer.stations[:2])  # noqa: E731
    ended = changed(right.cprbm, lambda answer: replace(short(answer), ending=Ending.STEP_TOO_SMALL), at_most=10)
    found = _found(hinge, Solvers(ended, right.fea))
    assert not found.completed
    family = _family(found, "BD.rotation")
    assert family.used == (20, 40, 80)
    (sentence,) = tables.sentences_of(found)
    assert sentence.startswith("CPRBM (auto) at N = 10 gave no complete answer: it ended early")
    entry = next(one for one in tables.document(found)["families"] if one["probe"] == "BD.rotation")
    assert entry["values"][0] is None
    assert entry["errors"][0] is None
    broken = changed(right.cprbm, short, at_most=9999)
    found = _found(hinge, Solvers(broken, changed(right.fea, lambda a: replace(a, stations=()), at_most=9999)))
    assert found.families == ()
    assert tables.tables_of(found) == ()
    assert convergence.convergence_figures(found) == ()
    ended = changed(right.cprbm, short, at_most=10)
    assert run(["converge", "hinge", "--sizes", "10,20", "--quiet"], Solvers(ended, right.fea)) == 1
    assert "at N = 10 gave no complete answer" in capsys.readouterr().out


def test_the_exact_values_stand_beside_where_they_are_known(hinge, right):
    known = MadeUp("cprbm", 0.0)(hinge, Choices())
    covered = replace(known, stations=known.stations[3:], ending=Ending.NOT_COVERED)
    found = _found(hinge, replace(right, exact=lambda scene, choices: covered))
    family = _family(found, "BD.rotation")
    assert family.true_error(20) == pytest.approx(family.apart(20), rel=1e-6)
    assert _family(found, "BD.rotation", hinge.stages[0].stations[0]).exact is None
    sheared = _found(hinge, replace(right, exact=lambda scene, choices: covered), theory="shear")
    assert all(one.exact is None for one in sheared.families)
    assert tables.tables_of(found)[0].headers[-1] == "CPRBM limit from exact"


def test_converge_prints_and_writes_and_an_interruption_keeps_finished_cases(right, capsys, tmp_path):
    def interrupted(scene, choices):
        if scene.name == "wrapped":
            raise KeyboardInterrupt
        return right.fea(scene, choices)

    arguments = ["--sizes", "10,20,40", "--theory", "bending", "--json"]
    assert run(["converge", "hinge", *arguments, "-"], right) == 0
    captured = capsys.readouterr()
    assert json.loads(captured.out)["families"]
    assert captured.err == ""
    arguments += [str(tmp_path / "c.json"), "--out", str(tmp_path / "c")]
    assert run(["converge", "hinge", "wrapped", *arguments], Solvers(right.cprbm, interrupted)) == 130
    captured = capsys.readouterr()
    assert "limits at load 0.67" in captured.out
    assert "order CPRBM" in captured.out
    assert "Interrupted" in captured.err
    assert 'id="hinge"' in (tmp_path / "c" / "index.html").read_text("utf-8")
    for name in ("convergence.json", "convergence.svg", "convergence.png"):
        assert (tmp_path / "c" / "hinge" / name).is_file()
    (case,) = json.loads((tmp_path / "c.json").read_text("utf-8"))["cases"]
    assert case["case"] == "hinge"


# -- The search for the N of a tolerance


@pytest.mark.parametrize(("closed", "tolerance"), [(False, 3e-2), (False, 1e-3), (True, 2e-3)])
def test_a_comparison_solves_nothing_twice_and_states_no_more_than_was_asked(hinge, closed, tolerance):
    solid = Falling(0.01, 3.9)
    solvers = Solvers(Noting(MadeUp("cprbm", 2e-3), []), Noting(MadeUp("fea", -5e-4), []), solid=solid)
    scene = of_stage(hinge) if closed else hinge
    runs, found = runs_within(scene, Choices(), tolerance, solvers, ALONE, quiet)
    comparison = compare(runs)
    assert comparison.verdict.word is Word.AGREE, comparison.verdict.sentence
    assert [each.solver for each in found] == ["cprbm", "fea", "solid"]
    met = [each.met for each in found]
    assert met[:2] == [True, True]
    # no mesh of the made-up solid meets 1e-3 at the station where the contact is about to close
    assert met[2] is (tolerance > 1e-3)
    for asked in (solvers.cprbm.asked, solvers.fea.asked, solid.asked):
        assert len(asked) == len(set(asked))
    assert [answer.settings["elements"] for answer in runs.solids] == list(found[2].solved)
    for row in comparison.rows:
        if row.bounds is not None:
            assert row.fraction(row.bounds.cprbm) <= tolerance
            assert row.fraction(row.bounds.fea) <= tolerance


def test_what_is_settled_beside_kinks_errs_by_no_more_than_it_states():
    """Reference: the exact answer of `tapered`, whose sections' kinks no mesh meets: at 80 links a moment was off by
    2.6 times what two successive changes, small by accident, had stated."""
    runs, _ = runs_within(cases.opened("tapered"), Choices(), 0.01, solvers_of(None), ALONE, lambda text: None)
    verdict = compare(runs).verdict
    assert verdict.word is Word.AGREE, verdict.sentence
    assert "are within the stated ones" in verdict.sentence


def test_a_contact_open_at_one_size_or_ends_that_change_places_keep_the_finest_value(hinge, right):
    answers = [right.cprbm(hinge, Choices(links=n)) for n in (10, 20, 40)]
    apart = replace(answers[1].stations[-1], touching={})
    answers[1] = replace(answers[1], stations=(*answers[1].stations[:-1], apart))
    value = limits_of(hinge, dict(zip((10, 20, 40), answers, strict=True))).answer
    fine = answers[2].stations[-1].values["contact.force"]
    assert value.stations[-1].values["contact.force"] == fine
    assert value.stations[-2].values["contact.force"] != answers[2].stations[-2].values["contact.force"]
    asked = hinge.model_copy(update={"probes": (*hinge.probes, Probe(of="contact", quantity="ends"))})
    answers = {}
    for n, ends in ((10, [0.0, 5e-3]), (20, [1e-3, 4e-3]), (40, [2e-3, 2.1e-3])):
        found = right.cprbm(asked, Choices(links=n))
        values = {**found.stations[-1].values, "contact.ends": frozen_array(ends)}
        last = replace(found.stations[-1], values=frozendict(values))
        answers[n] = replace(found, stations=(*found.stations[:-1], last))
    assert limits_of(asked, answers).answer.stations[-1].values["contact.ends"].tolist() == [2e-3, 2.1e-3]


def test_what_falls_with_the_square_of_n_is_extrapolated_and_the_commands_print_the_n(hinge, right, capsys, tmp_path):
    # reference: the made-up solver's own law, 2e-3 (40/N)²: without an error the displacement is 0.01 of the load
    answer, found = solve_within(hinge, "cprbm", Choices(), 1e-3, right, quiet)
    assert found.extrapolated == (20, 40)
    assert found.solved == (10, 11, 20, 23, 40)
    assert found.n == answer.settings["links"] == 40
    assert answer.settings["extrapolated_from"] == [20, 40]
    assert "B.displacement" in found.probes
    assert "N = 20, 40" in answer.notes[-1]
    station = answer.stations[0]
    assert station.values["B.displacement"][0] == pytest.approx(0.01 * station.value, rel=1e-12)
    solve = commands.commands["solve"]
    for text in ("0.1%", " 0.1 % ", "0.001", "1e-3"):  # a percentage or a fraction
        assert tolerance(click.Context(solve), solve.params[0], text) == pytest.approx(1e-3), text
    assert run(["solve", "hinge", "--tol", "0.1%", "--json", "-"], right) == 0
    found = json.loads(capsys.readouterr().out)["cases"][0]["solvers"]["cprbm"]["tolerance"]
    assert found["asked"] == pytest.approx(1e-3)
    assert found["estimate"] <= 1e-3
    assert found["extrapolated"] == [20, 40]
    assert (found["links"], found["elements"], found["met"]) == (40, None, True)
    file = tmp_path / "numbers.json"
    assert run(["compare", "hinge", "--tol", "0.1%", "--json", str(file)], right) == 0
    assert "N for 0.100 %: cprbm 40, fea 80." in capsys.readouterr().out
    solvers = json.loads(file.read_text("utf-8"))["cases"][0]["solvers"]
    assert solvers["cprbm"]["tolerance"]["links"] == 40
    # in bending the made-up contact is still open at 0.201 N·m with 10 elements, and 10, 20 and 40 are not of one law
    assert solvers["fea"]["tolerance"]["extrapolated"] == [40, 80]


@pytest.mark.parametrize("command", ["solve", "compare"])
def test_an_unmet_tolerance_is_code_3_with_the_probe_and_an_incomplete_solver_is_code_1(right, capsys, command):
    asked = [command, "hinge", "--tol", "0.001%"]
    assert run(asked, Solvers(Scattered("cprbm", 1e-3), right.fea)) == 3
    captured = capsys.readouterr()
    assert "CPRBM: NOT within" in captured.out + captured.err
    assert " states " in captured.out + captured.err
    assert "B.displacement" in captured.out

    def ended(scene, choices):
        found = right.cprbm(scene, choices)
        return replace(found, stations=found.stations[:4], ending=Ending.STEP_TOO_SMALL, sentence="Too small.")

    assert run([command, "hinge", "--tol", "1%", "--quiet"], Solvers(ended, right.fea)) == 1
    captured = capsys.readouterr()
    assert "Too small." in (captured.err if command == "solve" else captured.out)


def test_a_drives_reaction_by_the_energies_comes_with_an_extrapolated_answer(right):
    scene = cases.opened("gripper-driven")
    stage = scene.stages[0].model_copy(update={"stations": scene.stages[0].stations[:3]})
    scene = scene.model_copy(update={"stages": (stage,), "claims": ()})
    runs, (cprbm, _) = runs_within(scene, Choices(), 1e-3, right, ALONE, lambda text: None)
    assert cprbm.extrapolated
    assert len(compare(runs).reactions) == 3


@pytest.mark.parametrize("p", [1.1, 2.0, 3.9])
@pytest.mark.parametrize("tolerance", [3e-2, 3e-4])
def test_the_error_is_within_the_tolerance_whatever_the_order(hinge, p, tolerance):
    # reference: the law without an error, 0.01 of the load along x
    scene = of_stage(hinge)
    solid = Falling(-0.017, p)
    answer, found = solve_within(scene, "solid", Choices(), tolerance, Solvers(solid=solid), lambda text: None)
    assert found.worst is not None
    assert found.met == (found.fraction <= tolerance)
    error = abs(answer.stations[-1].values["B.displacement"][0] - 0.0067) / 0.0067
    assert error <= min(found.fraction, tolerance) if found.met else error <= found.fraction
    assert len(set(solid.asked)) == len(solid.asked)
    assert [n for n, _ in solid.asked] == list(found.solved) == [20 * 2**k for k in range(len(solid.asked))]
    assert all(n == 20 * across for n, across in solid.asked)


def test_the_search_on_the_solid_ends_at_its_bound_or_where_no_mesh_would_do(hinge):
    def search(solid, within):
        return solve_within(of_stage(hinge), "solid", Choices(), within, Solvers(solid=solid), quiet)

    for solid, within, to_the_end, said in (
        (Falling(0.02, 1.1), 1e-3, True, "N = 160 is the largest N"),
        (Falling(0.2, 1.1), 1e-9, False, "would not do either"),
    ):
        _, found = search(solid, within)
        assert not found.met
        assert (max(found.solved) == LARGEST["solid"]) is to_the_end
        assert said in found.sentence(hinge)
    # a mesh too coarse to arrive counts for nothing
    _, found = search(Falling(0.01, 3.0, until=40), 1e-2)
    assert found.met
    assert found.extrapolated == (40, 80)
    answer, found = search(Falling(0.01, 3.0, until=1000), 1e-2)
    assert not found.met
    assert not answer.completed
    assert "ended early" in found.sentence(hinge)


def test_the_order_is_seen_on_three_meshes_and_assumed_on_two(hinge):
    scene = of_stage(hinge)
    solid = Falling(0.01, 3.9)
    answers = [solid(scene, Choices(elements=n, across=n // 20)) for n in (20, 40, 80)]
    runs = Runs(scene, "bending", dict.fromkeys(("cprbm", "cprbm finer", "fea", "fea finer"), answers[-1]))
    row = next(row for row in reversed(rows_of(runs)) if row.probe.name == "B.displacement")
    three, two = (solid_limit(scene, row, meshes)[0] for meshes in (answers, answers[1:]))
    assert three.order == pytest.approx(3.9, abs=0.05)  # 0.005 of what presses besides is not linear in the error
    assert (three.assumed, two.assumed, two.order) == (4.0, 2.0, None)


def test_a_bar_bends_as_timoshenko_says_within_what_is_asked():
    # P L³/(3 E I) + 6 P L/(5 G A); the ends cannot warp and take less than half of the second term
    L, t, P = 0.31, 0.034, 0.011
    scene = bar(straight(L), t, poisson=0.35, stations=(P,), probes=(("tip", "displacement"),))
    solvers = Solvers(solid=solid_answer)
    answer, found = solve_within(scene, "solid", Choices(), 1e-3, solvers, lambda text: None)
    bending = P * L**3 / (3.0 * YOUNG * WIDTH * t**3 / 12.0)
    shear = 1.2 * P * L / (YOUNG / 2.7 * WIDTH * t)
    assert found.met
    assert bending + 0.5 * shear < answer.stations[-1].values["tip.displacement"][1] < bending + shear


def test_the_command_line_says_what_was_solved(hinge, right, capsys, tmp_path):
    solvers = replace(right, solid=Falling(0.01, 3.1))
    assert run(["solve", "hinge", "--solver", "solid", "--tol", "2%", "--json", "-"], solvers) == 0
    told = json.loads(capsys.readouterr().out)["cases"][0]["solvers"]["solid"]["tolerance"]
    assert told["met"]
    assert told["links"] is None
    assert told["elements"] == max(told["solved"])
    assert told["extrapolated"] == told["solved"][-2:]
    assert run(["solve", "hinge", "--solver", "solid", "--tol", "1e-9"], solvers) == 3
    assert "SOLID: NOT within" in capsys.readouterr().err
    file = tmp_path / "numbers.json"
    asked = ["compare", "hinge", "--solver", "cprbm,fea,solid", "--tol", "1%", "--json", str(file)]
    assert run(asked, solvers) == 0
    told = json.loads(file.read_text("utf-8"))["cases"][0]
    found = told["solvers"]["solid"]["tolerance"]
    assert found["met"]
    assert found["estimate"] <= 1e-2
    assert {row["probe"] for row in told["solid"]} == {row["probe"] for row in told["rows"]}
