"""``cprbm compare``, ``converge``, ``report``, ``bench`` and ``study``: results one by one, as tables, JSON and a page.

After every result the page and the JSON file are whole: an interrupted command leaves all finished work.
"""

import shlex
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Literal, TypeVar

import click

from comparisons import case, cases, logs, pairing, provenance
from comparisons.bench import measures, running
from comparisons.bench.section import bench_section, pictures, size_text
from comparisons.case import Comparison
from comparisons.choices import Count, check_counts
from comparisons.cli import output
from comparisons.cli.commands import load_tool
from comparisons.cli.errors import code_of
from comparisons.cli.main import OPTIMISERS
from comparisons.present import brief, csv_table, figures, page
from comparisons.present.columns import Figure, Plain, Section
from comparisons.present.offset import Compared, compared_offset
from comparisons.store import Run, run_into
from comparisons.studies import calibration, convergence, table1
from comparisons.studies.report import Report
from comparisons.tolerances import runs_within
from comparisons.verdict import Word
from comparisons.writing import write
from cprbm_scene import OffsetQuestion, Question, frozendict

Study = TypeVar("Study")
Step = TypeVar("Step")


def compare_all(request: output.Request) -> int:
    """Compare both solvers on questions; the exit code.

    0 if all agree; 1 if any case differs or a solve did not complete; 3 if no case is worse than undecided.  An
    uncertainty above the requested tolerance counts as undecided.
    """
    questions = request.questions()
    request = request.with_room("report" if "all" in request.arguments else "")
    # with a tolerance a status line with N replaces the bar
    progress = output.bar(len(questions), shown=not request.quiet and request.tol is None, noun="case")
    finished = list[Compared]()
    with _run(request, questions) as run, progress as shown:
        publish = _publisher(request, run, page.report_page)
        for question in shown.through(questions):
            compared = _compared(request, run, question)
            finished.append(compared)
            publish(page.document_of(compared), partial(page.put_case, compared=compared))
            shown.clear()
            if request.prints:
                _show(request, compared)
    _export(request, [found for found in finished if isinstance(found, Comparison)])
    if request.prints and not request.quiet and len(finished) > 1:
        output.print_tables([brief.summary(finished)], brief.WIDTH)
    output.print_folder(request)
    verdicts = [found.verdict for found in finished]
    return code_of(
        incomplete=any(verdict.word is Word.DIFFER or not verdict.completed for verdict in verdicts),
        undecided=any(verdict.word is Word.UNDECIDED for verdict in verdicts) or any(map(_failed_searches, finished)),
    )


def _compared(request: output.Request, run: Run, question: Question) -> Compared:
    """The comparison of a question, within the tolerance if the request has any."""
    if isinstance(question, OffsetQuestion):
        return compared_offset(question, run.solvers.offset)
    if request.tol is not None:
        with output.status(shown=not request.quiet) as say:
            runs, searches = runs_within(question, request.choices, request.tol, run.solvers, run.crew, say)
        return replace(case.compare(runs), tolerances=searches)
    return case.compare(pairing.paired(question, request.choices, run.solvers, run.crew))


def _run(request: output.Request, questions: Sequence[Question]) -> AbstractContextManager[Run]:
    """Context with the run of the questions into the folder of the request."""
    return run_into(request.out, request.solvers, tuple(each.name for each in questions), request.processes)


def _publisher(
    request: output.Request,
    run: Run,
    page_of: Callable[[Sequence[page.Chapter]], page.Page],
    *,
    single: bool = False,
) -> Callable[[Plain, Callable[[Path], page.Chapter]], None]:
    """Function that publishes a finished question by its JSON, and by a function that writes files into a folder.

    Page and JSON are whole after every question, unless they would replace a page or a file with more questions.

    Args:
        request: of the command; run: of the questions.
        page_of: page of the chapters that the functions with a folder return.
        single: whether the JSON of a single question stands alone.
    """
    documents, chapters = list[Plain](), list[page.Chapter]()

    def publish(document: Plain, put: Callable[[Path], page.Chapter]) -> None:
        documents.append(document)
        if request.out is not None:
            chapters.append(put(request.out))
        if run.may_show(run.names[: len(documents)]):
            if request.out is not None:
                page.put_page(request.out, page_of(chapters))
            data = document if single and len(run.names) == 1 else {"cases": documents}
            output.write_json(request.json_file, data, finished=len(documents) == len(run.names))

    return publish


