"""The figure of a benchmark: time and iterations against N."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from comparisons.benchmark import METHODS, Benchmark, Method, trend
from comparisons.figures import BLUE, RED, Picture, canvas, picture
from scene import Ending

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def of_benchmark(measured: Benchmark) -> Picture:
    """Seconds and iterations against N, both axes logarithmic."""
    with canvas(6.4, 6.4) as figure:
        seconds, iterations = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        sizes = sorted({timing.n for timing in measured.timings})
        for method, colour, marker in zip(METHODS, (BLUE, RED), "os", strict=True):
            if measured.of(method):
                _timings(measured, method, seconds, iterations, colour, marker)
        for axes in (seconds, iterations):
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_xticks(sizes, [str(n) for n in sizes])
            axes.minorticks_off()
            axes.grid(visible=True, which="major", color="#e4e4e4", linewidth=0.6)
        for axes, values in (
            (seconds, [timing.median for timing in measured.timings]),
            (iterations, [max(timing.total_iterations, 1) for timing in measured.timings]),
        ):
            _decades(axes, values)
        seconds.set_ylabel("seconds of a whole answer")
        seconds.legend(loc="upper left")
        iterations.set_ylabel("iterations, all stations")
        iterations.set_xlabel("links or elements per beam, N")
        return picture(
            figure,
            "bench",
            "Median time with the quartiles, and iterations, against the number of links or elements per beam.",
        )


def _timings(measured: Benchmark, method: Method, seconds: Axes, iterations: Axes, colour: str, marker: str) -> None:
    """A method's runs that completed with their fit, and crosses for those that did not."""
    done = [timing for timing in measured.of(method) if timing.ending is Ending.COMPLETED]
    ended = [timing for timing in measured.of(method) if timing.ending is not Ending.COMPLETED]
    label = measured.label(method)
    found = trend(measured, method)
    if found.exponent is not None and found.factor is not None:
        span = np.array([found.sizes[0], found.sizes[-1]], dtype=float)
        seconds.plot(span, found.factor * span**found.exponent, "--", color=colour, linewidth=1.0)
        label += f": exponent {found.exponent:.2f}"
    n = [timing.n for timing in done]
    if done:
        median = np.array([timing.median for timing in done])
        quartiles = np.array([np.percentile(timing.seconds, (25.0, 75.0)) for timing in done]).T
        bars = np.abs(quartiles - median)
        seconds.errorbar(n, median, bars, fmt=marker, color=colour, markersize=5, capsize=3, label=label)
        iterations.plot(n, [timing.total_iterations for timing in done], marker, color=colour, markersize=5)
    if ended:
        label = f"{measured.label(method)}: did not complete"
        times = [timing.median for timing in ended]
        seconds.plot([timing.n for timing in ended], times, "x", color=colour, markersize=7, label=label)


def _decades(axes: Axes, values: Sequence[float]) -> None:
    """Whole decades round the values, so that a logarithmic axis always has two ticks or more."""
    low, high = np.floor(np.log10(min(values))), np.ceil(np.log10(max(values)))
    axes.set_ylim(10.0**low, 10.0 ** max(high, low + 1.0))
