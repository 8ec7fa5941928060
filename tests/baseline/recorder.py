"""Making a record: every run in a process of its own, on all cores, with a limit of processor time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

from tests.baseline import record
from tests.baseline.measuring import Entry, Program, heading, measure
from tests.baseline.runs import Run
from tests.robustness.limited import Calls, Crashed, Limits, OutOfTime, Returned, calls_of

SECONDS = 60.0
"""Limit of processor time for a run of a random scene: no user waits longer for an answer."""

SECONDS_BUILT_IN = 300.0
"""The same for a built-in case: a record of these is whole, and the longest comparison takes more than a minute."""


def record_runs(
    folder: Path, about: record.About, runs: Sequence[Run], program: Program, workers: int
) -> Iterator[Entry]:
    """Every new entry, after the folder holds the entry.

    Raises:
        RecordError: the folder holds another record.
        OSError: the folder cannot be written.
    """
    present = record.start(folder, about)
    missing = [run for run in runs if run.name not in present]
    if not missing:
        return
    with calls_of(workers, partial(load, program)) as calls:
        for built_in, seconds in ((True, SECONDS_BUILT_IN), (False, SECONDS)):
            mine = [run for run in missing if (run.scene in about.built_in) == built_in]
            yield from _ended(folder, calls, mine, program, Limits(seconds))


def _ended(folder: Path, calls: Calls, runs: Sequence[Run], program: Program, limits: Limits) -> Iterator[Entry]:
    """The entries of ``runs`` in the order of their ends, each in the folder before the next."""
    for run, end in calls.each(partial(measure, program=program), runs, limits):
        match end:
            case Returned(entry):
                pass
            case Crashed(sentence):
                entry = _without_answer(run, "crashed", sentence)
            case OutOfTime(sentence):
                entry = _without_answer(run, "out of time", sentence)
        record.add(folder, entry)
        yield entry


def load(program: Program) -> None:
    """Load both solvers by a small case: the time of loading counts in no run."""
    for solver in ("cprbm", "fea"):
        measure(Run("tapered", solver, 10), program)


def _without_answer(run: Run, outcome: str, sentence: str) -> Entry:
    return {**heading(run), "outcome": outcome, "sentence": sentence, "seconds": None}
