"""``cprbm sweep``, ``tolerance`` and ``optimise``: a scene at many values of its parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

import click

from comparisons.cli import bars, output
from comparisons.cli.errors import INCOMPLETE, UNDECIDED
from comparisons.cli.request import Request
from comparisons.optimum import problem as problems
from comparisons.optimum import result as optima
from comparisons.optimum.search import PointSolver, search
from comparisons.present.columns import Section
from comparisons.present.page import Page, put_page, put_section
from comparisons.scatter import study as scatters
from comparisons.scatter.draws import distributions_of
from comparisons.scatter.result import result_of
from comparisons.sweeps import points as grids
from comparisons.sweeps import running
from comparisons.sweeps.demands import Demands, bounds_of, read_demands
from comparisons.sweeps.netcdf import write_netcdf
from comparisons.sweeps.page import write_page
from comparisons.sweeps.tables import write_tables
from comparisons.sweeps.workers import Workers, workers_on
from cprbm_scene import Scene


def sweep(
    request: Request,
    vary: tuple[str, ...],
    sample: str | None,
    solver: Literal["cprbm", "fea", "compare"],
    check: int,
    shard: tuple[int, int],
    merge: tuple[Path, ...],
    netcdf: bool,  # noqa: FBT001 - click passes a keyword
) -> int:
    """Solve a scene at the points of a grid or a sample; the exit code.

    0 if all points completed and all checks agree; 1 for a failure or DIFFER; 3 for nothing worse than UNDECIDED.
    """
    scene = request.scene()
    axes, points = _points(request, scene, vary, sample)
    checked = grids.chosen_for_check(points, axes, check)
    tasks = running.tasks_of(scene, points, solver, checked, request.choices, shard)
    with _workers(request, scene, "sweep", len(tasks)) as (out, workers, moved):
        found = running.Sweep(scene, axes, tasks, running.known_outcomes([out, *merge]))
        found = running.run(found, workers, request.choices, request.solvers, request.at_most, out, moved)
    write_tables(out, found)
    write_page(out, found)
    if netcdf:
        write_netcdf(out / "sweep.nc", found)
    click.echo(f"{scene.name}: {found.headline}.")
    if not request.quiet:
        for task, outcome in found.points():
            if not outcome.completed:
                place = ", ".join(axis.text(task.point[axis.name]) for axis in axes)
                click.echo(f"{place}: {outcome.sentence}")
        click.echo(f"tables: {out / 'numbers.csv'}, {out / 'last.csv'}; page: {out / 'index.html'}")
    outcomes = [outcome for _, outcome in found.points()]
    if any(not outcome.completed or outcome.verdict == "DIFFER" for outcome in outcomes):
        return INCOMPLETE
    return UNDECIDED if any(outcome.verdict == "UNDECIDED" for outcome in outcomes) else 0


def tolerance(
    request: Request, samples: int, sobol: bool, limits: Path | None, solver: Literal["cprbm", "fea"]  # noqa: FBT001
) -> int:  # fmt: skip
    """Solve a sample of a scene's parameters, and print quantiles and yield; exit code 1 if a point is missing."""
    scene = request.scene()
    bounds = bounds_of(scene, read_demands(limits) if limits else Demands(), str(limits))
    distributions = distributions_of(scene)
    asked = scatters.study(scene, distributions, samples, solver, request.choices, indexed=sobol, bounds=bounds)
    with _workers(request, scene, "tolerance", len(asked.sweep.tasks)) as (out, workers, moved):
        found = scatters.solved(asked, workers, request.choices, request.solvers, request.at_most, out, moved)
    result = result_of(found)
    write_tables(out, found.sweep)
    _put(request, scene, out, result, f"{out / 'tolerance.json'}, {out / 'numbers.csv'}")
    return 0 if result.complete else INCOMPLETE


def optimise(request: Request, goal: Path, vary: tuple[str, ...], starts: int, solves: int) -> int:
    """Search the parameters of a scene for a goal; exit code 3 if the best point is undecided, 1 without an optimum."""
    scene = request.scene()
    problem = problems.problem_of(scene, [grids.axis_of(text, request.si) for text in vary], goal)
    with _workers(request, scene, "optimise", starts * solves) as (out, workers, moved):
        known, journal = running.known_outcomes([out]), out / running.JOURNAL
        settings = request.choices, request.solvers, request.at_most
        solver = PointSolver(problem, workers, *settings, journal, known, moved)
        found = optima.optimum(problem, search(problem, solver, starts, solves), solver)
    _put(request, scene, out, optima.result_of(found), str(out / "optimum.json"))
    if not found.doubt:
        return 0
    return UNDECIDED if found.compared.verdict == "UNDECIDED" else INCOMPLETE


@contextmanager
def _workers(
    request: Request, scene: Scene, command: str, solves: int
) -> Iterator[tuple[Path, Workers, Callable[[int], None]]]:
    """Context with the folder, workers, and a bar to be moved to a number of finished solves."""
    out = request.out or Path(f"{command}-{scene.name}")
    with workers_on(request.place) as workers, bars.bar(solves, shown=not request.quiet, loggers=()) as progress:
        request.with_room(str(out))
        yield out, workers, progress.move


def _put(request: Request, scene: Scene, out: Path, result: Section, numbers: str) -> None:
    """Write and print the section of a study."""
    put_section(out, result)
    put_page(out, Page(result.heading, scene.title, further=(result,)))
    for sentence in result.sentences:
        click.echo(sentence)
    if not request.quiet:
        output.print_tables(result.tables)
        click.echo(f"numbers: {numbers}; page: {out / 'index.html'}")


def _points(
    request: Request, scene: Scene, vary: tuple[str, ...], sampled: str | None
) -> tuple[tuple[grids.Axis, ...], tuple[grids.Point, ...]]:
    """Axes and points of the command line.

    Raises:
        click.UsageError: the command line has neither a range nor a sample.
    """
    axes = tuple(grids.axis_of(text, request.si) for text in vary)
    if sampled is None:
        if not axes:
            raise click.UsageError("found neither --vary nor --sample; allowed: --vary t=1.8mm..2.2mm:11, or a sample.")
        points = grids.grid(axes)
    elif sampled.endswith(".csv"):
        points = grids.read_points(Path(sampled), request.si)
        axes = grids.axes_of(points)
    else:
        axes = axes or grids.ranges_of(scene)
        points = grids.sample(sampled, axes)
    return grids.in_file_units(scene, axes), points
