"""Output of the commands: tables, sentences and JSON, and progress on a terminal at standard error.

There is no progress outside a terminal, with ``--verbose``, and with ``--quiet``.  A bar has no thread, so that the
program may still fork processes.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from logging import NOTSET
from pathlib import Path
from typing import TypeVar

import click

from comparisons import logs
from comparisons.cli.request import Request
from comparisons.present.columns import Plain, Section, Table
from comparisons.writing import text_of, write

T = TypeVar("T")

_PLAIN_WIDTH = 140
"""Columns of tables outside a terminal."""


def print_tables(tables: Iterable[Table], most: int = 10_000) -> None:
    """Print tables with at most ``most`` columns; colours appear on a terminal only."""
    from comparisons.present.table import screen_text  # loads rich

    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else _PLAIN_WIDTH
    for table in tables:
        click.echo(screen_text(table, width=min(width, most)))


def print_section(section: Section) -> None:
    """Print the tables and sentences of a section."""
    print_tables(section.tables)
    for sentence in section.sentences:
        click.echo(sentence + "\n")


def write_json(file: Path | None, data: Plain) -> None:
    """Write JSON to a file, or to standard output if the file is ``-``; without a file nothing.

    Raises:
        OSError: the file cannot be written.
    """
    if str(file) == "-":
        click.echo(text_of(data), nl=False)
    elif file is not None:
        write(file, text_of(data))


def print_folder(request: Request, file: str = "index.html") -> None:
    """Print the place of the page, if a page was written and standard output is for people."""
    if request.out is not None and request.prints and not request.quiet:
        click.echo(f"report: {request.out / file}")


@dataclass(slots=True)
class Rounds:
    """Progress of an item with rounds of steps; a round takes a ``share`` of the remaining part of the item.

    ``item`` is the item's number, ``left`` the remaining fraction after the last round, ``done`` the last step.
    """

    share: float = 1.0
    item: int = 0
    left: float = 1.0
    done: int = 0

    def begin(self, item: int) -> float:
        """The number of an item, which begins."""
        self.item, self.left, self.done = item, 1.0, 0
        return item

    def at(self, done: int, whole: int) -> float:
        """Number of finished items plus the finished part of the present item; the value never falls."""
        if done <= self.done:
            self.left *= 1.0 - self.share
        self.done = done
        return self.item + 1.0 - self.left * (1.0 - self.share * done / whole)


@dataclass(frozen=True, slots=True)
class Bar:
    """A bar: ``move`` to a number of finished items, ``clear`` the line before other output; no bar by default."""

    move: Callable[[float], None] = lambda done: None
    clear: Callable[[], None] = lambda: None
    rounds: Rounds = field(default_factory=Rounds)

    def through(self, items: Sequence[T]) -> Iterator[T]:
        """The items in order; the bar moves with every item."""
        for number, item in enumerate(items):
            self.move(self.rounds.begin(number))
            yield item


def _visible(*, shown: bool) -> bool:
    return shown and sys.stderr.isatty() and logs.level() == NOTSET


@contextmanager
def bar(
    whole: int, *, shown: bool, loggers: tuple[str, ...] = (logs.RUNS,), share: float = 1.0, noun: str = ""
) -> Iterator[Bar]:
    """Context with a bar for ``whole`` items and the remaining time, if ``shown``.

    Args:
        whole: number of items.
        shown: whether the user wants a bar.
        loggers: loggers whose steps move the bar during an item.
        share: part of the remaining item that a round of steps takes.
        noun: of an item, for "case 3 of 11"; empty without numbers.
    """
    if not _visible(shown=shown):
        yield Bar()
        return
    from rich.console import Console
    from rich.control import Control
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn
    from rich.segment import ControlType

    # standard output keeps its stream: a redirection would print at the place of the bar
    with Progress(
        *(TextColumn("{task.description}"), BarColumn(), TaskProgressColumn()),
        console=Console(stderr=True),
        transient=True,
        auto_refresh=False,
        redirect_stdout=False,
        redirect_stderr=False,
        speed_estimate_period=3600.0,
    ) as progress:
        task, rounds = progress.add_task("solving", total=whole), Rounds(share)

        def move(done: float) -> None:
            progress.update(task, completed=done)
            item = f"{noun} {min(int(done) + 1, whole)} of {whole}" if noun else "solving"
            left = progress.tasks[task].time_remaining
            text = item if left is None else f"{item}, about {left:.0f} s left"
            progress.update(task, description=text, refresh=True)

        def clear() -> None:
            progress.console.control(Control(ControlType.CARRIAGE_RETURN, (ControlType.ERASE_IN_LINE, 2)))

        move(0)
        with logs.steps_from(loggers, lambda done, steps: move(rounds.at(done, steps))):
            yield Bar(move, clear, rounds)
        clear()


@contextmanager
def status(*, shown: bool) -> Iterator[Callable[[str], None]]:
    """Context with a status line, if ``shown``; call the value with the text."""
    if not _visible(shown=shown):
        yield lambda text: None
        return
    from rich.console import Console

    with Console(stderr=True).status("solving") as line:
        yield line.update
