"""``cprbm study relations``: by how much the solvers' answers break relations that hold for every scene."""

from __future__ import annotations

from pathlib import Path

import click

from comparisons.cli.completing import offered
from comparisons.cli.options import count, folder, output
from comparisons.cli.study_ import Shown, answered


@click.command("relations")
@click.argument("scenes", nargs=-1, metavar="[CASE]...", shell_complete=offered)
@click.option("-n", "links", callback=count, metavar="COUNT", default="20", show_default=True,
              help="CPRBM links per beam: one number or beam1=30,beam2=40.")  # fmt: skip
@click.option("--elements", callback=count, metavar="COUNT", default="20", show_default=True,
              help="Finite elements per beam, likewise.")  # fmt: skip
@output
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
    """What must not change an answer: place, mirror, order, direction, units, steps, company; action and reaction."""
    from comparisons.choices import Choices
    from comparisons.cli import showing
    from comparisons.pairing import solvers_of
    from comparisons.resuming import resumed
    from tests.relations import study
    from tests.relations.told import told

    showing.room_for(json_file, out)
    show = Shown(json_file, out, quiet)
    with resumed(out, solvers_of(planted), ()) as whole:
        asked = study.pieces(scenes, Choices(links=links, elements=elements), whole.solvers)
        found = answered(study.Relations(), showing.progress(asked, shown=not quiet), study.with_piece, told, show)
    return 1 if found.broken else 0
