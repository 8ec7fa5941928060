"""What is told of a study: its numbers, its words, its tables and its figures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from comparisons.documents import Plain, text
from comparisons.figures import Picture
from comparisons.rendering import embedded, rendered
from comparisons.sheet import Sheet
from comparisons.writing import write


@dataclass(frozen=True, slots=True)
class Told:
    """A study as it is shown; ``data`` is its documented JSON."""

    name: str
    title: str
    words: tuple[str, ...]
    sheets: tuple[Sheet, ...]
    pictures: tuple[Picture, ...]
    data: Plain


def written(folder: Path, told: Told) -> None:
    """Put a study's page, its numbers and its figures into a folder.

    Raises:
        OSError: the folder cannot be written to.
    """
    for picture in told.pictures:
        write(folder / f"{picture.name}.svg", picture.svg)
        write(folder / f"{picture.name}.png", picture.png)
    write(folder / f"{told.name}.json", text(told.data))
    pictures = tuple(embedded(picture) for picture in told.pictures)
    write(folder / f"{told.name}.html", rendered("study.html", {"study": told, "pictures": pictures}))
