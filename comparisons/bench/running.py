"""Runs of all methods at all sizes on the clock.

======  ====================================================================================
symbol  meaning
======  ====================================================================================
N       links or elements per beam; their mean where beams have numbers of their own
T       median of the seconds of set-up and solve together
e       of T = a·N^e, fitted by least squares in log T and log N over N ≥ 40
======  ====================================================================================

All runs are made in one process, with BLAS on one thread.  The first run of every method does not count, so that no
time holds an import.  Every repetition goes through all sizes, and at each size through all methods: other work on the
machine then falls on all methods alike.  A run of less than a second is made twice in a row and the second run counts,
since the first fills the processor's caches.  The spread is the distance of the quartiles.

The clock times the set-up, from the scene (of a peer: from the discretised problem), and the solve, up to the certified
answer (of a peer: up to its end).  A size is not repeated after runs with a sum above the plan's ``at_most``.  After a
single run of that length no larger size of the method begins; a peer's solve ends after as many processor seconds.
"""

from __future__ import annotations

import gc
import math
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from comparisons.bench.contenders import Clocked, Contender, Outcome, mean
from comparisons.bench.measures import NOTHING, Measure, Reference, errors
from comparisons.choices import Count, Kinematics
from cprbm_scene import Scene, SceneError
from cprbm_scene.frozendict import frozendict
from cprbm_scene.threads import one_thread

SIZES = (10, 20, 40, 80, 160, 320, 640, 1280, 2560, 5120)
FIT_FROM = 40
REHEARSED = 1.0
"""Seconds; of a shorter run the repetition in a row counts."""

NO_WORSE = 1.01
"""Allowed error of a peer over the error of the CPRBM on the same problem: within the digits of a table."""

Clock = Literal["wall", "cpu"]
CLOCKS: Mapping[Clock, Callable[[], float]] = frozendict({"wall": time.perf_counter, "cpu": time.process_time})
"""Elapsed seconds, and seconds of the processor, which other work hardly changes."""

Job = tuple[Contender, Count]
"""A run of a method at a size."""

_EXTENTS = {"set-up": slice(0, 1), "solve": slice(1, 2), "both": slice(0, 2)}


@dataclass(frozen=True, slots=True)
class Plan:
    """Sizes and repetitions of a benchmark.

    Attributes:
        sizes: numbers of links and elements by method, ascending.
        kinematics: theory of the finite elements.
        repeat: number of solves at each size.
        at_most: seconds, as above.
        whole: True for the whole scene, False for its last loads.
        clock: kind of seconds.
    """

    sizes: Mapping[str, tuple[Count, ...]]
    kinematics: Kinematics = "bending"
    repeat: int = 5
    at_most: float = 30.0
    whole: bool = False
    clock: Clock = "wall"


