"""Section of a benchmark: tables, error against time (work and precision), and time and iterations against N."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from comparisons.bench.contenders import Contender, Name
from comparisons.bench.question import MEASURES, Measure
from comparisons.bench.running import Benchmark, trend
from comparisons.bench.tables import document, sized, tables_of
from comparisons.present.canvas import BLUE, RED, canvas, common_legend, finished, logarithmic
from comparisons.present.columns import Figure, Section
from cprbm_scene.frozendict import frozendict

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LOOKS: Mapping[Name, tuple[str, str]] = frozendict(
    {
        "auto": (BLUE, "o"),
        "paper": ("#5aa0e0", "s"),
        "fea": (RED, "^"),
    }
)
"""Colours and markers of the project's own methods; a peer brings its own."""
_MEASURED = {"places": "error of displacements and rotations", "forces": "error of forces"}


def bench_section(measured: Benchmark) -> Section:
    """Times, errors and ratios of a benchmark, with figures and documented JSON."""
    figures, tables = pictures(measured), tables_of(measured)
    return Section("Run time against error", (), figures, tables, "bench", document(measured))


def pictures(measured: Benchmark) -> tuple[Figure, ...]:
    """All figures that have something to show."""
    found = []
    if any(timing.counts and timing.errors for timing in measured.timings):
        found.append(_precision(measured))
    if any(timing.counts for timing in measured.timings):
        found.append(_growth(measured))
    return tuple(found)


def _precision(measured: Benchmark) -> Figure:
    """Error against seconds: a row for each measure, the solve alone beside set-up and solve."""
    measures = [measure for measure in MEASURES if any(measure in timing.errors for timing in measured.timings)]
    with canvas(9.6, 1.2 + 3.9 * len(measures)) as figure:
        rows = figure.subplots(len(measures), 2, squeeze=False, sharex="col", sharey="row")
        for measure, (alone, both) in zip(measures, rows, strict=True):
            for axes, solve in ((alone, True), (both, False)):
                for contender in measured.contenders:
                    _series(axes, measured, contender, measure, solve=solve)
                logarithmic(axes)
            alone.set_ylabel(_MEASURED[measure])
        rows[-1][0].set_xlabel("seconds of the solve alone")
        rows[-1][1].set_xlabel("seconds of set-up and solve")
        for axes in rows.ravel():
            _whole_decades(axes)
        common_legend(figure, "upper center", 5)
        return finished(figure, "bench-precision", "Error against time, each point a number of links or elements.")


def _look(contender: Contender) -> tuple[str, str]:
    return _LOOKS.get(contender.name, contender.look)


def _series(axes: Axes, measured: Benchmark, contender: Contender, measure: Measure, *, solve: bool) -> None:
    """A method's points, with N at the first and the last."""
    shown = [one for one in measured.of(contender.name) if one.counts and one.errors.get(measure, 0.0) > 0.0]
    if not shown:
        return
    colour, marker = _look(contender)
    points = [(one.solve if solve else one.total, one.errors[measure]) for one in shown]
    axes.plot(*zip(*points, strict=True), f"-{marker}", color=colour, markersize=5, linewidth=1.1,
              label=contender.label)  # fmt: skip
    for place, below in {0: 3.0, len(shown) - 1: -10.0}.items():
        axes.annotate(sized(shown[place].count), points[place], (5.0, below), textcoords="offset points", color=colour,
                      fontsize=8.0)  # fmt: skip


def _growth(measured: Benchmark) -> Figure:
    """Seconds and iterations against N."""
    with canvas(6.4, 7.2) as figure:
        seconds, iterations = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        for contender in measured.contenders:
            colour, marker = _look(contender)
            done = [timing for timing in measured.of(contender.name) if timing.counts]
            if not done:
                continue
            found = trend(measured.of(contender.name))
            label = contender.label
            if found.exponent is not None and found.factor is not None:
                span = np.array([found.sizes[0], found.sizes[-1]])
                seconds.plot(span, found.factor * span**found.exponent, "--", color=colour, linewidth=1.0)
                label += f": exponent {found.exponent:.2f}"
            n = [timing.n for timing in done]
            median = np.array([timing.total for timing in done])
            quartiles = np.array([np.percentile(timing.both, (25.0, 75.0)) for timing in done]).T
            bars = np.abs(quartiles - median)
            seconds.errorbar(n, median, bars, fmt=marker, color=colour, markersize=5, capsize=3, label=label)
            iterations.plot(n, [max(timing.total_iterations, 1) for timing in done], marker, color=colour, markersize=5)
        sizes = sorted({timing.n for timing in measured.timings if timing.counts})
        for axes in (seconds, iterations):
            logarithmic(axes, sizes)
            low, high = axes.get_ylim()
            axes.set_ylim(10.0 ** np.floor(np.log10(low)), 10.0 ** np.ceil(np.log10(high)))
            axes.tick_params(axis="x", which="minor", bottom=False)
        seconds.set_ylabel("seconds of set-up and solve")
        common_legend(figure, "upper center", 2)
        iterations.set_ylabel("iterations, all stations")
        iterations.set_xlabel("links or elements per beam, N")
        return finished(
            figure, "bench", "Median time with the quartiles, and iterations, against the number of links or elements."
        )


def _whole_decades(axes: Axes) -> None:
    """Whole decades, so that a logarithmic axis always has two ticks or more."""
    for get, put in ((axes.get_xlim, axes.set_xlim), (axes.get_ylim, axes.set_ylim)):
        low, high = get()
        put(10.0 ** np.floor(np.log10(low)), 10.0 ** np.ceil(np.log10(high)))
