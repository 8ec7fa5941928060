"""How often and how long: medians, their spread, and one solve on the clock."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np

from comparisons.choices import Choices
from comparisons.crew import Solver
from cprbm_scene import Answer, Scene

Method = Literal["cprbm", "fea"]


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
