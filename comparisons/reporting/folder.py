"""The folder of a report: its chapters, kept as numbers and texts so that none is made twice, and the page of them.

A chapter hangs on its question, on what was wanted of it, and on the program.  One that is there and hangs on the same
is taken as it is, with the run times that were measured then.  So a report that was ended by force goes on with the
chapter that was not finished, and a further question is added to a report without solving the others again.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from pydantic import TypeAdapter, ValidationError
from pydantic_core import to_json

from comparisons import documents, report
from comparisons.bench import drawn as bench_drawn
from comparisons.bench import tables as bench_tables
from comparisons.converging.report import write_case as put_convergence
from comparisons.documents import Plain
from comparisons.rendering import rendered, script
from comparisons.reporting.chapters import Chapter, Found, Section, chapter, section_of
from comparisons.reporting.inlined import letters_of
from comparisons.store import digest
from comparisons.studies.result import StudyResult
from comparisons.writing import write
from cprbm_scene import Question

T = TypeVar("T")

_CHAPTER = "chapter.json"
_TABLE = "table1-section.json"


def key(question: Question, wanted: str) -> str:
    """Digest of all that a chapter depends on; ``wanted`` states which parts, and how finely."""
    return digest(question.model_dump_json(exclude={"file"}), wanted)


def kept(folder: Path, question: Question, wanted: str) -> Chapter | None:
    """The chapter of a question, if the folder has the chapter and its key is the same."""
    return _read_kept(folder / question.name / _CHAPTER, Chapter, key(question, wanted))


def added(folder: Path, question: Question, wanted: str, found: Found) -> Chapter:
    """Write all that is known of a question into a folder, which is made where it is missing; its chapter.

    Raises:
        OSError: the folder cannot be written to.
    """
    own = folder / question.name
    report.put_files(folder, found.compared, found.pictures)
    if found.convergence is not None:
        put_convergence(folder, found.convergence)
    if found.benchmark is not None:
        write(own / "bench.json", documents.text(bench_tables.document(found.benchmark)))
        for picture in bench_drawn.pictures(found.benchmark):
            report.put_picture(own, picture)
    made = chapter(found)
    write(own / "scene.toml", made.scene)
    # the last of all files, for where it is, all are
    _keep(own / _CHAPTER, made, key(question, wanted))
    return made


def kept_table(folder: Path, made_on: Mapping[str, str | int]) -> Section | None:
    """The paper's Table 1 beside ours, if the folder has it and the program and the machine are the same."""
    return _read_kept(folder / _TABLE, Section, _of_machine(made_on))


def added_table(folder: Path, result: StudyResult, made_on: Mapping[str, str | int]) -> Section:
    """Write the paper's Table 1 beside ours into a folder; its section of the page.

    Raises:
        OSError: the folder cannot be written to.
    """
    write(folder / "table1.json", documents.text(result.data))
    for picture in result.pictures:
        report.put_picture(folder, picture)
    made = section_of(result)
    _keep(folder / _TABLE, made, _of_machine(made_on))
    return made


def _of_machine(made_on: Mapping[str, str | int]) -> str:
    return digest(str(sorted(made_on.items())))


def _read_kept(path: Path, kind: type[T], key: str) -> T | None:
    """The record in a file, if the key of the record is the same."""
    with suppress(FileNotFoundError, ValidationError):
        found, record = TypeAdapter(tuple[str, kind]).validate_json(path.read_bytes())  # type: ignore[valid-type]
        return record if found == key else None
    return None


def _keep(path: Path, record: Chapter | Section, key: str) -> None:
    write(path, to_json((key, record)))


def put_page(
    folder: Path, chapters: Sequence[Chapter], further: Sequence[Section], made_on: Mapping[str, str | int]
) -> None:
    """Write the page of some chapters.

    Args:
        folder: the report's.
        chapters: in the order of the page.
        further: what stands behind them, and is of no one question.
        made_on: the machine and the versions, as they are shown.

    Raises:
        OSError: the folder cannot be written to.
    """
    write(folder / "index.html", page(chapters, further, made_on))


def page(chapters: Sequence[Chapter], further: Sequence[Section], made_on: Mapping[str, str | int]) -> str:
    """The page of some chapters, and of further sections, as HTML."""
    words = [each.word for each in chapters]
    sections = (*(section for each in chapters for section in each.sections), *further)
    figures = (figure for section in sections for figure in section.figures)
    return rendered(
        "report.html",
        {
            "chapters": chapters,
            "tally": {word: words.count(word) for word in ("AGREE", "UNDECIDED", "DIFFER") if word in words},
            "further": further,
            "letters": letters_of(figures),
            "made_on": made_on,
            "script": script("report.js"),
        },
    )


def document(folder: Path, chapters: Sequence[Chapter], made_on: Mapping[str, str | int]) -> Plain:
    """The report's JSON: of every case what ``compare`` says, with ``convergence`` and ``bench`` as far as they are.

    Raises:
        OSError: a file of the folder cannot be read.
    """
    return {"machine": dict(made_on), "cases": [_case(folder / each.name, each) for each in chapters]}


def _case(own: Path, made: Chapter) -> Plain:
    found: Plain = _read(own / "comparison.json")["cases"][0]
    for name in ("convergence", "bench"):
        if f"{name}.json" in made.files:
            found[name] = _read(own / f"{name}.json")
    return found


def _read(path: Path) -> Plain:
    found: Plain = json.loads(path.read_text("utf-8"))
    return found
