"""Section of a benchmark: tables, error against time (work and precision), and time and iterations against N."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from comparisons.bench.contenders import Contender, Name
from comparisons.bench.question import MEASURES
from comparisons.bench.running import Benchmark, Timing, trend
from comparisons.bench.tables import document, sized, tables_of
from comparisons.present.canvas import BLUE, RED, canvas, common_legend, finished, logarithmic
from comparisons.present.columns import Figure, Section
from cprbm_scene.frozendict import frozendict

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LOOKS: Mapping[Name, tuple[str, str]] = frozendict({"auto": (BLUE, "o"), "paper": ("#5aa0e0", "s"), "fea": (RED, "^")})
"""Colours and markers of the project's own methods; a peer brings its own."""

_MEASURED = {"places": "error of displacements and rotations", "forces": "error of forces"}


def bench_section(measured: Benchmark) -> Section:
    """Times, errors and ratios of a benchmark, with figures and documented JSON."""
    return Section("Run time against error", (), pictures(measured), tables_of(measured), "bench", document(measured))


def pictures(measured: Benchmark) -> tuple[Figure, ...]:
    """Error against time, and time against N; without rows that count no figure."""
    counted = {each: [row for row in measured.of(each.name) if row.counts] for each in measured.contenders}
    counted = {each: rows for each, rows in counted.items() if rows}
    measures = [name for name in MEASURES if any(name in row.errors for rows in counted.values() for row in rows)]
    found = []
    if measures:
        with canvas(6.4, 1.2 + 3.6 * len(measures)) as drawing:
            panels = np.atleast_1d(drawing.subplots(len(measures), 1, sharex=True))
            for axes, measure in zip(panels, measures, strict=True):
                for method, rows in counted.items():
                    shown = [row for row in rows if row.errors.get(measure, 0.0) > 0.0]
                    _line(axes, method, shown, [(row.total, row.errors[measure]) for row in shown])
                _decades(axes, _MEASURED[measure])
            panels[-1].set_xlabel("seconds of set-up and solve")
            common_legend(drawing, "upper center", 3)
            caption = "Error against time, each point a number of links or elements."
            found.append(finished(drawing, "bench-precision", caption))
    if counted:
        with canvas(6.4, 7.2) as drawing:
            seconds, iterations = drawing.subplots(2, 1, sharex=True, height_ratios=(3, 2))
            for method, rows in counted.items():
                exponent = trend(measured.of(method.name)).exponent
                label = method.label + ("" if exponent is None else f": exponent {exponent:.2f}")
                _line(seconds, method, [], [(row.n, row.total) for row in rows], label)
                _line(iterations, method, [], [(row.n, max(row.total_iterations, 1)) for row in rows])
            sizes = sorted({row.n for rows in counted.values() for row in rows})
            _decades(seconds, "seconds of set-up and solve", sizes)
            _decades(iterations, "iterations, all stations", sizes)
            iterations.set_xlabel("links or elements per beam, N")
            drawing.legend(*seconds.get_legend_handles_labels(), loc="outside upper center", ncols=2)
            found.append(finished(drawing, "bench", "Median time and iterations against links or elements."))
    return tuple(found)


def _line(
    axes: Axes, method: Contender, named: Sequence[Timing], points: Sequence[tuple[float, float]], label: str = ""
) -> None:
    """A method's points, with N at the first and the last of the ``named`` rows."""
    colour, marker = _LOOKS.get(method.name, method.look)
    if points:
        axes.plot(*zip(*points, strict=True), f"-{marker}", color=colour, markersize=5, linewidth=1.1,
                  label=label or method.label)  # fmt: skip
    for place, below in {0: 3.0, len(named) - 1: -10.0}.items() if named else ():
        axes.annotate(sized(named[place].count), points[place], (5.0, below), textcoords="offset points", color=colour,
                      fontsize=8.0)  # fmt: skip


def _decades(axes: Axes, name: str, sizes: Sequence[float] = ()) -> None:
    """Logarithmic scales with whole decades, so that an axis has two ticks or more, and ticks at the sizes."""
    logarithmic(axes, sizes)
    both = ((axes.get_ylim, axes.set_ylim), (axes.get_xlim, axes.set_xlim))
    for get, put in both[:1] if sizes else both:
        low, high = get()
        put(10.0 ** np.floor(np.log10(low)), 10.0 ** np.ceil(np.log10(high)))
    axes.set_ylabel(name)
