"""Values of the shared options of commands, and the output for these values: tables, sentences, JSON and progress.

There is no progress outside a terminal, with ``--verbose``, and with ``--quiet``.  A bar has no thread, so that the
program may still fork processes.
"""

import math
import os
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Self, TypeVar

import click

from comparisons import cases, logs, pairing
from comparisons.choices import Choices, check_counts
from comparisons.cli.errors import printable
from comparisons.present.columns import Plain, Section, Table
from comparisons.writing import text_of, write
from cprbm_scene import Question, Scene
from cprbm_scene.notes import notes

T = TypeVar("T")

_PLAIN_WIDTH = 140
"""Columns of tables outside a terminal."""


@dataclass(frozen=True, slots=True)
class Request:
    """Values of shared options; an option without a place in a command has the value here.

    Attributes:
        planted: solvers in place of the real solvers.
        choices: links, elements and variants.
        case: name or file of a single scene; arguments: of several questions.
        values: values of the scene's parameters by name.
        tol: wanted error, a share of the scale; None with stated numbers of links and elements.
        exact: whether the exact reference is asked; with None a rule decides.
        opinions: solvers of a comparison.
        json_file, csv_file, plot_file, out: output files and folder.
        quiet: whether tables and progress are left out.
        place: of the workers.
        at_most: time limit of a solve, s.
    """

    planted: object = None
    choices: Choices = field(default_factory=Choices)
    case: str = ""
    arguments: tuple[str, ...] = ()
    values: Mapping[str, str] = field(default_factory=dict)
    tol: float | None = None
    exact: bool | None = None
    opinions: tuple[str, ...] = ("cprbm", "fea")
    json_file: Path | None = None
    csv_file: Path | None = None
    plot_file: Path | None = None
    out: Path | None = None
    quiet: bool = False
    place: str = ""
    at_most: float = math.inf

    @property
    def prints(self) -> bool:
        """Whether standard output is for people: no JSON goes there."""
        return str(self.json_file) != "-"

    @property
    def solvers(self) -> pairing.Solvers:
        """The solvers of a comparison."""
        found = pairing.solvers_of(self.planted, exact=self.exact)
        return pairing.with_solid(found) if "solid" in self.opinions else found

    @property
    def processes(self) -> int:
        """Number of processes for the runs; planted solvers stay in this process."""
        return 1 if isinstance(self.planted, pairing.Solvers) else min(2, os.cpu_count() or 1)

    def scene(self) -> Scene:
        """The scene of a command for a single scene; notes on implausible numbers go to standard error.

        Raises:
            SceneError: the case does not exist, the file is no valid scene, or the choices do not fit the scene.
        """
        scene = cases.opened(self.case, self.values)
        self._check([scene])
        return scene

    def si(self, name: str, text: str) -> float:
        """Value of a parameter of the scene, SI, for a text such as ``1.9mm``.

        Raises:
            SceneError: an unknown parameter, a wrong unit or a wrong value.
        """
        return cases.opened(self.case, {**self.values, name: text}).parameters[name].value

    def questions(self) -> list[Question]:
        """Questions of the arguments, without repetition; notes on implausible numbers go to standard error.

        Raises:
            SceneError: a case does not exist, a file is no valid question, or the choices do not fit a scene.
            click.UsageError: two questions have the same name.
        """
        names = [name for text in self.arguments for name in (cases.names() if text == "all" else (text,))]
        questions = [cases.asked(name, self.values) for name in dict.fromkeys(names)]
        found = [question.name for question in questions]
        twice = sorted({name for name in found if found.count(name) > 1})
        if twice:
            raise click.UsageError(f"Several scenes have the name {', '.join(twice)}; allowed: a name for each scene.")
        self._check(questions)
        return questions

    def _check(self, questions: Sequence[Question]) -> None:
        """Write notes on implausible numbers to standard error, and check that the choices fit all scenes."""
        for scene in (question for question in questions if isinstance(question, Scene)):
            for note in notes(scene):
                click.echo(printable(f"Note: {scene.file}: {note}"), err=True)
            check_counts(self.choices, scene)

    def with_room(self, folder: str = "") -> Self:
        """The request with its folders made; without ``--out`` the report goes to ``folder``, or nowhere if empty.

        Raises:
            OSError: a folder cannot be created.
        """
        out = self.out or (Path(folder) if folder else None)
        files = (self.json_file, self.csv_file, self.plot_file)
        for needed in (*(file.parent for file in files if file and str(file) != "-"), *filter(None, (out,))):
            needed.mkdir(parents=True, exist_ok=True)
        return replace(self, out=out)


