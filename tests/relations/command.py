"""``cprbm study relations``: violations of relations that hold for every scene."""

from __future__ import annotations

from pathlib import Path

import click

from comparisons.cli.completion import candidates
from comparisons.cli.options import COUNT, count, folder, output_options
from comparisons.cli.section_output import SectionOutput, run_steps


@click.command("relations")
@click.argument("scenes", nargs=-1, metavar="[CASE]...", shell_complete=candidates)
@click.option("-n", "--links", "links", callback=count, metavar=COUNT, default="20", show_default=True,
              help="CPRBM links per beam: 20 for all beams, or beam1=30,beam2=40.")  # fmt: skip
@click.option("--elements", callback=count, metavar=COUNT, default="20", show_default=True,
              help="Finite elements per beam, in the same form.")  # fmt: skip
@output_options
@folder("Folder for the page and the numbers.")
@click.pass_obj
def command(
    planted: object,
    scenes: tuple[str, ...],
    links: int | dict[str, int],
    elements: int | dict[str, int],
    json_file: Path | None,
    quiet: bool,
    out: Path | None,
) -> int:
    """Compare a scene with its moved, mirrored, reordered and scaled images."""
    from comparisons.choices import Choices
    from comparisons.cli import output
    from comparisons.pairing import solvers_of
    from comparisons.store import run_into
    from tests.relations import study
    from tests.relations.result import result_of

    output.room_for(json_file, out)
    show = SectionOutput(json_file, out, quiet)
    with run_into(out, solvers_of(planted)) as run:
        asked = study.pieces(scenes, Choices(links=links, elements=elements), run.solvers)
        found = run_steps(study.Relations(), output.progress(asked, shown=not quiet), study.with_piece, result_of, show)
    return 1 if found.broken else 0
