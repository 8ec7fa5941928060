"""Time and iterations against N, for the project's own two solvers on one scene.

======  ====================================================================================
symbol  meaning
======  ====================================================================================
N       links of the CPRBM per beam, or finite elements per beam
T       median of the seconds that a whole answer takes (all stations, set-up included)
a, e    of T = a·N^e, fitted by least squares in log T and log N over N ≥ 40
======  ====================================================================================

All solves are made in one process, BLAS on one thread.  Each method solves once before anything counts, so that no
time holds an import.  Then every repetition goes through all sizes and at each size through all methods, so that
what else the machine does falls on all of them alike.  The spread is the distance of the quartiles.

A size at which one solve took longer than the plan's ``at_most`` is not repeated, and no larger size of that
method is begun.  A run that did not complete stands with its ending and takes no part in a fit.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from threadpoolctl import threadpool_limits

from comparisons.choices import Choices
from comparisons.pairing import Solver, Solvers
from scene import Answer, Ending, Scene

Method = Literal["cprbm", "fea"]
METHODS: tuple[Method, ...] = ("cprbm", "fea")

SIZES = (40, 80, 160, 320, 640, 1280, 2560, 5120)
LARGEST: dict[Method, int] = {"cprbm": 5120, "fea": 1280}
"""Up to which size a method goes if no sizes are named."""

FIT_FROM = 40


@dataclass(frozen=True, slots=True)
class Plan:
    """What is to be timed.

    Attributes:
        sizes: N by method, ascending.
        choices: everything else of a run.
        repeat: how often each size is solved.
        at_most: seconds of one solve, beyond which neither it is repeated nor a larger size begun.
    """

    sizes: dict[Method, tuple[int, ...]]
    choices: Choices
    repeat: int = 5
    at_most: float = 60.0


@dataclass(frozen=True, slots=True)
class Timing:
    """One method at one size.

    Attributes:
        seconds: of every solve, in the order in which they were made.
        iterations: of each station that was reached.
        ending: the first that is not COMPLETED, if there is one.
    """

    method: Method
    n: int
    seconds: tuple[float, ...]
    iterations: tuple[int, ...]
    ending: Ending

    @property
    def median(self) -> float:
        """T, s."""
        return middle(self.seconds)

    @property
    def spread(self) -> float:
        """Distance of the quartiles, s."""
        return quartiles_apart(self.seconds)

    @property
    def total_iterations(self) -> int:
        """Of all stations."""
        return sum(self.iterations)

    @property
    def iterations_per_station(self) -> float | None:
        """Their mean; None where no station was reached."""
        return self.total_iterations / len(self.iterations) if self.iterations else None


@dataclass(frozen=True, slots=True)
class Trend:
    """How a method's runs that completed go with N.

    Attributes:
        exponent: e; None with fewer than two sizes.
        factor: a, s; None likewise.
        iterations: those at the largest size over those at the smallest; None likewise.
    """

    method: Method
    sizes: tuple[int, ...]
    exponent: float | None
    factor: float | None
    iterations: float | None


@dataclass(frozen=True, slots=True)
class Benchmark:
    """All timings of a scene, by method and N, and by which machine.

    ``left_out`` holds by method the sizes that were not begun.
    """

    scene: Scene
    plan: Plan
    machine: dict[str, str | int]
    timings: tuple[Timing, ...]
    left_out: dict[Method, tuple[int, ...]] = field(default_factory=dict)

    def of(self, method: Method) -> tuple[Timing, ...]:
        """A method's timings by ascending N."""
        return tuple(timing for timing in self.timings if timing.method == method)

    def label(self, method: Method) -> str:
        """What a method is called, with its variant."""
        choices = self.plan.choices
        return f"CPRBM {choices.formulation}" if method == "cprbm" else f"FEA {choices.kinematics}"


def sizes_of(method: Method, named: tuple[int, ...] | None) -> tuple[int, ...]:
    """The sizes of a method: those named, else the usual ones up to its largest."""
    return tuple(size for size in SIZES if size <= LARGEST[method]) if named is None else tuple(sorted(set(named)))


