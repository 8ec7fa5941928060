"""The solid's meshes for a tolerance: on laws of known limit, on a bar of known stiffness, on the command line."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace

import pytest

from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.crew import ALONE
from comparisons.pairing import Solvers, solid_answer
from comparisons.solid_limits import solid_limit
from comparisons.tolerances.search import LARGEST, runs_within, solve_within
from comparisons.verdict.rows import rows_of
from comparisons.verdict.runs import Runs
from cprbm_scene import Ending
from tests.fea_reference.solid.bars import WIDTH, YOUNG, bar, straight
from tests.verdict.made_up import MadeUp

SAME_THEORY = Choices(kinematics="bending")


@dataclass
class Falling:
    """A made-up solid whose error falls with the power p of n from C at n = 20; it notes what it is asked."""

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


@pytest.mark.parametrize("p", [1.1, 1.5, 2.0, 3.1, 3.9])
@pytest.mark.parametrize("tolerance", [3e-2, 4e-3, 3e-4])
def test_the_error_is_within_the_tolerance_whatever_the_order(hinge, p, tolerance):
    # reference: the law without an error, 0.01 of the load along x
    scene = of_stage(hinge)
    solid = Falling(-0.017, p)
    answer, found = solve_within(scene, "solid", Choices(), tolerance, Solvers(solid=solid), lambda text: None)
    assert found.worst is not None
    assert found.met == (found.worst.fraction <= tolerance)
    error = abs(answer.stations[-1].values["B.displacement"][0] - 0.0067) / 0.0067
    assert error <= min(found.worst.fraction, tolerance) if found.met else error <= found.worst.fraction
    assert len(set(solid.asked)) == len(solid.asked)
    assert [n for n, _ in solid.asked] == list(found.solved) == [20 * 2**k for k in range(len(solid.asked))]
    assert all(n == 20 * across for n, across in solid.asked)


def test_the_order_is_seen_on_three_meshes_and_assumed_on_two(hinge):
    scene = of_stage(hinge)
    solid = Falling(0.01, 3.9)
    answers = [solid(scene, Choices(elements=n, across=n // 20)) for n in (20, 40, 80)]
    runs = Runs("bending", (answers[-1], answers[-1]), (answers[-1], answers[-1]))
    row = next(row for row in reversed(rows_of(scene, runs)) if row.probe.name == "B.displacement")
    three, two = (solid_limit(scene, row, meshes)[0] for meshes in (answers, answers[1:]))
    assert three.order == pytest.approx(3.9, abs=0.05)  # 0.005 of what presses besides is not linear in the error
    assert (three.assumed, two.assumed, two.order) == (4.0, 2.0, None)


def test_the_search_ends_at_its_bound_and_says_so(hinge):
    scene = of_stage(hinge)
    solid = Falling(0.02, 1.1)
    _, found = solve_within(scene, "solid", Choices(), 1e-3, Solvers(solid=solid), lambda text: None)
    assert not found.met
    assert max(found.solved) == LARGEST["solid"]
    assert "N = 160 is the largest N" in found.sentence(hinge)


def test_what_no_mesh_can_meet_is_not_looked_for_on_the_finest(hinge):
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
    assert [answer.settings["elements"] for answer in runs.solid] == list(found[2].solved)


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


def test_a_tolerance_and_elements_across_are_a_wrong_question(right, capsys):
    assert run(["solve", "hinge", "--solver", "solid", "--tol", "1%", "--across", "3"], right) == 2
    assert "--tol and --across" in capsys.readouterr().err
