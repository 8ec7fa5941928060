"""``cprbm bench`` and ``study``: run times and calibration, with output after every step.

After every step the page and the JSON file are whole: an interrupted command leaves all finished work.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Literal, TypeVar

import click

from comparisons import provenance, workshop
from comparisons.bench import measures, running
from comparisons.bench.running import OURS, Session
from comparisons.bench.section import bench_section, size_text
from comparisons.choices import Count, check
from comparisons.cli import output
from comparisons.cli.errors import INCOMPLETE
from comparisons.cli.main import OPTIMISERS
from comparisons.cli.request import Request
from comparisons.present.columns import Section
from comparisons.present.page import Page, own_folder, put_page, put_section
from comparisons.store import run_into
from comparisons.studies import calibration as calibrations
from comparisons.studies import table1 as timings
from comparisons.verdict import Word
from cprbm_scene.frozendict import frozendict

Study = TypeVar("Study")
Step = TypeVar("Step")


def bench(
    request: Request,
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
    opened, whole = request.scene(), stations == "all"
    counts = tuple(n if isinstance(n, int) else frozendict(n) for n in numbers) or (sizes or ())
    for n in counts:
        check(replace(request.choices, links=n), opened)
    asked = [
        *(each for each in running.contenders(request.solvers, request.choices) if each.name in (methods or OURS)),
        *(
            workshop.load(f"bench --method {name}").contender()
            for name in OPTIMISERS
            if name in (methods or OPTIMISERS)
        ),
    ]
    absent = {each.name: reason for each in asked if (reason := _absence(each, whole=whole))}
    taking = tuple(each for each in asked if each.name not in absent)
    if not taking:
        reasons = "; ".join(f"{name}: {reason}" for name, reason in absent.items())
        raise click.UsageError(f"No method is left: {reasons}.")
    own = {each.name: running.sizes_of(each, counts) for each in taking}
    plan = running.Plan(own, request.choices.kinematics_of(opened), repeat, request.at_most, whole, clock)
    question = measures.benchmark_scene(opened)
    request = request.with_room()
    if request.out is not None:
        request = replace(request, out=own_folder(request.out, opened.name))
    with output.status(shown=not request.quiet) as say:
        say("reference of the errors")
        known = measures.reference(question, request.solvers)
    session = Session(opened if whole else question, plan, taking, provenance.machine(), known, absent)
    take_steps(request, session, session.jobs(), Session.do, bench_section)
    failed = [row for row in session.rows() if row.contender.name in OURS and not row.outcome.completed]
    for row in failed:
        who = f"{row.contender.label} at N = {size_text(row.count)}"
        click.echo(f"cprbm: {opened.name}: {who}: {row.outcome.why}", err=True)
    return INCOMPLETE if failed else 0


def _absence(contender: running.Contender, *, whole: bool) -> str:
    """Reason against a method; empty for a possible method."""
    alone = whole and contender.is_peer
    return "an optimiser solves the last station only" if alone else contender.absence


def calibration(request: Request) -> int:
    """Compare stated with true errors; exit code 1 for a case that differs or did not complete."""
    request = request.with_room()
    with run_into(request.out, request.solvers, processes=request.processes) as run:
        take = partial(calibrations.with_case, solvers=run.solvers, crew=run.crew)
        found = take_steps(request, calibrations.Calibration(), calibrations.pieces(), take, calibrations.result_of)
    verdicts = [trial.verdict for trial in found.trials]
    return INCOMPLETE if any(each.word is Word.DIFFER or not each.completed for each in verdicts) else 0


def table1(request: Request, repeat: int) -> int:
    """Time both solvers on the cells of the paper's Table 1; exit code 1 for an incomplete solve."""
    request = request.with_room()
    session = timings.session(request.solvers, provenance.machine(), repeat, request.at_most)
    take_steps(request, session, session.jobs(), Session.do, timings.result_of)
    return 0 if timings.result_of(session).complete else INCOMPLETE


def take_steps(
    request: Request,
    study: Study,
    steps: Sequence[Step],
    take: Callable[[Study, Step], Study],
    section_of: Callable[[Study], Section],
) -> Study:
    """The finished study; every step writes the partial section, and an interrupted study shows its section."""
    written: Section | None = None
    with output.bar(len(steps), shown=not request.quiet) as progress:
        try:
            for step in progress.through(steps):
                study, written = take(study, step), None
                if request.out is not None or (request.json_file is not None and request.prints):
                    written = _write_files(request, section_of(study))
        finally:
            section = written or _write_files(request, section_of(study))
            progress.clear()
            if not request.prints:
                output.write_json(request.json_file, dict(section.data))
            elif not request.quiet:
                output.print_section(section)
                output.print_folder(request, f"{section.name}.html")
    return study


def _write_files(request: Request, section: Section) -> Section:
    """The section, whose files are written now."""
    if request.prints:
        output.write_json(request.json_file, dict(section.data))
    if request.out is not None:
        put_section(request.out, section)
        put_page(request.out, Page(section.heading, "", further=(section,)), section.name)
    return section
