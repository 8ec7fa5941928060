"""Methods of a benchmark, and their runs at all sizes on the clock.

A method has a set-up, a solve, and the outcome of the result.  The methods here are the project's own solvers;
optimisers come from outside as further methods.

======  ====================================================================================
symbol  meaning
======  ====================================================================================
N       links or elements per beam; their mean where beams have numbers of their own
T       median of the seconds of set-up and solve together
e       of T = a·N^e, fitted by least squares in log T and log N over N ≥ 40
======  ====================================================================================

All runs share a process, with BLAS on a single thread.  The first run of every method does not count, so that no
time holds an import.  Every repetition goes through all sizes, and at each size through all methods: other work on the
machine then falls on all methods alike.  A run of less than a second is made twice in a row and the second run counts,
since the first fills the processor's caches.  The spread is the distance of the quartiles.

The clock times the set-up, from the scene (of a peer: from the discretised problem), and the solve, up to the certified
answer (of a peer: up to its end).  A size is not repeated after runs with a sum above the plan's ``at_most``.  After a
single run of that length no larger size of the method begins; a peer's solve ends after as many processor seconds.
"""

import gc
import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, Self

import numpy as np

from comparisons.bench.measures import NOTHING, Measure, Reference, errors
from comparisons.choices import Choices, Count, Kinematics
from comparisons.executor import Solver
from comparisons.pairing import Solvers, prepared
from cprbm_scene import Answer, Array, Scene, SceneError, frozendict
from cprbm_scene.solving import one_thread

OURS: tuple[str, ...] = ("auto", "paper", "fea")
"""Names of the project's own methods, in the order of the tables."""

Clocked = Literal["solve", "both"]
"""Extent of a time: the solve alone, or set-up and solve together."""

SIZES = (10, 20, 40, 80, 160, 320, 640, 1280, 2560, 5120)
FIT_FROM = 40
REHEARSED = 1.0
"""Seconds; of a shorter run the repetition in a row counts."""

NO_WORSE = 1.01
"""Allowed error of a peer over the error of the CPRBM on the same problem: within the digits of a table."""

Clock = Literal["wall", "cpu"]
CLOCKS: dict[Clock, Callable[[], float]] = {"wall": time.perf_counter, "cpu": time.process_time}
"""Elapsed seconds, and seconds of the processor, which other work hardly changes."""

Extent = Clocked | Literal["set-up"]
_EXTENTS: Mapping[Extent, slice] = frozendict({"set-up": slice(0, 1), "solve": slice(1, 2), "both": slice(0, 2)})


@dataclass(frozen=True, slots=True)
class Outcome:
    """Outcome of a solve.

    Attributes:
        ended: COMPLETED, or the name of another ending; why: a sentence on another ending.
        iterations: at every reached station.
        values: at the last station, by probe; empty without the last station.
        residual: in the common measure of the peers; None of the project's own methods, which certify themselves.
    """

    ended: str
    why: str
    iterations: tuple[int, ...]
    values: Mapping[str, Array]
    residual: float | None = None

    @property
    def completed(self) -> bool:
        """True for a complete answer."""
        return self.ended == "COMPLETED"


@dataclass(frozen=True, slots=True)
class Run:
    """A run: ``set_up`` returns the solve, both on the clock; ``outcome`` of the result is off the clock."""

    set_up: Callable[[], Callable[[], Any]]
    outcome: Callable[[Any], Outcome]


Begin = Callable[[Scene, Count, float], Run]
"""A run from a scene, N and the largest seconds of a solve; raises SceneError where the method refuses the scene."""


