"""The folder of a report: its chapters, kept as numbers and texts so that none is made twice, and the page of them.

A chapter hangs on its question, on what was wanted of it, and on the program.  One that is there and hangs on the same
is taken as it is, with the run times that were measured then.  So a report that was ended by force goes on with the
chapter that was not finished, and a further question is added to a report without solving the others again.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from comparisons import documents, report
from comparisons.bench import drawn as bench_drawn
from comparisons.bench import tables as bench_tables
from comparisons.converging.report import write_case as put_convergence
from comparisons.documents import Plain
from comparisons.rendering import rendered, script
from comparisons.reporting.chapters import Chapter, Found, Section, chapter, section_of
from comparisons.reporting.inlined import letters_of
from comparisons.sources import program
from comparisons.studies.result import StudyResult
from comparisons.writing import write
from cprbm_scene import Question

_CHAPTER = "chapter.json"
_TABLE = "table1-section.json"


@dataclass(frozen=True, slots=True)
class _Kept:
    """A chapter, and the digest of all that it hangs on."""

    key: str
    chapter: Chapter


def key(question: Question, wanted: str) -> str:
    """The digest of what a chapter hangs on; ``wanted`` says which parts, and how finely."""
    asked = (question.model_dump_json(exclude={"file"}), wanted, program())
    return sha256("\n".join(asked).encode()).hexdigest()


def kept(folder: Path, question: Question, wanted: str) -> Chapter | None:
    """A question's chapter, if the folder has it and all that it hangs on is the same."""
    with suppress(FileNotFoundError, ValidationError):
        found = TypeAdapter(_Kept).validate_json((folder / question.name / _CHAPTER).read_bytes())
        if found.key == key(question, wanted):
            return found.chapter
    return None


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
    write(own / _CHAPTER, TypeAdapter(_Kept).dump_json(_Kept(key(question, wanted), made)))
    return made


@dataclass(frozen=True, slots=True)
class _KeptTable:
    """Section of the paper's Table 1, with the digest of its sources."""

    key: str
    section: Section


def kept_table(folder: Path, made_on: Mapping[str, str | int]) -> Section | None:
    """The paper's Table 1 beside ours, if the folder has it and the program and the machine are the same."""
    with suppress(FileNotFoundError, ValidationError):
        found = TypeAdapter(_KeptTable).validate_json((folder / _TABLE).read_bytes())
        if found.key == _of_machine(made_on):
            return found.section
    return None


def added_table(folder: Path, result: StudyResult, made_on: Mapping[str, str | int]) -> Section:
    """Write the paper's Table 1 beside ours into a folder; its section of the page.

    Raises:
        OSError: the folder cannot be written to.
    """
    write(folder / "table1.json", documents.text(result.data))
    for picture in result.pictures:
        report.put_picture(folder, picture)
    made = section_of(result)
    write(folder / _TABLE, TypeAdapter(_KeptTable).dump_json(_KeptTable(_of_machine(made_on), made)))
    return made


def _of_machine(made_on: Mapping[str, str | int]) -> str:
    return sha256(f"{sorted(made_on.items())} {program()}".encode()).hexdigest()


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
