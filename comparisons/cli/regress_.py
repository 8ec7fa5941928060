"""``cprbm regress``: the regression files, and the only way to change them."""

from __future__ import annotations

from datetime import date
from pathlib import Path

import click

from comparisons.cli.completing import offered
from comparisons.cli.options import verbose

DEPARTED = 1


@click.command("regress")
@click.argument("asked", metavar="CASE|all", shell_complete=offered)
@click.option("--accept", "reason", metavar="REASON", help="Make today's numbers the file's own, and say why.")
@click.option("--date", "day", metavar="YYYY-MM-DD", help="The date of the reason; needed with --accept.")
@click.option(
    "--folder",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("tests/together/regression"),
    show_default=True,
)
@click.option("-q", "--quiet", is_flag=True, help="No departures one by one and no progress.")
@verbose
@click.pass_obj
def command(
    planted: object,
    asked: str,
    reason: str | None,
    day: str | None,
    folder: Path,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
) -> int:
    """Compare today's numbers with the accepted ones, or accept them."""
    from comparisons import cases, regression
    from comparisons.cli import showing
    from comparisons.listening import SOLVERS
    from comparisons.pairing import solvers_of

    if (reason is None) != (day is None) or (reason is not None and not reason.strip()):
        raise click.UsageError("--accept REASON and --date YYYY-MM-DD belong together, and neither is empty.")
    if day is not None:
        try:
            date.fromisoformat(day)
        except ValueError:
            raise click.UsageError(f"--date: found {day!r}; allowed: a date as YYYY-MM-DD.") from None
    solvers = solvers_of(planted)
    code = 0
    scenes = [cases.opened(name) for name in (cases.scenes() if asked == "all" else (asked,))]
    steps = showing.progress(scenes, shown=not quiet, within=SOLVERS, share=0.5)
    for scene in steps:
        file = folder / f"{scene.name}.json"
        try:
            found = regression.measured(scene, solvers)
        except RuntimeError as error:
            click.echo(f"cprbm: {scene.name}: {error}", err=True)
            return DEPARTED
        steps.clear()
        if reason is not None and day is not None:
            regression.accept(file, found, date=day, reason=reason)
            click.echo(f"{scene.name}: accepted into {file}")
            continue
        if not file.exists():
            raise click.UsageError(f"{file} is not there; --accept REASON --date YYYY-MM-DD makes it.")
        wrong = regression.departures(file, found)
        for departure in () if quiet else wrong:
            click.echo(f"{scene.name}: {departure}")
        click.echo(f"{scene.name}: {len(wrong)} numbers depart from {file}")
        code = DEPARTED if wrong else code
    return code
