"""``cprbm solve`` and ``view``: the answer of a single solver, as tables, files and pictures."""

import math
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import click

from comparisons.audit import Audit, audit
from comparisons.cli import output
from comparisons.cli.doctor import WHAT_DRAWS
from comparisons.cli.errors import code_of
from comparisons.formats import at_station, file_unit
from comparisons.logs import SOLVERS
from comparisons.pairing import ANSWERS, SolverName, solvers_of
from comparisons.present.strips import Coloured, with_stresses
from comparisons.quantities import load_unit
from comparisons.sentences import remedy_sentence
from comparisons.tolerances import Tolerance, solve_within
from comparisons.writing import write
from cprbm_scene import Answer, Scene

_ROUNDING = 1e-9
"""Largest distance of a typed station, a share of the station: decimal digits are rounded."""


def solve(request: output.Request, solver: SolverName) -> int:
    """Write and print the answer of a solver; the exit code."""
    scene = request.scene()
    request = request.with_room()
    found = _answer_of(request, scene, solver)
    if not request.quiet or request.json_file or request.csv_file or request.plot_file:
        _write(request, scene, *found)
    return _report_problems(scene, *found)


def _write(
    request: output.Request, scene: Scene, answer: Answer, audited: Audit, searches: tuple[Tolerance, ...]
) -> None:
    """Write the files of an answer, and print its tables."""
    from comparisons.present import case_tables, csv_table, figures, json_document  # not for a quiet solve

    if request.json_file is not None:
        output.write_json(request.json_file, {"cases": [json_document.solution(scene, answer, searches, audited)]})
    if request.csv_file is not None:
        write(request.csv_file, csv_table.csv_of(scene, answer))
    if request.plot_file is not None and answer.stations:
        figures.answer_figure(scene, answer).save(request.plot_file)
    if request.prints and not request.quiet:
        output.print_tables(case_tables.answer_tables(scene, answer, searches))


def _answer_of(
    request: output.Request, scene: Scene, solver: SolverName
) -> tuple[Answer, Audit, tuple[Tolerance, ...]]:
    """The answer of a solver, its audit, and the searches for N.

    Raises:
        SceneError: the solver does not support the scene.
    """
    if request.tol is not None and solver != "exact":
        with output.status(shown=not request.quiet) as say:
            answer, search = solve_within(scene, solver, request.choices, request.tol, solvers_of(request.planted), say)
        return answer, audit(scene, answer), (search,)
    # a named solver has no rule on its size
    function = getattr(request.planted, solver, None) or ANSWERS[solver]
    with output.bar(1, shown=not request.quiet, loggers=SOLVERS):
        answer = function(scene, request.choices)
    return answer, audit(scene, answer), ()


def _report_problems(scene: Scene, answer: Answer, audited: Audit, searches: tuple[Tolerance, ...]) -> int:
    """Report an early end, complaints of the audit, or a missed tolerance; the exit code."""
    ending = answer.ending.value
    sentences = [f"the audit fails {complaint}" for complaint in audited.complaints]
    if not answer.completed:
        ended = answer.sentence if answer.sentence.startswith(ending) else f"{ending}. {answer.sentence}".rstrip()
        sentences = [". ".join(filter(None, (ended, remedy_sentence(answer))))]
    sentences = sentences or [search.sentence(scene) for search in searches if not search.met]
    for sentence in sentences:
        click.echo(f"cprbm: {scene.name}: {sentence}", err=True)
    return code_of(incomplete=not answer.completed, undecided=bool(sentences))


def view(request: output.Request, solver: SolverName, quantity: Coloured, station: str | None) -> int:
    """Write pictures of the answer of a solver; the exit code.

    Raises:
        click.BadParameter: the file has no known ending, or the station does not exist.
        click.ClickException: VTK cannot draw here.
    """
    from comparisons.present import view as pictures  # not for a solve

    scene = with_stresses(request.scene())
    path = request.out or Path(f"{scene.name}.png")
    kind = pictures.kind_of(path)
    if kind is None:
        allowed = f"a name that ends in {', '.join(pictures.KINDS)}"
        raise click.BadParameter(f"found {path.name!r}; allowed: {allowed}", param_hint="--out")
    last = None if station is None else _station(scene, station)
    path.parent.mkdir(parents=True, exist_ok=True)
    answer, audited, searches = _answer_of(request, scene, solver)
    code = _report_problems(scene, answer, audited, searches)
    places = [place for place, each in enumerate(answer.stations, 1) if last in (None, (each.stage, each.value))]
    if not places:
        click.echo(f"cprbm: {scene.name}: no picture, since the solver did not reach the station.", err=True)
        return code
    shown = replace(answer, stations=answer.stations[: places[-1]])
    try:
        for file, content in pictures.files(scene, shown, path, kind, quantity):
            write(file, content)
    except pictures.DrawingError as trouble:
        remedy = f"On Debian and Ubuntu install its libraries with: {WHAT_DRAWS}"
        raise click.ClickException(f"VTK cannot draw in space here ({trouble}). {remedy}") from None
    if not request.quiet:
        end = shown.stations[-1]
        click.echo(f"{path}: {scene.name} by {solver}, {at_station(scene, end.stage, end.value)}.")
    return code


def _station(scene: Scene, text: str) -> tuple[str, float]:
    """The last station of the scene with the stage and the value of a text, in the units of the scene's file.

    Raises:
        click.BadParameter: the text names no station.
    """
    stage, _, value = text.rpartition(":")
    known = [(each.name, load, load / file_unit(scene, load_unit(scene, each.name))[0])
             for each in scene.stages for load in each.stations]  # fmt: skip
    with suppress(ValueError):
        for name, load, typed in reversed(known):
            if stage in ("", name) and math.isclose(typed, float(value), rel_tol=_ROUNDING):
                return name, load
    allowed = ", ".join(f"{name}:{typed:g}" for name, _, typed in known[:40]) + (", ..." if len(known) > 40 else "")
    raise click.BadParameter(f"found {text!r}; allowed: one of {allowed}", param_hint="--station")
