"""The folder of ``converge``: a page, written after every case, with numbers and figure of every case."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from comparisons import documents
from comparisons.documents import Plain
from comparisons.figures import Picture
from comparisons.rendering import Embedded, embedded, rendered
from comparisons.sheet import Sheet
from comparisons.writing import write
from cprbm_scene import Question


@dataclass(frozen=True, slots=True)
class ConvergenceResult:
    """Result of a case; ``data`` is the documented JSON."""

    asked: Question
    sheets: tuple[Sheet, ...]
    sentences: tuple[str, ...]
    pictures: tuple[Picture, ...]
    data: Plain
    completed: bool


@dataclass(frozen=True, slots=True)
class Chapter:
    """Section of the page for a case."""

    name: str
    title: str
    source: str
    sentences: tuple[str, ...]
    sheets: tuple[Sheet, ...]
    pictures: tuple[Embedded, ...]


def added(folder: Path, result: ConvergenceResult) -> Chapter:
    """Write a finished case into the folder; the chapter of the page.

    Raises:
        OSError: the folder is not writable.
    """
    write_case(folder, result)
    asked, pictures = result.asked, tuple(embedded(picture) for picture in result.pictures)
    return Chapter(asked.name, asked.title or asked.name, asked.source, result.sentences, result.sheets, pictures)


def write_case(folder: Path, result: ConvergenceResult) -> None:
    """Write numbers and figures of a case.

    Raises:
        OSError: the folder is not writable.
    """
    own = folder / result.asked.name
    write(own / "convergence.json", documents.text(result.data))
    for picture in result.pictures:
        write(own / f"{picture.name}.svg", picture.svg)
        write(own / f"{picture.name}.png", picture.png)


def put_page(folder: Path, chapters: tuple[Chapter, ...]) -> None:
    """Write the page of the chapters.

    Raises:
        OSError: the folder is not writable.
    """
    write(folder / "index.html", rendered("convergence.html", {"cases": chapters}))
