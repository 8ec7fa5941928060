"""Content of a report: the comparison of a question, error against N, and run times."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from comparisons import cases, provenance
from comparisons.bench.contenders import OURS, contenders
from comparisons.bench.measures import asked, reference
from comparisons.bench.running import CLOCKS, Plan, Session
from comparisons.bench.section import bench_section
from comparisons.case import Comparison, compare
from comparisons.choices import Choices
from comparisons.crew import Crew
from comparisons.offset_verdict import OffsetComparison, compared_offset
from comparisons.pairing import Solvers, paired
from comparisons.present.columns import Figure, Section
from comparisons.present.page import figures_of
from comparisons.studies import table1
from comparisons.studies.convergence import convergence_section
from comparisons.verdict.runs import Runs
from cprbm_scene import OffsetQuestion, Question, Scene, SceneError
from cprbm_scene.frozendict import frozendict

SIZES = (10, 20, 40, 80, 160)
"""N of the run times."""

REPEAT = 3
AT_MOST = 4.0
"""Seconds after which a size is not repeated and no larger size begins."""


@dataclass(frozen=True, slots=True)
class Parts:
    """Parts of a report for every question.

    Attributes:
        choices: of the comparison.
        sizes: N of the error against N; empty without this part.
        times: whether run times are measured.
    """

    choices: Choices
    sizes: tuple[int, ...]
    times: bool


@dataclass(frozen=True, slots=True)
class Content:
    """The comparison of a question, figures, and further sections: error against N, and run times."""

    compared: Comparison | OffsetComparison
    figures: tuple[Figure, ...]
    further: tuple[Section, ...] = ()


def gathered(
    question: Question,
    pending: Callable[[], Runs] | None,
    parts: Parts,
    solvers: Solvers,
    timed: Solvers,
    crew: Crew,
) -> Content:
    """All parts of a question; run times come last, when no other solve runs.

    Args:
        question: a scene or an offset question.
        pending: the runs of the comparison, if the runs began before.
        parts: the parts, and their sizes.
        solvers: solvers, perhaps with kept answers.
        timed: solvers for run times, without kept answers.
        crew: processes to share the runs.

    Raises:
        SceneError: a solver refuses the comparison; the report names other refusals.
    """
    found: Comparison | OffsetComparison
    if isinstance(question, OffsetQuestion):
        found = compared_offset(question, solvers.offset)
    else:
        runs = paired(question, parts.choices, solvers, crew) if pending is None else pending()
        found = compare(question, runs)
    further = []
    if parts.sizes:
        further.append(
            _or_refusal(
                "error against N",
                lambda: convergence_section(question, parts.sizes, parts.choices, solvers, crew),
            )
        )
    if parts.times and not isinstance(question, OffsetQuestion):
        further.append(_or_refusal("run times", lambda: _run_times(question, timed, solvers)))
    return Content(found, figures_of(found), tuple(further))


def _or_refusal(subject: str, section: Callable[[], Section]) -> Section:
    """A section, or the cause for which a solver refuses it."""
    try:
        return section()
    except SceneError as error:
        why = "; ".join(f"{each.key}: found {each.found}; allowed: {each.allowed}" for each in error.mistakes)
        heading = f"{subject[:1].upper()}{subject[1:]}"
        return Section(heading, (f"There is no {subject}: {why}.".replace("is no run times", "are no run times"),))


def has_table(questions: Sequence[Question]) -> bool:
    """Whether the questions include all cases of the paper's Table 1, as built in."""
    return all(cases.asked(name) in questions for name in {cell.case for cell in table1.CELLS})


def _run_times(scene: Scene, timed: Solvers, knowing: Solvers) -> Section:
    """Run times at the last load by the processor's clock, since reports are made on machines with other work.

    Args:
        scene: the question.
        timed: solvers without kept answers.
        knowing: solvers for the reference of the errors, with kept answers.

    Raises:
        SceneError: every method refuses the question.
    """
    scene = asked(scene)
    plan = Plan(frozendict(dict.fromkeys(OURS, SIZES)), repeat=REPEAT, at_most=AT_MOST, clock="cpu")
    taking = contenders(timed, Choices(kinematics=plan.kinematics))
    session = Session(scene, plan, taking, provenance.machine(), CLOCKS[plan.clock], reference(scene, knowing))
    for job in session.jobs():
        session.do(job)
    return bench_section(session)


def table_section(timed: Solvers, made_on: Mapping[str, str | int]) -> Section:
    """The paper's Table 1 beside our run times.

    Args:
        timed: solvers without kept answers.
        made_on: the machine and the versions.
    """
    session = table1.session(timed, made_on, REPEAT, AT_MOST)
    for job in session.jobs():
        session.do(job)
    return table1.result_of(session)
