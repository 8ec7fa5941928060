"""``cprbm robustness``: both solvers on random scenes, with an outcome per scene."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import click

from comparisons.cases import opened
from comparisons.choices import KINEMATICS
from comparisons.cli.commands import SolvingCommand
from comparisons.cli.options import OUTPUT, folder, positive, whole
from comparisons.cli.output import Request, bar, print_tables, write_json
from comparisons.pairing import solvers_of
from tests.robustness import tables
from tests.robustness.judging import Effort
from tests.robustness.limited import Limits
from tests.robustness.outcomes import Outcome, Way
from tests.robustness.running import Crew, Plan, Stress, replayed, run

NOT_FINISHED = 1
UNDECIDED = 3


def judge(
    request: Request, scenes: int, seed: int, workers: int | None, also: tuple[str, ...], replay: Path | None
) -> int:
    """Judge both solvers on random scenes, or on a single scene; the exit code."""
    solvers = solvers_of(request.planted)
    first = replace(Effort().first, theory=request.choices.theory)
    plan = Plan(seed, Effort(first), Limits(seconds=request.at_most))
    if replay is not None:
        request.with_room()
        there = Stress(plan, {0: replayed(opened(str(replay)), solvers, plan)}, {})
        write_json(request.json_file, tables.document(there))
        if request.prints:
            click.echo(tables.text_of(there.outcomes[0]))
        return exit_code(there.outcomes.values())
    out = request.out or Path(f"{click.get_current_context().info_name}-{seed}")
    request.with_room(str(out))
    there = Stress(plan, {}, {})
    try:
        with bar(scenes, shown=not request.quiet, loggers=()) as progress:
            for there in run(plan, scenes, out, [Way(way) for way in also], Crew(solvers, workers or _cores())):
                progress.move(len(there.outcomes))
    finally:
        if there.outcomes:
            _show(there, request, out)
    return exit_code(there.outcomes.values())


def exit_code(outcomes: Iterable[Outcome]) -> int:
    """0 if all agree; 1 if any is wrong, crashed, was out of time or ended early; 3 if nothing is worse than undecided.

    A scene that is refused counts as undecided: a question was drawn that nobody answers.
    """
    ways = {outcome.way for outcome in outcomes}
    if ways & {Way.WRONG, Way.CRASHED, Way.TIMED_OUT, Way.ENDED}:
        return NOT_FINISHED
    return UNDECIDED if ways & {Way.UNDECIDED, Way.REFUSED} else 0


def _cores() -> int:
    return min(2, os.cpu_count() or 1)


def _show(there: Stress, request: Request, out: Path) -> None:
    """Write and print a run, or as much of it as there is."""
    write_json(request.json_file, tables.document(there))
    if not request.prints:
        return
    if not request.quiet:
        print_tables(tables.sheets_of(there))
    click.echo(tables.sentence(there))
    if there.saved and not request.quiet:
        click.echo(f"saved: {', '.join(str(out / file) for file in there.saved.values())}")


command = SolvingCommand(
    "robustness",
    callback=judge,
    params=[
        click.Option(["--scenes"], callback=whole, metavar="K", default="40", show_default=True,
                     help="Number of scenes."),
        click.Option(["--seed"], type=click.IntRange(min=0), metavar="S", default=1, show_default=True,
                     help="Seed of the scenes: a seed always draws the same list."),
        click.Option(["--at-most"], callback=positive, metavar="SECONDS", default="60", show_default=True,
                     help="Limit of processor seconds per scene."),
        click.Option(["--workers"], type=click.IntRange(1, 256), metavar="N",
                     help="Worker processes.  [default: a process per core, at most two]"),
        click.Option(["--save", "also"], multiple=True, type=click.Choice(["undecided", "ended", "refused"]),
                     help="Save scenes with this outcome too, beside wrong, crashed and timed out."),
        click.Option(["--replay"], type=click.Path(dir_okay=False, path_type=Path), metavar="FILE.toml",
                     help="Judge a single scene."),
        click.Option(["--theory"], type=click.Choice(KINEMATICS),
                     help="Beam theory of both solvers.  [default: the scene's, bending of drawn scenes]"),
        *OUTPUT,
        folder(help="Folder of outcomes and failing scenes; a run goes on from there.  [default: 'robustness-SEED']"),
    ],
    help="Judge both solvers on random scenes.\n\nThe question: is a certified answer ever wrong?",
)  # fmt: skip
