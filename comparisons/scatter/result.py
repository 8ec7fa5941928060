"""The result of a study of scatter: sentences, tables, a figure and JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from comparisons.formats import number, percent, scaled_unit
from comparisons.plain import Plain, plain
from comparisons.present.canvas import BLUE, RED, canvas, finished
from comparisons.present.columns import Figure, Section, Table
from comparisons.scatter.study import LEAST, LEVELS, Indices, Interval, Scatter, quantiles, share, values_of
from comparisons.sweeps.demands import Measure, meets

_PANELS = 6
"""Largest number of histograms in the figure."""


def result_of(scatter: Scatter) -> Section:
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
        tuple(_histograms(scatter, scattering[:_PANELS])),
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


def _quantile_table(scatter: Scatter, scattering: Sequence[Measure]) -> Table:
    headers = ("number", "unit", "nominal", "mean", "deviation", *(f"{percent(level)} below" for level in LEVELS))
    rows = []
    for measure in scattering:
        nominal = measure.values(scatter.nominal)[0]
        size, unit = (1.0, measure.unit) if measure.size != 1.0 else scaled_unit(measure.unit, abs(nominal))
        values = values_of(measure, scatter.standing) / size
        cells = map(_cell, quantiles(values))
        rows.append((str(measure), unit, *map(_plain, (nominal / size, values.mean(), values.std(ddof=1))), *cells))
    note = "Last stations; complete answers on the branch of the nominal point. In brackets the ends of the interval."
    return Table("Quantiles", headers, tuple(rows), note)


def _limit_table(scatter: Scatter) -> Table:
    sample = scatter.sample
    rows = tuple((str(each), _cell(share(sum(meets(one, (each,)) for one in sample), len(sample)), whole=100.0))
                 for each in scatter.bounds)  # fmt: skip
    return Table("Limits", ("limit", "met, %"), rows)


def _index_table(scatter: Scatter, found: dict[Measure, Indices]) -> Table:
    names = [axis.name for axis in scatter.sweep.axes]
    rows = tuple(
        (str(measure), name, _cell(each.first[place]), _cell(each.total[place]))
        for measure, each in found.items()
        for place, name in enumerate(names)
    )
    note = "First order: share of the variance by the parameter alone; total order: with all interactions."
    return Table("Sobol indices", ("number", "parameter", "first order", "total order"), rows, note)


def _plain(value: float) -> str:
    return number(value, 4)


def _cell(each: Interval, whole: float = 1.0) -> str:
    return f"{_plain(whole * each.value)} ({_plain(whole * each.low)} to {_plain(whole * each.high)})"


def _histograms(scatter: Scatter, chosen: Sequence[Measure]) -> Iterator[Figure]:
    if not chosen:
        return
    columns = min(len(chosen), 2)
    rows = -(-len(chosen) // columns)
    with canvas(4.2 * columns, 2.6 * rows) as figure:
        for place, measure in enumerate(chosen, start=1):
            axes = figure.add_subplot(rows, columns, place)
            axes.hist(values_of(measure, scatter.standing), bins="auto", color=BLUE)
            axes.axvline(measure.values(scatter.nominal)[0], color=RED, linewidth=1.0)
            axes.set_xlabel(f"{measure}, {measure.unit}".rstrip(", "), fontsize=8)
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
            "first": found[measure].first if measure in found else [],
            "total": found[measure].total if measure in found else [],
        }
        for measure in scattering
    ]
    data: Plain = plain({
        "scene": scatter.sweep.scene.name,
        "points": len(scatter.sample),
        "parameters": [axis.name for axis in scatter.sweep.axes],
        "shares": _shares(scatter),
        "levels": LEVELS,
        "numbers": numbers,
    })  # fmt: skip
    return data
