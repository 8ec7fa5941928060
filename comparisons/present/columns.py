"""Records of a presentation: columns and tables of texts, figures, and sections of a page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Generic, TypeVar

from comparisons.plain import Plain
from comparisons.writing import write

T = TypeVar("T")

NOTHING = "–"
"""Text of a missing value."""


@dataclass(frozen=True)  # slots refuse the alias that Column[T](...) notes
class Column(Generic[T]):
    """Column of a table, of a CSV file or of JSON records.

    Attributes:
        header: heading of the column, or key of the record.
        value: value for an item; None without a value.
        text: text of a value on the screen and on a page.
    """

    header: str
    value: Callable[[T], Any]
    text: Callable[[Any], str] = str

    def cell(self, item: T) -> str:
        """Text for an item."""
        value = self.value(item)
        return NOTHING if value is None else self.text(value)


@dataclass(frozen=True, slots=True)
class Table:
    """Table of texts: ``rows`` have as many cells as ``headers``; ``note`` explains the columns.

    The first cells of a ``linked`` table are names of chapters of the same page.
    """

    title: str
    headers: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""
    linked: bool = False


def table_of(title: str, columns: Sequence[Column[T]], items: Iterable[T], note: str = "") -> Table:
    """Table with a row for every item, without columns that have no value in any row."""
    rows = tuple(tuple(column.cell(item) for column in columns) for item in items)
    return without_empty(Table(title, tuple(column.header for column in columns), rows, note))


def without_empty(table: Table) -> Table:
    """The table without columns that have no value in any row; the first column stays."""
    kept = [
        place
        for place in range(len(table.headers))
        if place == 0 or any(row[place] not in ("", NOTHING) for row in table.rows)
    ]
    headers, *rows = (tuple(row[place] for place in kept) for row in (table.headers, *table.rows))
    return replace(table, headers=headers, rows=tuple(rows))


def records_of(columns: Sequence[Column[T]], items: Iterable[T]) -> list[Plain]:
    """Record of every item: values by header."""
    return [{column.header: column.value(item) for column in columns} for item in items]


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure: its name, a caption, and the drawing in two formats."""

    name: str
    caption: str
    svg: bytes = field(repr=False)
    png: bytes = field(repr=False)

    def _repr_svg_(self) -> str:
        """The figure in a notebook."""
        return self.svg.decode()

    def save(self, path: Path) -> None:
        """Write the figure to a file with the ending ``.svg`` or ``.png``.

        Raises:
            ValueError: the path ends otherwise.
            OSError: the file cannot be written.
        """
        content = {".svg": self.svg, ".png": self.png}.get(path.suffix.lower())
        if content is None:
            raise ValueError(f"found the file name {path.name!r}; allowed: a name that ends in .svg or .png")
        write(path, content)


@dataclass(frozen=True, slots=True)
class Section:
    """Part of a page, or the result of a study.

    Attributes:
        heading: heading of the section.
        sentences: paragraphs; figures, tables: below the paragraphs.
        name: name of the JSON file with the data; empty for parts of a larger document.
        data: documented JSON.
        complete: False if a run of the section ended early.
    """

    heading: str
    sentences: tuple[str, ...] = ()
    figures: tuple[Figure, ...] = ()
    tables: tuple[Table, ...] = ()
    name: str = ""
    data: Mapping[str, Any] = field(default_factory=dict)
    complete: bool = True

    @property
    def empty(self) -> bool:
        """Whether the section has no content."""
        return not (self.sentences or self.figures or self.tables)
