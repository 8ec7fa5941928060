"""All methods at all sizes, in turn, on the clock.

======  ====================================================================================
symbol  meaning
======  ====================================================================================
N       links or elements per beam; their mean where beams have numbers of their own
T       median of the seconds of set-up and solve together
a, e    of T = a·N^e, fitted by least squares in log T and log N over N ≥ 40
======  ====================================================================================

All runs are made in one process, BLAS on one thread.  Each method runs once before anything counts, so that no time
holds an import.  Then every repetition goes through all sizes and at each size through all methods, so that what else
the machine does falls on all of them alike.  A run of less than a second is made twice in a row and the second counts:
else each would pay for filling the processor's caches anew after what another method has left there.  The spread is
the distance of the quartiles.

A run is on the clock twice: set-up, from the scene (of a peer: from the discretised problem) to where solving begins,
and the solve, to the certified answer (of a peer: to where it stops; how that is judged is not on the clock).

A size is not repeated once its runs have taken longer than the plan's ``at_most`` together, and no larger size of a
method is begun after a run that took as long alone; a peer's solve is ended after so many seconds of the processor.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from comparisons.bench.contenders import Contender, Name, Outcome, mean
from comparisons.bench.errors import NOTHING, Reference, errors
from comparisons.bench.question import Measure
from comparisons.bench.timing import middle, quartiles_apart
from comparisons.choices import Count, Kinematics
from cprbm_scene import Scene, SceneError
from cprbm_scene.frozendict import frozendict
from cprbm_scene.threads import one_thread

SIZES = (10, 20, 40, 80, 160, 320, 640, 1280, 2560, 5120)
FIT_FROM = 40
REHEARSED = 1.0  # s: a shorter run counts when it is made a second time in a row
NO_WORSE = 1.01
"""A peer's error may be so many times that of the CPRBM on the same problem: less is within the digits of a table."""


Clock = Literal["wall", "cpu"]
CLOCKS: Mapping[Clock, Callable[[], float]] = frozendict({"wall": time.perf_counter, "cpu": time.process_time})
"""Seconds that pass, and those of the processor, which other work on the machine hardly changes."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What is to be timed.

    Attributes:
        sizes: numbers of links and elements by method, ascending.
        kinematics: theory of the finite elements.
        repeat: how often each size is solved.
        at_most: seconds, as above.
        whole: whether it is the whole scene, and not its last loads alone.
        clock: by which seconds.
    """

    sizes: Mapping[Name, tuple[Count, ...]]
    kinematics: Kinematics = "bending"
    repeat: int = 5
    at_most: float = 30.0
    whole: bool = False
    clock: Clock = "wall"


@dataclass(frozen=True, slots=True)
class Timing:
    """One method at one size.

    Attributes:
        setups, solves: seconds of every run, in the order in which they were made.
        outcome: of the last run, or of the first that did not complete.
        errors: by measure; empty if it did not complete or no reference is known.
        worse: whether a peer's error is larger than that of the CPRBM on the same problem.
    """

    contender: Contender
    count: Count
    setups: tuple[float, ...]
    solves: tuple[float, ...]
    outcome: Outcome
    errors: Mapping[Measure, float]
    worse: bool = False

    @property
    def n(self) -> float:
        """N."""
        return mean(self.count)

    @property
    def setup(self) -> float:
        """Median, s."""
        return middle(self.setups)

    @property
    def solve(self) -> float:
        """Median, s."""
        return middle(self.solves)

    @property
    def spread(self) -> float:
        """Distance of the quartiles of the solve, s."""
        return quartiles_apart(self.solves)

    @property
    def both(self) -> tuple[float, ...]:
        """Seconds of set-up and solve together of every run."""
        return tuple(setup + solve for setup, solve in zip(self.setups, self.solves, strict=True))

    @property
    def total(self) -> float:
        """T, s."""
        return middle(self.both)

    @property
    def counts(self) -> bool:
        """Whether the row counts: it completed, and its error is no worse."""
        return self.outcome.completed and not self.worse

    @property
    def total_iterations(self) -> int:
        """Of all stations."""
        return sum(self.outcome.iterations)

    @property
    def iterations_per_station(self) -> float | None:
        """Their mean; None where no station was reached."""
        return self.total_iterations / len(self.outcome.iterations) if self.outcome.iterations else None


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A method, or one size of it, that was not run, and why."""

    name: Name
    count: Count | None
    why: str


@dataclass(frozen=True, slots=True)
class Benchmark:
    """All timings of a scene, by method and N, what was left out, and by which machine."""

    scene: Scene
    plan: Plan
    machine: Mapping[str, str | int]
    timings: tuple[Timing, ...]
    left_out: tuple[LeftOut, ...] = ()
    reference: Reference = NOTHING

    def of(self, name: Name) -> tuple[Timing, ...]:
        """A method's timings by ascending N."""
        return tuple(timing for timing in self.timings if timing.contender.name == name)

    @property
    def contenders(self) -> tuple[Contender, ...]:
        """Those that have a timing."""
        return tuple({timing.contender.name: timing.contender for timing in self.timings}.values())


@dataclass(frozen=True, slots=True)
class Job:
    """One run of one repetition."""

    repetition: int
    contender: Contender
    count: Count


