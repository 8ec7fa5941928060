"""``cprbm converge``: both solvers at a family of sizes, the limits of all numbers and their orders."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from comparisons.choices import Kinematics
from comparisons.cli.completing import offered
from comparisons.cli.options import exactness, family_sizes, folder, opinions, output, parameters, variants

if TYPE_CHECKING:
    from comparisons.converging.report import Told
    from comparisons.documents import Plain
    from cprbm_scene import Question

NOT_COMPLETED = 1


@click.command("converge")
@click.argument("asked", nargs=-1, required=True, metavar="CASE|FILE.toml...|all", shell_complete=offered)
@parameters
@click.option("--solver", "asking_solid", callback=opinions, default="cprbm,fea", show_default=True, metavar="SOLVERS",
              help="Who answers: 'cprbm,fea', or 'cprbm,fea,solid' for what the beam theories miss.")  # fmt: skip
@click.option(
    "--sizes",
    callback=family_sizes,
    metavar="N,N,...",
    default="10,20,40,80,160,320",
    show_default=True,
    help="Links and elements per beam, two or more.",
)
@variants
@exactness
@output
@folder("Folder of the page, the numbers and the figures; 'convergence' for 'converge all', else none unless given.")
@click.pass_obj
def command(
    planted: object,
    asked: tuple[str, ...],
    asking_solid: bool,  # noqa: FBT001 - click hands it over by name
    sizes: tuple[int, ...],
    formulation: Literal["auto", "paper"],
    kinematics: Kinematics,
    exact: bool | None,  # noqa: FBT001 - click hands it over by name
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
    out: Path | None,
) -> int:
    """See how the error falls with N, with which order and to which limit, and what a difference is made of."""
    from comparisons.choices import Choices
    from comparisons.cli import showing
    from comparisons.cli.asking import questions
    from comparisons.converging import report
    from comparisons.converging.telling import all_told
    from comparisons.pairing import crew_of, solvers_of, with_solid, workers_for
    from comparisons.resuming import resumed

    wanted = questions(asked)
    if out is None and "all" in asked:
        out = Path("convergence")
    showing.room_for(json_file, out)
    taking_part = with_solid(solvers_of(planted, exact=exact)) if asking_solid else solvers_of(planted, exact=exact)
    choices = Choices(formulation=formulation, kinematics=kinematics)
    printing = str(json_file) != "-"
    finished: list[Told] = []
    chapters: tuple[report.Chapter, ...] = ()
    names = tuple(question.name for question in wanted)
    with resumed(out, taking_part, names) as whole, crew_of(workers_for(planted)) as crew:
        steps = showing.progress(wanted, shown=not quiet, share=0.8)
        for place, question in enumerate(steps):
            told = all_told(question, sizes, choices, whole.solvers, crew)
            finished.append(told)
            if out is not None:
                chapters = (*chapters, report.added(out, told))
            whole.tells(question.name)
            if whole.caught_up(names[: place + 1]):
                if out is not None:
                    report.put_page(out, chapters)
                if json_file is not None and printing:
                    showing.json(json_file, _document(finished, wanted))
            steps.clear()
            if printing and not quiet:
                showing.tables(told.sheets)
            if printing:
                for sentence in told.sentences:
                    click.echo(f"{question.name}: {sentence}")
    if json_file is not None and not printing:
        showing.json(json_file, _document(finished, wanted))
    if out is not None and printing and not quiet:
        click.echo(f"report: {out / 'index.html'}")
    return 0 if all(told.completed for told in finished) else NOT_COMPLETED


def _document(finished: Sequence[Told], wanted: Sequence[Question]) -> Plain:
    """Of one question its own document, of several theirs as ``cases``."""
    return finished[0].data if len(wanted) == 1 else {"cases": [told.data for told in finished]}
