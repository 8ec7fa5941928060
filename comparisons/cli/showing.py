"""What the sub-commands write: tables, JSON and a bar that shows how far they are."""

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

from comparisons.documents import Plain, text
from comparisons.listening import RUNS, SOLVERS, heard_from, steps_of
from comparisons.sheet import Sheet

T = TypeVar("T")

_PLAIN_WIDTH = 140
"""Columns where there is no terminal to ask."""


def tables(sheets: Iterable[Sheet], most: int = 10_000) -> None:
    """Print tables, at most ``most`` columns wide; colours only reach a terminal."""
    from comparisons.tables import drawn

    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else _PLAIN_WIDTH
    for sheet in sheets:
        click.echo(drawn(sheet, width=min(width, most)))


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


class Steps(Generic[T]):
    """The items one after the other, with a bar on standard error if that is a terminal and the bar is wanted.

    Between one item and the next the bar goes on as those ``within`` it say how much of their own is done.  They may
    do so in several rounds, each from the beginning: a round takes ``share`` of what was left of the item.
    """

    def __init__(self, items: Sequence[T], within: tuple[str, ...], share: float, noun: str, *, shown: bool) -> None:
        self.items, self.within, self.share, self.noun, self.shown = items, within, share, noun, shown
        self._bar: Bar | None = None

    def __iter__(self) -> Iterator[T]:
        """The items; the bar is there until the last one is done with."""
        with _bar(len(self.items), self.noun, shown=self.shown) as bar:
            if bar is None:
                yield from self.items
                return
            self._bar = bar
            rounds = Rounds(self.share)
            with steps_of(self.within, lambda done, whole: bar.move(rounds.at(done, whole))):
                for item in self.items:
                    bar.move(rounds.next_item())
                    yield item

    def clear(self) -> None:
        """Take the bar away before something else is printed; its next move brings it back."""
        if self._bar is not None:
            self._bar.clear()


@dataclass(slots=True)
class Rounds:
    """How far an item is whose steps come in rounds, of which each takes a ``share`` of what is left of it.

    ``begun`` is the item's number, ``left`` the fraction of it that the round before has left, ``done`` the last step.
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
        """The items done, and the part of the one that is not, after a step of a round; never less than before."""
        if done <= self.done:
            self.left *= 1.0 - self.share
        self.done = done
        return self.begun + 1.0 - self.left * (1.0 - self.share * done / whole)


def progress(
    items: Sequence[T], *, shown: bool, within: tuple[str, ...] = (RUNS,), share: float = 1.0, noun: str = ""
) -> Steps[T]:
    """Some items as :class:`Steps`, of a comparison's runs, in one round, unless told otherwise.

    With a ``noun`` the bar says the number of the item: "case 3 of 11".
    """
    return Steps(items, within, share, noun, shown=shown)


@contextmanager
def stations(*, shown: bool) -> Iterator[None]:
    """While within, a bar on standard error, as of :class:`Steps`, of the stations that a solver reaches."""
    with _bar(1, shown=shown) as bar:
        if bar is None:
            yield
            return
        with steps_of(SOLVERS, lambda done, whole: bar.move(done / whole)):
            yield


@contextmanager
def counted(whole: int, *, shown: bool) -> Iterator[Callable[[int], None]]:
    """A bar on standard error, as of :class:`Steps`, that is told how many of a ``whole`` are done."""
    with _bar(whole, shown=shown) as bar:
        yield (lambda done: None) if bar is None else bar.move


@dataclass(frozen=True, slots=True)
class Bar:
    """A bar on a terminal: ``move`` it to how many are done, ``clear`` its line."""

    move: Callable[[float], None]
    clear: Callable[[], None]


@contextmanager
def _bar(whole: int, noun: str = "", *, shown: bool) -> Iterator[Bar | None]:
    """A bar of a ``whole``, with the time that remains; None where none is shown.

    None is where standard error is no terminal, where sentences are asked for in its place, and where none is wanted.
    It is drawn when it is told, by no thread of its own: who shows it may still start processes.
    """
    if not shown or not sys.stderr.isatty() or heard_from() != NOTSET:
        yield None
        return
    from rich.console import Console
    from rich.control import Control
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn
    from rich.segment import ControlType

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn())
    terminal = Console(stderr=True)
    # what goes to standard output stays there: redirected, it would go where the bar is
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
    """A line on standard error that says what is being done, if that is a terminal and the line is wanted."""
    if not shown or not sys.stderr.isatty() or heard_from() != NOTSET:
        yield lambda text: None
        return
    from rich.console import Console

    with Console(stderr=True).status("solving") as status:
        yield status.update
