"""What every optimiser is handed, and what it hands back."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cprbm_scene.answer import Array

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

    from benchmarks.peers.record import Discretised


@dataclass(frozen=True, slots=True)
class Solved:
    """Where an optimiser stopped: ``z`` (n_z,), ``iterations``, and why that is no answer, or nothing where it is."""

    z: Array
    iterations: int
    why: str = ""


Solve = Callable[[], Solved]
Optimiser = Callable[["Discretised", float], Solve]
"""From a problem, and the processor's seconds a solve may take, to its solve from the state without stress."""

LATE = "its time was up"


class TimeIsUpError(Exception):
    """Ends a solve from within; ``z`` is where it stood."""

    def __init__(self, z: Array, iterations: int) -> None:
        super().__init__()
        self.z, self.iterations = z, iterations


class Clock:
    """Counts iterations, and ends a solve that takes longer than ``seconds`` of the processor.

    Those that pass would end it by what else the machine does.
    """

    def __init__(self, seconds: float) -> None:
        self.until, self.iterations = time.process_time() + seconds, 0

    def __call__(self, z: Array, *_: object) -> None:
        """Called by an optimiser after each iteration."""
        self.iterations += 1
        if time.process_time() > self.until:
            raise TimeIsUpError(z.copy(), self.iterations)


def by_scipy(minimised: Callable[[Clock], OptimizeResult], rest: Array, seconds: float) -> Solved:
    """What one of SciPy's optimisers comes to from the state ``rest`` in so many ``seconds`` of the processor.

    Args:
        minimised: runs it with a clock for its callback.
        rest: where it begins (n_z,).
        seconds: after which it is ended.
    """
    clock = Clock(seconds)
    try:
        found = minimised(clock)
    except TimeIsUpError as up:
        return Solved(up.z, up.iterations, LATE)
    except np.linalg.LinAlgError:
        return Solved(rest, clock.iterations, "no curve can be fitted where it went")
    return Solved(np.asarray(found.x), int(found.nit))
