"""Seconds and answer of a solve on the clock."""

from __future__ import annotations

import gc
import time
from typing import Literal

from comparisons.choices import Choices
from comparisons.crew import Solver
from cprbm_scene import Answer, Scene

Method = Literal["cprbm", "fea"]


def timed(solver: Solver, scene: Scene, choices: Choices) -> tuple[float, Answer]:
    """Seconds of a solve and its answer; BLAS keeps the threads of the caller.

    Raises:
        SceneError: the solver refuses the question.
    """
    gc.collect()  # the rubbish of earlier solves is not on the clock
    begin = time.perf_counter()
    answer = solver(scene, choices)
    return time.perf_counter() - begin, answer
