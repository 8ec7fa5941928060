"""``cprbm compare``: both solvers on one scene or several, and the verdicts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from comparisons.choices import Kinematics
from comparisons.cli.completing import offered
from comparisons.cli.options import exactness, folder, numerical, one_of_both, opinions, output, parameters

if TYPE_CHECKING:
    from comparisons.case import Comparison
    from comparisons.documents import Plain
    from comparisons.offset_verdict import OffsetComparison
    from comparisons.tolerances.search import Tolerance


@click.command("compare")
@click.argument("asked", nargs=-1, required=True, metavar="CASE|FILE.toml...|all", shell_complete=offered)
@parameters
@click.option("--solver", "asking_solid", callback=opinions, default="cprbm,fea", show_default=True, metavar="SOLVERS",
              help="Who answers: 'cprbm,fea', or 'cprbm,fea,solid' for a third opinion.")  # fmt: skip
@numerical
@exactness
@output
@folder("Folder of the report; 'report' for 'compare all', else none unless given.")
@click.pass_obj
def command(
    planted: object,
    asked: tuple[str, ...],
    asking_solid: bool,  # noqa: FBT001 - click hands it over by name
    links: int | Mapping[str, int],
    elements: int | Mapping[str, int],
    formulation: Literal["auto", "paper"],
    kinematics: Kinematics,
    penetration: float,
    across: int,
    tol: float | None,
    exact: bool | None,  # noqa: FBT001 - click hands it over by name
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
    out: Path | None,
) -> int:
    """Answer scenes with both solvers and say whether they agree."""
    from comparisons import offset_pages, report, sheets
    from comparisons.case import compare
    from comparisons.choices import Choices, check
    from comparisons.cli import showing
    from comparisons.cli.asking import questions
    from comparisons.offset_verdict import OffsetComparison, compared_offset
    from comparisons.pairing import Runs, begin, crew_of, solvers_of, with_solid, workers_for
    from comparisons.resuming import resumed
    from comparisons.tolerances.tolerated import paired_within
    from cprbm_scene import OffsetQuestion, Scene

    one_of_both(tol)
    taking_part = with_solid(solvers_of(planted, exact=exact)) if asking_solid else solvers_of(planted, exact=exact)
    scenes = questions(asked)
    choices = Choices(links, formulation, elements, kinematics, penetration, across)
    for scene in scenes:
        if not isinstance(scene, OffsetQuestion):
            check(choices, scene)
    if out is None and "all" in asked:
        out = Path("report")
    showing.room_for(json_file, out)
    printing = str(json_file) != "-"
    finished: list[Comparison | OffsetComparison] = []
    chapters: tuple[report.Chapter, ...] = ()
    names = tuple(scene.name for scene in scenes)
    with resumed(out, taking_part, names) as whole, crew_of(workers_for(planted)) as crew:
        solvers = whole.solvers

        def begun(place: int) -> Callable[[], Runs] | None:
            scene = scenes[place] if tol is None and place < len(scenes) else None
            return begin(scene, choices, solvers, crew) if isinstance(scene, Scene) else None

        following = begun(0)
        # a line that says which N is being solved stands in the bar's place
        steps = showing.progress(scenes, shown=not quiet and tol is None)
        for place, scene in enumerate(steps):
            comparison: Comparison | OffsetComparison
            # the next case is solved while this one is judged and drawn
            pending, following = following, begun(place + 1)
            if isinstance(scene, OffsetQuestion):
                comparison = compared_offset(scene, solvers.offset)
            else:
                found: tuple[Tolerance, ...] = ()
                if pending is not None:
                    runs = pending()
                else:
                    assert tol is not None
                    with showing.current(shown=not quiet) as say:
                        runs, found = paired_within(scene, choices, tol, solvers, crew, say)
                comparison = replace(compare(scene, runs), tolerances=found)
            finished.append(comparison)
            if out is not None:
                chapters = (*chapters, report.added(out, comparison))
            whole.tells(scene.name)
            if whole.caught_up(names[: place + 1]):
                if out is not None:
                    report.put_page(out, chapters)
                if json_file is not None and printing:
                    showing.json(json_file, {"cases": [_document(one) for one in finished]})
            steps.clear()
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
                for tolerance in _beyond(comparison):
                    click.echo(f"{scene.name}: {tolerance.sentence}")
    if json_file is not None and str(json_file) == "-":
        showing.json(json_file, {"cases": [_document(one) for one in finished]})
    if out is not None and printing and not quiet:
        click.echo(f"report: {out / 'index.html'}")
    return exit_code(finished)


def exit_code(finished: Sequence[Comparison | OffsetComparison]) -> int:
    """0 if all agree; 1 if any differs or a solve did not complete; 3 if nothing is worse than undecided.

    An uncertainty that is not within the tolerance asked is as undecided as a verdict can be.
    """
    from comparisons.verdict.words import Word

    verdicts = [comparison.verdict for comparison in finished]
    if any(verdict.word is Word.DIFFER or not verdict.completed for verdict in verdicts):
        return 1
    undecided = any(verdict.word is Word.UNDECIDED for verdict in verdicts)
    return 3 if undecided or any(_beyond(comparison) for comparison in finished) else 0


def _beyond(one: Comparison | OffsetComparison) -> tuple[Tolerance, ...]:
    """The searches for N that have not met their tolerance."""
    from comparisons.offset_verdict import OffsetComparison

    return () if isinstance(one, OffsetComparison) else tuple(found for found in one.tolerances if not found.met)


def _document(one: Comparison | OffsetComparison) -> Plain:
    from comparisons import documents, offset_pages
    from comparisons.offset_verdict import OffsetComparison

    return offset_pages.document(one) if isinstance(one, OffsetComparison) else documents.comparison(one)
