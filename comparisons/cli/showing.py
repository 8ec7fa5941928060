"""What the sub-commands write: tables, JSON and a bar that shows how far they are."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import click

from comparisons.documents import Plain, text
from comparisons.sheet import Sheet

T = TypeVar("T")

_PLAIN_WIDTH = 140
"""Columns where there is no terminal to ask."""


def tables(sheets: Iterable[Sheet]) -> None:
    """Print tables; colours only reach a terminal."""
    from comparisons.tables import drawn

    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else _PLAIN_WIDTH
    for sheet in sheets:
        click.echo(drawn(sheet, width=width))


def json(file: Path, data: Plain) -> None:
    """Write JSON to a file, or to standard output if the file is ``-``.

    Raises:
        OSError: the file cannot be written.
    """
    if str(file) == "-":
        click.echo(text(data), nl=False)
        return
    from comparisons.writing import write

    write(file, text(data))


def room_for(file: Path | None, out: Path | None = None) -> None:
    """See before anything is solved that JSON has a folder to go to, and a report its own.

    Raises:
        OSError: a folder cannot be made.
    """
    if file is not None and str(file) != "-":
        file.parent.mkdir(parents=True, exist_ok=True)
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)


def progress(items: Sequence[T], *, shown: bool) -> Iterator[T]:
    """The items, with a bar on standard error if that is a terminal and the bar is wanted."""
    if not shown or not sys.stderr.isatty():
        yield from items
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(items, "solving", console=Console(stderr=True), transient=True)


@contextmanager
def counted(whole: int, *, shown: bool) -> Iterator[Callable[[int], None]]:
    """A bar on standard error, as in :func:`progress`, that is told how many of a ``whole`` are done.

    It is drawn when it is told, by no thread of its own: who shows it may still start processes.
    """
    if not shown or not sys.stderr.isatty():
        yield lambda done: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("solving"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True, auto_refresh=False) as bar:
        task = bar.add_task("solving", total=whole)

        def tell(done: int) -> None:
            bar.update(task, completed=done, refresh=True)

        yield tell


@contextmanager
def current(*, shown: bool) -> Iterator[Callable[[str], None]]:
    """A line on standard error that says what is being done, if that is a terminal and the line is wanted."""
    if not shown or not sys.stderr.isatty():
        yield lambda text: None
        return
    from rich.console import Console

    with Console(stderr=True).status("solving") as status:
        yield status.update
