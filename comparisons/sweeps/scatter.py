"""Scatter: points drawn from the tolerances of a scene as a sweep, statistics of the outcomes, and the result.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
d, n    number of parameters, and number of points in a sample, a power of 2
A, B    two independent samples (n, d): the columns of a scrambled Sobol sequence in 2 d dimensions
ABᵢ     the sample A with column i of B, for the indices of parameter i
f       a number of the answer, a function of the parameters
Sᵢ      first-order index: the variance of the mean of f for a fixed parameter i, over the variance of f
Tᵢ      total-order index: the mean of the variance of f with all but parameter i fixed, over the variance of f
======  ==========================================================================================

Quantiles have the exact binomial interval of independent points; for scrambled Sobol points this interval is cautious.
Shares have Wilson's interval.  The design and the estimates of the indices are those of Saltelli et al., Computer
Physics Communications 181 (2010) 259-270, in SciPy; their intervals of 95 % confidence come from resampled rows.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from scipy.stats import binomtest, norm, qmc, quantile_test, sobol_indices, uniform

from comparisons.choices import Choices
from comparisons.formats import number, percent, scaled_unit, with_symbols
from comparisons.present.canvas import BLUE, RED, canvas, finished, panels
from comparisons.present.columns import Figure, Plain, Section, Table, plain
from comparisons.sweeps.demands import Bound, Measure, measures, meets
from comparisons.sweeps.outcome import Asked, Outcome
from comparisons.sweeps.points import SEED, axes_of, in_file_units
from comparisons.sweeps.running import Sweep, tasks_of
from cprbm_scene import Array, Mistake, Scene, SceneError

LEVELS = (0.025, 0.5, 0.975)
"""Probabilities of the quantiles."""

LEAST = 16
"""Least number of rows for indices."""

CONSTANT = 1e-9
"""Standard deviation below which a number is constant, over the largest magnitude of its unit: round-off of answers."""

_PANELS = 6
"""Largest number of histograms in the figure."""

_CONFIDENCE = 0.95
_RESAMPLES = 400
_EDGE = 2.0**-32
"""Distance of a share from 0 and 1, where a normal distribution is infinite; Sobol points have 30 bits."""


Distribution: TypeAlias = Any
"""Frozen distribution of :mod:`scipy.stats`, which has no types, of a parameter in SI."""


def distributions_of(scene: Scene) -> dict[str, Distribution]:
    """Distributions of the parameters with a tolerance.

    Raises:
        SceneError: no parameter has a tolerance.
    """
    found: dict[str, Distribution] = {}
    for name, parameter in scene.parameters.items():
        scatter = parameter.tolerance
        if scatter is not None and scatter.normal is not None:
            found[name] = norm(parameter.value, scatter.normal)
        elif scatter is not None and scatter.uniform is not None:
            found[name] = uniform(parameter.value - scatter.uniform, 2.0 * scatter.uniform)
    if not found:
        allowed = "a parameter with a tolerance, as t = { value = 2.0, unit = 'mm', tolerance = { normal = 0.02 } }"
        raise SceneError([Mistake("parameters", "no tolerance", allowed, scene.file)])
    return found


def drawn(distributions: Mapping[str, Distribution], count: int, *, indices: bool) -> Array:
    """Values (k, d) of d parameters, SI: a sample of ``count`` points, or with ``indices`` A, B, AB₁, ... AB_d.

    Raises:
        SceneError: indices of a single parameter.
    """
    size = len(distributions)
    if indices and size < 2:
        raise SceneError([Mistake("--sobol", "one parameter with a tolerance", "two or more: the index of one is 1")])
    samples = 2 if indices else 1
    shares = qmc.Sobol(samples * size, seed=SEED).random_base2(count.bit_length() - 1)
    shares = np.clip(shares, _EDGE, 1.0 - _EDGE)
    own = [*distributions.values()] * samples
    columns = [each.ppf(column) for each, column in zip(own, shares.T, strict=True)]
    if not indices:
        return np.column_stack(columns)
    a, b = columns[:size], columns[size:]
    mixed = ([*a[:i], b[i], *a[i + 1 :]] for i in range(size))
    return np.concatenate([np.column_stack(each) for each in (a, b, *mixed)])


class Interval(NamedTuple):
    """An estimate and the ends of its interval; NaN where the sample is too small for an end."""

    value: float
    low: float
    high: float


Indices = tuple[tuple[Interval, ...], ...]
"""First-order indices by parameter, and total-order indices."""


def quantiles(values: Array) -> tuple[Interval, ...]:
    """Quantiles of ``values`` (n,) at ``LEVELS``."""
    ends = [quantile_test(values, p=level).confidence_interval(_CONFIDENCE) for level in LEVELS]
    estimates = np.quantile(values, LEVELS).tolist()
    return tuple(Interval(each, float(low), float(high)) for each, (low, high) in zip(estimates, ends, strict=True))


def share(count: int, whole: int) -> Interval:
    """``count`` over ``whole``."""
    ends = binomtest(count, whole).proportion_ci(_CONFIDENCE, method="wilson")
    return Interval(count / whole, float(ends.low), float(ends.high))


def indices(values: Array) -> Indices:
    """Indices of d parameters.

    Args:
        values: (d + 2, n) values of f at A, B, AB₁, ... AB_d; n is a power of 2.
    """
    count = values.shape[1]
    rows = np.random.default_rng(SEED).integers(count, size=(_RESAMPLES, count))
    estimate = _estimates(values)
    low, high = np.quantile([_estimates(values[:, row]) for row in rows], [0.025, 0.975], axis=0)
    return tuple(tuple(map(Interval, *(each[order].tolist() for each in (estimate, low, high)))) for order in range(2))


def _estimates(values: Array) -> Array:
    """Estimates (2, d) of the first- and total-order indices."""
    functions = {"f_A": values[None, 0], "f_B": values[None, 1], "f_AB": values[2:, None]}
    found = sobol_indices(func=functions, n=values.shape[1])
    return np.array([found.first_order, found.total_order])


@dataclass(frozen=True)  # slots refuse cached properties
class Scatter:
    """Outcomes at the nominal point and at the points of a sample.

    Attributes:
        sweep: the nominal point, then the points of :func:`drawn`.
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
        sizes = [(measure.unit, float(np.max(np.abs(values)))) for measure, values in table.items()]
        largest = dict(sorted(sizes))  # the last of a unit stays
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
    sweep = Sweep(
        scene,
        axes=in_file_units(scene, axes_of(points)),
        tasks=tasks_of(scene, points, asked, frozenset(), choices),
    )
    return Scatter(sweep, count, indexed, bounds)


