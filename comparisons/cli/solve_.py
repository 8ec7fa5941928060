"""``cprbm solve``: one solver's answer to one scene."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import click

from comparisons.choices import Kinematics
from comparisons.cli.options import numerical, output

NOT_COMPLETED = 1


@click.command("solve")
@click.argument("case", metavar="CASE|FILE.toml")
@click.option("--solver", type=click.Choice(["cprbm", "fea", "exact"]), default="cprbm", show_default=True)
@numerical
@output
@click.pass_obj
def command(
    planted: object,
    case: str,
    solver: str,
    links: int | Mapping[str, int],
    elements: int | Mapping[str, int],
    formulation: Literal["auto", "paper"],
    kinematics: Kinematics,
    penetration: float,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
) -> int:
    """Answer one scene with one solver."""
    from comparisons import cases, documents, sheets
    from comparisons.choices import Choices, check
    from comparisons.cli import showing
    from comparisons.pairing import exact_answer, solvers_of

    solvers = solvers_of(planted)
    scene = cases.opened(case)
    choices = Choices(links, formulation, elements, kinematics, penetration)
    check(choices, scene)
    showing.room_for(json_file)
    asked = {"cprbm": solvers.cprbm, "fea": solvers.fea, "exact": solvers.exact or exact_answer}[solver]
    answer = asked(scene, choices)
    if json_file is not None:
        showing.json(json_file, {"cases": [documents.solution(scene, answer)]})
    if not quiet and str(json_file) != "-":
        showing.tables(sheets.of_answer(scene, answer))
    if not answer.completed:
        click.echo(f"cprbm: {scene.name}: {answer.ending.value}. {answer.sentence}".rstrip(), err=True)
        return NOT_COMPLETED
    return 0
