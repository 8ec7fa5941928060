"""The fastest method at an error, and times over the time of the CPRBM, from the rows of a benchmark that count.

A method reaches an error at a size if the errors at this size and at all larger sizes are no larger.  Its time lies on
the straight line between this size and the size before, in the logarithms of error and time; without a size before, the
time is that of the size.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from comparisons.bench.contenders import Clocked, Name
from comparisons.bench.question import MEASURES, Measure
from comparisons.bench.running import Benchmark
from comparisons.plain import Plain, plain
from cprbm_scene.frozendict import frozendict

TARGETS = (1e-2, 1e-3, 1e-4)
CLOCKED: tuple[Clocked, ...] = ("both", "solve")


@dataclass(frozen=True, slots=True)
class Standing:
    """Seconds by method at an ``error``, of all methods that reach it.

    Attributes:
        clocked: set-up and solve, or the solve alone.
        fastest: name of the fastest method; None without a method.
        ahead: seconds of the next method over the seconds of the fastest; None without a next method.
    """

    measure: Measure
    error: float
    clocked: Clocked
    fastest: Name | None
    ahead: float | None
    seconds: Mapping[Name, float]


def standings(measured: Benchmark) -> tuple[Standing, ...]:
    """Standings for each measure with errors: by both clocks, at every target."""
    known = [name for name in MEASURES if any(name in timing.errors for timing in measured.timings)]
    return tuple(
        _standing(measured, measure, clocked, target) for measure in known for clocked in CLOCKED for target in TARGETS
    )


def _standing(measured: Benchmark, measure: Measure, clocked: Clocked, target: float) -> Standing:
    seconds = dict[Name, float]()
    for contender in measured.contenders:
        counted = [one for one in measured.of(contender.name) if one.counts and measure in one.errors]
        found = reached([(one.errors[measure], one.median(clocked)) for one in counted], target)
        if found is not None:
            seconds[contender.name] = found
    first, second, *_ = (*sorted(seconds.values()), 0.0, 0.0)
    fastest = min(seconds, key=lambda name: seconds[name], default=None)
    return Standing(
        measure, target, clocked, fastest, second / first if first and second else None, frozendict(seconds)
    )


def reached(points: Sequence[tuple[float, float]], target: float) -> float | None:
    """Seconds from which the error is at most the ``target``, of (error, seconds) by ascending size; or None."""
    first = max((place + 1 for place, (error, _) in enumerate(points) if error > target), default=0)
    if first == len(points):
        return None
    (error, seconds), (before, quick) = points[first], points[max(first - 1, 0)]
    if first == 0 or min(error, seconds, quick) <= 0.0:
        return seconds
    share = math.log(before / target) / math.log(before / error)
    return math.exp(math.log(quick) + share * math.log(seconds / quick))


def ratios(measured: Benchmark) -> list[Plain]:
    """Documented JSON of times over the time of the CPRBM in ``paper``, at every size with another method.

    A row that does not count has None.
    """
    found = []
    for ours in (row for row in measured.of("paper") if row.counts):
        rows = {row.contender.name: row for row in measured.timings if row.count == ours.count and row.counts}
        over = {
            ratio_key(method.name, clocked): rows[method.name].median(clocked) / mine
            if method.name in rows and (mine := ours.median(clocked)) > 0.0
            else None
            for method in measured.contenders
            for clocked in method.ratios
        }
        untimed: Plain = dict.fromkeys(("slsqp_both", "ipopt_both", "ipopt_solve"))
        if rows.keys() - {"paper", "fea"}:
            iterations = ours.iterations_per_station
            found.append({"n": plain(ours.count), **untimed, **over, "iterations_per_station": iterations})
    return found


def ratio_key(name: Name, clocked: Clocked) -> str:
    """Key of a ratio in the JSON."""
    return f"{name.replace('-', '_')}_{clocked}"
