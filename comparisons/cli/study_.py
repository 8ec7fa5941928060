"""``cprbm study``: the longer questions, one sub-command each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import click

from comparisons import workshop
from comparisons.cli.commands import Commands, ToolCommand
from comparisons.cli.options import folder, output, timed

if TYPE_CHECKING:
    from comparisons.studies.told import Told

Found = TypeVar("Found")
Step = TypeVar("Step")


class _Studies(Commands):
    """The studies, and in a checkout those that are developers' tools."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all studies."""
        return sorted([*self.commands, *(["relations"] if workshop.is_checkout() else [])])

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The study of a name."""
        return ToolCommand("study relations") if cmd_name == "relations" else super().get_command(ctx, cmd_name)


@click.group("study", cls=_Studies, invoke_without_command=True)
@click.pass_context
def command(ctx: click.Context) -> None:
    """Answer one of the longer questions; without a name, say which there are."""
    if ctx.invoked_subcommand is None:
        for name in command.list_commands(ctx):
            study = command.get_command(ctx, name)
            assert study is not None, "a study is listed"
            click.echo(f"{name:<16} {study.get_short_help_str(100)}")


@command.command("calibration")
@output
@folder("Folder for the page, the numbers and the figure.")
@click.pass_obj
def calibration(
    planted: object,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
    out: Path | None,
) -> int:
    """Stated uncertainties beside true errors, on every case of which an exact answer is known."""
    from comparisons.cli import showing
    from comparisons.pairing import crew_of, solvers_of, workers_for
    from comparisons.resuming import resumed
    from comparisons.studies import calibration as study
    from comparisons.studies.calibration_told import told
    from comparisons.verdict.words import Word

    showing.room_for(json_file, out)
    show = Shown(json_file, out, quiet)
    pieces = showing.progress(study.pieces(), shown=not quiet)
    with resumed(out, solvers_of(planted), ()) as whole, crew_of(workers_for(planted)) as crew:
        found = answered(
            study.Calibration(),
            pieces,
            lambda found, piece: study.with_piece(found, piece, whole.solvers, crew),
            told,
            show,
        )
    return 1 if any(trial.verdict.word is Word.DIFFER or not trial.verdict.completed for trial in found.trials) else 0


@command.command("table1")
@timed("How often each cell is solved.", "is not repeated.")
@output
@folder("Folder for the page, the numbers and the figure.")
@click.pass_obj
def table1(
    planted: object,
    repeat: int,
    at_most: float,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
    out: Path | None,
) -> int:
    """Run times of both solvers at the paper's discretisations, beside its Table 1."""
    from comparisons import machine
    from comparisons.cli import showing
    from comparisons.pairing import solvers_of
    from comparisons.studies import table1 as study
    from comparisons.studies.table1_told import told

    showing.room_for(json_file, out)
    solvers = solvers_of(planted)
    show = Shown(json_file, out, quiet)
    runs = showing.progress(study.runs(repeat), shown=not quiet)
    begun = study.begun(solvers, machine.described())
    found = answered(begun, runs, lambda found, run: study.solved(found, run, solvers, at_most), told, show)
    return 1 if found.unfinished else 0


@dataclass(frozen=True, slots=True)
class Shown:
    """Where a study goes, or as much of it as there is."""

    json_file: Path | None
    out: Path | None
    quiet: bool

    @property
    def writes(self) -> bool:
        """Whether it goes into files."""
        return self.out is not None or (self.json_file is not None and str(self.json_file) != "-")

    def write(self, told: Told) -> None:
        """Write the files.

        Raises:
            OSError: one cannot be written.
        """
        from comparisons.cli import showing
        from comparisons.studies.told import written

        if self.json_file is not None and str(self.json_file) != "-":
            showing.json(self.json_file, told.data)
        if self.out is not None:
            written(self.out, told)

    def show(self, told: Told) -> None:
        """Print what goes to standard output."""
        from comparisons.cli import showing

        if str(self.json_file) == "-":
            showing.json(Path("-"), told.data)
            return
        if self.quiet:
            return
        showing.tables(told.sheets)
        for sentence in told.words:
            click.echo(sentence + "\n")
        if self.out is not None:
            click.echo(f"report: {self.out / told.name}.html")


def answered(
    found: Found,
    steps: Iterable[Step],
    taken: Callable[[Found, Step], Found],
    told: Callable[[Found], Told],
    shown: Shown,
) -> Found:
    """A study step by step: what there is of it is written after each, and shown even where it is stopped."""
    last: Told | None = None
    try:
        for step in steps:
            found, last = taken(found, step), None
            if shown.writes:
                last = told(found)
                shown.write(last)
    finally:
        if last is None:
            last = told(found)
            shown.write(last)
        shown.show(last)
    return found
