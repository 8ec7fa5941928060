"""What a report is made of: the comparison of a question, its error against N, and its run times."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from comparisons import cases, paths_drawn, report
from comparisons.bench import brief
from comparisons.bench.running import Benchmark
from comparisons.case import Comparison, compare
from comparisons.choices import Choices
from comparisons.converging.report import ConvergenceResult
from comparisons.converging.results import result_of
from comparisons.crew import Crew
from comparisons.figures import Picture
from comparisons.offset_verdict import OffsetComparison, compared_offset
from comparisons.pairing import Runs, Solvers, paired
from comparisons.reporting.chapters import Found
from comparisons.studies import table1, table1_result
from comparisons.studies.result import StudyResult
from cprbm_scene import OffsetQuestion, Question, SceneError


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is wanted of every question.

    Attributes:
        choices: of the comparison.
        sizes: N of the error against N, which is left out where there are none.
        times: whether run times are measured.
    """

    choices: Choices
    sizes: tuple[int, ...]
    times: bool


def gathered(
    question: Question,
    pending: Callable[[], Runs] | None,
    wanted: Wanted,
    solvers: Solvers,
    timed: Solvers,
    crew: Crew,
) -> Found:
    """All that is wanted of a question; run times come last, when nothing else is solved.

    Args:
        question: a scene or an offset question.
        pending: the runs of the comparison, where they were begun before.
        wanted: which parts, and how finely.
        solvers: who answers, and may have kept answers.
        timed: the solvers themselves, for run times.
        crew: processes to share the runs.

    Raises:
        SceneError: a solver refuses the comparison; the report names other refusals.
    """
    found: Comparison | OffsetComparison
    if isinstance(question, OffsetQuestion):
        found = compared_offset(question, solvers.offset)
    else:
        runs = paired(question, wanted.choices, solvers, crew) if pending is None else pending()
        found = compare(question, runs)
    convergence, unconverged = _converged(question, wanted, solvers, crew)
    measured, untimed = _timed(question, wanted, timed, solvers)
    return Found(found, _drawn(found), convergence, unconverged, measured, untimed)


def has_table(questions: Sequence[Question]) -> bool:
    """Whether the questions are those of the paper's Table 1, as they are built in, and more."""
    return all(cases.asked(name) in questions for name in {cell.case for cell in table1.CELLS})


def table(timed: Solvers, made_on: Mapping[str, str | int]) -> StudyResult:
    """The paper's Table 1 beside our run times.

    Args:
        timed: the solvers themselves.
        made_on: the machine and the versions.
    """
    found = table1.begun(timed, made_on)
    for cell in table1.runs(brief.REPEAT):
        found = table1.solved(found, cell, timed, brief.AT_MOST)
    return table1_result.result_of(found)


def _converged(
    question: Question, wanted: Wanted, solvers: Solvers, crew: Crew
) -> tuple[ConvergenceResult | None, str]:
    if not wanted.sizes:
        return None, ""
    try:
        return result_of(question, wanted.sizes, wanted.choices, solvers, crew), ""
    except SceneError as error:
        return None, f"There is no error against N: {_why(error)}."


def _timed(question: Question, wanted: Wanted, timed: Solvers, knowing: Solvers) -> tuple[Benchmark | None, str]:
    if not wanted.times or isinstance(question, OffsetQuestion):
        return None, ""
    try:
        return brief.measured(question, timed, knowing), ""
    except SceneError as error:
        return None, f"There are no run times: {_why(error)}."


def _why(error: SceneError) -> str:
    return "; ".join(f"{each.key}: found {each.found}; allowed: {each.allowed}" for each in error.mistakes)


def _drawn(found: Comparison | OffsetComparison) -> tuple[Picture, ...]:
    """The figures of the comparison, and what every load or drive meets along its way."""
    of_all = report.drawn(found)
    if isinstance(found, OffsetComparison):
        return of_all
    names = {picture.name for picture in of_all}
    return (*of_all, *(picture for picture in paths_drawn.of_every_way(found) if picture.name not in names))