def screen_width() -> int:
    """Columns of the terminal, or of a file."""
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else _PLAIN_WIDTH


def print_tables(tables: Iterable[Table], most: int = 10_000) -> None:
    """Print tables with at most ``most`` columns; colours appear on a terminal only."""
    from comparisons.present.table import screen_text  # loads rich

    for table in tables:
        click.echo(screen_text(table, width=min(screen_width(), most)))


def print_section(section: Section) -> None:
    """Print the tables and sentences of a section."""
    print_tables(section.tables)
    for sentence in section.sentences:
        click.echo(sentence + "\n")


def write_json(file: Path | None, data: Plain, *, finished: bool = True) -> None:
    """Write JSON to a file, or to standard output if the file is ``-``; without a file nothing.

    Standard output gets ``finished`` data alone.

    Raises:
        OSError: the file cannot be written.
    """
    if file is not None and str(file) != "-":
        write(file, text_of(data))
    elif file is not None and finished:
        click.echo(text_of(data), nl=False)


def print_folder(request: Request, file: str = "index.html") -> None:
    """Print the place of the page, if a page was written and standard output is for people."""
    if request.out is not None and request.prints and not request.quiet:
        click.echo(f"report: {request.out / file}")


@dataclass(slots=True)
class Bar:
    """Progress of items, of which an item may have steps; no bar is drawn by default.

    Attributes:
        move: draws the bar at a number of finished items.
        clear: clears the line of the bar before other output.
        item: number of the present item; part: its finished part.
    """

    move: Callable[[float], None] = lambda done: None
    clear: Callable[[], None] = lambda: None
    item: int = 0
    part: float = 0.0

    def through(self, items: Sequence[T]) -> Iterator[T]:
        """The items in order; the bar moves with every item."""
        for number, item in enumerate(items):
            self.item, self.part = number, 0.0
            self.move(number)
            yield item

    def step(self, done: int, whole: int) -> None:
        """Move to the finished items and the finished part of the present item; the bar never goes back."""
        self.part = max(self.part, done / whole)
        self.move(self.item + self.part)


def _visible(*, shown: bool) -> bool:
    return shown and sys.stderr.isatty() and not logs.level()


@contextmanager
def bar(whole: int, *, shown: bool, loggers: tuple[str, ...] = (logs.RUNS,), noun: str = "") -> Iterator[Bar]:
    """Context with a bar for ``whole`` items and the remaining time, if ``shown``.

    Args:
        whole: number of items.
        shown: whether the user wants a bar.
        loggers: loggers whose steps move the bar during an item.
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
        task = progress.add_task("solving", total=whole)

        def move(done: float) -> None:
            progress.update(task, completed=done)
            item = f"{noun} {min(int(done) + 1, whole)} of {whole}" if noun else "solving"
            left = progress.tasks[task].time_remaining
            text = item if left is None else f"{item}, about {left:.0f} s left"
            progress.update(task, description=text, refresh=True)

        def clear() -> None:
            progress.console.control(Control(ControlType.CARRIAGE_RETURN, (ControlType.ERASE_IN_LINE, 2)))

        move(0)
        found = Bar(move, clear)
        with logs.steps_from(loggers, found.step):
            yield found
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
