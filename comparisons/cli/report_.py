"""``cprbm report``: a folder with a page on verdicts, convergence and run times, to send to a colleague."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from comparisons.cli.completion import candidates
from comparisons.cli.options import (
    choices_for,
    exactness,
    family_sizes,
    folder,
    output_options,
    parameters,
    sized,
    variants,
)

if TYPE_CHECKING:
    from comparisons.present.columns import Section
    from comparisons.present.page import Chapter
    from comparisons.verdict.runs import Runs

PARTS = ("convergence", "times")


@click.command("report")
@click.argument("arguments", nargs=-1, metavar="[CASE|FILE.toml...|all]", shell_complete=candidates)
@parameters
@sized
@variants
@click.option("--sizes", callback=family_sizes, metavar="N,N,...", default="10,20,40,80", show_default=True,
              help="Two or more numbers of links and elements per beam for the error against N.")  # fmt: skip
@click.option("--without", multiple=True, type=click.Choice(PARTS),
              help="Leave out a long part; may be repeated. 'convergence': error against N and the error budget. "
              "'times': run time against error, and the paper's Table 1.")  # fmt: skip
@exactness
@output_options
@folder("Folder of the report.  [default: 'full-report']")
@click.pass_obj
def command(
    planted: object,
    arguments: tuple[str, ...],
    sizes: tuple[int, ...],
    without: tuple[str, ...],
    exact: bool | None,  # noqa: FBT001 - click passes a keyword
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
    out: Path | None,
) -> int:
    """Write a page with verdicts, figures, errors and run times.

    The page opens without a network. Without a scene the report covers all built-in cases. Finished parts are taken
    from the folder, and an interrupted run goes on. Exit code 0 means a written report, with any verdict.
    """
    from comparisons import provenance
    from comparisons.cli import output
    from comparisons.cli.questions import read_questions
    from comparisons.pairing import begin, solvers_of, workers_for
    from comparisons.present.page import put_page, report_page
    from comparisons.store import run_into
    from comparisons.studies import report as put
    from cprbm_scene import OffsetQuestion

    wanted = read_questions(arguments or ("all",))
    choices = choices_for(*wanted)
    out = out or Path("full-report")
    output.room_for(json_file, out)
    parts = put.Parts(choices, () if "convergence" in without else sizes, times="times" not in without)
    made_on = provenance.page_origin()
    made_of = f"{parts!r}, exact={exact}"  # chapters with other parts are written anew
    chapters: dict[str, Chapter] = {}
    for question in wanted:
        there = put.kept(out, question, made_of)
        if there is not None:
            chapters[question.name] = there
    with_table = parts.times and put.has_table(wanted)
    there_too = put.kept_table(out, made_on) if with_table else None
    further: tuple[Section, ...] = () if there_too is None else (there_too,)
    missing = [question for question in wanted if question.name not in chapters]
    ordered = tuple(question.name for question in wanted)

    def so_far() -> list[Chapter]:
        return [chapters[name] for name in ordered if name in chapters]

    solvers = solvers_of(planted, exact=exact)
    with run_into(out, solvers, ordered, workers_for(planted)) as run:

        def begun(place: int) -> Callable[[], Runs] | None:
            question = missing[place] if place < len(missing) else None
            if question is None or isinstance(question, OffsetQuestion):
                return None
            return begin(question, choices, run.solvers, run.crew)

        pending = begun(0)
        for place, question in enumerate(output.progress(missing, shown=not quiet)):
            found = put.gathered(question, pending, parts, run.solvers, solvers, run.crew)
            # solve the next case during the drawings, but not during the measurement of run times
            pending = begun(place + 1)
            chapters[question.name] = put.added(out, question, made_of, found)
            put_page(out, report_page(so_far(), further, made_on))
        if with_table and not further:
            further = (put.added_table(out, put.table_section(solvers, made_on), made_on),)
    put_page(out, report_page(so_far(), further, made_on))
    if json_file is not None:
        output.json(json_file, put.document(out, so_far(), made_on))
    if str(json_file) != "-":
        for chapter in so_far():
            click.echo(f"{chapter.name}: {chapter.word}. {chapter.sentence}")
        if not quiet:
            click.echo(f"report: {out / 'index.html'}")
    return 0
