"""Records of a presentation: columns and tables of texts, plain data of JSON, figures, and sections of a page."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, Generic, TypeVar

from pydantic_core import to_jsonable_python

from comparisons.writing import write

T = TypeVar("T")

Plain = dict[str, Any]
"""Data in the types of JSON."""

NOTHING = "–"
"""Text of a missing value."""


@dataclass(frozen=True)  # slots refuse the alias that Column[T](...) notes
class Column(Generic[T]):
    """Column of a table, of a CSV file or of JSON records.

    Attributes:
        header: heading of the column, or key of the record.
        value: value for an item, or the path to the value (:func:`follow`); None without a value.
        text: text of a value on the screen and on a page.
    """

    header: str
    value: Callable[[T], Any] | str
    text: Callable[[Any], str] = str

    def of(self, item: T) -> Any:  # noqa: ANN401 - any value
        """Value for an item."""
        return follow(item, self.value) if isinstance(self.value, str) else self.value(item)

    def cell(self, item: T) -> str:
        """Text for an item."""
        value = self.of(item)
        return NOTHING if value is None else self.text(value)


def follow(item: Any, path: str) -> Any:  # noqa: ANN401 - any record
    """Value at the end of a path of attributes or keys, such as ``bounds.total``; None where an owner is None."""
    for name in path.split("."):
        item = item.get(name) if isinstance(item, Mapping) else getattr(item, name) if item is not None else None
    return item


def columns_of(text: Callable[[Any, Any], str | None], paths: Mapping[str, str]) -> list[Column[Any]]:
    """Columns of the same kind.

    Args:
        text: text of an item and the value at a path, called with values alone; None for no text.
        paths: paths to the values by header.
    """

    def cell(item: object, path: str) -> str | None:
        value = follow(item, path)
        return None if value is None else text(item, value)

    return [Column(header, partial(cell, path=path)) for header, path in paths.items()]


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
    return without_empty(
        Table(
            title,
            tuple(column.header for column in columns),
            rows=tuple(tuple(column.cell(item) for column in columns) for item in items),
            note=note,
        )
    )


def without_empty(table: Table) -> Table:
    """The table without columns that have no value in any row; the first column stays."""
    columns = [*zip(table.headers, *table.rows, strict=True)]
    kept = [column for place, column in enumerate(columns) if place == 0 or {*column[1:]} - {"", NOTHING}]
    headers, *rows = zip(*kept, strict=True)
    return replace(table, headers=headers, rows=tuple(rows))


def records_of(columns: Sequence[Column[T]], items: Iterable[T]) -> list[Plain]:
    """Record of every item: values by header."""
    return [{column.header: column.of(item) for column in columns} for item in items]


def plain(value: object) -> Any:  # noqa: ANN401 - all types of JSON
    """``value`` in the types of JSON; None for a number without a finite value."""
    return to_jsonable_python(value, inf_nan_mode="null", fallback=lambda array: array.tolist())


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
