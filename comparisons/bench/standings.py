"""Who is fastest at an error, and by how much: from the rows of a benchmark that count.

A method reaches an error from the first of its sizes on from which no larger one has a larger error than that.  Its
time there is read off the straight line, in the logarithms of error and time, between that size and the one before;
where there is none before, it is that of the size itself.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from comparisons.bench.contenders import Clocked, Name
from comparisons.bench.question import MEASURES, Measure
from comparisons.bench.running import Benchmark, Timing
from comparisons.choices import Count
from cprbm_scene.frozendict import frozendict

TARGETS = (1e-2, 1e-3, 1e-4)
CLOCKED: tuple[Clocked, ...] = ("both", "solve")


@dataclass(frozen=True, slots=True)
class Standing:
    """Seconds by method at one error, of those that reach it; ``clocked`` is set-up and solve, or the solve alone."""

    measure: Measure
    target: float
    clocked: Clocked
    seconds: Mapping[Name, float]

    @property
    def fastest(self) -> Name | None:
        """Who is; None where nobody reaches it."""
        return min(self.seconds, key=lambda name: self.seconds[name], default=None)

    @property
    def ahead(self) -> float | None:
        """The next one's seconds over the fastest one's; None where there is no next."""
        ordered = sorted(self.seconds.values())
        return ordered[1] / ordered[0] if len(ordered) > 1 and ordered[0] > 0.0 else None


@dataclass(frozen=True, slots=True)
class Ratios:
    """At one size, how many times longer others take than the CPRBM in ``paper``; None where a row does not count.

    Attributes:
        of: time over ours, by the method and by what is on the clock.
        iterations: of ours, per station.
    """

    count: Count
    of: Mapping[tuple[Name, Clocked], float | None]
    iterations: float | None


def standings(measured: Benchmark) -> tuple[Standing, ...]:
    """For each measure that has errors: every target, by both clocks."""
    return tuple(
        Standing(measure, target, clocked, _by_name(measured, measure, target, clocked))
        for measure in MEASURES
        if any(measure in timing.errors for timing in measured.timings)
        for clocked in CLOCKED
        for target in TARGETS
    )


def ratios(measured: Benchmark) -> tuple[Ratios, ...]:
    """At every size at which the CPRBM's ``paper`` counts and another method of the same links has a row."""
    found = []
    for ours in measured.of("paper"):
        others = {one.contender.name: one for one in measured.timings if one.count == ours.count and one.counts}
        if not ours.counts or not others.keys() - {"paper", "fea"}:
            continue
        of = {
            (method.name, clocked): _over(others.get(method.name), ours, clocked)
            for method in measured.contenders
            for clocked in method.ratios
        }
        found.append(Ratios(ours.count, frozendict(of), ours.iterations_per_station))
    return tuple(found)


def _over(other: Timing | None, ours: Timing, clocked: Clocked) -> float | None:
    """The other's time over ours; None where either has none."""
    if other is None:
        return None
    theirs, mine = (other.solve, ours.solve) if clocked == "solve" else (other.total, ours.total)
    return theirs / mine if mine > 0.0 else None


def reached(points: Sequence[tuple[float, float]], target: float) -> float | None:
    """Seconds from which the error is at most the ``target``, of (error, seconds) by ascending size; or None."""
    first = len(points)
    while first > 0 and points[first - 1][0] <= target:
        first -= 1
    if first == len(points):
        return None
    error, seconds = points[first]
    if first == 0 or error <= 0.0 or seconds <= 0.0 or points[first - 1][1] <= 0.0:
        return seconds
    before, quick = points[first - 1]
    share = math.log(before / target) / math.log(before / error)
    return math.exp(math.log(quick) + share * math.log(seconds / quick))


def _by_name(measured: Benchmark, measure: Measure, target: float, clocked: Clocked) -> Mapping[Name, float]:
    found: dict[Name, float] = {}
    for contender in measured.contenders:
        counted = [one for one in measured.of(contender.name) if one.counts and measure in one.errors]
        points = [(one.errors[measure], one.solve if clocked == "solve" else one.total) for one in counted]
        seconds = reached(points, target)
        if seconds is not None:
            found[contender.name] = seconds
    return frozendict(found)
