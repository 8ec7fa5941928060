"""The page of a sweep: values over one or two parameters, curves of all points with a slider, and checked points.

Values on different branches are never joined: a curve is cut, and a contour map leaves the cell out.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.formats import display_unit
from comparisons.present.canvas import BLUE, RED, canvas, finished, panels
from comparisons.present.columns import Figure, Section
from comparisons.present.page import put_section, rendered
from comparisons.sweeps.outcome import Outcome, Record
from comparisons.sweeps.points import Axis, place_text
from comparisons.sweeps.running import Sweep, Task
from comparisons.sweeps.tables import last_numbers, name_of
from comparisons.verdict.rows import ROUND_OFF
from comparisons.writing import write

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PANELS = 12
"""Largest number of panels in a figure."""

_RATIO = "difference over stated uncertainty"

Solved = Sequence[tuple[Task, Outcome]]
"""Points with numbers."""


def write_page(folder: Path, sweep: Sweep) -> None:
    """Write ``index.html`` and the figures.

    Raises:
        OSError: a file cannot be written.
    """
    solved = sweep.solved()
    names = _names_of(_fullest(solved)) if solved else []
    figures = tuple(_figures(sweep, solved, names)) if solved else ()
    put_section(folder, Section("", figures=figures))
    failed = [
        (place_text(sweep.axes, task.point), outcome.ending, outcome.sentence)
        for task, outcome in sweep.points()
        if not outcome.completed
    ]
    family = json.dumps(_slider(sweep, solved, *names[0]) if names else {"curves": []}).replace("<", "\\u003c")
    context = {"sweep": sweep, "figures": figures, "failed": failed, "family": family}
    write(folder / "index.html", rendered("sweep.html", context))


def _figures(sweep: Sweep, solved: Solved, names: Sequence[tuple[str, str]]) -> Iterator[Figure]:
    """All figures of a sweep."""
    yield _over_parameters(sweep, solved, names[:_PANELS])
    for stage in sweep.scene.stages:
        mine = [name for own, name in names if own == stage.name][:_PANELS]
        if mine:
            yield _curves(sweep, solved, stage.name, mine)
    if any(outcome.solver == "compare" for _, outcome in solved):
        yield _checked(sweep, solved)


def _fullest(solved: Solved) -> Outcome:
    """The first outcome with the most numbers."""
    return max((outcome for _, outcome in solved), key=lambda outcome: len(outcome.numbers))


def _names_of(outcome: Outcome) -> list[tuple[str, str]]:
    """Stages and names of the numbers of the last stations, without components that are round-off at all stations."""
    largest: dict[tuple[str, ...], float] = {}
    for number, key in ((n, key) for n in outcome.numbers for key in ((n["unit"],), (n["stage"], name_of(n)))):
        largest[key] = max(largest.get(key, 0.0), abs(number["value"]))
    names = [((each["stage"], name_of(each)), each["unit"]) for each in last_numbers(outcome)]
    return [name for name, unit in names if largest[name] > ROUND_OFF * largest[unit,]]


def _curve_of(outcome: Outcome, stage: str, name: str) -> list[Record]:
    """Numbers of a name in a stage, station by station."""
    mine = (each for each in outcome.numbers if each["stage"] == stage and each["arc_length"] is None)
    return [each for each in mine if name_of(each) == name]


def _unit_of(sweep: Sweep, numbers: Sequence[Record], kind: str = "") -> tuple[float, str]:
    """Displayed unit of the values, or with ``station`` of the stations, of numbers in one unit."""
    unit, value = (f"{kind}_unit", kind) if kind else ("unit", "value")
    return display_unit(sweep.scene, numbers[0][unit], max(abs(each[value]) for each in numbers))


def _over_parameters(sweep: Sweep, solved: Solved, names: Sequence[tuple[str, str]]) -> Figure:
    """Numbers of the last station over the parameters: curves, contours, or points of a sample."""
    grid, first = all(axis.count for axis in sweep.axes), sweep.axes[0]
    mapped = grid and len(sweep.axes) == 2
    failed = [task for task, outcome in sweep.points() if not outcome.completed]
    ends = [{(each["stage"], name_of(each)): each for each in last_numbers(outcome)} for _, outcome in solved]
    with canvas(6.4, 4.8) as figure:
        for axes, (stage, name) in zip(panels(figure, len(names), 3.0), names, strict=True):
            known = [each.get((stage, name)) for each in ends]
            size, label = _unit_of(sweep, [each for each in known if each is not None])
            numbers = [np.nan if each is None else each["value"] / size for each in known]
            axes.set_title(f"{stage}: {name}, {label}".rstrip(", "), fontsize=9)
            axes.set_xlabel(first.label)
            if mapped:
                _contours(figure, axes, sweep.axes, solved, numbers)
            else:
                _joined(axes, first, solved, numbers, join=grid and len(sweep.axes) == 1)
            low = [sweep.axes[1].of(task.point) if mapped else axes.get_ylim()[0] for task in failed]
            if failed:
                axes.plot([first.of(task.point) for task in failed], low, "x", color=RED, clip_on=False)
        caption = "Values at the last station over the parameters. Crosses: points that failed."
        return finished(figure, "parameters", caption)


def _joined(axes: Axes, axis: Axis, solved: Solved, numbers: list[float], *, join: bool) -> None:
    """Points over a parameter; neighbours on one branch are joined."""
    for _, part in groupby(enumerate(solved), lambda each: each[1][1].branch):
        mine = [place for place, _ in part]
        x = [axis.of(solved[place][0].point) for place in mine]
        axes.plot(x, [numbers[place] for place in mine], "o-" if join else "o", color=BLUE, markersize=3.0)


def _contours(figure: Any, axes: Axes, pair: Sequence[Axis], solved: Solved, numbers: list[float]) -> None:  # noqa: ANN401
    """Filled contours over two parameters, branch by branch."""
    first, second = pair
    values = np.full(first.count * second.count, np.nan)
    branches = np.full(values.size, -1)
    kinds = sorted({outcome.branch for _, outcome in solved if outcome.completed})
    for (task, outcome), number in zip(solved, numbers, strict=True):
        if outcome.completed:
            values[task.number - 1], branches[task.number - 1] = number, kinds.index(outcome.branch)
    if not np.isfinite(values).any():
        return
    levels = np.linspace(np.nanmin(values), max(np.nanmax(values), np.nextafter(np.nanmin(values), np.inf)), 12)
    axes.set_ylabel(second.label)
    x, y = (np.array(axis.values()) / axis.size for axis in pair)
    for branch in range(len(kinds)):
        own = np.ma.masked_where(branches != branch, values).reshape(first.count, second.count).T
        drawn = axes.contourf(x, y, own, levels=levels)
    figure.colorbar(drawn, ax=axes)


def _curves(sweep: Sweep, solved: Solved, stage: str, names: Sequence[str]) -> Figure:
    """The curves of all points against the load or drive of a stage."""
    first, longest = sweep.axes[0], _fullest(solved)
    steps = next(each.steps for each in sweep.scene.stages if each.name == stage)
    with canvas(6.4, 4.8) as figure:
        for axes, name in zip(panels(figure, len(names), 3.0), names, strict=True):
            whole = _curve_of(longest, stage, name)
            (size, label), (step, step_label) = _unit_of(sweep, whole[-1:]), _unit_of(sweep, whole, "station")
            axes.set_title(f"{name}, {label}".rstrip(", "), fontsize=9)
            axes.set_xlabel(f"{steps}, {step_label}")
            for task, outcome in solved:
                share = (task.point[first.name] - first.low) / (first.high - first.low)
                colour = 0.1 + 0.5 * share, 0.2 + 0.55 * share, 0.45 + 0.45 * share  # from dark to light blue
                curve = _curve_of(outcome, stage, name)
                for _, part in groupby(curve, lambda number: number["branch"]):
                    own = np.array([(number["station"] / step, number["value"] / size) for number in part])
                    look = "o" if len(own) == 1 else "-"
                    axes.plot(*own.T, look, color=colour, linewidth=1.0, markersize=2.0)
                if curve and not outcome.completed:
                    axes.plot(curve[-1]["station"] / step, curve[-1]["value"] / size, "x", color=RED)
        caption = f"Stage {stage}: curves of all points; colours from {first.text(first.low)} (dark) to "
        caption += f"{first.text(first.high)} (light). Crosses: the last station of points that failed."
        return finished(figure, f"curves-{stage}", caption)


def _slider(sweep: Sweep, solved: Solved, stage: str, name: str) -> Mapping[str, Any]:
    """Curves of a number for the slider."""
    curves = [_curve_of(outcome, stage, name) for _, outcome in solved]
    ends = [curve[-1] for curve in curves if curve]
    (size, unit), (step, step_unit) = _unit_of(sweep, ends), _unit_of(sweep, ends, "station")
    return {
        "title": f"Stage {stage}: {name}, {unit}, against the load or drive, {step_unit}",
        "curves": [
            {
                "label": f"{place_text(sweep.axes, task.point)}: {outcome.ending}",
                "points": [[n["station"] / step, n["value"] / size, n["branch"]] for n in curve],
            }
            for (task, outcome), curve in zip(solved, curves, strict=True)
        ],
    }


def _checked(sweep: Sweep, solved: Solved) -> Figure:
    """Largest difference over stated uncertainty at the checked points."""
    checked = [(task.point, outcome.numbers) for task, outcome in solved if outcome.solver == "compare"]
    ratios = [
        max((n["difference"] / n["stated"] for n in numbers if n["stated"]), default=np.nan) for _, numbers in checked
    ]
    with canvas(6.4, 4.0) as figure:
        axes = figure.add_subplot()
        axes.set_xlabel(sweep.axes[0].label)
        x, y = ([axis.of(point) for point, _ in checked] for axis in (sweep.axes * 2)[:2])
        if len(sweep.axes) > 1:
            axes.set_ylabel(sweep.axes[1].label)
            figure.colorbar(axes.scatter(x, y, c=ratios, cmap="viridis"), ax=axes, label=_RATIO)
        else:
            axes.plot(x, ratios, "o", color=BLUE)
            axes.axhline(1.0, color=RED, linewidth=0.8)
            axes.set_ylabel(_RATIO)
        return finished(figure, "checked", "Largest difference over stated uncertainty at the checked points.")
