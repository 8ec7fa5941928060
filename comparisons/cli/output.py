"""Output of the sub-commands: tables, JSON and progress bars."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from logging import NOTSET
from pathlib import Path
from typing import Generic, TypeVar

import click

from comparisons import logs
from comparisons.logs import RUNS, SOLVERS, steps_from
from comparisons.plain import Plain, text_of
from comparisons.present.columns import Section, Table

T = TypeVar("T")

_PLAIN_WIDTH = 140
"""Columns of tables outside a terminal."""


def tables(found: Iterable[Table], most: int = 10_000) -> None:
    """Print tables with at most ``most`` columns; colours appear on a terminal only."""
    from comparisons.present.table import screen_text

    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else _PLAIN_WIDTH
    for table in found:
        click.echo(screen_text(table, width=min(width, most)))


def sections(found: Iterable[Section]) -> None:
    """Print the tables and sentences of sections."""
    for section in found:
        tables(section.tables)
        for sentence in section.sentences:
            click.echo(sentence + "\n")


def json(file: Path, data: Plain) -> None:
    """Write JSON to a file, or to standard output if the file is ``-``.

    Raises:
        OSError: the file cannot be written.
    """
    if str(file) == "-":
        click.echo(text_of(data), nl=False)
        return
    from comparisons.writing import write

    write(file, text_of(data))


def room_for(file: Path | None, out: Path | None = None) -> None:
    """Create the folders of JSON and report before any solve.

    Raises:
        OSError: a folder cannot be created.
    """
    if file is not None and str(file) != "-":
        file.parent.mkdir(parents=True, exist_ok=True)
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)


class Steps(Generic[T]):
    """Items in order, with a bar on standard error on a terminal, if ``shown``.

    During an item the loggers ``within`` move the bar by their own progress.  Several rounds are possible, every round
    from its beginning: a round takes ``share`` of the remaining part of the item.
    """

    def __init__(self, items: Sequence[T], within: tuple[str, ...], share: float, noun: str, *, shown: bool) -> None:
        self.items, self.within, self.share, self.noun, self.shown = items, within, share, noun, shown
        self._bar: Bar | None = None

    def __iter__(self) -> Iterator[T]:
        """The items; the bar stays until the end of the last item."""
        with _bar(len(self.items), self.noun, shown=self.shown) as bar:
            if bar is None:
                yield from self.items
                return
            self._bar = bar
            rounds = Rounds(self.share)
            with steps_from(self.within, lambda done, whole: bar.move(rounds.at(done, whole))):
                for item in self.items:
                    bar.move(rounds.next_item())
                    yield item

    def clear(self) -> None:
        """Erase the bar before other output; the next move draws the bar again."""
        if self._bar is not None:
            self._bar.clear()


@dataclass(slots=True)
class Rounds:
    """Progress of an item with rounds of steps; a round takes a ``share`` of the remaining part of the item.

    ``begun`` is the item's number, ``left`` the remaining fraction after the last round, ``done`` the last step.
    """

    share: float
    begun: int = -1
    left: float = 1.0
    done: int = 0

    def next_item(self) -> int:
        """The next item's number."""
        self.begun, self.left, self.done = self.begun + 1, 1.0, 0
        return self.begun

    def at(self, done: int, whole: int) -> float:
        """Number of finished items plus the finished part of the present item; the value never falls."""
        if done <= self.done:
            self.left *= 1.0 - self.share
        self.done = done
        return self.begun + 1.0 - self.left * (1.0 - self.share * done / whole)


def progress(
    items: Sequence[T], *, shown: bool, within: tuple[str, ...] = (RUNS,), share: float = 1.0, noun: str = ""
) -> Steps[T]:
    """Items as :class:`Steps`, by default with the runs of a comparison in a single round.

    With a ``noun`` the bar shows the number of the item: "case 3 of 11".
    """
    return Steps(items, within, share, noun, shown=shown)


@contextmanager
def stations(*, shown: bool) -> Iterator[None]:
    """Context with a bar on standard error, as in :class:`Steps`, for the stations of a solver."""
    with _bar(1, shown=shown) as bar:
        if bar is None:
            yield
            return
        with steps_from(SOLVERS, lambda done, whole: bar.move(done / whole)):
            yield


@contextmanager
def counted(whole: int, *, shown: bool) -> Iterator[Callable[[int], None]]:
    """Context with a bar on standard error, as in :class:`Steps`; call the value with the number of finished items."""
    with _bar(whole, shown=shown) as bar:
        yield (lambda done: None) if bar is None else bar.move


@dataclass(frozen=True, slots=True)
class Bar:
    """A bar on a terminal: ``move`` to a number of finished items, ``clear`` the line."""

    move: Callable[[float], None]
    clear: Callable[[], None]


@contextmanager
def _bar(whole: int, noun: str = "", *, shown: bool) -> Iterator[Bar | None]:
    """Context with a bar for ``whole`` items and the remaining time; None without a bar.

    There is no bar outside a terminal, with ``--verbose``, and with ``--quiet``.  The bar has no thread, so that the
    program may still fork processes.
    """
    if not shown or not sys.stderr.isatty() or logs.level() != NOTSET:
        yield None
        return
    from rich.console import Console
    from rich.control import Control
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn
    from rich.segment import ControlType

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn())
    terminal = Console(stderr=True)
    # standard output keeps its stream: a redirection would print at the place of the bar
    with Progress(
        *columns,
        console=terminal,
        transient=True,
        auto_refresh=False,
        redirect_stdout=False,
        redirect_stderr=False,
        speed_estimate_period=3600.0,
    ) as progress:
        task = progress.add_task("solving", total=whole)

        def move(done: float) -> None:
            progress.update(task, completed=done)
            item = f"{noun} {min(int(done) + 1, whole)} of {whole}" if noun else "solving"
            left = progress.tasks[task].time_remaining
            progress.update(
                task, description=item if left is None else f"{item}, about {left:.0f} s left", refresh=True
            )

        def clear() -> None:
            terminal.control(Control(ControlType.CARRIAGE_RETURN, (ControlType.ERASE_IN_LINE, 2)))

        move(0)
        yield Bar(move, clear)
        clear()


@contextmanager
def current(*, shown: bool) -> Iterator[Callable[[str], None]]:
    """Context with a status line on standard error on a terminal, if ``shown``; call the value with the text."""
    if not shown or not sys.stderr.isatty() or logs.level() != NOTSET:
        yield lambda text: None
        return
    from rich.console import Console

    with Console(stderr=True).status("solving") as status:
        yield status.update
