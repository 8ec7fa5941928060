"""``cprbm bench`` and ``study``: run times and calibration, with output after every step."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Literal

import click

from comparisons import provenance, workshop
from comparisons.bench import contenders, measures, running
from comparisons.bench.contenders import OURS
from comparisons.bench.section import bench_section
from comparisons.bench.tables import size_text
from comparisons.choices import Count, check
from comparisons.cli import bars, pipeline
from comparisons.cli.declarations import OPTIMISERS
from comparisons.cli.errors import INCOMPLETE
from comparisons.cli.request import Request
from comparisons.present.page import own_folder
from comparisons.store import run_into
from comparisons.studies import calibration as calibrations
from comparisons.studies import table1 as timings
from comparisons.verdict import Word
from cprbm_scene.frozendict import frozendict

Session = running.Session


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
        *(each for each in contenders.contenders(request.solvers, request.choices) if each.name in (methods or OURS)),
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
    with bars.status(shown=not request.quiet) as say:
        say("reference of the errors")
        known = measures.reference(question, request.solvers)
    session = Session(opened if whole else question, plan, taking, provenance.machine(), known, absent)
    pipeline.take_steps(request, session, session.jobs(), Session.do, bench_section)
    failed = [row for row in session.rows() if row.contender.name in OURS and not row.outcome.completed]
    for row in failed:
        who = f"{row.contender.label} at N = {size_text(row.count)}"
        click.echo(f"cprbm: {opened.name}: {who}: {row.outcome.why}", err=True)
    return INCOMPLETE if failed else 0


def _absence(contender: contenders.Contender, *, whole: bool) -> str:
    """Reason against a method; empty for a possible method."""
    alone = whole and contender.is_peer
    return "an optimiser solves the last station only" if alone else contender.absence


def calibration(request: Request) -> int:
    """Compare stated with true errors; exit code 1 for a case that differs or did not complete."""
    request = request.with_room()
    with run_into(request.out, request.solvers, processes=request.processes) as run:
        take = partial(calibrations.with_case, solvers=run.solvers, crew=run.crew)
        found = pipeline.take_steps(
            request, calibrations.Calibration(), calibrations.pieces(), take, calibrations.result_of
        )
    verdicts = [trial.verdict for trial in found.trials]
    return INCOMPLETE if any(each.word is Word.DIFFER or not each.completed for each in verdicts) else 0


def table1(request: Request, repeat: int) -> int:
    """Time both solvers on the cells of the paper's Table 1; exit code 1 for an incomplete solve."""
    request = request.with_room()
    session = timings.session(request.solvers, provenance.machine(), repeat, request.at_most)
    pipeline.take_steps(request, session, session.jobs(), Session.do, timings.result_of)
    return 0 if timings.result_of(session).complete else INCOMPLETE
