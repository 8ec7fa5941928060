"""Figures of a sweep: values over one or two parameters, curves of all points, and the map of the checked points.

Values on different branches are never joined: a curve is cut, and a contour map leaves the cell out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby, islice
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.formats import display_unit
from comparisons.present.canvas import BLUE, RED, canvas, finished
from comparisons.present.columns import Figure
from comparisons.sweeps.outcome import Outcome, Record
from comparisons.sweeps.points import Axis
from comparisons.sweeps.running import Sweep, Task
from comparisons.sweeps.tables import last_numbers, name_of
from comparisons.verdict.rows import ROUND_OFF

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PANELS = 12
"""Largest number of panels in a figure."""

_Solved = list[tuple[Task, Outcome]]


def pictures(sweep: Sweep) -> Iterator[Figure]:
    """All figures of a sweep; none where no point has a number."""
    solved = sweep.solved()
    if not solved:
        return
    yield _over_parameters(sweep, solved)
    yield from _family(sweep, solved)
    if any(outcome.solver == "compare" for _, outcome in solved):
        yield _checked(sweep, solved)


def fullest(solved: _Solved) -> Outcome:
    """The first outcome with the most numbers."""
    return max((outcome for _, outcome in solved), key=lambda outcome: len(outcome.numbers))


def names_of(outcome: Outcome) -> list[tuple[str, str]]:
    """Stages and names of the numbers of the last stations, without components that are round-off at all stations."""
    largest: dict[tuple[str, ...], float] = {}
    for number, key in ((n, key) for n in outcome.numbers for key in ((n["unit"],), (n["stage"], name_of(n)))):
        largest[key] = max(largest.get(key, 0.0), abs(number["value"]))
    names = [((each["stage"], name_of(each)), each["unit"]) for each in last_numbers(outcome)]
    return [name for name, unit in names if largest[name] > ROUND_OFF * largest[unit,]]


def curve_of(outcome: Outcome, stage: str, name: str) -> list[Record]:
    """Numbers of a name in a stage, station by station."""
    return [
        number
        for number in outcome.numbers
        if number["stage"] == stage and number["arc_length"] is None and name_of(number) == name
    ]


def _panels(figure: Any, count: int) -> Sequence[Axes]:  # noqa: ANN401 - loaded inside the canvas
    columns = min(count, 2)
    rows = -(-count // columns)
    figure.set_size_inches(4.2 * columns, 3.0 * rows)
    return [figure.add_subplot(rows, columns, place + 1) for place in range(count)]


def _over_parameters(sweep: Sweep, solved: _Solved) -> Figure:
    """Numbers of the last station over the parameters: curves, contours, or points of a sample."""
    chosen = list(islice(names_of(fullest(solved)), _PANELS))
    grid, count = all(axis.count for axis in sweep.axes), len(sweep.axes)
    kind = {1: "curves", 2: "contours"}.get(count, "points") if grid else "points"
    with canvas(6.4, 4.8) as figure:
        for axes, (stage, name) in zip(_panels(figure, len(chosen)), chosen, strict=True):
            values = [next((n for n in last_numbers(o) if (n["stage"], name_of(n)) == (stage, name)), None)
                      for _, o in solved]  # fmt: skip
            unit = next(each["unit"] for each in values if each is not None)
            size, label = display_unit(sweep.scene, unit, max(abs(each["value"]) for each in values if each))
            numbers = [np.nan if each is None else each["value"] / size for each in values]
            first = sweep.axes[0]
            axes.set_title(f"{stage}: {name}, {label}".rstrip(", "), fontsize=9)
            axes.set_xlabel(_label(first))
            if kind == "contours":
                _contours(figure, axes, sweep, solved, numbers)
            else:
                _joined(axes, first, solved, numbers, join=kind == "curves")
            failed = [task for task, outcome in sweep.points() if not outcome.completed]
            low = [axes.get_ylim()[0] if kind != "contours" else _place(task, sweep.axes[1]) for task in failed]
            if failed:
                axes.plot([_place(task, first) for task in failed], low, "x", color=RED, clip_on=False)
        caption = "Values at the last station over the parameters. Crosses: points that failed."
        return finished(figure, "parameters", caption)


def _place(task: Task, axis: Axis) -> float:
    """Value of a parameter in the displayed unit."""
    return task.point[axis.name] / axis.size


def _label(axis: Axis) -> str:
    return f"{axis.name}, {axis.unit}".rstrip(", ")


def _joined(axes: Axes, axis: Axis, solved: _Solved, numbers: list[float], *, join: bool) -> None:
    """Points over a parameter; neighbours on one branch are joined."""
    places = [task.point[axis.name] / axis.size for task, _ in solved]
    start = 0
    for _, part in groupby(solved, lambda each: each[1].branch):
        stop = start + len(list(part))
        axes.plot(places[start:stop], numbers[start:stop], "o-" if join else "o", color=BLUE, markersize=3.0)
        start = stop


def _contours(figure: Any, axes: Axes, sweep: Sweep, solved: _Solved, numbers: list[float]) -> None:  # noqa: ANN401
    """Filled contours over two parameters, branch by branch."""
    first, second = sweep.axes
    shape = first.count, second.count
    values = np.full(shape[0] * shape[1], np.nan)
    branches = np.full(values.size, -1)
    kinds = sorted({outcome.branch for _, outcome in solved if outcome.completed})
    for (task, outcome), number in zip(solved, numbers, strict=True):
        if outcome.completed:
            values[task.number - 1], branches[task.number - 1] = number, kinds.index(outcome.branch)
    if not np.isfinite(values).any():
        return
    levels = np.linspace(np.nanmin(values), max(np.nanmax(values), np.nextafter(np.nanmin(values), np.inf)), 12)
    axes.set_ylabel(_label(second))
    x, y = (np.array(axis.values()) / axis.size for axis in (first, second))
    for branch in range(len(kinds)):
        own = np.ma.masked_where(branches != branch, values).reshape(shape).T
        drawn = axes.contourf(x, y, own, levels=levels)
    figure.colorbar(drawn, ax=axes)


def _family(sweep: Sweep, solved: _Solved) -> Iterator[Figure]:
    """The curves of all points against the load or drive of every stage."""
    first = sweep.axes[0]
    span, longest = first.high - first.low, fullest(solved)
    for stage in sweep.scene.stages:
        chosen = list(islice((name for own, name in names_of(longest) if own == stage.name), _PANELS))
        if not chosen:
            continue
        with canvas(6.4, 4.8) as figure:
            for axes, name in zip(_panels(figure, len(chosen)), chosen, strict=True):
                end = curve_of(longest, stage.name, name)[-1]
                size, label = display_unit(sweep.scene, end["unit"], abs(end["value"]))
                step, step_label = display_unit(sweep.scene, end["station_unit"], max(map(abs, stage.stations)))
                axes.set_title(f"{name}, {label}".rstrip(", "), fontsize=9)
                axes.set_xlabel(f"{stage.steps}, {step_label}")
                for task, outcome in solved:
                    colour = _colour((task.point[first.name] - first.low) / span)
                    curve = curve_of(outcome, stage.name, name)
                    for _, part in groupby(curve, lambda number: number["branch"]):
                        own = np.array([(number["station"] / step, number["value"] / size) for number in part])
                        look = "o" if len(own) == 1 else "-"
                        axes.plot(*own.T, look, color=colour, linewidth=1.0, markersize=2.0)
                    if curve and not outcome.completed:
                        axes.plot(curve[-1]["station"] / step, curve[-1]["value"] / size, "x", color=RED)
            caption = f"Stage {stage.name}: curves of all points; colours from {first.text(first.low)} (dark) to "
            caption += f"{first.text(first.high)} (light). Crosses: the last station of points that failed."
            yield finished(figure, f"curves-{stage.name}", caption)


def _colour(share: float) -> tuple[float, float, float]:
    """Colour from dark to light blue."""
    return 0.1 + 0.5 * share, 0.2 + 0.55 * share, 0.45 + 0.45 * share


def _checked(sweep: Sweep, solved: _Solved) -> Figure:
    """Largest difference over stated uncertainty at the checked points."""
    checked = [(task, outcome) for task, outcome in solved if outcome.solver == "compare"]
    ratios = [
        max((n["difference"] / n["stated"] for n in outcome.numbers if n["stated"]), default=np.nan)
        for _, outcome in checked
    ]
    first, second = sweep.axes[0], sweep.axes[1] if len(sweep.axes) > 1 else None
    with canvas(6.4, 4.0) as figure:
        axes = figure.add_subplot()
        axes.set_xlabel(_label(first))
        x = [task.point[first.name] / first.size for task, _ in checked]
        if second is None:
            axes.plot(x, ratios, "o", color=BLUE)
            axes.axhline(1.0, color=RED, linewidth=0.8)
            axes.set_ylabel("difference over stated uncertainty")
        else:
            axes.set_ylabel(_label(second))
            y = [task.point[second.name] / second.size for task, _ in checked]
            drawn = axes.scatter(x, y, c=ratios, cmap="viridis")
            figure.colorbar(drawn, ax=axes, label="difference over stated uncertainty")
        return finished(figure, "checked", "Largest difference over stated uncertainty at the checked points.")
