"""The folder of ``converge``: a page, rewritten after every finished case, and per case the numbers and the figure."""

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
class Told:
    """What there is to tell of one case; ``data`` is its documented JSON."""

    asked: Question
    sheets: tuple[Sheet, ...]
    sentences: tuple[str, ...]
    pictures: tuple[Picture, ...]
    data: Plain
    completed: bool


@dataclass(frozen=True, slots=True)
class Chapter:
    """What the page shows of one case."""

    name: str
    title: str
    source: str
    sentences: tuple[str, ...]
    sheets: tuple[Sheet, ...]
    pictures: tuple[Embedded, ...]


def added(folder: Path, told: Told) -> Chapter:
    """Write a finished case into the folder, which is made where it is missing; its chapter of the page.

    Raises:
        OSError: the folder cannot be written to.
    """
    written(folder, told)
    asked, pictures = told.asked, tuple(embedded(picture) for picture in told.pictures)
    return Chapter(asked.name, asked.title or asked.name, asked.source, told.sentences, told.sheets, pictures)


def written(folder: Path, told: Told) -> None:
    """Write a finished case's numbers and figures into its folder.

    Raises:
        OSError: the folder cannot be written to.
    """
    own = folder / told.asked.name
    write(own / "convergence.json", documents.text(told.data))
    for picture in told.pictures:
        write(own / f"{picture.name}.svg", picture.svg)
        write(own / f"{picture.name}.png", picture.png)


def put_page(folder: Path, chapters: tuple[Chapter, ...]) -> None:
    """Write the page of some chapters.

    Raises:
        OSError: the folder cannot be written to.
    """
    write(folder / "index.html", rendered("convergence.html", {"cases": chapters}))
