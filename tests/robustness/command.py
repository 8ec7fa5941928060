"""``cprbm robustness``: both solvers on random scenes, with an outcome per scene."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from comparisons.cli.options import folder, output_options, positive, whole

if TYPE_CHECKING:
    from tests.robustness.outcomes import Outcome
    from tests.robustness.running import Stress

NOT_FINISHED = 1
UNDECIDED = 3


@click.command("robustness")
@click.option("--scenes", callback=whole, metavar="K", default="40", show_default=True, help="Number of scenes.")
@click.option("--seed", type=click.IntRange(min=0), metavar="S", default=1, show_default=True,
              help="Seed of the scenes: a seed always draws the same list.")  # fmt: skip
@click.option("--at-most", callback=positive, metavar="SECONDS", default="60", show_default=True,
              help="Limit of processor seconds per scene.")  # fmt: skip
@click.option("--workers", type=click.IntRange(1, 256), metavar="N",
              help="Worker processes.  [default: a process per core, at most two]")  # fmt: skip
@click.option("--save", "also", multiple=True, type=click.Choice(["undecided", "ended", "refused"]),
              help="Save scenes with this outcome too, beside wrong, crashed and timed out.")  # fmt: skip
@click.option("--replay", type=click.Path(dir_okay=False, path_type=Path), metavar="FILE.toml",
              help="Judge a single scene.")  # fmt: skip
@output_options
@folder("Folder of outcomes and failing scenes; a run goes on from there.  [default: 'robustness-SEED']")
@click.pass_context
def command(
    ctx: click.Context,
    scenes: int,
    seed: int,
    at_most: float,
    workers: int | None,
    also: tuple[str, ...],
    replay: Path | None,
    json_file: Path | None,
    quiet: bool,
    out: Path | None,
) -> int:
    """Judge both solvers on random scenes.

    The question: is a certified answer ever wrong?
    """
    from comparisons.cases import opened
    from comparisons.cli import output
    from comparisons.pairing import solvers_of
    from tests.robustness import tables
    from tests.robustness.limited import Limits
    from tests.robustness.outcomes import Way
    from tests.robustness.running import Crew, Plan, Stress, replayed, run

    solvers = solvers_of(ctx.obj)
    plan = Plan(seed, limits=Limits(seconds=at_most))
    printing = str(json_file) != "-"
    if replay is not None:
        output.room_for(json_file)
        there = Stress(plan, {0: replayed(opened(str(replay)), solvers, plan)}, {})
        if json_file is not None:
            output.json(json_file, tables.document(there))
        if printing:
            click.echo(tables.text_of(there.outcomes[0]))
        return exit_code(there.outcomes.values())
    out = Path(f"{ctx.info_name}-{seed}") if out is None else out
    output.room_for(json_file, out)
    there = Stress(plan, {}, {})
    try:
        with output.counted(scenes, shown=not quiet) as count:
            for there in run(plan, scenes, out, [Way(way) for way in also], Crew(solvers, workers or _cores())):
                count(len(there.outcomes))
    finally:
        if there.outcomes:
            _show(there, json_file, out, quiet=quiet)
    return exit_code(there.outcomes.values())


def exit_code(outcomes: Iterable[Outcome]) -> int:
    """0 if all agree; 1 if any is wrong, crashed, was out of time or ended early; 3 if nothing is worse than undecided.

    A scene that is refused counts as undecided: a question was drawn that nobody answers.
    """
    from tests.robustness.outcomes import Way

    ways = {outcome.way for outcome in outcomes}
    if ways & {Way.WRONG, Way.CRASHED, Way.TIMED_OUT, Way.ENDED}:
        return NOT_FINISHED
    return UNDECIDED if ways & {Way.UNDECIDED, Way.REFUSED} else 0


def _cores() -> int:
    import os

    return min(2, os.cpu_count() or 1)


def _show(there: Stress, json_file: Path | None, out: Path, *, quiet: bool) -> None:
    """Write and print a run, or as much of it as there is."""
    from comparisons.cli import output
    from tests.robustness import tables

    if json_file is not None:
        output.json(json_file, tables.document(there))
    if str(json_file) == "-":
        return
    if not quiet:
        output.tables(tables.sheets_of(there))
    click.echo(tables.sentence(there))
    if there.saved and not quiet:
        click.echo(f"saved: {', '.join(str(out / file) for file in there.saved.values())}")
