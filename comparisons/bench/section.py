"""Section of a benchmark: tables, error against time (work and precision), and time and iterations against N."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from comparisons.bench.contenders import Contender
from comparisons.bench.measures import MEASURES, Measure
from comparisons.bench.running import Session, Timing, trend
from comparisons.bench.tables import document, size_text, tables_of
from comparisons.present.canvas import canvas, common_legend, finished, logarithmic
from comparisons.present.columns import Figure, Section

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MEASURED: dict[Measure, str] = {"places": "error of displacements and rotations", "forces": "error of forces"}
Rows = dict[Contender, Sequence[Timing]]
"""Rows that count, by method."""


def bench_section(measured: Session) -> Section:
    """Times, errors and ratios of a benchmark, with figures and documented JSON."""
    return Section("Run time against error", (), pictures(measured), tables_of(measured), "bench", document(measured))


def pictures(measured: Session) -> tuple[Figure, ...]:
    """Error against time, and time against N; without rows that count no figure."""
    every: Rows = {each: [row for row in measured.rows(each.name) if row.counts] for each in measured.methods()}
    rows = {each: mine for each, mine in every.items() if mine}
    known = [name for name in MEASURES if any(name in row.errors for mine in rows.values() for row in mine)]
    return (*((_precision(rows, known),) if known else ()), *((_growth(rows),) if rows else ()))


def _precision(rows: Rows, measures: Sequence[Measure]) -> Figure:
    with canvas(6.4, 1.2 + 3.6 * len(measures)) as drawing:
        panels = np.atleast_1d(drawing.subplots(len(measures), 1, sharex=True))
        for axes, measure in zip(panels, measures, strict=True):
            for method, mine in rows.items():
                shown = [row for row in mine if row.errors.get(measure, 0.0) > 0.0]
                points = [(row.median("both"), row.errors[measure]) for row in shown]
                _line(axes, method, points, method.label)
                for place, below in {0: 3.0, len(shown) - 1: -10.0}.items() if shown else ():
                    text = size_text(shown[place].count)
                    axes.annotate(text, points[place], (5.0, below), textcoords="offset points", color=method.look[0],
                                  fontsize=8.0)  # fmt: skip
            _decades(axes, _MEASURED[measure])
        panels[-1].set_xlabel("seconds of set-up and solve")
        common_legend(drawing, "upper center", 3)
        return finished(drawing, "bench-precision", "Error against time, each point a number of links or elements.")


def _growth(rows: Rows) -> Figure:
    with canvas(6.4, 7.2) as drawing:
        seconds, iterations = drawing.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        for method, mine in rows.items():
            _, exponent, _ = trend(tuple(mine))
            label = method.label + ("" if exponent is None else f": exponent {exponent:.2f}")
            _line(seconds, method, [(row.n, row.median("both")) for row in mine], label)
            _line(iterations, method, [(row.n, max(row.iterations, 1)) for row in mine], label)
        sizes = sorted({row.n for mine in rows.values() for row in mine})
        _decades(seconds, "seconds of set-up and solve", sizes)
        _decades(iterations, "iterations, all stations", sizes)
        iterations.set_xlabel("links or elements per beam, N")
        drawing.legend(*seconds.get_legend_handles_labels(), loc="outside upper center", ncols=2)
        return finished(drawing, "bench", "Median time and iterations against links or elements.")


def _line(axes: Axes, method: Contender, points: Sequence[tuple[float, float]], label: str) -> None:
    """Draw the points of a method with its colour and marker; without points nothing, not even a label."""
    colour, marker = method.look
    if points:
        axes.plot(*zip(*points, strict=True), f"-{marker}", color=colour, markersize=5, linewidth=1.1, label=label)


def _decades(axes: Axes, name: str, sizes: Sequence[float] = ()) -> None:
    """Logarithmic scales with whole decades, so that an axis has two ticks or more, and ticks at the sizes."""
    logarithmic(axes, sizes)
    axes.set_ylabel(name)
    for axis in (axes.yaxis,) if sizes else (axes.yaxis, axes.xaxis):
        low, high = np.log10(axis.get_view_interval())
        axis.set_view_interval(10.0 ** np.floor(low), 10.0 ** np.ceil(high), ignore=True)
