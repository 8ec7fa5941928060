"""``cprbm solve``: one solver's answer to one scene."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from comparisons.choices import Kinematics
from comparisons.cli.options import numerical, one_of_both, output

if TYPE_CHECKING:
    from comparisons.tolerances.search import Tolerance

NOT_COMPLETED = 1
NOT_WITHIN = 3


@click.command("solve")
@click.argument("case", metavar="CASE|FILE.toml")
@click.option("--solver", type=click.Choice(["cprbm", "fea", "exact", "solid"]), default="cprbm", show_default=True)
@numerical
@output
@click.pass_obj
def command(
    planted: object,
    case: str,
    solver: Literal["cprbm", "fea", "exact", "solid"],
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
    from comparisons.pairing import exact_answer, solid_answer, solvers_of

    one_of_both(tol)
    solvers = solvers_of(planted)
    scene = cases.opened(case)
    choices = Choices(links, formulation, elements, kinematics, penetration, across)
    check(choices, scene)
    showing.room_for(json_file)
    found: tuple[Tolerance, ...] = ()
    if tol is not None and solver == "solid":
        raise click.UsageError("found --tol and --solver solid; allowed: --elements and --across for the solid.")
    if tol is not None and solver != "exact" and solver != "solid":
        from comparisons.tolerances import tolerated

        with showing.current(shown=not quiet) as say:
            answer, reached = tolerated.solved(scene, solver, choices, tol, solvers, say)
        found = (reached,)
    else:
        asked = {
            "cprbm": solvers.cprbm,
            "fea": solvers.fea,
            "exact": solvers.exact or exact_answer,
            "solid": solvers.solid or solid_answer,
        }[solver]
        with showing.stations(shown=not quiet):
            answer = asked(scene, choices)
    from comparisons.audit import audit

    checked = audit(scene, answer)
    if json_file is not None:
        from comparisons import documents

        showing.json(json_file, {"cases": [documents.solution(scene, answer, found, checked)]})
    if not quiet and str(json_file) != "-":
        from comparisons import sheets

        showing.tables(sheets.of_answer(scene, answer, found))
    if not answer.completed:
        click.echo(f"cprbm: {scene.name}: {answer.ending.value}. {answer.sentence}".rstrip(), err=True)
        return NOT_COMPLETED
    if checked.complaints:
        for complaint in checked.complaints:
            click.echo(f"cprbm: {scene.name}: the audit fails {complaint}", err=True)
        return NOT_WITHIN
    for reached in found:
        if not reached.met:
            click.echo(f"cprbm: {scene.name}: {reached.sentence}", err=True)
            return NOT_WITHIN
    return 0
