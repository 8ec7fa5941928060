"""The report: one folder with one page, which needs no network and is rewritten after every finished case.

In the folder: ``index.html``; and per case ``comparison.json`` (as documented for ``compare --json``),
``answers.json`` (every answer whole) and the figures as SVG and PNG.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from comparisons import archive, documents, figures, reactions_drawn, sheets
from comparisons.rendering import Embedded, embedded, rendered
from comparisons.verdict import Comparison
from comparisons.writing import write


@dataclass(frozen=True, slots=True)
class Chapter:
    """What the page shows of one case."""

    name: str
    title: str
    source: str
    word: str
    sentence: str
    sheets: tuple[sheets.Sheet, ...]
    explanation: tuple[str, ...]
    pictures: tuple[Embedded, ...]


def add(folder: Path, earlier: tuple[Chapter, ...], compared: Comparison) -> tuple[Chapter, ...]:
    """Write a finished case into a report.

    Args:
        folder: the report's folder; it is made where it is missing.
        earlier: the chapters that the page holds already.
        compared: the case.

    Returns:
        All chapters that the page holds now.

    Raises:
        OSError: the folder cannot be written to.
    """
    own = folder / compared.scene.name
    pictures = (*figures.of_comparison(compared), *reactions_drawn.of_comparison(compared))
    for picture in pictures:
        write(own / f"{picture.name}.svg", picture.svg)
        write(own / f"{picture.name}.png", picture.png)
    answers = {name: archive.packed(answer) for name, answer in compared.runs.everything()}
    for name, answer in (("cprbm paper", compared.runs.paper), ("cprbm nearby", compared.runs.nearby)):
        if answer is not None:
            answers[name] = archive.packed(answer)
    write(own / "answers.json", documents.text(answers))
    write(own / "comparison.json", documents.text({"cases": [documents.comparison(compared)]}))
    chapters = (*earlier, chapter(compared, pictures))
    write(folder / "index.html", page(chapters))
    return chapters


def page(chapters: tuple[Chapter, ...]) -> str:
    """The page as HTML."""
    return rendered("index.html", {"cases": chapters})


def chapter(compared: Comparison, pictures: tuple[figures.Picture, ...]) -> Chapter:
    """What the page shows of a case and its figures."""
    return Chapter(
        name=compared.scene.name,
        title=compared.scene.title or compared.scene.name,
        source=compared.scene.source,
        word=compared.verdict.word.value,
        sentence=compared.verdict.sentence,
        sheets=sheets.of_comparison(compared),
        explanation=sheets.explanation(compared),
        pictures=tuple(embedded(picture) for picture in pictures),
    )
