"""``cprbm sweep``: a scene at many values of its parameters."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from comparisons.cli.completion import candidates
from comparisons.cli.many import in_si, solved_often
from comparisons.cli.options import choices_for, settings

if TYPE_CHECKING:
    from comparisons.sweeps.points import Axis, Point
    from comparisons.sweeps.running import Sweep
    from cprbm_scene import Scene

FAILED, UNDECIDED = 1, 3


def _shard(ctx: click.Context, param: click.Parameter, value: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,6})/(\d{1,6})", value)
    if found is None or not 1 <= int(found[1]) <= int(found[2]):
        raise click.BadParameter(f"found {value!r}; allowed: I/N with I from 1 to N, as 3/64")
    return int(found[1]), int(found[2])


@click.command("sweep")
@click.argument("case", metavar="CASE|FILE.toml", shell_complete=candidates)
@click.option("--vary", multiple=True, metavar="NAME=FIRST..LAST:COUNT",
              help="Range of a parameter, such as t=1.8mm..2.2mm:11; several make a grid. Without :COUNT the range of "
              "a sample.")  # fmt: skip
@click.option("--sample", metavar="sobol:K|lhs:K|FILE.csv",
              help="Points of a sample in place of a grid; without --vary in the ranges of the scene's parameters.",
              )  # fmt: skip
@click.option("--solver", type=click.Choice(["cprbm", "fea", "compare"]), default="cprbm", show_default=True,
              help="Solver of every point, or both with a verdict.")  # fmt: skip
@click.option("--check", type=click.IntRange(min=0), default=0, metavar="K",
              help="Compare both solvers at K points: corners, then a Sobol subset.")  # fmt: skip
@click.option("--shard", callback=_shard, default="1/1", metavar="I/N", show_default=True,
              help="Solve the points I, I + N, ... only.")  # fmt: skip
@click.option("--merge", multiple=True, type=click.Path(exists=True, file_okay=False, path_type=Path), metavar="DIR",
              help="Take over the outcomes of a folder, such as of a shard; may be repeated.")  # fmt: skip
@click.option("--netcdf", is_flag=True, help="Write sweep.nc too, through xarray.")
@solved_often
@click.pass_obj
def command(
    planted: object,
    case: str,
    vary: tuple[str, ...],
    sample: str | None,
    solver: Literal["cprbm", "fea", "compare"],
    check: int,
    place: str,
    shard: tuple[int, int],
    merge: tuple[Path, ...],
    netcdf: bool,  # noqa: FBT001 - click passes a keyword
    at_most: float,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
    out: Path | None,
) -> int:
    """Solve a scene at many values of its parameters.

    The folder has a table of all numbers, a table of the last stations, figures and a page. A sweep that was stopped
    goes on with the same command, and a larger grid takes over the points of a smaller grid.
    """
    from comparisons.cases import opened
    from comparisons.cli import output
    from comparisons.pairing import solvers_of
    from comparisons.sweeps.netcdf import write_netcdf
    from comparisons.sweeps.page import write_page
    from comparisons.sweeps.points import chosen_for_check
    from comparisons.sweeps.running import Sweep, known_outcomes, run, tasks_of
    from comparisons.sweeps.tables import write_tables
    from comparisons.sweeps.workers import workers_on

    scene = opened(case, settings())
    axes, points = _asked(scene, vary, sample, in_si(case))
    choices = choices_for(scene)
    tasks = tasks_of(scene, points, solver, chosen_for_check(points, axes, check), choices, shard)
    out = Path(f"sweep-{scene.name}") if out is None else out
    output.room_for(None, out)
    sweep = Sweep(scene, axes, tasks, known_outcomes([out, *merge]))
    with workers_on(place) as workers, output.counted(len(tasks), shown=not quiet) as moved:
        sweep = run(sweep, workers, choices, solvers_of(planted), at_most, out, moved)
    write_tables(out, sweep)
    write_page(out, sweep)
    if netcdf:
        write_netcdf(out / "sweep.nc", sweep)
    click.echo(f"{scene.name}: {sweep.headline}.")
    if not quiet:
        for task, outcome in sweep.points():
            if not outcome.completed:
                click.echo(f"{', '.join(axis.text(task.point[axis.name]) for axis in axes)}: {outcome.sentence}")
        click.echo(f"tables: {out / 'numbers.csv'}, {out / 'last.csv'}; page: {out / 'index.html'}")
    return exit_code(sweep)


def exit_code(sweep: Sweep) -> int:
    """0 if all points completed and all checks agree; 1 for a failure or DIFFER; 3 for nothing worse than UNDECIDED."""
    outcomes = [outcome for _, outcome in sweep.points()]
    if any(not outcome.completed or outcome.verdict == "DIFFER" for outcome in outcomes):
        return FAILED
    return UNDECIDED if any(outcome.verdict == "UNDECIDED" for outcome in outcomes) else 0


def _asked(
    scene: Scene, vary: tuple[str, ...], sampled: str | None, si: Callable[[str, str], float]
) -> tuple[tuple[Axis, ...], tuple[Point, ...]]:
    """Axes and points of the command line."""
    from comparisons.sweeps.points import axes_of, axis_of, grid, in_file_units, ranges_of, read_points, sample

    axes = tuple(axis_of(text, si) for text in vary)
    if sampled is None:
        if not axes:
            raise click.UsageError("found neither --vary nor --sample; allowed: --vary t=1.8mm..2.2mm:11, or a sample.")
        points = grid(axes)
    elif sampled.endswith(".csv"):
        points = read_points(Path(sampled), si)
        axes = axes_of(points)
    else:
        axes = axes or ranges_of(scene)
        points = sample(sampled, axes)
    return in_file_units(scene, axes), points
