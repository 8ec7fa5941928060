"""The folder of a report: its chapters, kept as numbers and texts for later runs, and the page.

A chapter depends on its question, on the wanted parts, and on the program.  A kept chapter with the same dependence is
taken with its measured run times.  An interrupted report goes on with the unfinished chapter, and a further question is
added without solving the others again.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from pydantic import TypeAdapter, ValidationError
from pydantic_core import to_json

from comparisons.plain import Plain
from comparisons.present.columns import Section
from comparisons.present.page import Chapter, case_chapter, light, put_case, put_page, put_section, report_page
from comparisons.store import digest
from comparisons.studies.report import Content
from comparisons.writing import write
from cprbm_scene import Question

T = TypeVar("T")

_CHAPTER = "chapter.json"
_TABLE = "table1-section.json"


def _read_kept(file: Path, kind: type[T], key: str) -> T | None:
    """The record of a file; None without a record of this key."""
    with suppress(FileNotFoundError, ValidationError):
        found, record = TypeAdapter(tuple[str, kind]).validate_json(file.read_bytes())  # type: ignore[valid-type]
        return record if found == key else None
    return None


def _keep(file: Path, record: Chapter | Section, key: str) -> None:
    write(file, to_json((key, record)))


def _key(question: Question, wanted: str) -> str:
    """Digest of the dependence of a chapter; ``wanted`` names the parts and sizes."""
    return digest(question.model_dump_json(exclude={"file"}), wanted)


def _machine_key(made_on: Mapping[str, str | int]) -> str:
    return digest(str(sorted(made_on.items())))


def kept(folder: Path, question: Question, wanted: str) -> Chapter | None:
    """A question's kept chapter; None without a chapter of the same dependence."""
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
    _keep(own / _CHAPTER, chapter, _key(question, wanted))
    return chapter


def kept_table(folder: Path, made_on: Mapping[str, str | int]) -> Section | None:
    """The kept section of the paper's Table 1; None if the program or the machine is another."""
    return _read_kept(folder / _TABLE, Section, _machine_key(made_on))


def added_table(folder: Path, section: Section, made_on: Mapping[str, str | int]) -> Section:
    """Write the paper's Table 1 beside ours into a folder; the section of the page.

    Raises:
        OSError: the folder cannot be written to.
    """
    put_section(folder, section)
    shown = light(section)
    _keep(folder / _TABLE, shown, _machine_key(made_on))
    return shown


def put_report(
    folder: Path, chapters: Sequence[Chapter], further: Sequence[Section], made_on: Mapping[str, str | int]
) -> None:
    """Write the page.

    Raises:
        OSError: the folder cannot be written to.
    """
    put_page(folder, report_page(chapters, further, made_on))


def document(folder: Path, chapters: Sequence[Chapter], made_on: Mapping[str, str | int]) -> Plain:
    """The report's JSON: the JSON of ``compare`` for every case, with ``convergence`` and ``bench`` as far as known.

    Raises:
        OSError: a file of the folder cannot be read.
    """
    return {"machine": dict(made_on), "cases": [_case(folder / each.name, each) for each in chapters]}


def _case(own: Path, chapter: Chapter) -> Plain:
    found: Plain = _read(own / "comparison.json")["cases"][0]
    for name in ("convergence", "bench"):
        if f"{name}.json" in chapter.files:
            found[name] = _read(own / f"{name}.json")
    return found


def _read(path: Path) -> Plain:
    found: Plain = json.loads(path.read_text("utf-8"))
    return found
