"""The search for N: on laws that are known, and on the command line with made-up solvers."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace

import click
import pytest

from comparisons import cases
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.cli.main import commands, run
from comparisons.cli.options import tolerance
from comparisons.executor import ALONE
from comparisons.opinions import solid_limit
from comparisons.pairing import Solvers, solid_answer, solvers_of
from comparisons.tolerances import LARGEST, limits_of, runs_within, solve_within
from comparisons.verdict import Word
from comparisons.verdict.rows import rows_of
from comparisons.verdict.runs import Runs
from cprbm_scene import Ending, Probe
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.fea_reference.solid.bars import WIDTH, YOUNG, bar, straight
from tests.verdict.made_up import MadeUp


@dataclass
class Noting:
    """Notes what a solver is asked."""

    solver: MadeUp
    asked: list

    def __hash__(self):
        return id(self)

    def __call__(self, scene, choices):
        one = self.solver.solver == "cprbm"
        mine = (choices.links, choices.formulation) if one else (choices.elements, choices.kinematics)
        self.asked.append((scene.name, choices.theory, *mine, None if one else choices.penetration))
        return self.solver(scene, choices)


@pytest.mark.parametrize("tolerance", [3e-2, 1e-3])
def test_a_comparison_solves_nothing_twice_and_states_no_more_than_was_asked(hinge, tolerance):
    solvers = Solvers(Noting(MadeUp("cprbm", 2e-3), []), Noting(MadeUp("fea", -5e-4), []))
    runs, found = runs_within(hinge, Choices(), tolerance, solvers, ALONE, lambda text: None)
    comparison = compare(runs)
    assert comparison.verdict.word is Word.AGREE, comparison.verdict.sentence
    assert all(each.met for each in found)
    for asked in (solvers.cprbm.asked, solvers.fea.asked):
        assert len(asked) == len(set(asked))
    for row in comparison.rows:
        if row.bounds is not None:
            assert row.fraction(row.bounds.cprbm) <= tolerance
            assert row.fraction(row.bounds.fea) <= tolerance


def test_what_falls_with_the_square_of_n_is_extrapolated_to_its_limit(hinge, right):
    # reference: the made-up solver's own law, 2e-3 (40/N)²: without an error the displacement is 0.01 of the load
    answer, found = solve_within(hinge, "cprbm", Choices(), 1e-3, right, lambda text: None)
    assert found.extrapolated == (20, 40)
    assert found.solved == (10, 11, 20, 23, 40)
    assert found.n == answer.settings["links"] == 40
    assert answer.settings["extrapolated_from"] == [20, 40]
    assert "B.displacement" in found.probes
    assert "N = 20, 40" in answer.notes[-1]
    station = answer.stations[0]
    assert station.values["B.displacement"][0] == pytest.approx(0.01 * station.value, rel=1e-12)


def test_what_is_settled_beside_kinks_errs_by_no_more_than_it_states():
    """Reference: the exact answer of `tapered`, whose sections' kinks no mesh meets: at 80 links a moment was off by
    2.6 times what two successive changes, small by accident, had stated."""
    runs, _ = runs_within(cases.opened("tapered"), Choices(), 0.01, solvers_of(None), ALONE, lambda text: None)
    verdict = compare(runs).verdict
    assert verdict.word is Word.AGREE, verdict.sentence
    assert "are within the stated ones" in verdict.sentence


def test_a_contact_that_is_open_at_one_size_leaves_the_finest_value_as_it_is(hinge, right):
    answers = [right.cprbm(hinge, Choices(links=n)) for n in (10, 20, 40)]
    touched = answers[1].stations[-1]
    apart = replace(touched, touching={})
    answers[1] = replace(answers[1], stations=(*answers[1].stations[:-1], apart))
    value = limits_of(hinge, dict(zip((10, 20, 40), answers, strict=True))).answer
    fine = answers[2].stations[-1].values["contact.force"]
    assert value.stations[-1].values["contact.force"] == fine
    assert value.stations[-2].values["contact.force"] != answers[2].stations[-2].values["contact.force"]


def test_ends_of_a_zone_that_would_change_places_are_kept(hinge, right):
    asked = hinge.model_copy(update={"probes": (*hinge.probes, Probe(of="contact", quantity="ends"))})
    answers = []
    for n, ends in ((10, [0.0, 5e-3]), (20, [1e-3, 4e-3]), (40, [2e-3, 2.1e-3])):
        found = right.cprbm(asked, Choices(links=n))
        values = {**found.stations[-1].values, "contact.ends": frozen_array(ends)}
        last = replace(found.stations[-1], values=frozendict(values))
        answers.append(replace(found, stations=(*found.stations[:-1], last)))
    value = limits_of(asked, dict(zip((10, 20, 40), answers, strict=True))).answer
    assert value.stations[-1].values["contact.ends"].tolist() == [2e-3, 2.1e-3]


def test_a_tolerance_is_a_percentage_or_a_fraction():
    solve = commands.commands["solve"]
    for text in ("0.1%", " 0.1 % ", "0.001", "1e-3"):
        assert tolerance(click.Context(solve), solve.params[0], text) == pytest.approx(1e-3), text


def test_solve_and_compare_say_how_n_was_found(right, capsys, tmp_path):
    assert run(["solve", "hinge", "--tol", "0.1%", "--json", "-"], right) == 0
    found = json.loads(capsys.readouterr().out)["cases"][0]["solvers"]["cprbm"]["tolerance"]
    assert found["asked"] == pytest.approx(1e-3)
    assert found["estimate"] <= 1e-3
    assert found["extrapolated"] == [20, 40]
    assert found["solved"] == [10, 11, 20, 23, 40]
    assert (found["links"], found["elements"], found["met"]) == (40, None, True)
    file = tmp_path / "numbers.json"
    assert run(["compare", "hinge", "--tol", "0.1%", "--json", str(file)], right) == 0
    assert "N for 0.100 %: cprbm 40, fea 80." in capsys.readouterr().out
    solvers = json.loads(file.read_text("utf-8"))["cases"][0]["solvers"]
    assert solvers["cprbm"]["tolerance"]["links"] == 40
    # in bending the made-up contact is still open at 0.201 N·m with 10 elements, and 10, 20 and 40 are not of one law
    assert solvers["fea"]["tolerance"]["extrapolated"] == [40, 80]


@pytest.mark.parametrize("command", ["solve", "compare"])
def test_another_tolerance_is_refused(right, capsys, command):
    for text in ("0", "-1%", "100%", "1", "nan", "%", "tight", "1e-3%%", "inf"):
        assert run([command, "hinge", f"--tol={text}"], right) == 2, text
        said = capsys.readouterr().err
        assert f"found {text!r}; allowed" in said


@pytest.mark.parametrize("command", ["solve", "compare"])
def test_a_tolerance_and_n_are_a_wrong_question(right, capsys, command):
    for option in (["-n", "40"], ["--elements", "beam1=30,beam2=40"], ["--across", "3"]):
        assert run([command, "hinge", "--tol", "1%", *option], right) == 2, option
        captured = capsys.readouterr()
        assert captured.out == ""
        assert f"--tol and {option[0]}" in captured.err


class Scattered(MadeUp):
    """An error that does not fall with N: the error at one N says nothing of another N."""

    def __call__(self, scene, choices):
        count = choices.links if self.solver == "cprbm" else choices.elements
        spread = replace(self, error=1e-3 * (1 + count // 10 % 3) * (count / 40.0) ** 2)
        return MadeUp.__call__(spread, scene, choices)


def test_what_no_n_can_meet_is_said_with_the_probe_and_ends_with_3(right, capsys):
    scattered = Scattered("cprbm", 1e-3)
    for name in ("solve", "compare"):
        assert run([name, "hinge", "--tol", "0.001%"], Solvers(scattered, right.fea)) == 3
        captured = capsys.readouterr()
        assert "CPRBM: NOT within" in captured.out + captured.err
        assert " states " in captured.out + captured.err
        assert "B.displacement" in captured.out


def test_a_solver_that_never_completes_ends_with_1(right, capsys):
    def ended(scene, choices):
        found = right.cprbm(scene, choices)
        return replace(found, stations=found.stations[:4], ending=Ending.STEP_TOO_SMALL, sentence="Too small.")

    for name in ("solve", "compare"):
        assert run([name, "hinge", "--tol", "1%", "--quiet"], Solvers(ended, right.fea)) == 1
    assert "Too small." in capsys.readouterr().err


def test_a_drives_reaction_by_the_energies_comes_with_an_extrapolated_answer(right):
    scene = cases.opened("gripper-driven")
    stage = scene.stages[0].model_copy(update={"stations": scene.stages[0].stations[:3]})
    scene = scene.model_copy(update={"stages": (stage,), "claims": ()})
    runs, (cprbm, _) = runs_within(scene, Choices(), 1e-3, right, ALONE, lambda text: None)
    assert cprbm.extrapolated
    assert len(compare(runs).reactions) == 3


# -- The solid: laws of known limit, and a bar of known stiffness

SAME_THEORY = Choices(kinematics="bending")


@dataclass
class Falling:
    """A made-up solid whose error falls with the power p of n from C at n = 20; the solid notes the questions."""

    C: float
    p: float
    until: int | None = None
    asked: list = field(default_factory=list)

    def __hash__(self):
        return id(self)

    def __call__(self, scene, choices):
        n = choices.elements
        self.asked.append((n, choices.across))
        error = self.C * (20.0 / n) ** self.p
        made = MadeUp("fea", error * (n / 40.0) ** 2)(scene, choices.within("bending"))
        made = replace(made, solver="solid", settings={"elements": n, "across": choices.across})
        if self.until is not None and n < self.until:
            return replace(made, ending=Ending.STEP_TOO_SMALL, stations=made.stations[:1])
        return made


def of_stage(hinge):
    """The hinge where its made-up contact has closed."""
    stage = hinge.stages[0].model_copy(update={"stations": (0.402, 0.536, 0.67), "shown": ()})
    return hinge.model_copy(update={"stages": (stage,), "claims": ()})


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


def test_the_order_is_seen_on_three_meshes_and_assumed_on_two(hinge):
    scene = of_stage(hinge)
    solid = Falling(0.01, 3.9)
    answers = [solid(scene, Choices(elements=n, across=n // 20)) for n in (20, 40, 80)]
    runs = Runs(scene, "bending", dict.fromkeys(("cprbm", "cprbm finer", "fea", "fea finer"), answers[-1]))
    row = next(row for row in reversed(rows_of(runs)) if row.probe.name == "B.displacement")
    three, two = (solid_limit(scene, row, meshes)[0] for meshes in (answers, answers[1:]))
    assert three.order == pytest.approx(3.9, abs=0.05)  # 0.005 of what presses besides is not linear in the error
    assert (three.assumed, two.assumed, two.order) == (4.0, 2.0, None)


def test_the_search_ends_at_its_bound_or_where_no_mesh_would_do(hinge):
    scene = of_stage(hinge)
    solid = Falling(0.02, 1.1)
    _, found = solve_within(scene, "solid", Choices(), 1e-3, Solvers(solid=solid), lambda text: None)
    assert not found.met
    assert max(found.solved) == LARGEST["solid"]
    assert "N = 160 is the largest N" in found.sentence(hinge)
    solid = Falling(0.2, 1.1)
    _, found = solve_within(of_stage(hinge), "solid", Choices(), 1e-9, Solvers(solid=solid), lambda text: None)
    assert not found.met
    assert max(found.solved) < LARGEST["solid"]
    assert "would not do either" in found.sentence(hinge)


def test_a_mesh_too_coarse_to_arrive_counts_for_nothing(hinge):
    solid = Falling(0.01, 3.0, until=40)
    _, found = solve_within(of_stage(hinge), "solid", Choices(), 1e-2, Solvers(solid=solid), lambda text: None)
    assert found.met
    assert found.extrapolated == (40, 80)
    never = Falling(0.01, 3.0, until=1000)
    answer, found = solve_within(of_stage(hinge), "solid", Choices(), 1e-2, Solvers(solid=never), lambda text: None)
    assert not found.met
    assert not answer.completed
    assert "ended early" in found.sentence(hinge)


def test_a_comparison_has_all_meshes_of_the_solid_and_solves_none_twice(hinge, right):
    solid = Falling(0.01, 3.9)
    solvers = replace(right, solid=solid)
    runs, found = runs_within(of_stage(hinge), SAME_THEORY, 2e-3, solvers, ALONE, lambda text: None)
    assert [each.solver for each in found] == ["cprbm", "fea", "solid"]
    assert found[2].met
    assert len(set(solid.asked)) == len(solid.asked)
    assert [answer.settings["elements"] for answer in runs.solids] == list(found[2].solved)


def test_a_bar_bends_as_timoshenko_says_within_what_is_asked():
    # P L³/(3 E I) + 6 P L/(5 G A); the ends, which cannot warp, take less than half of the second term from it
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
