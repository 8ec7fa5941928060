"""A study of scatter: its points as a sweep, and values and shares from the outcomes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from comparisons.choices import Choices
from comparisons.pairing import Solvers
from comparisons.scatter.draws import Distribution, drawn
from comparisons.scatter.statistics import CONSTANT, Indices, indices
from comparisons.sweeps.demands import Bound, Measure, measures
from comparisons.sweeps.outcome import Asked, Outcome
from comparisons.sweeps.points import axes_of, in_file_units
from comparisons.sweeps.running import Sweep, known_outcomes, run, tasks_of
from comparisons.sweeps.workers import Workers
from cprbm_scene import Scene
from cprbm_scene.answer import Array

LEAST = 16
"""Least number of rows for indices."""


@dataclass(frozen=True)  # slots refuse cached properties
class Scatter:
    """Outcomes at the nominal point and at the points of a sample.

    Attributes:
        sweep: the nominal point, then the points of :func:`comparisons.scatter.draws.drawn`.
        count: number of points in a sample.
        indexed: whether the points serve the indices too; then the two samples A and B count.
        bounds: limits of the yield.
    """

    sweep: Sweep
    count: int
    indexed: bool
    bounds: tuple[Bound, ...] = ()

    @cached_property
    def outcomes(self) -> list[Outcome]:
        """Outcomes in the order of the points."""
        return [outcome for _, outcome in self.sweep.points()]

    @property
    def nominal(self) -> Outcome:
        """The outcome at the values of the file."""
        return self.outcomes[0]

    @property
    def sample(self) -> list[Outcome]:
        """Outcomes at the points of the sample, without the mixed points of the indices."""
        return self.outcomes[1 : 1 + self.count * (2 if self.indexed else 1)]

    @property
    def standing(self) -> list[Outcome]:
        """Outcomes of the sample with a complete answer on the branch of the nominal point."""
        return [each for each in self.sample if each.branch == self.nominal.branch]

    def scattering(self) -> list[Measure]:
        """Numbers of the last stations with a value at all standing points that is not constant."""
        table = {measure: values_of(measure, self.standing) for measure in measures(self.sweep.scene)}
        table = {measure: values for measure, values in table.items() if values.size and np.isfinite(values).all()}
        largest: dict[str, float] = {}
        for measure, values in table.items():
            largest[measure.unit] = max(largest.get(measure.unit, 0.0), float(np.max(np.abs(values))))
        return [each for each, values in table.items() if np.std(values) > CONSTANT * largest[each.unit]]

    def rows(self, measure: Measure) -> Array:
        """Values (d + 2, m) at A, B and the mixed points.

        A row counts if all of its points stand on the branch of the nominal point; m is the largest power of 2.
        """
        table = np.array([each.branch == self.nominal.branch for each in self.outcomes[1:]]).reshape(-1, self.count)
        whole = np.flatnonzero(table.all(axis=0))
        whole = whole[: 1 << (len(whole).bit_length() - 1)] if len(whole) else whole
        return values_of(measure, self.outcomes[1:]).reshape(-1, self.count)[:, whole]

    def indices(self, measure: Measure) -> Indices | None:
        """Indices of a number by the order of the axes; None with fewer than 16 whole rows."""
        rows = self.rows(measure)
        return indices(rows) if rows.shape[1] >= LEAST else None


def values_of(measure: Measure, outcomes: Sequence[Outcome]) -> Array:
    """Values (n,) in the unit of the file; NaN without a value."""
    return np.array([(measure.values(each) or [np.nan])[0] for each in outcomes])


def study(
    scene: Scene,
    distributions: Mapping[str, Distribution],
    count: int,
    asked: Asked,
    choices: Choices,
    *,
    indexed: bool,
    bounds: tuple[Bound, ...] = (),
) -> Scatter:
    """The points of a study, without outcomes.

    Args:
        scene: the question.
        distributions: by the name of a parameter.
        count: number of points in a sample, a power of 2.
        asked: solver of the points.
        choices: how finely, and by which variants.
        indexed: whether to add the points for the indices.
        bounds: limits of the yield.

    Raises:
        SceneError: the scene at a point is invalid, or indices of a single parameter.
    """
    names = list(distributions)
    values = drawn(distributions, count, indices=indexed)
    nominal = [scene.parameters[name].value for name in names]
    points = tuple(dict(zip(names, map(float, row), strict=True)) for row in (nominal, *values))
    tasks = tasks_of(scene, points, asked, frozenset(), choices)
    return Scatter(Sweep(scene, in_file_units(scene, axes_of(points)), tasks, {}), count, indexed, bounds)


def solved(
    scatter: Scatter,
    workers: Workers,
    choices: Choices,
    solvers: Solvers,
    limit: float,
    out: Path | None,
    moved: Callable[[int], None] = lambda done: None,
) -> Scatter:
    """The study with all outcomes; arguments and errors as of :func:`comparisons.sweeps.running.run`."""
    known = {} if out is None else known_outcomes([out])
    asked = replace(scatter.sweep, outcomes=known)
    return replace(scatter, sweep=run(asked, workers, choices, solvers, limit, out, moved))