@dataclass(slots=True)
class Timing:
    """Runs of a method at a size; during a session the runs so far.

    Attributes:
        seconds: of set-up and solve of every run, (k, 2), in order.
        outcome: of the last run, or of the first incomplete run; None without a run.
        refusal: the method's refusal of the question.
        errors: by measure; empty for an incomplete run or without a reference.
        worse: True if the error of a peer is larger than the error of the CPRBM on the same problem.
    """

    contender: Contender
    count: Count
    seconds: list[tuple[float, float]] = field(default_factory=list)
    outcome: Outcome = field(default_factory=lambda: Outcome("", "", (), frozendict()))
    refusal: SceneError | None = None
    errors: Mapping[Measure, float] = frozendict()
    worse: bool = False

    def quartiles(self, clocked: Clocked | Literal["set-up"]) -> tuple[float, float, float]:
        """Lower quartile, median and upper quartile of the set-up, of the solve, or of both together (T), s."""
        low, median, high = np.percentile(np.sum(np.array(self.seconds)[:, _EXTENTS[clocked]], axis=1), (25, 50, 75))
        return float(low), float(median), float(high)

    def median(self, clocked: Clocked | Literal["set-up"]) -> float:
        """Median, s."""
        return self.quartiles(clocked)[1]

    @property
    def n(self) -> float:
        """N."""
        return mean(self.count)

    @property
    def spread(self) -> float:
        """Distance of the quartiles of the solve, s."""
        low, _, high = self.quartiles("solve")
        return high - low

    @property
    def counts(self) -> bool:
        """Whether the row counts: complete, with an error that is no worse."""
        return self.outcome.completed and not self.worse

    @property
    def iterations(self) -> int:
        """Iterations at all stations together."""
        return sum(self.outcome.iterations)

    @property
    def iterations_per_station(self) -> float | None:
        """Mean number of iterations; None without a reached station."""
        return self.iterations / len(self.outcome.iterations) if self.outcome.iterations else None

    @property
    def why(self) -> str:
        """Why the method refuses the question, or why the run is incomplete; else empty."""
        if self.refusal is None:
            return self.outcome.why
        return "; ".join(f"{one.key}: found {one.found}; allowed: {one.allowed}" for one in self.refusal.mistakes)


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A method or a single size without a run, and the reason."""

    name: str
    count: Count | None
    why: str


@dataclass
class Session:
    """A benchmark, also while it runs: :meth:`do` makes a run, all else speaks of the runs so far.

    Attributes:
        scene, plan: the question; contenders: the methods; machine: the machine and the versions.
        clock: seconds.
        reference: of the errors.
        absent: methods that take no part, with reasons.
        timings: by name of the method and count, in the order of the runs.
        largest: by name of a method that has run, N above which no size begins.
    """

    scene: Scene
    plan: Plan
    contenders: tuple[Contender, ...]
    machine: Mapping[str, str | int]
    clock: Callable[[], float]
    reference: Reference = NOTHING
    absent: Mapping[str, str] = frozendict()
    timings: dict[tuple[str, Count], Timing] = field(default_factory=dict)
    largest: dict[str, float] = field(default_factory=dict)

    def jobs(self) -> tuple[Job, ...]:
        """All runs: by repetition, by size, and at each size every method with this size."""
        counts = sorted({count for sizes in self.plan.sizes.values() for count in sizes}, key=mean)
        once = [(each, count) for count in counts for each in self.contenders if count in self.plan.sizes[each.name]]
        return tuple(once * self.plan.repeat)

    def do(self, job: Job) -> Session:
        """This session after a run; no run where the question is refused or takes too long."""
        (contender, count), most = job, self.plan.at_most
        timing = self.timings.setdefault((contender.name, count), Timing(contender, count))
        if timing.refusal or self._is_late(timing) or sum(map(sum, timing.seconds)) > most:
            return self
        try:
            if contender.name not in self.largest:
                self._run(timing)
                self.largest[contender.name] = math.inf
            with one_thread():  # of the libraries that the first run has loaded
                gc.collect()  # the rubbish of earlier runs is not on the clock
                seconds, outcome = self._run(timing)
                if sum(seconds) < REHEARSED:
                    seconds, outcome = self._run(timing)
        except SceneError as error:
            timing.refusal = error
            return self
        if not timing.seconds or timing.outcome.completed:
            timing.outcome, timing.errors = outcome, errors(self.scene, self.reference, outcome.values)
        timing.seconds.append(seconds)
        if sum(seconds) > most:
            self.largest[contender.name] = min(self.largest[contender.name], timing.n)
        return self

    def _is_late(self, timing: Timing) -> bool:
        """Whether a smaller size of the method has taken too long."""
        return timing.n > self.largest.get(timing.contender.name, math.inf)

    def _run(self, timing: Timing) -> tuple[tuple[float, float], Outcome]:
        run = timing.contender.begin(self.scene, timing.count, self.plan.at_most)
        begin = self.clock()
        solve = run.set_up()
        ready = self.clock()
        result = solve()
        end = self.clock()
        return (ready - begin, end - ready), run.outcome(result)

    def rows(self, name: str = "") -> tuple[Timing, ...]:
        """The timings of all methods, or of the method of a ``name``, by method and ascending N.

        Raises:
            SceneError: every method has refused the question.
        """
        found = [timing for timing in self._in_order() if timing.seconds]
        refusals = [timing.refusal for timing in self.timings.values() if timing.refusal]
        if refusals and not found:
            raise refusals[0]
        ours = {row.count: row.errors for row in found if row.contender.name == "paper" and row.counts}
        for row in (row for row in found if row.contender.is_peer):
            limits = ours.get(row.count, {})
            row.worse = any(row.errors.get(key, 0.0) > NO_WORSE * off for key, off in limits.items())
        return tuple(row for row in found if name in ("", row.contender.name))

    def left_out(self) -> tuple[LeftOut, ...]:
        """Methods and sizes without a run."""
        absent = [LeftOut(name, None, why) for name, why in self.absent.items()]
        late = f"more than {self.plan.at_most:g} s"
        missing = [
            LeftOut(each.contender.name, each.count, each.why or (late if self._is_late(each) else "interrupted"))
            for each in self._in_order()
            if not each.seconds
        ]
        return (*absent, *missing)

    def methods(self) -> tuple[Contender, ...]:
        """All methods with a timing."""
        return tuple({row.contender.name: row.contender for row in self.rows()}.values())

    def _in_order(self) -> Iterator[Timing]:
        """Timings of all sizes of the plan, also without a run."""
        for contender in self.contenders:
            for count in self.plan.sizes[contender.name]:
                yield self.timings.get((contender.name, count), Timing(contender, count))


def trend(timings: tuple[Timing, ...]) -> tuple[tuple[float, ...], float | None, float | None]:
    """Sizes from 40 on of the rows that count, e, and the iterations at the largest size over the smallest.

    With fewer than two sizes e and the ratio are None.
    """
    counted = [timing for timing in timings if timing.counts and timing.n >= FIT_FROM]
    sizes = tuple(timing.n for timing in counted)
    if len(counted) < 2:
        return sizes, None, None
    exponent, _ = np.polyfit(np.log(sizes), np.log([timing.median("both") for timing in counted]), 1)
    return sizes, float(exponent), counted[-1].iterations / max(counted[0].iterations, 1)


def sizes_of(contender: Contender, named: tuple[Count, ...]) -> tuple[Count, ...]:
    """The ``named`` sizes, otherwise the standard sizes up to the method's largest."""
    if named:
        return tuple(sorted(dict.fromkeys(named), key=mean))
    return tuple(size for size in SIZES if size <= contender.largest)
