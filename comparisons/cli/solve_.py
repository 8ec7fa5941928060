"""``cprbm solve``: one solver's answer to one scene."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import click

from comparisons.choices import Kinematics
from comparisons.cli.answering import SOLVERS, SolverName, answered, told
from comparisons.cli.completing import offered
from comparisons.cli.options import numerical, one_of_both, output, parameters, settings


@click.command("solve")
@click.argument("case", metavar="CASE|FILE.toml", shell_complete=offered)
@parameters
@click.option("--solver", type=click.Choice(SOLVERS), default="cprbm", show_default=True)
@numerical
@output
@click.pass_obj
def command(
    planted: object,
    case: str,
    solver: SolverName,
    links: int | Mapping[str, int],
    elements: int | Mapping[str, int],
    formulation: Literal["auto", "paper"],
    kinematics: Kinematics,
    penetration: float,
    across: int,
    tol: float | None,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
) -> int:
    """Answer one scene with one solver."""
    from comparisons import cases
    from comparisons.choices import Choices, check
    from comparisons.cli import showing

    one_of_both(tol)
    scene = cases.opened(case, settings())
    choices = Choices(links, formulation, elements, kinematics, penetration, across)
    check(choices, scene)
    showing.room_for(json_file)
    answer, found = answered(planted, scene, solver, choices, tol, shown=not quiet)
    from comparisons.audit import audit

    checked = audit(scene, answer)
    if json_file is not None:
        from comparisons import documents

        showing.json(json_file, {"cases": [documents.solution(scene, answer, found, checked)]})
    if not quiet and str(json_file) != "-":
        from comparisons import sheets

        showing.tables(sheets.of_answer(scene, answer, found))
    return told(scene, answer, found, checked.complaints)
