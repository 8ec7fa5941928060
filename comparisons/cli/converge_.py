"""``cprbm converge``: both solvers at a family of sizes, with limits and orders of all numbers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from comparisons.cli.completion import candidates
from comparisons.cli.options import (
    choices_for,
    exactness,
    family_sizes,
    folder,
    opinions,
    output_options,
    parameters,
    variants,
)

if TYPE_CHECKING:
    from comparisons.plain import Plain
    from comparisons.present.columns import Section
    from cprbm_scene import Question

NOT_COMPLETED = 1


@click.command("converge")
@click.argument("arguments", nargs=-1, required=True, metavar="CASE|FILE.toml...|all", shell_complete=candidates)
@parameters
@click.option("--solver", "asking_solid", callback=opinions, default="cprbm,fea", show_default=True, metavar="SOLVERS",
              help="Solvers: 'cprbm,fea', or 'cprbm,fea,solid' for the error of the beam theories.")  # fmt: skip
@click.option(
    "--sizes",
    callback=family_sizes,
    metavar="N,N,...",
    default="10,20,40,80,160,320",
    show_default=True,
    help="Two or more numbers of links and elements per beam.",
)
@variants
@exactness
@output_options
@folder("Folder of page, numbers and figures.  [default: 'convergence' for 'converge all', otherwise none]")
@click.pass_obj
def command(
    planted: object,
    arguments: tuple[str, ...],
    asking_solid: bool,  # noqa: FBT001 - click passes a keyword
    sizes: tuple[int, ...],
    exact: bool | None,  # noqa: FBT001 - click passes a keyword
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
    out: Path | None,
) -> int:
    """State order, limit and error of every number against N.

    The error budget splits every difference of the solvers into parts.
    """
    from comparisons.cli import output
    from comparisons.cli.questions import read_questions
    from comparisons.pairing import solvers_of, with_solid, workers_for
    from comparisons.present.page import Chapter, convergence_page, own_folder, put_page, put_section, section_chapter
    from comparisons.store import run_into
    from comparisons.studies.convergence import convergence_section

    wanted = read_questions(arguments)
    if out is None and "all" in arguments:
        out = Path("convergence")
    output.room_for(json_file, out)
    taking_part = with_solid(solvers_of(planted, exact=exact)) if asking_solid else solvers_of(planted, exact=exact)
    choices = choices_for()
    printing = str(json_file) != "-"
    finished: list[Section] = []
    chapters: tuple[Chapter, ...] = ()
    names = tuple(question.name for question in wanted)
    with run_into(out, taking_part, names, workers_for(planted)) as run:
        steps = output.progress(wanted, shown=not quiet, share=0.8)
        for place, question in enumerate(steps):
            result = convergence_section(question, sizes, choices, run.solvers, run.crew)
            finished.append(result)
            if out is not None:
                put_section(own_folder(out, question.name), result)
                chapters = (*chapters, section_chapter(question, [result]))
            run.mark_shown(question.name)
            if run.covers(names[: place + 1]):
                if out is not None:
                    put_page(out, convergence_page(chapters))
                if json_file is not None and printing:
                    output.json(json_file, _document(finished, wanted))
            steps.clear()
            if printing and not quiet:
                output.tables(result.tables)
            if printing:
                for sentence in result.sentences:
                    click.echo(f"{question.name}: {sentence}")
    if json_file is not None and not printing:
        output.json(json_file, _document(finished, wanted))
    if out is not None and printing and not quiet:
        click.echo(f"report: {out / 'index.html'}")
    return 0 if all(result.complete for result in finished) else NOT_COMPLETED


def _document(finished: Sequence[Section], wanted: Sequence[Question]) -> Plain:
    """The document of a single question, or the documents of several as ``cases``."""
    return dict(finished[0].data) if len(wanted) == 1 else {"cases": [result.data for result in finished]}
