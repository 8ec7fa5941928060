"""A report: for every question the comparison, error against N and run times; kept in the folder of the report.

A chapter depends on its question, on the wanted parts, and on the program.  A kept chapter with the same dependence is
taken with its measured run times.  An interrupted report goes on with the unfinished chapter, and a further question is
added without solving the others again.
"""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TypeVar

from pydantic import TypeAdapter, ValidationError
from pydantic_core import to_json

from comparisons import cases, provenance
from comparisons.bench.measures import benchmark_scene, reference
from comparisons.bench.running import Session, contenders, refusal_text
from comparisons.bench.section import bench_section, pictures
from comparisons.choices import Choices
from comparisons.pairing import Solvers
from comparisons.present.columns import Plain, Section
from comparisons.present.offset import Compared
from comparisons.present.page import (
    Chapter,
    light,
    put_case,
    put_page,
    put_section,
    report_page,
)
from comparisons.store import Run, digest
from comparisons.studies import table1
from comparisons.studies.convergence import convergence_section
from comparisons.writing import write
from cprbm_scene import Question, Scene, SceneError

T = TypeVar("T")

SIZES = (10, 20, 40, 80, 160)
"""N of the run times."""

REPEAT = 3
AT_MOST = 4.0
"""Seconds after which a size is not repeated and no larger size begins."""

_CHAPTER, _TABLE = "chapter.json", "table1-section.json"


@dataclass(frozen=True, slots=True)
class Report:
    """A report in a folder, which keeps the finished chapters; the page in the folder shows these chapters.

    Attributes:
        folder: of page and chapters.
        questions: in the order of the chapters.
        choices: of the comparison.
        sizes: N of the error against N; empty without this part.
        times: whether run times are measured.
        exact: whether the exact reference is asked; with None a rule decides.
        timed: solvers for run times, without kept answers.
        origin: the machine and the versions.
    """

    folder: Path
    questions: Sequence[Question]
    choices: Choices
    sizes: tuple[int, ...]
    times: bool
    exact: bool | None
    timed: Solvers
    origin: Mapping[str, str | int]

    @property
    def chapters(self) -> dict[str, Chapter]:
        """Kept chapters by name, in the order of the questions."""
        files = {each.name: (self.folder / each.name / _CHAPTER, self._key(each)) for each in self.questions}
        kept = {name: _record_of(file, Chapter, key) for name, (file, key) in files.items()}
        return {name: chapter for name, chapter in kept.items() if chapter is not None}

    @property
    def table(self) -> Section | None:
        """The paper's Table 1 beside our run times; None before the measurement, and in a report without the table."""
        return _record_of(self.folder / _TABLE, Section, self._table_key) if self._has_table else None

    def missing(self) -> list[Question]:
        """Questions without a kept chapter."""
        kept = self.chapters
        return [question for question in self.questions if question.name not in kept]

    def _key(self, question: Question) -> str:
        """Digest of the dependence of a chapter: a chapter with other choices or parts is written anew."""
        return digest(
            question.model_dump_json(exclude={"file"}), repr((self.choices, self.sizes, self.times, self.exact))
        )

    @property
    def _table_key(self) -> str:
        """Digest of the dependence of the table."""
        return digest(str(sorted(self.origin.items())))

    @property
    def _has_table(self) -> bool:
        """Whether run times are measured, and the questions include all cases of the paper's Table 1, as built in."""
        return self.times and all(cases.asked(name) in self.questions for name in {cell.case for cell in table1.CELLS})

    def further_sections(self, question: Question, run: Run) -> Iterator[Section]:
        """Error against N and run times of a question, or the refusals of a solver; run times come last.

        Args:
            question: a scene or an offset question.
            run: solvers with kept answers, and processes to share the runs.
        """
        if self.sizes:
            convergence = partial(convergence_section, question, self.sizes, self.choices, run.solvers, run.crew)
            yield _or_refusal("Error against N", convergence)
        if self.times and isinstance(question, Scene):
            yield _or_refusal("Run times", partial(_run_times, question, self.timed, run.solvers))

    def add(self, question: Question, compared: Compared, further: tuple[Section, ...]) -> None:
        """Write the chapter of a question, and the page with the chapter.

        Raises:
            OSError: the folder cannot be written to.
        """
        own, chapter = self.folder / question.name, put_case(self.folder, compared, further)
        chapter = replace(chapter, files=("scene.toml", *chapter.files))
        write(own / "scene.toml", chapter.scene)
        # the last of all files: with it all are there
        write(own / _CHAPTER, to_json((self._key(question), chapter)))
        self.put_page()

    def add_table(self) -> None:
        """Write the paper's Table 1 beside our run times, and the page.

        Raises:
            OSError: the folder cannot be written to.
        """
        if self._has_table and self.table is None:
            measured = table1.session(self.timed, self.origin, REPEAT, AT_MOST).after_all()
            section = replace(table1.result_of(measured), figures=table1.pictures(measured))
            put_section(self.folder, section)
            write(self.folder / _TABLE, to_json((self._table_key, light(section))))
        self.put_page()

    def put_page(self) -> None:
        """Write the page of all finished chapters, in the order of the questions.

        Raises:
            OSError: the folder cannot be written to.
        """
        page = report_page([*self.chapters.values()], [*filter(None, (self.table,))], self.origin)
        put_page(self.folder, page)

    def document(self) -> Plain:
        """JSON of all chapters: the JSON of ``compare``, with ``convergence`` and ``bench`` as far as known.

        Raises:
            OSError: a file of the folder cannot be read.
        """
        found = []
        for chapter in self.chapters.values():
            files = {name: self.folder / chapter.name / f"{name}.json" for name in ("convergence", "bench")}
            compared = self.folder / chapter.name / "comparison.json"
            case: Plain = json.loads(compared.read_text("utf-8"))["cases"][0]
            known = {name: file for name, file in files.items() if file.name in chapter.files}
            found.append(case | {name: json.loads(file.read_text("utf-8")) for name, file in known.items()})
        return {"machine": dict(self.origin), "cases": found}


def _or_refusal(heading: str, section: Callable[[], Section]) -> Section:
    """A section, or the cause for which a solver refuses it."""
    try:
        return section()
    except SceneError as error:
        return Section(heading, (f"A solver refuses the question: {refusal_text(error)}.",))


def _run_times(scene: Scene, timed: Solvers, knowing: Solvers) -> Section:
    """Run times at the last load by the processor's clock, since reports are made on machines with other work.

    Args:
        scene: the question.
        timed: solvers without kept answers.
        knowing: solvers for the reference of the errors, with kept answers.

    Raises:
        SceneError: every method refuses the question.
    """
    scene = benchmark_scene(scene)
    session = Session(
        scene,
        provenance.machine(),
        sizes=dict.fromkeys(contenders(timed, Choices(kinematics="bending")), SIZES),
        reference=reference(scene, knowing),
        repeat=REPEAT,
        at_most=AT_MOST,
        clock="cpu",
    )
    measured = session.after_all()
    return replace(bench_section(measured), figures=pictures(measured))


def _record_of(file: Path, kind: type[T], key: str) -> T | None:
    """The record of a file; None without a record of this key."""
    with suppress(FileNotFoundError, ValidationError):
        found, record = TypeAdapter(tuple[str, kind]).validate_json(file.read_bytes())  # type: ignore[valid-type]
        return record if found == key else None
    return None
