"""The account of a case's differences: its runs and budgets."""

from __future__ import annotations

from dataclasses import dataclass

from comparisons.budgets.parts import Budget, budgets_of
from comparisons.budgets.runs import BudgetRuns, budgeted
from comparisons.choices import Choices
from comparisons.sentences import problem_sentences
from comparisons.store import AnswerMemory
from cprbm_scene import Scene


@dataclass(frozen=True, slots=True)
class Account:
    """What the differences of a case are made of.

    Attributes:
        scene: the question.
        choices: how finely, and by which variants.
        runs: all answers that it rests on.
        budgets: at every station; none where an answer is not whole.
        missing: why there are no budgets, in sentences; empty where there are.
        silent: why the solid, which was asked, says nothing; empty where it does.
    """

    scene: Scene
    choices: Choices
    runs: BudgetRuns
    budgets: tuple[Budget, ...]
    missing: tuple[str, ...]
    silent: str = ""

    @property
    def last(self) -> tuple[Budget, ...]:
        """The budgets of the last station of the last stage."""
        stage = self.scene.stages[-1]
        where = stage.name, stage.stations[-1]
        return tuple(each for each in self.budgets if (each.row.stage, each.row.station) == where)


def accounted(scene: Scene, choices: Choices, memory: AnswerMemory) -> Account:
    """Run what an error budget needs, and draw it up.

    Args:
        scene: the question.
        choices: how finely, and by which variants.
        memory: who answers; what it knows already is not run again.

    Raises:
        SceneError: a solver refuses the question.
    """
    runs = budgeted(scene, choices, memory)
    missing = tuple(
        f"{name}: {what}" for name, answer in runs.everything() for what in problem_sentences(scene, answer)
    )
    if missing:
        return Account(scene, choices, runs, (), missing)
    ended = [each for each in runs.solid or () if not each.completed]
    silent = f"{ended[0].ending.value}. {ended[0].sentence}" if ended else ""
    return Account(scene, choices, runs, budgets_of(scene, runs), (), silent)