def scatter_section(scatter: Scatter) -> Section:
    """The result."""
    scattering = scatter.scattering()
    indexed = {measure: scatter.indices(measure) for measure in scattering} if scatter.indexed else {}
    found = {measure: each for measure, each in indexed.items() if each is not None}
    tables = [_quantile_table(scatter, scattering), _limit_table(scatter), _index_table(scatter, found)]
    sentences = list(_sentences(scatter))
    if scatter.indexed and not found:
        sentences.append(f"No Sobol indices: fewer than {LEAST} rows of points have complete answers on a branch.")
    return Section(
        f"Tolerances of {scatter.sweep.scene.name}",
        tuple(sentences),
        tuple(_histograms(scatter, scattering[:_PANELS]) if scattering else ()),
        tuple(table for table in tables if table.rows),
        "tolerance",
        _data(scatter, scattering, found),
        complete=scatter.nominal.completed,
    )


def _shares(scatter: Scatter) -> dict[str, Interval]:
    sample = scatter.sample
    complete = [each for each in sample if each.completed]
    counts = {
        "without a complete answer": len(sample) - len(complete),
        "on another branch": sum(each.branch != scatter.nominal.branch for each in complete),
    }
    if scatter.bounds:
        counts["yield"] = sum(meets(each, scatter.bounds) for each in sample)
    return {name: share(count, len(sample)) for name, count in counts.items()}