def measured(
    scene: Scene,
    plan: Plan,
    solvers: Solvers,
    machine: dict[str, str | int],
    *,
    clock: Callable[[], float] = time.perf_counter,
    watch: Callable[[int, Method, int], None] = lambda repetition, method, n: None,
) -> Benchmark:
    """Time the plan's methods on a scene.

    Args:
        scene: the question.
        plan: which methods, sizes and repetitions.
        solvers: who answers.
        machine: what it runs on, as :func:`comparisons.machine.described` says.
        clock: seconds that pass.
        watch: called before every solve with its repetition, method and size.

    Raises:
        SceneError: a solver refuses the question.
    """
    seconds: dict[tuple[Method, int], list[float]] = {}
    answers: dict[tuple[Method, int], list[tuple[Ending, tuple[int, ...]]]] = {}
    last: dict[Method, float] = dict.fromkeys(plan.sizes, float("inf"))
    for method, sizes in plan.sizes.items():
        _solver(solvers, method)(scene, _choices(plan, method, sizes[0]))
    with threadpool_limits(limits=1, user_api="blas"):
        for repetition in range(plan.repeat):
            for method, n in _interleaved(plan):
                slow = any(taken > plan.at_most for taken in seconds.get((method, n), ()))
                if n > last[method] or slow:
                    continue
                watch(repetition, method, n)
                taken, answer = timed(_solver(solvers, method), scene, _choices(plan, method, n), clock)
                seconds.setdefault((method, n), []).append(taken)
                steps = tuple(station.certificate.iterations for station in answer.stations)
                answers.setdefault((method, n), []).append((answer.ending, steps))
                if taken > plan.at_most:
                    last[method] = min(last[method], n)
    timings = tuple(
        Timing(
            method,
            n,
            tuple(seconds[method, n]),
            answers[method, n][-1][1],
            next((ending for ending, _ in answers[method, n] if ending is not Ending.COMPLETED), Ending.COMPLETED),
        )
        for method, sizes in plan.sizes.items()
        for n in sizes
        if (method, n) in seconds
    )
    left_out = {method: tuple(n for n in sizes if (method, n) not in seconds) for method, sizes in plan.sizes.items()}
    return Benchmark(scene, plan, machine, timings, left_out)


def trend(benchmark: Benchmark, method: Method) -> Trend:
    """The fit of a method's times, and how its iterations grow, over sizes from 40 on."""
    counted = [timing for timing in benchmark.of(method) if timing.ending is Ending.COMPLETED and timing.n >= FIT_FROM]
    sizes = tuple(timing.n for timing in counted)
    if len(counted) < 2:
        return Trend(method, sizes, None, None, None)
    exponent, log_factor = np.polyfit(np.log(sizes), np.log([timing.median for timing in counted]), 1)
    growth = counted[-1].total_iterations / max(counted[0].total_iterations, 1)
    return Trend(method, sizes, float(exponent), float(np.exp(log_factor)), growth)


def _interleaved(plan: Plan) -> Iterator[tuple[Method, int]]:
    """All runs of a repetition: by size, and at each size every method that has it."""
    for n in sorted({n for sizes in plan.sizes.values() for n in sizes}):
        for method, sizes in plan.sizes.items():
            if n in sizes:
                yield method, n


def middle(seconds: Sequence[float]) -> float:
    """T: the median, s."""
    return float(np.median(seconds))


def quartiles_apart(seconds: Sequence[float]) -> float:
    """The spread: distance of the quartiles, s."""
    low, high = np.percentile(seconds, (25.0, 75.0))
    return float(high - low)


def timed(
    solver: Solver, scene: Scene, choices: Choices, clock: Callable[[], float] = time.perf_counter
) -> tuple[float, Answer]:
    """Seconds of one solve and its answer; BLAS keeps the threads that the caller has left it.

    Raises:
        SceneError: the solver refuses the question.
    """
    gc.collect()  # what earlier solves have left is not this one's to clear
    begin = clock()
    answer = solver(scene, choices)
    return clock() - begin, answer


def _solver(solvers: Solvers, method: Method) -> Solver:
    return solvers.cprbm if method == "cprbm" else solvers.fea


def _choices(plan: Plan, method: Method, n: int) -> Choices:
    return replace(plan.choices, links=n) if method == "cprbm" else replace(plan.choices, elements=n)