def _show(request: output.Request, compared: Compared) -> None:
    """Print a case: in brief, with ``-v`` with all tables, or quietly with the verdict alone."""
    if not request.quiet and not logs.level():
        values = [text for name, value in request.values.items() for text in ("--set", f"{name}={value}")]
        argument = shlex.join([cases.argument(compared.question), *values])
        click.echo(brief.brief(compared, argument, request.out, output.screen_width()) + "\n")
        return
    if not request.quiet:
        for section in page.sections_of(compared):
            output.print_section(section)
    click.echo(brief.headline(compared.question.name, compared.verdict, compared.verdict.sentence))
    for sentence in _failed_searches(compared):
        click.echo(f"{compared.question.name}: {sentence}")


def _failed_searches(compared: Compared) -> list[str]:
    """Sentences on searches for N without success."""
    if not isinstance(compared, Comparison):
        return []
    return [search.sentence(compared.scene) for search in compared.tolerances if not search.met]


def _export(request: output.Request, compared: Sequence[Comparison]) -> None:
    """Write the table and the drawing of all comparisons; without common stations standard error reports the reason."""
    if request.csv_file is not None:
        write(request.csv_file, csv_table.csv_of_comparisons(compared))
    if request.plot_file is not None and compared and all(each.rows for each in compared):
        figures.designs_figure(compared).save(request.plot_file)
    elif request.plot_file is not None:
        click.echo(f"cprbm: {request.plot_file} is not drawn: a case has no station of both solvers.", err=True)


def converge_all(request: output.Request, sizes: tuple[int, ...]) -> int:
    """State limits and orders of all numbers of questions; exit code 1 for an incomplete series."""
    questions = request.questions()
    request = request.with_room("convergence" if "all" in request.arguments else "")
    complete = True
    with _run(request, questions) as run, output.bar(len(questions), shown=not request.quiet) as shown:
        publish = _publisher(request, run, partial(page.Page, *convergence.TITLE), single=True)
        for question in shown.through(questions):
            section = convergence.convergence_section(question, sizes, request.choices, run.solvers, run.crew)
            complete = complete and section.complete
            publish(dict(section.data), partial(page.put_chapter, question=question, section=section))
            shown.clear()
            if request.prints:
                output.print_tables(() if request.quiet else section.tables)
                for sentence in section.sentences:
                    click.echo(f"{question.name}: {sentence}")
    output.print_folder(request)
    return code_of(incomplete=not complete)


def report(request: output.Request, sizes: tuple[int, ...], without: tuple[str, ...]) -> None:
    """Write the page of questions with verdicts, errors and run times; finished parts are taken from the folder."""
    request = replace(request, arguments=request.arguments or ("all",))
    questions = request.questions()
    request = request.with_room("full-report")
    assert request.out is not None
    found = Report(
        request.out,
        questions,
        request.choices,
        sizes=() if "convergence" in without else sizes,
        times="times" not in without,
        exact=request.exact,
        timed=request.solvers,
        origin=provenance.page_origin(),
    )
    missing = found.missing()
    with _run(request, questions) as run, output.bar(len(missing), shown=not request.quiet) as progress:
        for question in progress.through(missing):
            found.add(question, _compared(request, run, question), tuple(found.further_sections(question, run)))
        found.add_table()
    output.write_json(request.json_file, found.document() if request.json_file else {})
    for chapter in found.chapters.values() if request.prints else ():
        click.echo(f"{chapter.name}: {chapter.word}. {chapter.sentence}")
    output.print_folder(request)


