"""``cprbm study relations``: violations of relations that hold for every scene."""

from __future__ import annotations

import click

from comparisons.cli.commands import SolvingCommand
from comparisons.cli.options import COUNT, OUTPUT, candidates, count, folder
from comparisons.cli.output import Request
from comparisons.cli.verdicts import take_steps
from comparisons.pairing import solvers_of
from comparisons.store import run_into
from tests.relations import study
from tests.relations.result import result_of


def compare_images(request: Request, scenes: tuple[str, ...]) -> int:
    """Compare scenes with their images; exit code 1 for a broken relation."""
    request = request.with_room()
    with run_into(request.out, solvers_of(request.planted)) as run:
        pieces = study.pieces(scenes, request.choices, run.solvers)
        found = take_steps(request, study.Relations(), pieces, study.with_piece, result_of)
    return 1 if found.broken else 0


command = SolvingCommand(
    "relations",
    callback=compare_images,
    params=[
        click.Argument(["scenes"], nargs=-1, metavar="[CASE]...", shell_complete=candidates),
        click.Option(["-n", "--links", "links"], callback=count, metavar=COUNT, default="20", show_default=True,
                     help="CPRBM links per beam: 20 for all beams, or beam1=30,beam2=40."),
        click.Option(["--elements"], callback=count, metavar=COUNT, default="20", show_default=True,
                     help="Finite elements per beam, in the same form."),
        *OUTPUT,
        folder(help="Folder for the page and the numbers."),
    ],
    help="Compare a scene with its moved, mirrored, reordered and scaled images.",
)  # fmt: skip
