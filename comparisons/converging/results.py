"""Result of a question at a family of sizes: error against N, and the error budget."""

from __future__ import annotations

from dataclasses import replace

from comparisons.budgets import drawn as budget_drawn
from comparisons.budgets import tables as budget_tables
from comparisons.budgets.accounts import accounted
from comparisons.choices import Choices
from comparisons.converging import drawn, offset
from comparisons.converging import tables as numbers
from comparisons.converging.families import converged
from comparisons.converging.report import ConvergenceResult
from comparisons.crew import Crew
from comparisons.pairing import Solvers
from comparisons.store import AnswerMemory
from comparisons.thinning import at_shown
from cprbm_scene import OffsetQuestion, Question


def result_of(
    question: Question, sizes: tuple[int, ...], choices: Choices, solvers: Solvers, crew: Crew
) -> ConvergenceResult:
    """Error against N, and the parts of every difference.

    Args:
        question: a scene with its shown stations, or an offset question.
        sizes: two or more ascending N.
        choices: the formulation and the beam theory.
        solvers: solvers of all runs.
        crew: worker processes.

    Raises:
        SceneError: a solver refuses the question.
    """
    if isinstance(question, OffsetQuestion):
        return offset.result_of(question, sizes, solvers.offset)
    question = at_shown(question)
    memory = AnswerMemory(pool=crew.pool, solvers=solvers)
    found = converged(question, sizes, choices, solvers, memory)
    n = numbers.shown_size(found)
    account = accounted(question, replace(choices, links=n, elements=2 * n), memory)
    return ConvergenceResult(
        question,
        (*numbers.sheets_of(found), *budget_tables.sheets_of(account)),
        (*numbers.sentences_of(found), *budget_tables.sentences_of(account)),
        (*drawn.of_convergence(found), *budget_drawn.of_account(account)),
        {**numbers.document(found), **budget_tables.data_of(account)},
        found.completed and not account.missing,
    )