def bench(
    request: output.Request,
    sizes: tuple[int, ...] | None,
    numbers: tuple[Count, ...],
    methods: tuple[str, ...],
    stations: Literal["last", "all"],
    repeat: int,
    clock: running.Clock,
) -> int:
    """Time the methods on a scene; exit code 1 for an incomplete run of a solver of this project.

    Raises:
        click.UsageError: sizes are stated twice, or no method is possible.
    """
    if sizes is not None and numbers:
        raise click.UsageError("found --sizes and -n; allowed: one of them.")
    opened, whole = request.scene().model_copy(update={"theory": "bending"}), stations == "all"
    counts = tuple(n if isinstance(n, int) else frozendict(n) for n in numbers) or (sizes or ())
    for n in counts:
        check_counts(replace(request.choices, links=n), opened)
    wanted = methods or (*running.OURS, *OPTIMISERS)
    asked = [each for each in running.contenders(request.solvers, request.choices) if each.name in wanted]
    asked += [load_tool(f"bench --method {name}").contender() for name in OPTIMISERS if name in wanted]
    last_only = {each.name: "an optimiser solves the last station only" for each in asked if whole and each.is_peer}
    absent = {each.name: each.absence for each in asked if each.absence} | last_only
    taking = tuple(each for each in asked if each.name not in absent)
    if not taking:
        reasons = "; ".join(f"{name}: {reason}" for name, reason in absent.items())
        raise click.UsageError(f"No method is left: {reasons}.")
    question = measures.benchmark_scene(opened)
    request = request.with_room()
    if request.out is not None:
        request = replace(request, out=page.own_folder(request.out, opened.name))
    with output.status(shown=not request.quiet) as say:
        say("reference of the errors")
        known = measures.reference(question, request.solvers)
    session = running.Session(
        opened if whole else question,
        provenance.machine(),
        {each: running.sizes_of(each, counts) for each in taking},
        reference=known,
        kinematics=request.choices.kinematics_of(opened),
        repeat=repeat,
        at_most=request.at_most,
        whole=whole,
        clock=clock,
        absent=absent,
    )
    take_steps(request, session, session.jobs(), running.Session.do, bench_section, pictures)
    failed = [row for row in session.rows() if row.contender.name in running.OURS and not row.outcome.completed]
    for row in failed:
        who = f"{row.contender.label} at N = {size_text(row.count)}"
        click.echo(f"cprbm: {opened.name}: {who}: {row.outcome.why}", err=True)
    return code_of(incomplete=bool(failed))


def study_calibration(request: output.Request) -> int:
    """Compare stated with true errors; exit code 1 for a case that differs or did not complete."""
    request = request.with_room()
    with run_into(request.out, request.solvers, processes=request.processes) as run:
        found = take_steps(
            request,
            calibration.Calibration(),
            [cases.opened(name) for name in cases.scenes()],
            partial(calibration.with_case, solvers=run.solvers, crew=run.crew),
            calibration.result_of,
            calibration.pictures,
        )
    verdicts = [trial.verdict for trial in found.trials]
    return code_of(incomplete=any(each.word is Word.DIFFER or not each.completed for each in verdicts))


def study_table1(request: output.Request, repeat: int) -> int:
    """Time both solvers on the cells of the paper's Table 1; exit code 1 for an incomplete solve."""
    request = request.with_room()
    session = table1.session(request.solvers, provenance.machine(), repeat, request.at_most)
    take_steps(request, session, session.jobs(), running.Session.do, table1.result_of, table1.pictures)
    return code_of(incomplete=not table1.result_of(session).complete)


def take_steps(
    request: output.Request,
    study: Study,
    steps: Sequence[Step],
    take: Callable[[Study, Step], Study],
    section_of: Callable[[Study], Section],
    figures_of: Callable[[Study], tuple[Figure, ...]] = lambda study: (),
) -> Study:
    """The finished study: every step writes numbers and tables, and the end or an interruption also the figures."""
    with output.bar(len(steps), shown=not request.quiet) as progress:
        try:
            for step in progress.through(steps):
                study = take(study, step)
                if request.out is not None or request.json_file is not None:
                    _write_files(request, section_of(study), finished=False)
        finally:
            section = replace(section_of(study), figures=figures_of(study))
            progress.clear()
            _write_files(request, section, finished=True)
            if request.prints and not request.quiet:
                output.print_section(section)
                output.print_folder(request, f"{section.name}.html")
    return study


def _write_files(request: output.Request, section: Section, *, finished: bool) -> None:
    """Write the page, the figures and the JSON of a section."""
    output.write_json(request.json_file, dict(section.data), finished=finished)
    if request.out is not None:
        page.put_section(request.out, section)
        page.put_page(request.out, page.Page(section.heading, "", further=(section,)), section.name)
