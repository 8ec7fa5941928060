"""The report: one folder with one page, which needs no network and is rewritten after every finished case.

In the folder: ``index.html``; and per case ``comparison.json`` (as documented for ``compare --json``),
``answers.json.gz`` (all answers, compressed) and the figures as SVG and PNG.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from comparisons import documents, figures, offset_drawn, offset_pages, paths_drawn, reactions_drawn, sheets
from comparisons.case import Comparison, Verdict
from comparisons.offset_verdict import OffsetComparison
from comparisons.rendering import Embedded, embedded, rendered
from comparisons.sheet import Sheet
from comparisons.store import packed_json
from comparisons.writing import write
from cprbm_scene import Question

_DRAWN = (figures, paths_drawn, reactions_drawn)
"""The modules that draw a comparison, in the order of the page."""


@dataclass(frozen=True, slots=True)
class Chapter:
    """What the page shows of one case; ``because`` is what decided, ``sentence`` all that the verdict says."""

    name: str
    title: str
    source: str
    word: str
    because: str
    sentence: str
    sheets: tuple[Sheet, ...]
    explanation: tuple[str, ...]
    pictures: tuple[Embedded, ...]
    files: tuple[str, ...]


def added(folder: Path, compared: Comparison | OffsetComparison) -> Chapter:
    """Write a finished case's files into a report.

    Args:
        folder: the report's folder; it is made where it is missing.
        compared: the case.

    Returns:
        Its chapter of the page.

    Raises:
        OSError: the folder cannot be written to.
    """
    pictures = drawn(compared)
    put_files(folder, compared, pictures)
    return offset_chapter(compared, pictures) if isinstance(compared, OffsetComparison) else chapter(compared, pictures)


def drawn(compared: Comparison | OffsetComparison) -> tuple[figures.Picture, ...]:
    """All figures of a case."""
    if isinstance(compared, OffsetComparison):
        return offset_drawn.of_comparison(compared)
    return tuple(picture for module in _DRAWN for picture in module.of_comparison(compared))


def put_files(folder: Path, compared: Comparison | OffsetComparison, pictures: tuple[figures.Picture, ...]) -> None:
    """Write a finished case's numbers and figures into its folder in a report.

    Raises:
        OSError: the folder cannot be written to.
    """
    if isinstance(compared, OffsetComparison):
        own = folder / compared.question.name
        write(own / "comparison.json", documents.text({"cases": [offset_pages.document(compared)]}))
    else:
        own = folder / compared.scene.name
        _archive(own, compared)
    for picture in pictures:
        put_picture(own, picture)


def put_picture(folder: Path, picture: figures.Picture) -> None:
    """Write a figure into a folder.

    Raises:
        OSError: the folder cannot be written to.
    """
    write(folder / f"{picture.name}.svg", picture.svg)
    write(folder / f"{picture.name}.png", picture.png)


def put_page(folder: Path, chapters: tuple[Chapter, ...]) -> None:
    """Write the page of some chapters.

    Raises:
        OSError: the folder cannot be written to.
    """
    write(folder / "index.html", page(chapters))


def _archive(own: Path, compared: Comparison) -> None:
    runs = compared.runs
    beside = (("cprbm paper", runs.paper), ("cprbm perturbed", runs.perturbed), ("exact", runs.exact))
    answers = {**dict(runs.everything()), **{name: answer for name, answer in beside if answer is not None}}
    write(own / "answers.json.gz", packed_json(answers))
    write(own / "comparison.json", documents.text({"cases": [documents.comparison(compared)]}))


def page(chapters: tuple[Chapter, ...]) -> str:
    """The page as HTML."""
    return rendered("index.html", {"cases": chapters})


def chapter(compared: Comparison, pictures: tuple[figures.Picture, ...]) -> Chapter:
    """What the page shows of a case and its figures."""
    content = sheets.of_comparison(compared), sheets.explanation(compared)
    return _chapter(compared.scene, compared.verdict, *content, pictures, ("comparison.json", "answers.json.gz"))


def offset_chapter(compared: OffsetComparison, pictures: tuple[figures.Picture, ...]) -> Chapter:
    """What the page shows of an offset question and its figures."""
    tables = offset_pages.sheets_of(compared)
    return _chapter(compared.question, compared.verdict, tables, (), pictures, ("comparison.json",))


def _chapter(
    asked: Question,
    verdict: Verdict,
    tables: tuple[Sheet, ...],
    explanation: tuple[str, ...],
    pictures: tuple[figures.Picture, ...],
    files: tuple[str, ...],
) -> Chapter:
    return Chapter(
        name=asked.name,
        title=asked.title or asked.name,
        source=asked.source,
        word=verdict.word.value,
        because=verdict.because,
        sentence=verdict.sentence,
        sheets=tables,
        explanation=explanation,
        pictures=tuple(embedded(picture) for picture in pictures),
        files=files,
    )
