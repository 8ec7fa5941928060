"""The output of ``compare``: a line for every class of change, the failing numbers, and ratios of effort."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import median

from tests.baseline.accepted import Accepted
from tests.baseline.changes import FAILING, Change, Finding
from tests.baseline.record import Record

MOST_NAMES = 12
LEAST_SECONDS = 0.01
"""Of the processor: a shorter run is timed too coarsely to count in the median of ratios."""


def failing(findings: Sequence[Finding], accepted: Accepted) -> list[Finding]:
    """Findings of a failing class without an accepted reason."""
    return [finding for finding in findings if finding.change in FAILING and not accepted.reason(finding)]


def lines(old: Record, new: Record, findings: Sequence[Finding], accepted: Accepted) -> Iterator[str]:
    """The lines on the screen."""
    for change in Change:
        names = [finding.run for finding in findings if finding.change is change]
        listed = "" if change is Change.SAME or not names else f": {_listed(names)}"
        yield f"{change.value:<36} {len(names):5}{listed}"
    added = sorted(set(new.entries) - set(old.entries))
    if added:
        yield f"{'only in the new record':<36} {len(added):5}: {_listed(added)}"
    yield from _effort(old, new)
    for finding in findings:
        if finding.change in FAILING:
            reason = accepted.reason(finding)
            verdict = f" (accepted: {reason})" if reason else ""
            yield f"{finding.change.value}: {finding.run}: {finding.sentence}{verdict}"
    for (scene, change), _ in accepted.changes.items():
        if not any((finding.scene, finding.change) == (scene, change) for finding in findings):
            yield f"accepted without need: {scene}: {change.value}; take the entry away"


def _listed(names: Sequence[str]) -> str:
    rest = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(names[:MOST_NAMES]) + rest


def _effort(old: Record, new: Record) -> Iterator[str]:
    """Seconds and iterations, new over old, of the runs with an answer in both records: sums and median."""
    for solver in ("cprbm", "fea", "comparison"):
        pairs = [
            (before, new.entries[name])
            for name, before in old.entries.items()
            if before["solver"] == solver and before["outcome"] == "answered"
            if name in new.entries and new.entries[name]["outcome"] == "answered"
        ]
        if not pairs:
            continue
        seconds = [(before["seconds"], after["seconds"]) for before, after in pairs]
        steps = [(before["iterations"], after["iterations"]) for before, after in pairs]
        shares = [now / was for was, now in seconds if was >= LEAST_SECONDS]
        middle = f", median of the runs {median(shares):.2f}" if shares else ""
        yield (
            f"{solver}: {len(pairs)} answers; seconds {_ratio(seconds)}{middle}; iterations {_ratio(steps)} "
            f"({sum(now for _, now in seconds):.0f} s, {sum(now for _, now in steps)} iterations)"
        )


def _ratio(pairs: Sequence[tuple[float, float]]) -> str:
    before, after = (sum(column) for column in zip(*pairs, strict=True))
    return f"{after / before:.3f}" if before else "-"
