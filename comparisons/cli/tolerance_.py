"""``cprbm tolerance``: the numbers of a scene whose parameters scatter within their tolerances."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import click

from comparisons.cli.completion import candidates
from comparisons.cli.many import solved_often
from comparisons.cli.options import choices_for, settings

INCOMPLETE = 1


def _power(ctx: click.Context, param: click.Parameter, value: int) -> int:
    if value & (value - 1):
        raise click.BadParameter(f"found {value}; allowed: a power of 2, as {1 << value.bit_length() - 1}")
    return value


@click.command("tolerance")
@click.argument("case", metavar="CASE|FILE.toml", shell_complete=candidates)
@click.option("--samples", type=click.IntRange(16, 65536), callback=_power, default=1024, show_default=True,
              metavar="N", help="Number of points in a sample, a power of 2.")  # fmt: skip
@click.option("--sobol", is_flag=True,
              help="First- and total-order Sobol indices too; N (d + 2) points for d parameters.")  # fmt: skip
@click.option("--limits", type=click.Path(dir_okay=False, path_type=Path), metavar="FILE.toml",
              help="File with [[limits]] on probes, for the yield.")  # fmt: skip
@click.option("--solver", type=click.Choice(["cprbm", "fea"]), default="cprbm", show_default=True,
              help="Solver of all points.")  # fmt: skip
@solved_often
@click.pass_obj
def command(
    planted: object,
    case: str,
    samples: int,
    sobol: bool,  # noqa: FBT001 - click passes a keyword
    limits: Path | None,
    solver: Literal["cprbm", "fea"],
    place: str,
    at_most: float,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
    out: Path | None,
) -> int:
    """Quantiles and yield of a scene whose parameters scatter.

    The parameters with a tolerance in the scene are independent: normal or uniform. The folder has the tables of a
    sweep, tolerance.json and a page. A study that was stopped goes on with the same command.
    """
    from comparisons.cases import opened
    from comparisons.cli import output
    from comparisons.pairing import solvers_of
    from comparisons.present.page import Page, put_page, put_section
    from comparisons.scatter.draws import distributions_of
    from comparisons.scatter.result import result_of
    from comparisons.scatter.study import solved, study
    from comparisons.sweeps.demands import Demands, bounds_of, read_demands
    from comparisons.sweeps.tables import write_tables
    from comparisons.sweeps.workers import workers_on

    scene = opened(case, settings())
    choices = choices_for(scene)
    bounds = bounds_of(scene, read_demands(limits) if limits else Demands(), str(limits))
    asked = study(scene, distributions_of(scene), samples, solver, choices, indexed=sobol, bounds=bounds)
    out = Path(f"tolerance-{scene.name}") if out is None else out
    with workers_on(place) as workers, output.counted(len(asked.sweep.tasks), shown=not quiet) as moved:
        output.room_for(None, out)
        scatter = solved(asked, workers, choices, solvers_of(planted), at_most, out, moved)
    result = result_of(scatter)
    write_tables(out, scatter.sweep)
    put_section(out, result)
    put_page(out, Page(result.heading, scene.title, further=(result,)))
    for sentence in result.sentences:
        click.echo(sentence)
    if not quiet:
        output.tables(result.tables)
        click.echo(f"numbers: {out / 'tolerance.json'}, {out / 'numbers.csv'}; page: {out / 'index.html'}")
    return 0 if result.complete else INCOMPLETE
