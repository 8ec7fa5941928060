"""``cprbm solve``: the answer of a single solver, as tables and files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import click

from comparisons.audit import Audit, audit
from comparisons.cli.bars import bar, status
from comparisons.cli.errors import INCOMPLETE, UNDECIDED
from comparisons.cli.output import print_tables, write_json
from comparisons.cli.questions import scene_of, with_room
from comparisons.cli.request import Request
from comparisons.logs import SOLVERS
from comparisons.pairing import Solvers, exact_answer, solid_answer, solvers_of
from comparisons.tolerances.result import Tolerance
from comparisons.writing import write
from cprbm_scene import Answer, Scene

SolverName = Literal["cprbm", "fea", "exact", "solid"]


def solve(request: Request, solver: SolverName) -> int:
    """Write and print the answer of a solver; the exit code."""
    scene = scene_of(request)
    request = with_room(request)
    answer, searches = answer_of(request, scene, solver)
    audited = audit(scene, answer)
    if not request.quiet or request.json_file or request.csv_file or request.plot_file:
        _write(request, scene, answer, searches, audited)
    return report_problems(scene, answer, searches, audited.complaints)


def _write(request: Request, scene: Scene, answer: Answer, searches: tuple[Tolerance, ...], audited: Audit) -> None:
    """Write the files of an answer, and print its tables."""
    from comparisons.present import answer_tables, csv_table, figures, json_document  # not for a quiet solve

    if request.json_file is not None:
        document = json_document.solution(scene, answer, searches, audited)
        write_json(request.json_file, {"cases": [document]})
    if request.csv_file is not None:
        write(request.csv_file, csv_table.csv_of(scene, answer))
    if request.plot_file is not None and answer.stations:
        figures.answer_figure(scene, answer).save(request.plot_file)
    if request.prints and not request.quiet:
        print_tables(answer_tables.answer_tables(scene, answer, searches))


def answer_of(request: Request, scene: Scene, solver: SolverName) -> tuple[Answer, tuple[Tolerance, ...]]:
    """The answer, and the result of the search for N with a tolerance.

    Raises:
        SceneError: the solver does not support the scene.
    """
    solvers = solvers_of(request.planted or Solvers(exact=exact_answer))  # a named solver has no rule on its size
    if request.tol is not None and solver != "exact":
        from comparisons.tolerances.search import solve_within

        with status(shown=not request.quiet) as say:
            answer, search = solve_within(scene, solver, request.choices, request.tol, solvers, say)
        return answer, (search,)
    functions = {
        "cprbm": solvers.cprbm,
        "fea": solvers.fea,
        "exact": solvers.exact or exact_answer,
        "solid": solvers.solid or solid_answer,
    }
    with bar(1, shown=not request.quiet, loggers=SOLVERS):
        return functions[solver](scene, request.choices), ()


def report_problems(scene: Scene, answer: Answer, searches: Sequence[Tolerance], complaints: Sequence[str]) -> int:
    """Report an early end, ``complaints`` of the audit, or a missed tolerance; the exit code."""
    code, ending = UNDECIDED, answer.ending.value
    sentences = [f"the audit fails {complaint}" for complaint in complaints]
    if not answer.completed:
        code = INCOMPLETE
        sentences = [answer.sentence if answer.sentence.startswith(ending) else f"{ending}. {answer.sentence}".rstrip()]
    elif not complaints:
        sentences = [search.sentence(scene) for search in searches if not search.met][:1]
    for sentence in sentences:
        click.echo(f"cprbm: {scene.name}: {sentence}", err=True)
    return code if sentences else 0