@dataclass(frozen=True, slots=True)
class Contender:
    """A method.

    Attributes:
        name: in the option ``--method``; method, formulation: in the JSON; label: in tables.
        begin: begin of a run.
        largest: largest of the standard sizes.
        tolerance: largest residual of a complete solve of a peer; None for the project's own methods.
        ratios: clocks of the ratios of the method's time to the time of CPRBM ``paper``.
        look: colour and marker of the points in figures.
        absence: why the method cannot take part on this machine; empty if it can.
    """

    name: str
    method: str
    formulation: str | None
    label: str
    begin: Begin
    largest: int = 160
    tolerance: float | None = None
    ratios: tuple[Clocked, ...] = ()
    look: tuple[str, str] = ("#606060", "x")
    absence: str = ""

    @property
    def is_peer(self) -> bool:
        """True for an optimiser on the problem of CPRBM ``paper``, which solves the last station only."""
        return self.tolerance is not None


def contenders(solvers: Solvers, choices: Choices) -> tuple[Contender, ...]:
    """The project's own methods, in the order of ``OURS``."""
    auto, paper = (_ours(solvers.cprbm, replace(choices, formulation=name)) for name in ("auto", "paper"))
    return (
        Contender("auto", "cprbm", "auto", "CPRBM auto", auto, 5120, ratios=("both",), look=("#1f5fa8", "o")),
        Contender("paper", "cprbm", "paper", "CPRBM paper", paper, 640, look=("#5aa0e0", "s")),
        Contender(
            "fea", "fea", None, f"FEA {choices.kinematics}", _ours(solvers.fea, choices), 1280, look=("#c8321e", "^")
        ),
    )


def _ours(solver: Solver, choices: Choices) -> Begin:
    def begin(scene: Scene, count: Count, at_most: float) -> Run:
        # a penalty whose error falls with the error of the elements
        chosen = replace(choices.of_size(round(mean(count))), links=count, elements=count)
        return Run(lambda: prepared(solver, scene, chosen), outcome_of)

    return begin


def mean(count: Count) -> float:
    """N: links or elements per beam, on average where beams have numbers of their own."""
    return float(count) if isinstance(count, int) else sum(count.values()) / len(count)


def outcome_of(answer: Answer) -> Outcome:
    """Outcome of a solve of our solvers."""
    return Outcome(
        ended=answer.ending.name,
        why="" if answer.completed else answer.sentence,
        iterations=tuple(station.certificate.iterations for station in answer.stations),
        values=answer.stations[-1].values if answer.completed and answer.stations else frozendict(),
    )


