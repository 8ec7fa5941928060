"""``cprbm solve``: the answer of a single solver to a scene."""

from __future__ import annotations

from pathlib import Path

import click

from comparisons.cli.answers import SOLVERS, SolverName, report_problems, solve_scene
from comparisons.cli.completion import candidates
from comparisons.cli.options import (
    choices_for,
    exports,
    numerical,
    output_options,
    parameters,
    refuse_sizes_with,
    settings,
)


@click.command("solve")
@click.argument("case", metavar="CASE|FILE.toml", shell_complete=candidates)
@parameters
@click.option("--solver", type=click.Choice(SOLVERS), default="cprbm", show_default=True,
              help="Solver of the scene.")  # fmt: skip
@numerical
@exports
@output_options
@click.pass_obj
def command(
    planted: object,
    case: str,
    solver: SolverName,
    tol: float | None,
    csv_file: Path | None,
    plot_file: Path | None,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
) -> int:
    """Solve a scene with a single solver and print all stations."""
    from comparisons import cases
    from comparisons.cli import output

    refuse_sizes_with(tol)
    scene = cases.opened(case, settings())
    choices = choices_for(scene)
    for file in (json_file, csv_file, plot_file):
        output.room_for(file)
    answer, found = solve_scene(planted, scene, solver, choices, tol, shown=not quiet)
    from comparisons.audit import audit
    from comparisons.writing import write

    checked = audit(scene, answer)
    if json_file is not None:
        from comparisons.present import json_document

        output.json(json_file, {"cases": [json_document.solution(scene, answer, found, checked)]})
    if csv_file is not None:
        from comparisons.present.csv_table import csv_of

        write(csv_file, csv_of(scene, answer))
    if plot_file is not None and answer.stations:
        from comparisons.present.figures import answer_figure

        answer_figure(scene, answer).save(plot_file)
    if not quiet and str(json_file) != "-":
        from comparisons.present.answer_tables import answer_tables

        output.tables(answer_tables(scene, answer, found))
    return report_problems(scene, answer, found, checked.complaints)
