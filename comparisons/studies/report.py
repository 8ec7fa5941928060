"""A report: for every question the comparison, error against N and run times; kept in the folder of the report.

A chapter depends on its question, on the wanted parts, and on the program.  A kept chapter with the same dependence is
taken with its measured run times.  An interrupted report goes on with the unfinished chapter, and a further question is
added without solving the others again.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from pydantic import TypeAdapter, ValidationError
from pydantic_core import to_json

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
from comparisons.plain import Plain
from comparisons.present.columns import Figure, Section
from comparisons.present.page import Chapter, case_chapter, figures_of, light, put_case, put_section
from comparisons.store import digest
from comparisons.studies import table1
from comparisons.studies.convergence import convergence_section
from comparisons.verdict.runs import Runs
from comparisons.writing import write
from cprbm_scene import OffsetQuestion, Question, Scene, SceneError

T = TypeVar("T")

SIZES = (10, 20, 40, 80, 160)
"""N of the run times."""

REPEAT = 3
AT_MOST = 4.0
"""Seconds after which a size is not repeated and no larger size begins."""

_CHAPTER, _TABLE = "chapter.json", "table1-section.json"


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
    further = dict[str, Callable[[], Section]]()
    if parts.sizes:
        further["Error against N"] = lambda: convergence_section(question, parts.sizes, parts.choices, solvers, crew)
    if isinstance(question, OffsetQuestion):
        found: Comparison | OffsetComparison = compared_offset(question, solvers.offset)
    else:
        found = compare(question, paired(question, parts.choices, solvers, crew) if pending is None else pending())
        if parts.times:
            further["Run times"] = lambda: _run_times(question, timed, solvers)
    sections = tuple(_or_refusal(heading, section) for heading, section in further.items())
    return Content(found, figures_of(found), sections)


def _or_refusal(heading: str, section: Callable[[], Section]) -> Section:
    """A section, or the cause for which a solver refuses it."""
    try:
        return section()
    except SceneError as error:
        why = "; ".join(f"{each.key}: found {each.found}; allowed: {each.allowed}" for each in error.mistakes)
        return Section(heading, (f"A solver refuses the question: {why}.",))


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
    plan = Plan(dict.fromkeys(OURS, SIZES), repeat=REPEAT, at_most=AT_MOST, clock="cpu")
    methods, known = contenders(timed, Choices(kinematics=plan.kinematics)), reference(scene, knowing)
    return bench_section(_done(Session(scene, plan, methods, provenance.machine(), CLOCKS[plan.clock], known)))


def _done(session: Session) -> Session:
    """The session after all of its runs."""
    for job in session.jobs():
        session.do(job)
    return session


def has_table(questions: Sequence[Question]) -> bool:
    """Whether the questions include all cases of the paper's Table 1, as built in."""
    return all(cases.asked(name) in questions for name in {cell.case for cell in table1.CELLS})


def table_section(timed: Solvers, made_on: Mapping[str, str | int]) -> Section:
    """The paper's Table 1 beside our run times.

    Args:
        timed: solvers without kept answers.
        made_on: the machine and the versions.
    """
    return table1.result_of(_done(table1.session(timed, made_on, REPEAT, AT_MOST)))


def kept(folder: Path, question: Question, wanted: str) -> Chapter | None:
    """A question's kept chapter; None without a chapter of the same question and ``wanted`` parts."""
    return _read_kept(folder / question.name / _CHAPTER, Chapter, _key(question, wanted))


def added(folder: Path, question: Question, wanted: str, found: Content) -> Chapter:
    """Write the content of a question into a folder; the chapter of the page.

    Raises:
        OSError: the folder cannot be written to.
    """
    own = folder / question.name
    put_case(folder, found.compared, found.figures)
    for section in found.further:
        put_section(own, section)
    chapter = case_chapter(found.compared, found.figures, found.further)
    chapter = replace(chapter, files=("scene.toml", *chapter.files))
    write(own / "scene.toml", chapter.scene)
    # the last of all files: with it all are there
    write(own / _CHAPTER, to_json((_key(question, wanted), chapter)))
    return chapter


def kept_table(folder: Path, made_on: Mapping[str, str | int]) -> Section | None:
    """The kept section of the paper's Table 1; None if the program or the machine is another."""
    return _read_kept(folder / _TABLE, Section, digest(str(sorted(made_on.items()))))


def added_table(folder: Path, section: Section, made_on: Mapping[str, str | int]) -> Section:
    """Write the paper's Table 1 beside ours into a folder; the section of the page.

    Raises:
        OSError: the folder cannot be written to.
    """
    put_section(folder, section)
    write(folder / _TABLE, to_json((digest(str(sorted(made_on.items()))), light(section))))
    return light(section)


def document(folder: Path, chapters: Sequence[Chapter], made_on: Mapping[str, str | int]) -> Plain:
    """The report's JSON: the JSON of ``compare`` for every case, with ``convergence`` and ``bench`` as far as known.

    Raises:
        OSError: a file of the folder cannot be read.
    """
    found = []
    for chapter in chapters:
        own = folder / chapter.name
        case: Plain = json.loads((own / "comparison.json").read_text("utf-8"))["cases"][0]
        for name in ("convergence", "bench"):
            if f"{name}.json" in chapter.files:
                case[name] = json.loads((own / f"{name}.json").read_text("utf-8"))
        found.append(case)
    return {"machine": dict(made_on), "cases": found}


def _read_kept(file: Path, kind: type[T], key: str) -> T | None:
    """The record of a file; None without a record of this key."""
    with suppress(FileNotFoundError, ValidationError):
        found, record = TypeAdapter(tuple[str, kind]).validate_json(file.read_bytes())  # type: ignore[valid-type]
        return record if found == key else None
    return None


def _key(question: Question, wanted: str) -> str:
    """Digest of the dependence of a chapter; ``wanted`` names the parts and sizes."""
    return digest(question.model_dump_json(exclude={"file"}), wanted)
