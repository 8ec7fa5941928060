"""``cprbm study``: long studies as sub-commands."""

from __future__ import annotations

from pathlib import Path

import click

from comparisons import workshop
from comparisons.cli.commands import Commands, ToolCommand
from comparisons.cli.options import folder, output_options, timed
from comparisons.cli.section_output import SectionOutput, run_steps


class _Studies(Commands):
    """The studies; the developers' tools belong to a checkout."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all studies."""
        return sorted([*self.commands, *(["relations"] if workshop.is_checkout() else [])])

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The study with a name, or None."""
        return ToolCommand("study relations") if cmd_name == "relations" else super().get_command(ctx, cmd_name)


@click.group("study", cls=_Studies, invoke_without_command=True)
@click.pass_context
def command(ctx: click.Context) -> None:
    """Run a long study; without a name, list the studies."""
    if ctx.invoked_subcommand is None:
        for name in command.list_commands(ctx):
            study = command.get_command(ctx, name)
            assert study is not None, "a study is listed"
            click.echo(f"{name:<16} {study.get_short_help_str(100)}")


@command.command("calibration")
@output_options
@folder("Folder for page, numbers and figure.")
@click.pass_obj
def calibration(
    planted: object,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
    out: Path | None,
) -> int:
    """Compare stated and true errors on every case with an exact answer."""
    from comparisons.cli import output
    from comparisons.pairing import solvers_of, workers_for
    from comparisons.store import run_into
    from comparisons.studies import calibration as study
    from comparisons.verdict.words import Word

    output.room_for(json_file, out)
    show = SectionOutput(json_file, out, quiet)
    pieces = output.progress(study.pieces(), shown=not quiet)
    with run_into(out, solvers_of(planted), processes=workers_for(planted)) as run:
        found = run_steps(
            study.Calibration(),
            pieces,
            lambda found, scene: study.with_case(found, scene, run.solvers, run.crew),
            study.result_of,
            show,
        )
    return 1 if any(trial.verdict.word is Word.DIFFER or not trial.verdict.completed for trial in found.trials) else 0


@command.command("table1")
@timed("Repetitions of every cell of the table.", "is not repeated.")
@output_options
@folder("Folder for page, numbers and figure.")
@click.pass_obj
def table1(
    planted: object,
    repeat: int,
    at_most: float,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
    out: Path | None,
) -> int:
    """Time both solvers at the paper's discretisations, beside the paper's Table 1."""
    from comparisons import provenance
    from comparisons.bench.running import Session
    from comparisons.cli import output
    from comparisons.pairing import solvers_of
    from comparisons.studies import table1 as study

    output.room_for(json_file, out)
    session = study.session(solvers_of(planted), provenance.machine(), repeat, at_most)
    jobs = output.progress(session.jobs(), shown=not quiet)
    run_steps(session, jobs, Session.do, study.result_of, SectionOutput(json_file, out, quiet))
    return 0 if study.result_of(session).complete else 1
