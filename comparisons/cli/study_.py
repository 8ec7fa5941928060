"""``cprbm study``: the longer questions, one sub-command each."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from comparisons.cli.commands import Commands
from comparisons.cli.options import folder, output, positive, whole

if TYPE_CHECKING:
    from comparisons.studies.told import Told


@click.group("study", cls=Commands, invoke_without_command=True)
@click.pass_context
def command(ctx: click.Context) -> None:
    """Answer one of the longer questions; without a name, say which there are."""
    if ctx.invoked_subcommand is None:
        for name, study in command.commands.items():
            click.echo(f"{name:<16} {study.get_short_help_str(100)}")


@command.command("materials")
@output
@folder("Folder for the page, the numbers and the figure.")
@click.pass_obj
def materials(
    planted: object,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
    out: Path | None,
) -> int:
    """ABS, titanium and steel at one deformation: what of the error a material can change."""
    from comparisons.cli import showing
    from comparisons.pairing import Solvers
    from comparisons.studies import materials as study
    from comparisons.studies.materials_told import told

    showing.room_for(json_file, out)
    solvers = planted if isinstance(planted, Solvers) else Solvers()
    found = study.Materials()
    try:
        for piece in showing.progress(study.pieces(), shown=not quiet):
            found = found.with_piece(piece(solvers))
    finally:
        _show(told(found), json_file, out, quiet=quiet)
    return 0 if all(tested.comparison.verdict.completed for tested in found.tested) else 1


@command.command("table1")
@click.option("--repeat", callback=whole, default="5", show_default=True, help="How often each cell is solved.")
@click.option(
    "--at-most",
    callback=positive,
    metavar="SECONDS",
    default="60",
    show_default=True,
    help="A solve that takes longer is not repeated.",
)
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
    from comparisons.pairing import Solvers
    from comparisons.studies import table1 as study
    from comparisons.studies.table1_told import told

    showing.room_for(json_file, out)
    solvers = planted if isinstance(planted, Solvers) else Solvers()
    found = study.begun(solvers, machine.described())
    try:
        for run in showing.progress(study.runs(repeat), shown=not quiet):
            found = study.solved(found, run, solvers, at_most)
    finally:
        _show(told(found), json_file, out, quiet=quiet)
    return 1 if found.unfinished else 0


def _show(told: Told, json_file: Path | None, out: Path | None, *, quiet: bool) -> None:
    """Write and print a study, or as much of it as there is."""
    from comparisons.cli import showing
    from comparisons.studies.told import written

    if json_file is not None:
        showing.json(json_file, told.data)
    if out is not None:
        written(out, told)
    if quiet or str(json_file) == "-":
        return
    showing.tables(told.sheets)
    for sentence in told.words:
        click.echo(sentence + "\n")
    if out is not None:
        click.echo(f"report: {out / told.name}.html")
