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
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from comparisons.bench.contenders import Clocked, Contender, Name, Outcome, mean
from comparisons.bench.errors import NOTHING, Reference, errors
from comparisons.bench.question import Measure
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

    sizes: Mapping[Name, tuple[Count, ...]]
    kinematics: Kinematics = "bending"
    repeat: int = 5
    at_most: float = 30.0
    whole: bool = False
    clock: Clock = "wall"


@dataclass(frozen=True, slots=True)
class Timing:
    """Runs of a method at a size.

    Attributes:
        seconds: of set-up and solve of every run, (k, 2), in order.
        outcome: of the last run, or of the first incomplete run.
        errors: by measure; empty for an incomplete run or without a reference.
        worse: True if the error of a peer is larger than the error of the CPRBM on the same problem.
    """

    contender: Contender
    count: Count
    seconds: tuple[tuple[float, float], ...]
    outcome: Outcome
    errors: Mapping[Measure, float]
    worse: bool = False

    def median(self, clocked: Clocked | Literal["set-up"]) -> float:
        """Median of the set-up, of the solve, or of both together (T), s."""
        chosen = {"set-up": slice(0, 1), "solve": slice(1, 2), "both": slice(0, 2)}[clocked]
        return float(np.median(np.sum(np.array(self.seconds)[:, chosen], axis=1)))

    @property
    def n(self) -> float:
        """N."""
        return mean(self.count)

    @property
    def spread(self) -> float:
        """Distance of the quartiles of the solve, s."""
        return float(np.subtract(*np.percentile(np.array(self.seconds)[:, 1], (75.0, 25.0))))

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


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A method or a single size without a run, and the reason."""

    name: Name
    count: Count | None
    why: str


@dataclass(frozen=True, slots=True)
class Benchmark:
    """All timings of a scene, by method and N, everything left out, and the machine."""

    scene: Scene
    plan: Plan
    machine: Mapping[str, str | int]
    timings: tuple[Timing, ...]
    left_out: tuple[LeftOut, ...] = ()
    reference: Reference = NOTHING

    def of(self, name: Name) -> tuple[Timing, ...]:
        """The timings of a method by ascending N."""
        return tuple(timing for timing in self.timings if timing.contender.name == name)

    @property
    def contenders(self) -> tuple[Contender, ...]:
        """All methods with a timing."""
        return tuple({timing.contender.name: timing.contender for timing in self.timings}.values())


@dataclass
class _Size:
    """Seconds of set-up and solve, outcome, and mistakes of a refused question, of a method at a size."""

    seconds: list[tuple[float, float]] = field(default_factory=list)
    outcome: Outcome | None = None
    refusal: SceneError | None = None


@dataclass
class Session:
    """A benchmark while it runs: :meth:`do` makes a run, :meth:`done` returns the benchmark of all runs so far.

    ``absent`` are methods that take no part, with reasons.
    """

    scene: Scene
    plan: Plan
    contenders: tuple[Contender, ...]
    machine: Mapping[str, str | int]
    clock: Callable[[], float]
    absent: Mapping[Name, str] = frozendict()
    sizes: dict[tuple[Name, Count], _Size] = field(default_factory=dict)
    largest: dict[Name, float] = field(default_factory=dict)

    def jobs(self) -> tuple[Job, ...]:
        """All runs: by repetition, by size, and at each size every method with this size."""
        counts = sorted({count for sizes in self.plan.sizes.values() for count in sizes}, key=mean)
        once = [(each, count) for count in counts for each in self.contenders if count in self.plan.sizes[each.name]]
        return tuple(once * self.plan.repeat)

    def do(self, job: Job) -> None:
        """Make a run, unless the question is refused or takes too long."""
        (contender, count), most = job, self.plan.at_most
        size = self.sizes.setdefault((contender.name, count), _Size())
        if size.refusal or mean(count) > self._largest(contender) or sum(map(sum, size.seconds)) > most:
            return
        try:
            if contender.name not in self.largest:
                self._run(job)
                self.largest[contender.name] = np.inf
            with one_thread():  # of the libraries that the first run has loaded
                gc.collect()  # the rubbish of earlier runs is not on the clock
                seconds, outcome = self._run(job)
                if sum(seconds) < REHEARSED:
                    seconds, outcome = self._run(job)
        except SceneError as error:
            size.refusal = error
            return
        size.seconds.append(seconds)
        if size.outcome is None or size.outcome.completed:
            size.outcome = outcome
        if sum(seconds) > most:
            self.largest[contender.name] = min(self._largest(contender), mean(count))

    def _largest(self, contender: Contender) -> float:
        return self.largest.get(contender.name, np.inf)

    def _run(self, job: Job) -> tuple[tuple[float, float], Outcome]:
        run = job[0].begin(self.scene, job[1], self.plan.at_most)
        begin = self.clock()
        solve = run.set_up()
        ready = self.clock()
        result = solve()
        end = self.clock()
        return (ready - begin, end - ready), run.outcome(result)

    def done(self, known: Reference = NOTHING) -> Benchmark:
        """The benchmark of all runs so far, with errors against a ``known`` reference.

        Raises:
            SceneError: every method has refused the question.
        """
        refusals = [size.refusal for size in self.sizes.values() if size.refusal]
        if refusals and not any(size.seconds for size in self.sizes.values()):
            raise refusals[0]
        timings, left_out = list[Timing](), [LeftOut(name, None, why) for name, why in self.absent.items()]
        for contender in self.contenders:
            for count in self.plan.sizes[contender.name]:
                size = self.sizes.get((contender.name, count), _Size())
                if size.outcome:
                    off = errors(self.scene, known, size.outcome.values)
                    timings.append(Timing(contender, count, tuple(size.seconds), size.outcome, off))
                else:
                    left_out.append(LeftOut(contender.name, count, self._why(contender, count, size)))
        return Benchmark(self.scene, self.plan, self.machine, marked(timings), tuple(left_out), known)

    def _why(self, contender: Contender, count: Count, size: _Size) -> str:
        """Reason why a size has no run."""
        if size.refusal:
            return "; ".join(f"{one.key}: found {one.found}; allowed: {one.allowed}" for one in size.refusal.mistakes)
        late = mean(count) > self._largest(contender)
        return f"more than {self.plan.at_most:g} s" if late else "interrupted"


def marked(timings: list[Timing]) -> tuple[Timing, ...]:
    """The timings, with a mark on peers with a worse error than the CPRBM on the same problem."""
    ours = {row.count: row.errors for row in timings if row.contender.name == "paper" and row.counts}
    limits = [{measure: NO_WORSE * off for measure, off in ours.get(row.count, {}).items()} for row in timings]
    return tuple(
        replace(row, worse=row.contender.is_peer and any(row.errors.get(m, 0.0) > most for m, most in limit.items()))
        for row, limit in zip(timings, limits, strict=True)
    )


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
