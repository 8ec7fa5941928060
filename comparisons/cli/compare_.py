"""``cprbm compare``: both solvers on scenes, and the verdicts."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from logging import NOTSET
from pathlib import Path
from typing import TYPE_CHECKING

import click

from comparisons import logs
from comparisons.cli.completion import candidates
from comparisons.cli.options import (
    choices_for,
    exactness,
    exports,
    folder,
    numerical,
    opinions,
    output_options,
    parameters,
    refuse_sizes_with,
    settings,
)

if TYPE_CHECKING:
    from comparisons.case import Comparison
    from comparisons.choices import Choices
    from comparisons.cli.output import Steps
    from comparisons.crew import Crew
    from comparisons.offset_verdict import OffsetComparison
    from comparisons.pairing import Solvers
    from comparisons.tolerances.result import Tolerance
    from comparisons.verdict.runs import Runs
    from cprbm_scene import Question


@click.command("compare")
@click.argument("arguments", nargs=-1, required=True, metavar="CASE|FILE.toml...|all", shell_complete=candidates)
@parameters
@click.option("--solver", "asking_solid", callback=opinions, default="cprbm,fea", show_default=True, metavar="SOLVERS",
              help="Solvers: 'cprbm,fea', or 'cprbm,fea,solid' for a third opinion.")  # fmt: skip
@numerical
@exactness
@exports
@output_options
@folder("Folder of the report.  [default: 'report' for 'compare all', otherwise none]")
@click.pass_obj
def command(
    planted: object,
    arguments: tuple[str, ...],
    asking_solid: bool,  # noqa: FBT001 - click passes a keyword
    tol: float | None,
    exact: bool | None,  # noqa: FBT001 - click passes a keyword
    csv_file: Path | None,
    plot_file: Path | None,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
    out: Path | None,
) -> int:
    """Solve scenes with both solvers and state a verdict.

    The verdict of a scene is AGREE, DIFFER or UNDECIDED, with a reason.
    """
    from comparisons.cli import output
    from comparisons.cli.questions import read_questions
    from comparisons.pairing import solvers_of, with_solid, workers_for
    from comparisons.present.brief import WIDTH, summary
    from comparisons.present.page import Chapter, case_chapter, document_of, figures_of, put_case, put_page, report_page
    from comparisons.store import run_into

    refuse_sizes_with(tol)
    taking_part = with_solid(solvers_of(planted, exact=exact)) if asking_solid else solvers_of(planted, exact=exact)
    scenes = read_questions(arguments)
    choices = choices_for(*scenes)
    if out is None and "all" in arguments:
        out = Path("report")
    for file in (json_file, csv_file, plot_file):
        output.room_for(file, out)
    printing = str(json_file) != "-"
    finished: list[Comparison | OffsetComparison] = []
    chapters: tuple[Chapter, ...] = ()
    names = tuple(scene.name for scene in scenes)
    with run_into(out, taking_part, names, workers_for(planted)) as run:
        # with a tolerance a status line with N replaces the bar
        steps = output.progress(scenes, shown=not quiet and tol is None, noun="case")
        for comparison in _compared(steps, choices, tol, run.solvers, run.crew, shown=not quiet):
            finished.append(comparison)
            if out is not None:
                figures = figures_of(comparison)
                put_case(out, comparison, figures)
                chapters = (*chapters, case_chapter(comparison, figures))
            run.mark_shown(names[len(finished) - 1])
            if run.covers(names[: len(finished)]):
                if out is not None:
                    put_page(out, report_page(chapters))
                if json_file is not None and printing:
                    output.json(json_file, {"cases": [document_of(comparison) for comparison in finished]})
            steps.clear()
            if printing:
                _show(comparison, scenes[len(finished) - 1], out, quiet=quiet, full=logs.level() != NOTSET)
    if json_file is not None and not printing:
        output.json(json_file, {"cases": [document_of(comparison) for comparison in finished]})
    _export(finished, csv_file, plot_file)
    if printing and not quiet:
        if len(finished) > 1:
            output.tables([summary(finished)], WIDTH)
        if out is not None:
            click.echo(f"report: {out / 'index.html'}")
    return exit_code(finished)


def _compared(
    steps: Steps[Question], choices: Choices, tol: float | None, solvers: Solvers, crew: Crew, *, shown: bool
) -> Iterator[Comparison | OffsetComparison]:
    """Comparisons of all questions; the next question is solved while the caller draws and prints the last."""
    from comparisons.case import compare
    from comparisons.cli import output
    from comparisons.offset_verdict import compared_offset
    from comparisons.pairing import begin
    from comparisons.tolerances.search import runs_within
    from cprbm_scene import OffsetQuestion, Scene

    def begun(place: int) -> Callable[[], Runs] | None:
        scene = steps.items[place] if tol is None and place < len(steps.items) else None
        return begin(scene, choices, solvers, crew) if isinstance(scene, Scene) else None

    following = begun(0)
    for place, scene in enumerate(steps):
        pending, following = following, begun(place + 1)
        if isinstance(scene, OffsetQuestion):
            yield compared_offset(scene, solvers.offset)
        elif pending is not None:
            yield compare(scene, pending())
        else:
            assert tol is not None
            with output.current(shown=shown) as say:
                runs, found = runs_within(scene, choices, tol, solvers, crew, say)
            yield replace(compare(scene, runs), tolerances=found)


def _export(finished: Sequence[Comparison | OffsetComparison], csv_file: Path | None, plot_file: Path | None) -> None:
    """Write the table and the drawing of all comparisons; without common stations standard error reports the reason."""
    from comparisons.offset_verdict import OffsetComparison
    from comparisons.present.csv_table import csv_of_comparisons
    from comparisons.present.figures import designs_figure
    from comparisons.writing import write

    compared = [comparison for comparison in finished if not isinstance(comparison, OffsetComparison)]
    if csv_file is not None:
        write(csv_file, csv_of_comparisons(compared))
    if plot_file is not None and compared and all(comparison.rows for comparison in compared):
        designs_figure(compared).save(plot_file)
    elif plot_file is not None:
        click.echo(f"cprbm: {plot_file} is not drawn: a case has no station of both solvers.", err=True)


def _show(
    comparison: Comparison | OffsetComparison, question: Question, page: Path | None, *, quiet: bool, full: bool
) -> None:
    """Print a case: in brief, in full with all tables, or quietly with the verdict alone."""
    from comparisons import cases
    from comparisons.cli import output
    from comparisons.offset_verdict import OffsetComparison
    from comparisons.present.brief import brief, headline
    from comparisons.present.case_tables import case_sections
    from comparisons.present.offset import offset_sections

    if not quiet and not full:
        values = [text for name, value in settings().items() for text in ("--set", f"{name}={value}")]
        click.echo(brief(comparison, shlex.join([cases.argument(question), *values]), page) + "\n")
        return
    if not quiet:
        output.sections(
            offset_sections(comparison) if isinstance(comparison, OffsetComparison) else case_sections(comparison)
        )
    verdict = comparison.verdict
    click.echo(headline(question.name, verdict, verdict.sentence))
    if not isinstance(comparison, OffsetComparison):
        for tolerance in _beyond(comparison):
            click.echo(f"{question.name}: {tolerance.sentence(comparison.scene)}")


def exit_code(finished: Sequence[Comparison | OffsetComparison]) -> int:
    """0 if all agree; 1 if any case differs or a solve did not complete; 3 if no case is worse than undecided.

    An uncertainty above the requested tolerance counts as undecided.
    """
    from comparisons.verdict.words import Word

    verdicts = [comparison.verdict for comparison in finished]
    if any(verdict.word is Word.DIFFER or not verdict.completed for verdict in verdicts):
        return 1
    undecided = (verdict.word is Word.UNDECIDED for verdict in verdicts)
    return 3 if any(undecided) or any(map(_beyond, finished)) else 0


def _beyond(comparison: Comparison | OffsetComparison) -> tuple[Tolerance, ...]:
    """Searches for N without success."""
    from comparisons.offset_verdict import OffsetComparison

    searches = () if isinstance(comparison, OffsetComparison) else comparison.tolerances
    return tuple(tolerance for tolerance in searches if not tolerance.met)
