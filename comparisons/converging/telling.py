"""Everything that there is to tell of one question at a family of sizes."""

from __future__ import annotations

from dataclasses import replace

from comparisons.budgets import drawn as budget_drawn
from comparisons.budgets import told as budget_told
from comparisons.budgets.accounts import accounted
from comparisons.choices import Choices
from comparisons.converging import drawn, offset
from comparisons.converging import told as numbers
from comparisons.converging.families import converged
from comparisons.converging.report import Told
from comparisons.memory import Remembering
from comparisons.pairing import Crew, Solvers
from comparisons.thinning import at_shown
from cprbm_scene import OffsetQuestion, Question


def all_told(question: Question, sizes: tuple[int, ...], choices: Choices, solvers: Solvers, crew: Crew) -> Told:
    """Error against N, and what a difference is made of.

    Args:
        question: a scene, of which the stations that it shows count, or an offset question.
        sizes: N, two or more, ascending.
        choices: the formulation and the beam theory.
        solvers: who answers.
        crew: processes to share the runs.

    Raises:
        SceneError: a solver refuses the question.
    """
    if isinstance(question, OffsetQuestion):
        return offset.told(question, sizes, solvers.offset)
    question = at_shown(question)
    memory = Remembering(pool=crew.pool, solvers=solvers)
    found = converged(question, sizes, choices, solvers, memory)
    n = numbers.shown_size(found)
    account = accounted(question, replace(choices, links=n, elements=2 * n), memory)
    return Told(
        question,
        (*numbers.sheets_of(found), *budget_told.sheets_of(account)),
        (*numbers.sentences_of(found), *budget_told.sentences_of(account)),
        (*drawn.of_convergence(found), *budget_drawn.of_account(account)),
        {**numbers.document(found), **budget_told.data_of(account)},
        found.completed and not account.missing,
    )
