"""``cprbm optimise``: the parameters of a scene for a goal within limits."""

from __future__ import annotations

from pathlib import Path

import click

from comparisons.cli.completion import candidates
from comparisons.cli.many import in_si, solved_often
from comparisons.cli.options import choices_for, settings

NO_OPTIMUM, UNDECIDED = 1, 3


@click.command("optimise")
@click.argument("case", metavar="CASE|FILE.toml", shell_complete=candidates)
@click.option("--goal", required=True, type=click.Path(dir_okay=False, path_type=Path), metavar="FILE.toml",
              help="File with a [goal] and [[limits]] on probes.")  # fmt: skip
@click.option("--vary", multiple=True, metavar="NAME=FIRST..LAST",
              help="Range of a parameter; otherwise the ranges of the scene's parameters.")  # fmt: skip
@click.option("--starts", type=click.IntRange(1, 64), default=4, show_default=True, metavar="K",
              help="Number of starts: the values of the file, and Sobol points.")  # fmt: skip
@click.option("--solves", type=click.IntRange(10, 10_000), default=200, show_default=True, metavar="K",
              help="Largest number of solves per start.")  # fmt: skip
@solved_often
@click.pass_obj
def command(
    planted: object,
    case: str,
    goal: Path,
    vary: tuple[str, ...],
    starts: int,
    solves: int,
    place: str,
    at_most: float,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
    out: Path | None,
) -> int:
    """Search the parameters of a scene for a goal within limits.

    The CPRBM solves all points. The best point is solved at twice the links and by both solvers, and is called an
    optimum only if the solvers agree. A search that was stopped goes on with the same command.
    """
    from comparisons.cases import opened
    from comparisons.cli import output
    from comparisons.optimum.problem import problem_of
    from comparisons.optimum.result import optimum, result_of
    from comparisons.optimum.search import PointSolver, search
    from comparisons.pairing import solvers_of
    from comparisons.present.page import Page, put_page, put_section
    from comparisons.sweeps.points import axis_of
    from comparisons.sweeps.running import JOURNAL, known_outcomes
    from comparisons.sweeps.workers import workers_on

    scene = opened(case, settings())
    axes = [axis_of(text, in_si(case)) for text in vary]
    problem = problem_of(scene, axes, goal)
    choices = choices_for(scene)
    out = Path(f"optimise-{scene.name}") if out is None else out
    with workers_on(place) as workers, output.counted(starts * solves, shown=not quiet) as moved:
        output.room_for(None, out)
        known = known_outcomes([out])
        solver = PointSolver(problem, workers, choices, solvers_of(planted), at_most, out / JOURNAL, known, moved)
        found = optimum(problem, search(problem, solver, starts, solves), solver)
    result = result_of(found)
    put_section(out, result)
    put_page(out, Page(result.heading, scene.title, further=(result,)))
    for sentence in result.sentences:
        click.echo(sentence)
    if not quiet:
        output.tables(result.tables)
        click.echo(f"numbers: {out / 'optimum.json'}; page: {out / 'index.html'}")
    if not found.doubt:
        return 0
    return UNDECIDED if found.compared.verdict == "UNDECIDED" else NO_OPTIMUM
