"""Results of questions, or steps of a study, with growing output.

After every result the page and the JSON file are whole: an interrupted command leaves all finished work.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TypeVar

import click

from comparisons.cli.bars import Bar, bar
from comparisons.cli.output import print_section, write_json
from comparisons.cli.request import Request
from comparisons.present.columns import Section
from comparisons.present.page import Chapter, Page, put_page, put_section
from comparisons.store import Run, run_into
from comparisons.writing import Plain
from cprbm_scene import Question

Result = TypeVar("Result")
Study = TypeVar("Study")
Step = TypeVar("Step")


def answer_all(
    request: Request,
    questions: Sequence[Question],
    results: Callable[[Run, Bar], Iterator[Result]],
    progress: AbstractContextManager[Bar],
    chapter_of: Callable[[Path, Question, Result], Chapter],
    page_of: Callable[[Sequence[Chapter]], Page],
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
    out, finished, chapters = request.out, list[Result](), list[Chapter]()
    names = tuple(question.name for question in questions)
    with run_into(out, request.solvers, names, request.processes) as run, progress as shown:
        for question, result in zip(questions, results(run, shown), strict=True):
            finished.append(result)
            if out is not None:
                chapters.append(chapter_of(out, question, result))
            run.mark_shown(question.name)
            whole = run.covers(names[: len(finished)])
            if whole and out is not None:
                put_page(out, page_of(chapters))
            if whole and request.prints:
                write_json(request.json_file, document_of(finished))
            shown.clear()
            if request.prints:
                show(question, result)
    if not request.prints:
        write_json(request.json_file, document_of(finished))
    return finished


def print_folder(request: Request, file: str = "index.html") -> None:
    """Print the place of the page, if a page was written and standard output is for people."""
    if request.out is not None and request.prints and not request.quiet:
        click.echo(f"report: {request.out / file}")


def take_steps(
    request: Request,
    study: Study,
    steps: Sequence[Step],
    take: Callable[[Study, Step], Study],
    section_of: Callable[[Study], Section],
) -> Study:
    """The finished study; every step writes the partial section, and an interrupted study shows its section."""
    written: Section | None = None
    with bar(len(steps), shown=not request.quiet) as progress:
        try:
            for step in progress.through(steps):
                study, written = take(study, step), None
                if request.out is not None or (request.json_file is not None and request.prints):
                    written = _write_files(request, section_of(study))
        finally:
            section = written or _write_files(request, section_of(study))
            progress.clear()
            if not request.prints:
                write_json(request.json_file, dict(section.data))
            elif not request.quiet:
                print_section(section)
                print_folder(request, f"{section.name}.html")
    return study


def _write_files(request: Request, section: Section) -> Section:
    """The section, whose files are written now."""
    if request.prints:
        write_json(request.json_file, dict(section.data))
    if request.out is not None:
        put_section(request.out, section)
        put_page(request.out, Page(section.heading, "", further=(section,)), section.name)
    return section
