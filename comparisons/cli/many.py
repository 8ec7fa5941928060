"""``cprbm sweep``, ``tolerance`` and ``optimise``: a scene at many values of its parameters."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Literal

import click

from comparisons.cli import output
from comparisons.cli.errors import code_of
from comparisons.present.columns import Section
from comparisons.present.page import Page, put_page, put_section
from comparisons.sweeps import points as grids
from comparisons.sweeps.demands import Demands, bounds_of, read_demands
from comparisons.sweeps.optimum import optimum, optimum_section, problem_of
from comparisons.sweeps.running import Runner, Sweep, tasks_of
from comparisons.sweeps.scatter import distributions_of, scatter_section, study
from comparisons.sweeps.tables import write_netcdf, write_page, write_tables
from comparisons.sweeps.workers import workers_on
from cprbm_scene import Mistake, Scene
from cprbm_scene.mistakes import refuse_broken


def sweep(
    request: output.Request,
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
    tasks = tasks_of(scene, points, solver, grids.chosen_for_check(points, axes, check), request.choices, shard)
    with _runner(request, scene, "sweep", len(tasks)) as (out, runner):
        found = runner.run(Sweep(scene, axes, tasks), merge)
    write_tables(out, found)
    write_page(out, found)
    if netcdf:
        write_netcdf(out / "sweep.nc", found)
    click.echo(f"{scene.name}: {found.headline}.")
    if not request.quiet:
        for task, outcome in found.points():
            if not outcome.completed:
                click.echo(f"{grids.place_text(axes, task.point)}: {outcome.sentence}")
        click.echo(f"tables: {out / 'numbers.csv'}, {out / 'last.csv'}; page: {out / 'index.html'}")
    outcomes = [outcome for _, outcome in found.points()]
    return code_of(
        incomplete=any(not outcome.completed or outcome.verdict == "DIFFER" for outcome in outcomes),
        undecided=any(outcome.verdict == "UNDECIDED" for outcome in outcomes),
    )


def tolerance(
    request: output.Request, samples: int, sobol: bool, limits: Path | None, solver: Literal["cprbm", "fea"]  # noqa: FBT001
) -> int:  # fmt: skip
    """Solve a sample of a scene's parameters, and print quantiles and yield; exit code 1 if a point is missing."""
    scene = request.scene()
    bounds = bounds_of(scene, read_demands(limits) if limits else Demands(), str(limits))
    refuse_broken(
        limits
        and not bounds
        and Mistake("limits", "nothing", "[[limits]] with a probe, and least or most", str(limits))
    )
    found = study(scene, distributions_of(scene), samples, solver, request.choices, indexed=sobol, bounds=bounds)
    with _runner(request, scene, "tolerance", len(found.sweep.tasks)) as (out, runner):
        found = replace(found, sweep=runner.run(found.sweep))
    result = scatter_section(found)
    write_tables(out, found.sweep)
    _put(request, scene, out, result, f"{out / 'tolerance.json'}, {out / 'numbers.csv'}")
    return code_of(incomplete=not result.complete)


def optimise(request: output.Request, goal: Path, vary: tuple[str, ...], starts: int, solves: int) -> int:
    """Search the parameters of a scene for a goal; exit code 3 if the best point is undecided, 1 without an optimum."""
    scene = request.scene()
    problem = problem_of(scene, [grids.axis_of(text, request.si) for text in vary], goal)
    with _runner(request, scene, "optimise", starts * solves) as (out, runner):
        found = optimum(problem, runner, starts, solves)
    _put(request, scene, out, optimum_section(found), str(out / "optimum.json"))
    return code_of(incomplete=bool(found.doubt) and found.compared.verdict != "UNDECIDED", undecided=bool(found.doubt))


@contextmanager
def _runner(request: output.Request, scene: Scene, command: str, solves: int) -> Iterator[tuple[Path, Runner]]:
    """Context with the folder, and the solver of the points with a bar."""
    out = request.out or Path(f"{command}-{scene.name}")
    with workers_on(request.place) as workers, output.bar(solves, shown=not request.quiet, loggers=()) as progress:
        request.with_room(str(out))
        yield out, Runner(workers, request.choices, request.solvers, request.at_most, out, progress.move)


def _put(request: output.Request, scene: Scene, out: Path, result: Section, numbers: str) -> None:
    """Write and print the section of a study."""
    put_section(out, result)
    put_page(out, Page(result.heading, scene.title, further=(result,)))
    for sentence in result.sentences:
        click.echo(sentence)
    if not request.quiet:
        output.print_tables(result.tables)
        click.echo(f"numbers: {numbers}; page: {out / 'index.html'}")


def _points(
    request: output.Request, scene: Scene, vary: tuple[str, ...], sampled: str | None
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
