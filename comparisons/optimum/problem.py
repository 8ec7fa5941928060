"""A scene with ranges of parameters, a goal and limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan
from pathlib import Path

import numpy as np

from comparisons.sweeps.demands import Bound, Goal, Measure, bounds_of, measure_of, read_demands
from comparisons.sweeps.outcome import Outcome
from comparisons.sweeps.points import SEED, Axis, Point, in_file_units, ranges_of
from cprbm_scene import Mistake, Scene, SceneError
from cprbm_scene.answer import Array


@dataclass(frozen=True, slots=True)
class Problem:
    """A scene with ranges of parameters, a goal and limits.

    Attributes:
        scene: the question.
        axes: ranges of the parameters.
        goal: aim and value.
        measure: the number of the goal.
        bounds: the limits.
    """

    scene: Scene
    axes: tuple[Axis, ...]
    goal: Goal
    measure: Measure
    bounds: tuple[Bound, ...]

    def number(self, outcome: Outcome) -> float:
        """The number of the goal, of several stations the worst; NaN without a complete answer."""
        values = self.measure.values(outcome) if outcome.completed else []
        return max(values, key=self.cost, default=nan)

    def cost(self, number: float) -> float:
        """The function to minimise, of the number of the goal."""
        if self.goal.value is not None:
            return (number - self.goal.value) ** 2
        return -number if self.goal.aim == "maximise" else number

    def point(self, u: Array) -> Point:
        """Values of the parameters, SI, at shares ``u`` (d,) of the ranges."""
        return {axis.name: float(axis.low + x * (axis.high - axis.low)) for axis, x in zip(self.axes, u, strict=True)}

    def starts(self, count: int) -> list[Array]:
        """Shares (d,) of ``count`` starts: the values of the file, and Sobol points."""
        from scipy.stats import qmc

        own = [(self.scene.parameters[axis.name].value - axis.low) / (axis.high - axis.low) for axis in self.axes]
        others = qmc.Sobol(len(own), seed=SEED).random_base2((count - 1).bit_length())
        return [np.clip(own, 0.0, 1.0), *others[: count - 1]]


def problem_of(scene: Scene, axes: Sequence[Axis], file: Path) -> Problem:
    """The problem with the goal and the limits in a file.

    Args:
        scene: the question.
        axes: ranges of parameters; without axes the ranges of the scene.
        file: with a goal and limits.

    Raises:
        SceneError: the file is wrong, has no goal, or the scene has no such number or no range.
    """
    demands = read_demands(file)
    if demands.goal is None:
        raise SceneError([Mistake("goal", "nothing", "[goal] with a probe and an aim", str(file))])
    varied = in_file_units(scene, axes or ranges_of(scene))
    if not varied:
        raise SceneError([Mistake("--vary", "no range", "NAME=FIRST..LAST, or a parameter with a range")])
    measure = measure_of(scene, demands.goal, "goal", str(file))
    return Problem(scene, varied, demands.goal, measure, bounds_of(scene, demands, str(file)))
