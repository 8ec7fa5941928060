"""The result of a study: numbers, sentences, tables and figures, with its files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from comparisons.documents import Plain, text
from comparisons.figures import Picture
from comparisons.rendering import embedded, rendered
from comparisons.sheet import Sheet
from comparisons.writing import write


@dataclass(frozen=True, slots=True)
class StudyResult:
    """The displayed result of a study; ``data`` is the documented JSON."""

    name: str
    title: str
    words: tuple[str, ...]
    sheets: tuple[Sheet, ...]
    pictures: tuple[Picture, ...]
    data: Plain


def write_result(folder: Path, result: StudyResult) -> None:
    """Write page, numbers and figures of a study into a folder.

    Raises:
        OSError: the folder is not writable.
    """
    for picture in result.pictures:
        write(folder / f"{picture.name}.svg", picture.svg)
        write(folder / f"{picture.name}.png", picture.png)
    write(folder / f"{result.name}.json", text(result.data))
    pictures = tuple(embedded(picture) for picture in result.pictures)
    write(folder / f"{result.name}.html", rendered("study.html", {"study": result, "pictures": pictures}))
