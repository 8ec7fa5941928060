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
from pathlib import Path
from typing import TypeVar

import click

from comparisons import case, cases, logs, offset_verdict, pairing, provenance
from comparisons.case import Comparison
from comparisons.cli import output
from comparisons.cli.errors import INCOMPLETE, UNDECIDED
from comparisons.cli.request import Request
from comparisons.plain import Plain
from comparisons.present import brief, case_tables, csv_table, figures, offset, page
from comparisons.present.columns import Section
from comparisons.store import Run, run_into
from comparisons.studies import convergence
from comparisons.studies.report import Parts, Report
from comparisons.tolerances.search import runs_within
from comparisons.verdict.runs import Runs
from comparisons.verdict.words import Word
from comparisons.writing import write
from cprbm_scene import OffsetQuestion, Question

Compared = Comparison | offset_verdict.OffsetComparison
Result = TypeVar("Result")


def compare_all(request: Request) -> int:
    """Compare both solvers on questions; the exit code.

    0 if all agree; 1 if any case differs or a solve did not complete; 3 if no case is worse than undecided.  An
    uncertainty above the requested tolerance counts as undecided.
    """
    questions = request.questions()
    request = request.with_room("report" if "all" in request.arguments else "")
    # with a tolerance a status line with N replaces the bar
    progress = output.bar(len(questions), shown=not request.quiet and request.tol is None, noun="case")
    ends = _put_case, page.report_page, _document, partial(_show, request)
    finished = _answer_all(request, questions, partial(_comparisons, request, questions), progress, *ends)
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
            yield case.compare(question, pending())
        else:
            assert request.tol is not None
            with output.status(shown=not request.quiet) as say:
                runs, searches = runs_within(question, request.choices, request.tol, run.solvers, run.crew, say)
            yield replace(case.compare(question, runs), tolerances=searches)


def _begin(request: Request, questions: Sequence[Question], run: Run, place: int) -> Callable[[], Runs] | None:
    """The runs of a question, begun now; None beyond the last question, and for an offset question."""
    question = questions[place] if place < len(questions) else None
    if question is None or isinstance(question, OffsetQuestion):
        return None
    return pairing.begin(question, request.choices, run.solvers, run.crew)


def _put_case(out: Path, question: Question, compared: Compared) -> page.Chapter:
    return page.put_case(out, compared, page.figures_of(compared))


def _document(finished: Sequence[Compared]) -> Plain:
    return {"cases": [page.document_of(compared) for compared in finished]}


def _show(request: Request, question: Question, compared: Compared) -> None:
    """Print a case: in brief, with ``-v`` with all tables, or quietly with the verdict alone."""
    if not request.quiet and logs.level() == NOTSET:
        values = [text for name, value in request.values.items() for text in ("--set", f"{name}={value}")]
        click.echo(brief.brief(compared, shlex.join([cases.argument(question), *values]), request.out) + "\n")
        return
    if not request.quiet:
        for section in (
            case_tables.case_sections(compared)
            if isinstance(compared, Comparison)
            else offset.offset_sections(compared)
        ):
            output.print_section(section)
    click.echo(brief.headline(question.name, compared.verdict, compared.verdict.sentence))
    for sentence in _failed_searches(compared):
        click.echo(f"{question.name}: {sentence}")


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

    def results(run: Run, progress: output.Bar) -> Iterator[Section]:
        for question in progress.through(questions):
            yield convergence.convergence_section(question, sizes, request.choices, run.solvers, run.crew)

    def chapter(out: Path, question: Question, section: Section) -> page.Chapter:
        page.put_section(page.own_folder(out, question.name), section)
        return page.section_chapter(question, [section])

    def document(finished: Sequence[Section]) -> Plain:
        return dict(finished[0].data) if len(questions) == 1 else {"cases": [each.data for each in finished]}

    def show(question: Question, section: Section) -> None:
        output.print_tables(() if request.quiet else section.tables)
        for sentence in section.sentences:
            click.echo(f"{question.name}: {sentence}")

    progress = output.bar(len(questions), shown=not request.quiet, share=0.8)
    finished = _answer_all(request, questions, results, progress, chapter, page.convergence_page, document, show)
    output.print_folder(request)
    return 0 if all(section.complete for section in finished) else INCOMPLETE


def report(request: Request, sizes: tuple[int, ...], without: tuple[str, ...]) -> None:
    """Write the page of questions with verdicts, errors and run times; finished parts are taken from the folder."""
    request = replace(request, arguments=request.arguments or ("all",))
    questions = request.questions()
    request = request.with_room("full-report")
    assert request.out is not None
    counts = () if "convergence" in without else sizes
    parts = Parts(request.choices, counts, "times" not in without, request.exact)
    found = Report(request.out, questions, parts, request.solvers, provenance.page_origin())
    missing, names = found.missing(), tuple(question.name for question in questions)
    with (
        run_into(request.out, request.solvers, names, request.processes) as run,
        output.bar(len(missing), shown=not request.quiet) as progress,
    ):
        pending = _begin(request, missing, run, 0)
        for place, question in enumerate(progress.through(missing)):
            content = found.content_of(question, pending, run)
            # solve the next case during the drawings, but not during the measurement of run times
            pending = _begin(request, missing, run, place + 1)
            found.add(question, *content)
        found.add_table()
    if request.json_file is not None:
        output.write_json(request.json_file, found.document())
    for chapter in found.chapters.values() if request.prints else ():
        click.echo(f"{chapter.name}: {chapter.word}. {chapter.sentence}")
    output.print_folder(request)


def _answer_all(
    request: Request,
    questions: Sequence[Question],
    results: Callable[[Run, output.Bar], Iterator[Result]],
    progress: AbstractContextManager[output.Bar],
    chapter_of: Callable[[Path, Question, Result], page.Chapter],
    page_of: Callable[[Sequence[page.Chapter]], page.Page],
    document_of: Callable[[Sequence[Result]], Plain],
    show: Callable[[Question, Result], None],
) -> list[Result]:
    """Results of all questions; page and JSON stand after every result, and JSON on standard output at the end.

    Args:
        request: files, folder and solvers.
        questions: in order.
        results: results in the same order, for a run into the folder and a bar.
        progress: context with the bar.
        chapter_of: writes the files of a result into the folder; the chapter of the page.
        page_of: page of all chapters.
        document_of: JSON of all results.
        show: prints a result.
    """
    out, finished, chapters = request.out, list[Result](), list[page.Chapter]()
    names = tuple(question.name for question in questions)
    with run_into(out, request.solvers, names, request.processes) as run, progress as shown:
        for question, result in zip(questions, results(run, shown), strict=True):
            finished.append(result)
            if out is not None:
                chapters.append(chapter_of(out, question, result))
            run.mark_shown(question.name)
            whole = run.covers(names[: len(finished)])
            if whole and out is not None:
                page.put_page(out, page_of(chapters))
            if whole and request.prints:
                output.write_json(request.json_file, document_of(finished))
            shown.clear()
            if request.prints:
                show(question, result)
    if not request.prints:
        output.write_json(request.json_file, document_of(finished))
    return finished
