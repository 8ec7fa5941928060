"""The fastest method at an error, ratios of times, and growth of times, from the rows of a benchmark that count.

A method reaches an error at a size if the errors at this size and at all larger sizes are no larger.  Its time lies on
the straight line between this size and the size before, in the logarithms of error and time; without a size before, the
time is the time of the size.  All results are records of the documented JSON.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from comparisons.bench.contenders import Clocked
from comparisons.bench.measures import MEASURES, Measure
from comparisons.bench.running import Session, trend
from comparisons.writing import Plain, plain

TARGETS = (1e-2, 1e-3, 1e-4)
CLOCKED: tuple[Clocked, ...] = ("both", "solve")
UNTIMED = ("slsqp_both", "ipopt_both", "ipopt_solve")
"""Ratios of methods that take no part: None."""


def standings(measured: Session) -> list[Plain]:
    """``fastest``: for each measure with errors, by both clocks, at every target."""
    known = [name for name in MEASURES if any(name in timing.errors for timing in measured.rows())]
    return [
        _standing(measured, measure, clocked, target) for measure in known for clocked in CLOCKED for target in TARGETS
    ]


def _standing(measured: Session, measure: Measure, clocked: Clocked, target: float) -> Plain:
    """Seconds by method that reaches the error, the fastest, and the quotient of the second and the first time."""
    seconds = dict[str, float]()
    for contender in measured.methods():
        counted = [row for row in measured.rows(contender.name) if row.counts and measure in row.errors]
        found = seconds_at([(row.errors[measure], row.median(clocked)) for row in counted], target)
        if found is not None:
            seconds[contender.name] = found
    first, second, *_ = (*sorted(seconds.values()), 0.0, 0.0)
    return {
        "measure": measure,
        "error": target,
        "clocked": clocked,
        "fastest": min(seconds, key=lambda name: seconds[name], default=None),
        "ahead": second / first if first and second else None,
        "seconds": seconds,
    }


def seconds_at(points: Sequence[tuple[float, float]], target: float) -> float | None:
    """Seconds from which the error is at most the ``target``, of (error, seconds) by ascending size; or None."""
    first = max((place + 1 for place, (error, _) in enumerate(points) if error > target), default=0)
    if first == len(points):
        return None
    (error, seconds), (before, quick) = points[first], points[max(first - 1, 0)]
    if first == 0 or min(error, seconds, quick) <= 0.0:
        return seconds
    share = math.log(before / target) / math.log(before / error)
    return math.exp(math.log(quick) + share * math.log(seconds / quick))


def ratios(measured: Session) -> list[Plain]:
    """``ratios``: times over the time of the CPRBM in ``paper``, at every size with another method.

    A row that does not count has None.
    """
    found = []
    for ours in (row for row in measured.rows("paper") if row.counts):
        rows = {row.contender.name: row for row in measured.rows() if row.count == ours.count and row.counts}
        record: Plain = {"n": plain(ours.count), **dict.fromkeys(UNTIMED)}
        for method in measured.methods():
            for clocked in method.ratios:
                mine, theirs = ours.median(clocked), rows.get(method.name)
                record[ratio_key(method.name, clocked)] = theirs.median(clocked) / mine if theirs and mine else None
        if rows.keys() - {"paper", "fea"}:
            found.append({**record, "iterations_per_station": ours.iterations_per_station})
    return found


def ratio_key(name: str, clocked: Clocked) -> str:
    """Key of a ratio in the JSON."""
    return f"{name.replace('-', '_')}_{clocked}"


def trends(measured: Session) -> list[Plain]:
    """``trends``: growth of time and iterations of every method."""
    omitted = [(one.name, plain(one.count)) for one in measured.omissions()]
    found = {contender: trend(measured.rows(contender.name)) for contender in measured.methods()}
    return [
        {
            "method": contender.method,
            "formulation": contender.formulation,
            "n": [plain(n) for n in sizes],
            "exponent": exponent,
            "iterations_ratio": iterations,
            "left_out": [count for name, count in omitted if name == contender.name],
        }
        for contender, (sizes, exponent, iterations) in found.items()
    ]