@dataclass
class Session:
    """A benchmark while it runs: jobs are done one by one, and what is done so far can be asked for at any time.

    ``absent`` are methods that do not take part, and why.
    """

    scene: Scene
    plan: Plan
    contenders: tuple[Contender, ...]
    machine: Mapping[str, str | int]
    clock: Callable[[], float]
    seconds: dict[tuple[Name, Count], list[tuple[float, float]]] = field(default_factory=dict)
    outcomes: dict[tuple[Name, Count], Outcome] = field(default_factory=dict)
    refused: dict[tuple[Name, Count], SceneError] = field(default_factory=dict)
    warm: set[Name] = field(default_factory=set)
    largest: dict[Name, float] = field(default_factory=dict)
    absent: Mapping[Name, str] = frozendict()

    def jobs(self) -> tuple[Job, ...]:
        """All runs: by repetition, by size, and at each size every method that has it."""
        counts = sorted({count for sizes in self.plan.sizes.values() for count in sizes}, key=mean)
        return tuple(
            Job(repetition, contender, count)
            for repetition in range(self.plan.repeat)
            for count in counts
            for contender in self.contenders
            if count in self.plan.sizes[contender.name]
        )

    def do(self, job: Job) -> None:
        """Make a run, unless it is refused, takes too long, or such a run did."""
        name = job.contender.name
        key = name, job.count
        so_far = sum(setup + solve for setup, solve in self.seconds.get(key, ()))
        if key in self.refused or mean(job.count) > self.largest.get(name, np.inf) or so_far > self.plan.at_most:
            return
        try:
            if name not in self.warm:
                self._run(job)
                self.warm.add(name)
            # libraries that the first run has loaded are held to one thread as well
            with one_thread():
                gc.collect()  # what earlier runs have left is not this one's to clear
                setup, solve, outcome = self._run(job)
                if setup + solve < REHEARSED:
                    setup, solve, outcome = self._run(job)
        except SceneError as error:
            self.refused[key] = error
            return
        self.seconds.setdefault(key, []).append((setup, solve))
        if key not in self.outcomes or self.outcomes[key].completed:
            self.outcomes[key] = outcome
        if setup + solve > self.plan.at_most:
            self.largest[name] = min(self.largest.get(name, np.inf), mean(job.count))

    def done(self, known: Reference = NOTHING) -> Benchmark:
        """What is done so far, with errors against what is ``known``.

        Raises:
            SceneError: every method has refused the question.
        """
        if self.refused and not self.seconds:
            raise next(iter(self.refused.values()))
        timings, left_out = list[Timing](), [LeftOut(name, None, why) for name, why in self.absent.items()]
        for contender in self.contenders:
            for count in self.plan.sizes[contender.name]:
                key = contender.name, count
                if key in self.seconds:
                    setups, solves = zip(*self.seconds[key], strict=True)
                    outcome = self.outcomes[key]
                    found = errors(self.scene, known, outcome.values)
                    timings.append(Timing(contender, count, setups, solves, outcome, found))
                elif key in self.refused:
                    why = "; ".join(
                        f"{one.key}: found {one.found}; allowed: {one.allowed}" for one in self.refused[key].mistakes
                    )
                    left_out.append(LeftOut(contender.name, count, why))
                elif mean(count) > self.largest.get(contender.name, np.inf):
                    left_out.append(LeftOut(contender.name, count, f"more than {self.plan.at_most:g} s"))
                else:
                    left_out.append(LeftOut(contender.name, count, "interrupted"))
        return Benchmark(
            self.scene, self.plan, self.machine, compared(tuple(timings)), tuple(left_out), reference=known
        )

    def _run(self, job: Job) -> tuple[float, float, Outcome]:
        run = job.contender.begin(self.scene, job.count, self.plan.at_most)
        begin = self.clock()
        solve = run.set_up()
        ready = self.clock()
        result = solve()
        end = self.clock()
        return ready - begin, end - ready, run.outcome(result)


@dataclass(frozen=True, slots=True)
class Trend:
    """How a method's runs that count go with N.

    Attributes:
        exponent: e; None with fewer than two sizes.
        factor: a, s; None likewise.
        iterations: those at the largest size over those at the smallest; None likewise.
    """

    sizes: tuple[float, ...]
    exponent: float | None
    factor: float | None
    iterations: float | None


def trend(timings: tuple[Timing, ...]) -> Trend:
    """The fit of one method's times, and how its iterations grow, over sizes from 40 on."""
    counted = [timing for timing in timings if timing.counts and timing.n >= FIT_FROM]
    sizes = tuple(timing.n for timing in counted)
    if len(counted) < 2:
        return Trend(sizes, None, None, None)
    exponent, log_factor = np.polyfit(np.log(sizes), np.log([timing.total for timing in counted]), 1)
    growth = counted[-1].total_iterations / max(counted[0].total_iterations, 1)
    return Trend(sizes, float(exponent), float(np.exp(log_factor)), growth)


def sizes_of(contender: Contender, named: tuple[Count, ...]) -> tuple[Count, ...]:
    """The sizes of a method: those ``named``, else the usual ones up to its largest."""
    if named:
        return tuple(sorted(dict.fromkeys(named), key=mean))
    return tuple(size for size in SIZES if size <= contender.largest)


def compared(timings: tuple[Timing, ...]) -> tuple[Timing, ...]:
    """The timings, with peers marked whose error is worse than the CPRBM's on the same problem."""
    ours = {timing.count: timing.errors for timing in timings if timing.contender.name == "paper" and timing.counts}
    found = []
    for timing in timings:
        mine = ours.get(timing.count, {})
        worse = timing.contender.is_peer and any(
            error > NO_WORSE * mine[measure] for measure, error in timing.errors.items() if measure in mine
        )
        found.append(replace(timing, worse=worse))
    return tuple(found)
