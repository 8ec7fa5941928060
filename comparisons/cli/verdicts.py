"""``cprbm compare``, ``converge`` and ``report``: both solvers on questions, as tables, JSON and a page.

After every result the page and the JSON file are whole: an interrupted command leaves all finished work.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import partial
from logging import NOTSET

import click

from comparisons import case, cases, logs, offset_verdict, pairing, provenance
from comparisons.case import Comparison
from comparisons.cli import output
from comparisons.cli.errors import INCOMPLETE, UNDECIDED
from comparisons.cli.request import Request
from comparisons.present import brief, case_tables, csv_table, figures, offset, page
from comparisons.present.columns import Section
from comparisons.store import Run, run_into
from comparisons.studies import convergence
from comparisons.studies.report import Report
from comparisons.tolerances import runs_within
from comparisons.verdict import Word
from comparisons.verdict.runs import Runs
from comparisons.writing import Plain, write
from cprbm_scene import OffsetQuestion, Question

Compared = Comparison | offset_verdict.OffsetComparison


def compare_all(request: Request) -> int:
    """Compare both solvers on questions; the exit code.

    0 if all agree; 1 if any case differs or a solve did not complete; 3 if no case is worse than undecided.  An
    uncertainty above the requested tolerance counts as undecided.
    """
    questions = request.questions()
    request = request.with_room("report" if "all" in request.arguments else "")
    # with a tolerance a status line with N replaces the bar
    progress = output.bar(len(questions), shown=not request.quiet and request.tol is None, noun="case")
    finished, chapters, documents = list[Compared](), list[page.Chapter](), list[Plain]()
    with _run(request, questions) as run, progress as shown:
        for compared in _comparisons(request, questions, run, shown):
            finished.append(compared)
            documents.append(page.document_of(compared))
            if request.out is not None:
                chapters.append(page.put_case(request.out, compared, page.figures_of(compared)))
            _keep(request, run, questions[: len(finished)], page.report_page(chapters), {"cases": documents})
            shown.clear()
            if request.prints:
                _show(request, compared)
    if not request.prints:
        output.write_json(request.json_file, {"cases": documents})
    _export(request, [found for found in finished if isinstance(found, Comparison)])
    if request.prints and not request.quiet and len(finished) > 1:
        output.print_tables([brief.summary(finished)], brief.WIDTH)
    output.print_folder(request)
    verdicts = [found.verdict for found in finished]
    if any(verdict.word is Word.DIFFER or not verdict.completed for verdict in verdicts):
        return INCOMPLETE
    undecided = any(verdict.word is Word.UNDECIDED for verdict in verdicts)
    return UNDECIDED if undecided or any(map(_failed_searches, finished)) else 0


def _comparisons(request: Request, questions: Sequence[Question], run: Run, progress: output.Bar) -> Iterator[Compared]:
    """Comparisons of all questions; the next question is solved while the caller draws and prints the last."""
    begun = partial(_begin, request, [] if request.tol else questions, run)
    following = begun(0)
    for place, question in enumerate(progress.through(questions)):
        pending, following = following, begun(place + 1)
        if isinstance(question, OffsetQuestion):
            yield offset_verdict.compared_offset(question, run.solvers.offset)
        elif pending is not None:
            yield case.compare(pending())
        else:
            assert request.tol is not None
            with output.status(shown=not request.quiet) as say:
                runs, searches = runs_within(question, request.choices, request.tol, run.solvers, run.crew, say)
            yield replace(case.compare(runs), tolerances=searches)


def _begin(request: Request, questions: Sequence[Question], run: Run, place: int) -> Callable[[], Runs] | None:
    """The runs of a question, begun now; None beyond the last question, and for an offset question."""
    question = questions[place] if place < len(questions) else None
    if question is None or isinstance(question, OffsetQuestion):
        return None
    return pairing.begin(question, request.choices, run.solvers, run.crew)


def _run(request: Request, questions: Sequence[Question]) -> AbstractContextManager[Run]:
    """Context with the run of the questions into the folder of the request."""
    names = tuple(question.name for question in questions)
    return run_into(request.out, request.solvers, names, request.processes)


def _keep(request: Request, run: Run, shown: Sequence[Question], whole: page.Page, document: Plain) -> None:
    """Write the page and the JSON of the questions ``shown``, unless they would replace more; the last one is new."""
    run.mark_shown(shown[-1].name)
    if run.covers([question.name for question in shown]):
        if request.out is not None:
            page.put_page(request.out, whole)
        if request.prints:
            output.write_json(request.json_file, document)


def _show(request: Request, compared: Compared) -> None:
    """Print a case: in brief, with ``-v`` with all tables, or quietly with the verdict alone."""
    if not request.quiet and logs.level() == NOTSET:
        values = [text for name, value in request.values.items() for text in ("--set", f"{name}={value}")]
        click.echo(brief.brief(compared, shlex.join([cases.argument(compared.question), *values]), request.out) + "\n")
        return
    if not request.quiet:
        for section in (
            case_tables.case_sections(compared)
            if isinstance(compared, Comparison)
            else offset.offset_sections(compared)
        ):
            output.print_section(section)
    click.echo(brief.headline(compared.question.name, compared.verdict, compared.verdict.sentence))
    for sentence in _failed_searches(compared):
        click.echo(f"{compared.question.name}: {sentence}")


def _failed_searches(compared: Compared) -> list[str]:
    """Sentences on searches for N without success."""
    if isinstance(compared, offset_verdict.OffsetComparison):
        return []
    return [search.sentence(compared.scene) for search in compared.tolerances if not search.met]


def _export(request: Request, compared: Sequence[Comparison]) -> None:
    """Write the table and the drawing of all comparisons; without common stations standard error reports the reason."""
    if request.csv_file is not None:
        write(request.csv_file, csv_table.csv_of_comparisons(compared))
    if request.plot_file is not None and compared and all(each.rows for each in compared):
        figures.designs_figure(compared).save(request.plot_file)
    elif request.plot_file is not None:
        click.echo(f"cprbm: {request.plot_file} is not drawn: a case has no station of both solvers.", err=True)


def converge_all(request: Request, sizes: tuple[int, ...]) -> int:
    """State limits and orders of all numbers of questions; exit code 1 for an incomplete series."""
    questions = request.questions()
    request = request.with_room("convergence" if "all" in request.arguments else "")

    progress = output.bar(len(questions), shown=not request.quiet, share=0.8)
    finished, chapters, document = list[Section](), list[page.Chapter](), dict[str, object]()
    with _run(request, questions) as run, progress as shown:
        for question in shown.through(questions):
            section = convergence.convergence_section(question, sizes, request.choices, run.solvers, run.crew)
            finished.append(section)
            data = [each.data for each in finished]
            document = {"cases": data} if len(questions) > 1 else dict(*data)
            if request.out is not None:
                page.put_section(page.own_folder(request.out, question.name), section)
                chapters.append(page.section_chapter(question, [section]))
            _keep(request, run, questions[: len(finished)], page.convergence_page(chapters), document)
            shown.clear()
            if request.prints:
                output.print_tables(() if request.quiet else section.tables)
                for sentence in section.sentences:
                    click.echo(f"{question.name}: {sentence}")
    if not request.prints:
        output.write_json(request.json_file, document)
    output.print_folder(request)
    return 0 if all(section.complete for section in finished) else INCOMPLETE


def report(request: Request, sizes: tuple[int, ...], without: tuple[str, ...]) -> None:
    """Write the page of questions with verdicts, errors and run times; finished parts are taken from the folder."""
    request = replace(request, arguments=request.arguments or ("all",))
    questions = request.questions()
    request = request.with_room("full-report")
    assert request.out is not None
    parts = request.choices, () if "convergence" in without else sizes, "times" not in without, request.exact
    found = Report(request.out, questions, *parts, request.solvers, provenance.page_origin())
    missing = found.missing()
    with _run(request, questions) as run, output.bar(len(missing), shown=not request.quiet) as progress:
        pending = _begin(request, missing, run, 0)
        for place, question in enumerate(progress.through(missing)):
            content = found.content_of(question, pending, run)
            # solve the next case during the drawings, but not during the measurement of run times
            pending = _begin(request, missing, run, place + 1)
            found.add(question, *content)
        found.add_table()
    output.write_json(request.json_file, found.document() if request.json_file else {})
    for chapter in found.chapters.values() if request.prints else ():
        click.echo(f"{chapter.name}: {chapter.word}. {chapter.sentence}")
    output.print_folder(request)