def _sentences(scatter: Scatter) -> Iterator[str]:
    scene, sample = scatter.sweep.scene, scatter.sample
    names = ", ".join(axis.name for axis in scatter.sweep.axes)
    yield f"{scene.name}: {len(sample)} points drawn from the tolerances of {names}."
    if not scatter.nominal.completed:
        yield f"The nominal point ends with {scatter.nominal.ending}: {scatter.nominal.sentence}"
    shares = "; ".join(
        f"{name} {percent(each.value)} ({percent(each.low)} to {percent(each.high)})"
        for name, each in _shares(scatter).items()
    )
    yield f"Share of points: {shares}. Intervals of 95 % confidence."


def _displayed_unit(scatter: Scatter, measure: Measure) -> tuple[float, str]:
    """Size in the file's unit and name of the displayed unit: the stated unit, or SI with a prefix."""
    return (
        (1.0, measure.unit)
        if measure.size != 1.0
        else scaled_unit(measure.unit, abs(measure.values(scatter.nominal)[0]))
    )


def _quantile_table(scatter: Scatter, scattering: Sequence[Measure]) -> Table:
    rows = []
    for measure in scattering:
        nominal, (size, unit) = measure.values(scatter.nominal)[0], _displayed_unit(scatter, measure)
        values = values_of(measure, scatter.standing) / size
        rows.append(
            (
                str(measure),
                with_symbols(unit),
                *map(_plain, (nominal / size, values.mean(), values.std(ddof=1))),
                *map(_cell, quantiles(values)),
            )
        )
    return Table(
        "Quantiles",
        headers=("number", "unit", "nominal", "mean", "deviation", *(f"{percent(level)} below" for level in LEVELS)),
        rows=tuple(rows),
        note="Last stations; complete answers on the branch of the nominal point. In brackets the ends of the "
        "interval.",
    )


def _limit_table(scatter: Scatter) -> Table:
    met = ((bound, sum(meets(each, (bound,)) for each in scatter.sample)) for bound in scatter.bounds)
    rows = ((str(bound), _cell(share(count, len(scatter.sample)), whole=100.0)) for bound, count in met)
    return Table("Limits", ("limit", "met, %"), tuple(rows))


def _index_table(scatter: Scatter, found: dict[Measure, Indices]) -> Table:
    names = [axis.name for axis in scatter.sweep.axes]
    return Table(
        "Sobol indices",
        headers=("number", "parameter", "first order", "total order"),
        rows=tuple(
            (str(measure), name, *(_cell(order[place]) for order in each))
            for measure, each in found.items()
            for place, name in enumerate(names)
        ),
        note="First order: share of the variance by the parameter alone; total order: with all interactions.",
    )


_plain = partial(number, digits=4)


def _cell(each: Interval, whole: float = 1.0) -> str:
    return f"{_plain(whole * each.value)} ({_plain(whole * each.low)} to {_plain(whole * each.high)})"


def _histograms(scatter: Scatter, chosen: Sequence[Measure]) -> Iterator[Figure]:
    with canvas(*panels(len(chosen), 2.6)) as (figure, plots):
        for axes, measure in zip(plots, chosen, strict=True):
            size, unit = _displayed_unit(scatter, measure)
            axes.hist(values_of(measure, scatter.standing) / size, bins="auto", color=BLUE)
            axes.axvline(measure.values(scatter.nominal)[0] / size, color=RED, linewidth=1.0)
            axes.set(xlabel=f"{measure}, {with_symbols(unit)}".rstrip(", "), ylabel="points")
        yield finished(figure, "scatter", "Numbers of points by value at the last stations. Line: nominal value.")


def _data(scatter: Scatter, scattering: Sequence[Measure], found: dict[Measure, Indices]) -> Plain:
    """Documented JSON: intervals are lists of value, low and high end; numbers in the units of the scene's file."""
    numbers = [
        {
            "stage": measure.stage,
            "probe": measure.probe,
            "component": measure.component,
            "unit": measure.unit,
            "nominal": measure.values(scatter.nominal)[0],
            "quantiles": quantiles(values_of(measure, scatter.standing)),
            **dict(zip(("first", "total"), found.get(measure, ([], [])), strict=True)),
        }
        for measure in scattering
    ]
    return dict(plain({
        "scene": scatter.sweep.scene.name,
        "points": len(scatter.sample),
        "parameters": [axis.name for axis in scatter.sweep.axes],
        "shares": _shares(scatter),
        "levels": LEVELS,
        "numbers": numbers,
    }))  # fmt: skip
