"""``cprbm compare``: both solvers on one scene or several, and the verdicts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from comparisons.choices import Kinematics
from comparisons.cli.options import folder, numerical, output

if TYPE_CHECKING:
    from comparisons.documents import Plain
    from comparisons.offset_verdict import OffsetComparison
    from comparisons.verdict import Comparison


@click.command("compare")
@click.argument("asked", nargs=-1, required=True, metavar="CASE|FILE.toml...|all")
@numerical
@output
@folder("Folder of the report; 'report' for 'compare all', else none unless given.")
@click.pass_obj
def command(
    planted: object,
    asked: tuple[str, ...],
    links: int | Mapping[str, int],
    elements: int | Mapping[str, int],
    formulation: Literal["auto", "paper"],
    kinematics: Kinematics,
    penetration: float,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
    out: Path | None,
) -> int:
    """Answer scenes with both solvers and say whether they agree."""
    from comparisons import cases, offset_pages, report, sheets
    from comparisons.choices import Choices, check
    from comparisons.cli import showing
    from comparisons.offset_verdict import OffsetComparison, compared_offset
    from comparisons.pairing import crew_of, paired, solvers_of, workers_for
    from comparisons.verdict import compared
    from scene import OffsetQuestion

    solvers = solvers_of(planted)
    names = [name for text in asked for name in (cases.names() if text == "all" else (text,))]
    scenes = [cases.asked(name) for name in dict.fromkeys(names)]
    choices = Choices(links, formulation, elements, kinematics, penetration)
    for scene in scenes:
        if not isinstance(scene, OffsetQuestion):
            check(choices, scene)
    _distinct([scene.name for scene in scenes])
    if out is None and "all" in asked:
        out = Path("report")
    showing.room_for(json_file, out)
    printing = str(json_file) != "-"
    finished: list[Comparison | OffsetComparison] = []
    chapters: tuple[report.Chapter, ...] = ()
    with crew_of(workers_for(planted)) as crew:
        for scene in showing.progress(scenes, shown=not quiet):
            comparison: Comparison | OffsetComparison
            if isinstance(scene, OffsetQuestion):
                comparison = compared_offset(scene, solvers.offset)
            else:
                comparison = compared(scene, paired(scene, choices, solvers, crew))
            finished.append(comparison)
            if out is not None:
                chapters = report.add(out, chapters, comparison)
            if json_file is not None and str(json_file) != "-":
                showing.json(json_file, {"cases": [_document(one) for one in finished]})
            if printing:
                if not quiet:
                    if isinstance(comparison, OffsetComparison):
                        showing.tables(offset_pages.sheets_of(comparison))
                    else:
                        showing.tables(sheets.of_comparison(comparison))
                        for sentence in sheets.explanation(comparison):
                            click.echo(sentence + "\n")
                verdict = comparison.verdict
                click.echo(f"{scene.name}: {verdict.word.value}. {verdict.sentence}")
    if json_file is not None and str(json_file) == "-":
        showing.json(json_file, {"cases": [_document(one) for one in finished]})
    if out is not None and printing and not quiet:
        click.echo(f"report: {out / 'index.html'}")
    return exit_code(finished)


def exit_code(finished: Sequence[Comparison | OffsetComparison]) -> int:
    """0 if all agree; 1 if any differs or a solve did not complete; 3 if nothing is worse than undecided."""
    from comparisons.verdict import Word

    verdicts = [comparison.verdict for comparison in finished]
    if any(verdict.word is Word.DIFFER or not verdict.completed for verdict in verdicts):
        return 1
    return 3 if any(verdict.word is Word.UNDECIDED for verdict in verdicts) else 0


def _document(one: Comparison | OffsetComparison) -> Plain:
    from comparisons import documents, offset_pages
    from comparisons.offset_verdict import OffsetComparison

    return offset_pages.document(one) if isinstance(one, OffsetComparison) else documents.comparison(one)


def _distinct(names: list[str]) -> None:
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise click.UsageError(f"Several scenes have the name {', '.join(twice)}; allowed: a name for each.")