@dataclass(slots=True)
class Timing:
    """Runs of a method at a size; during a session the runs so far.

    Attributes:
        seconds: of set-up and solve of every run, (k, 2), in order.
        outcome: of the last run, or of the first incomplete run.
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

    def quartiles(self, extent: Extent) -> tuple[float, float, float]:
        """Lower quartile, median and upper quartile of the set-up, of the solve, or of both together (T), s."""
        low, median, high = np.percentile(np.sum(np.array(self.seconds)[:, _EXTENTS[extent]], axis=1), (25, 50, 75))
        return float(low), float(median), float(high)

    def median(self, extent: Extent) -> float:
        """Median, s."""
        return self.quartiles(extent)[1]

    def spread(self, extent: Extent) -> float:
        """Distance of the quartiles, s."""
        return self.quartiles(extent)[2] - self.quartiles(extent)[0]

    @property
    def n(self) -> float:
        """N."""
        return mean(self.count)

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
        return self.outcome.why if self.refusal is None else refusal_text(self.refusal)


Omission = tuple[str, Count | None, str]
"""Name of a method, a single size or None for all, and the reason for which there is no run."""


@dataclass
class Session:
    """A benchmark, also while it runs: :meth:`do` makes a run, all else speaks of the runs so far.

    Attributes:
        scene: the question; machine: the machine and the versions.
        sizes: numbers of links and elements by method, ascending.
        reference: of the errors.
        kinematics: theory of the finite elements.
        repeat: number of solves at each size.
        at_most: seconds, as above.
        whole: True for the whole scene, False for its last loads.
        clock: kind of seconds.
        absent: methods that take no part, with reasons.
        largest: by name of a method that has run, N above which no size begins.
        timings: of every method by ascending N, also without a run.
    """

    scene: Scene
    machine: Mapping[str, str | int]
    sizes: Mapping[Contender, tuple[Count, ...]]
    reference: Reference = NOTHING
    kinematics: Kinematics = "bending"
    repeat: int = 5
    at_most: float = 30.0
    whole: bool = False
    clock: Clock = "wall"
    absent: Mapping[str, str] = frozendict()
    largest: dict[str, float] = field(default_factory=dict)
    timings: list[Timing] = field(init=False)

    def __post_init__(self) -> None:
        """Begin with all sizes."""
        self.timings = [Timing(each, count) for each, counts in self.sizes.items() for count in counts]

    def jobs(self) -> list[Timing]:
        """All runs: by repetition, by size, and at each size every method with this size."""
        return sorted(self.timings, key=lambda timing: timing.n) * self.repeat

    def after_all(self) -> Self:
        """This session after all runs."""
        for job in self.jobs():
            self.do(job)
        return self

    def do(self, job: Timing) -> Self:
        """This session after a run; no run where the question is refused or takes too long."""
        name, most = job.contender.name, self.at_most
        if job.refusal or self._is_late(job) or sum(map(sum, job.seconds)) > most:
            return self
        try:
            if name not in self.largest:
                self._run(job)
                self.largest[name] = math.inf
            with one_thread():  # of the libraries that the first run has loaded
                gc.collect()  # the rubbish of earlier runs is not on the clock
                seconds, outcome = self._run(job)
                if sum(seconds) < REHEARSED:
                    seconds, outcome = self._run(job)
        except SceneError as error:
            job.refusal = error
            return self
        if not job.seconds or job.outcome.completed:
            job.outcome, job.errors = outcome, errors(self.scene, self.reference, outcome.values)
        job.seconds.append(seconds)
        if sum(seconds) > most:
            self.largest[name] = min(self.largest[name], job.n)
        return self

    def _is_late(self, timing: Timing) -> bool:
        """Whether a smaller size of the method has taken too long."""
        return timing.n > self.largest.get(timing.contender.name, math.inf)

    def _run(self, job: Timing) -> tuple[tuple[float, float], Outcome]:
        run = job.contender.begin(self.scene, job.count, self.at_most)
        clock = CLOCKS[self.clock]
        begin = clock()
        solve = run.set_up()
        ready = clock()
        result = solve()
        end = clock()
        return (ready - begin, end - ready), run.outcome(result)

    def rows(self, name: str = "") -> tuple[Timing, ...]:
        """The timings of all methods, or of the method of a ``name``, by method and ascending N.

        Raises:
            SceneError: every method has refused the question.
        """
        found = [timing for timing in self.timings if timing.seconds]
        refusals = [timing.refusal for timing in self.timings if timing.refusal]
        if refusals and len(refusals) == len(self.timings):
            raise refusals[0]
        ours = {row.count: row.errors for row in found if row.contender.name == "paper" and row.counts}
        for row in (row for row in found if row.contender.is_peer):
            limits = ours.get(row.count, {})
            row.worse = any(row.errors.get(key, 0.0) > NO_WORSE * off for key, off in limits.items())
        return tuple(row for row in found if name in ("", row.contender.name))

    def omissions(self) -> tuple[Omission, ...]:
        """Methods and sizes without a run."""
        late = f"more than {self.at_most:g} s"
        return (
            *((name, None, why) for name, why in self.absent.items()),
            *(
                (each.contender.name, each.count, each.why or (late if self._is_late(each) else "interrupted"))
                for each in self.timings
                if not each.seconds
            ),
        )

    def methods(self) -> tuple[Contender, ...]:
        """All methods with a timing."""
        return tuple(dict.fromkeys(row.contender for row in self.rows()))


def refusal_text(error: SceneError) -> str:
    """All mistakes of a refusal, without their file."""
    return "; ".join(f"{each.key}: found {each.found}; allowed: {each.allowed}" for each in error.mistakes)


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
