"""The account of a case's differences: its budgets, and what its claims would need.  Two rounds of runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from comparisons.budget import Budget, budgets_of
from comparisons.budget_runs import Asked, BudgetRuns, asked, budgeted
from comparisons.choices import KINEMATICS, Choices
from comparisons.convergence_told import shown_size
from comparisons.families import Convergence, Method, at
from comparisons.pairing import ALONE, Crew, Solvers
from comparisons.poisson import ClaimedRatio, claimed_ratios, rerun, with_ratio
from comparisons.soundness import complaints
from scene import Answer, Scene


@dataclass(frozen=True, slots=True)
class Account:
    """What the differences of a case are made of.

    Attributes:
        scene: the question.
        choices: how finely, and by which variants.
        runs: all answers that it rests on.
        budgets: at every station; none where an answer is not whole.
        claims: those of the last station.
        missing: why there are no budgets, in sentences; empty where there are.
    """

    scene: Scene
    choices: Choices
    runs: BudgetRuns
    budgets: tuple[Budget, ...]
    claims: tuple[ClaimedRatio, ...]
    missing: tuple[str, ...]


def account_of(found: Convergence, choices: Choices, solvers: Solvers, crew: Crew) -> Account:
    """The account at the size whose values ``converge`` shows, N links and 2N elements, which spares its own runs.

    Raises:
        SceneError: a solver refuses the question.
    """
    solved = {(series.method, series.variant): series.answers for series in found.series}
    variants: list[tuple[Method, str, Choices]] = [("cprbm", choices.formulation, choices)]
    variants += [("fea", theory, choices.within(theory)) for theory in KINEMATICS]
    known = {
        asked(method, at(own, n)): answer
        for method, variant, own in variants
        for n, answer in solved.get((method, variant), {}).items()
    }
    n = shown_size(found)
    return accounted(found.scene, replace(choices, links=n, elements=2 * n), solvers, crew, known)


def accounted(
    scene: Scene,
    choices: Choices,
    solvers: Solvers,
    crew: Crew = ALONE,
    known: Mapping[Asked, Answer] | None = None,
) -> Account:
    """Run what an error budget needs, and draw it up.

    Args:
        scene: the question.
        choices: how finely, and by which variants.
        solvers: who answers.
        crew: processes to share the runs.
        known: answers to this scene by :func:`comparisons.budget_runs.asked`; what is there is not run again.

    Raises:
        SceneError: a solver refuses the question.
    """
    runs = budgeted(scene, choices, solvers, crew, known)
    missing = tuple(f"{name}: {what}" for name, answer in runs.everything() for what in complaints(scene, answer))
    if missing:
        return Account(scene, choices, runs, (), (), missing)
    budgets = budgets_of(scene, runs)
    claims = claimed_ratios(scene, runs, budgets)
    ratios = [ratio for claim in claims for ratio in claim.ratios]
    answers = iter(crew.answers([(solvers.fea, with_ratio(scene, ratio), choices) for ratio in ratios]))
    return Account(
        scene,
        choices,
        runs,
        budgets,
        tuple(rerun(claim, [next(answers) for _ in claim.ratios]) for claim in claims),
        (),
    )
