"""Files of a sweep: two CSV tables, NetCDF through xarray (extra ``netcdf``), figures, and the page.

The long table has a line per number with its unit, the wide table a line per point with the numbers of the last
stations; both are in the units of the scene's file.  NetCDF is in SI: variables ``STAGE.PROBE.COMPONENT`` over the
points, the stations of the stage, and the places of a stress, with ``STAGE.station`` and ``STAGE.branch``.  A missing
number is NaN.

The page has values over one or two parameters, curves of all points with a slider, and checked points.  Values on
different branches are never joined: a curve is cut, and a contour map leaves the cell out.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.formats import display_unit
from comparisons.present.canvas import BLUE, RED, Axes, canvas, finished, panels
from comparisons.present.columns import Figure, Section, Table
from comparisons.present.csv_table import csv_text, in_file_units, in_unit
from comparisons.present.page import put_section, rendered
from comparisons.quantities import stage_of
from comparisons.sweeps.demands import Measure, measures
from comparisons.sweeps.outcome import NumberRecord, Outcome
from comparisons.sweeps.points import Axis, place_text
from comparisons.sweeps.running import Sweep, Task
from comparisons.verdict import ROUND_OFF
from comparisons.writing import write
from cprbm_scene import Array, Scene, Stage

_VALUES = ("value", "fea", "difference", "stated")
_PLACES = ("stage", "station", "station_unit", "branch", "probe", "component", "arc_length", "arc_length_unit")


def _point(task: Task, outcome: Outcome) -> dict[str, Any]:
    return {
        "point": task.number,
        **task.point,
        "solver": outcome.solver,
        "ending": outcome.ending,
        "sentence": outcome.sentence,
        "verdict": outcome.verdict,
        "reason": outcome.reason,
        "iterations": outcome.iterations,
        "seconds": outcome.seconds,
        "key": task.key,
    }


def write_tables(folder: Path, sweep: Sweep) -> None:
    """Write ``numbers.csv`` and ``last.csv``.

    Raises:
        OSError: a file cannot be written.
    """
    heads = ["point", *(axis.column for axis in sweep.axes), "solver"]
    tails = ["ending", "verdict", "reason", "iterations", "seconds", "key", "sentence"]
    long = (
        _in_units(sweep, {**_point(task, outcome), **number})
        for task, outcome in sweep.points()
        for number in outcome.numbers or ({},)  # a point without numbers has a line too
    )
    write(folder / "numbers.csv", csv_text([*heads, *_PLACES, *_VALUES, "unit", "word", *tails], long))
    rows = [_wide(sweep, task, outcome) for task, outcome in sweep.points()]
    wide = dict.fromkeys(name for row in rows for name in row if name not in (*heads, *tails))
    write(folder / "last.csv", csv_text([*heads, *tails[:-1], *wide, "sentence"], rows))


def _wide(sweep: Sweep, task: Task, outcome: Outcome) -> dict[str, Any]:
    """A point with the numbers of the last station of every stage."""
    row = _in_units(sweep, _point(task, outcome))
    ends = ((measure, measure.last(outcome)) for measure in measures(sweep.scene))
    return row | {f"{each}, {each.unit}": in_unit(end["value"], each.size) for each, end in ends if end is not None}


def name_of(number: NumberRecord) -> str:
    """Probe and component."""
    return ".".join(filter(None, (number["probe"], number["component"])))


def _in_units(sweep: Sweep, record: Mapping[str, Any]) -> dict[str, Any]:
    """A record with the units of the scene's file; parameters have their units in the keys."""
    row = in_file_units(sweep.scene, record) if "unit" in record else {**record}
    return row | {axis.column: in_unit(row.pop(axis.name), axis.size) for axis in sweep.axes}


def write_netcdf(path: Path, sweep: Sweep) -> None:
    """Write all numbers of a sweep.

    Raises:
        OSError: the file cannot be written.
        ImportError: xarray is not installed.
    """
    import xarray

    found = list(sweep.points())
    data = xarray.Dataset({"point": ("point", [task.number for task, _ in found])}, attrs={"scene": sweep.scene.name})
    for axis in sweep.axes:
        data[axis.name] = "point", [task.point[axis.name] for task, _ in found]
    for name in ("solver", "ending", "verdict"):
        data[name] = "point", [getattr(outcome, name) for _, outcome in found]
    for stage in sweep.scene.stages:
        rows = [[each for each in outcome.numbers if each["stage"] == stage.name] for _, outcome in found]
        stations = f"{stage.name}.stations"
        for key in ("station", "branch"):
            data[f"{stage.name}.{key}"] = ("point", stations), _table(rows, key)[:, :, 0]
        for name, unit in {name_of(each): each["unit"] for row in rows for each in row}.items():
            values = _table([[each for each in row if name_of(each) == name] for row in rows], "value", rows)
            dimensions = ("point", stations, f"{stage.name}.{name}.places")[: 2 + (values.shape[2] > 1)]
            data[f"{stage.name}.{name}"] = dimensions, values.reshape(values.shape[: len(dimensions)]), {"unit": unit}
    data.to_netcdf(path, engine="scipy")


def _table(
    rows: Sequence[Sequence[NumberRecord]], key: str, whole: Sequence[Sequence[NumberRecord]] | None = None
) -> Array:
    """Values (points, stations, places) of a ``key`` of ``rows``; ``whole`` rows state all stations by point."""
    orders = [list(dict.fromkeys(each["station"] for each in row)) for row in whole or rows]
    values = [
        [[each[key] for each in row if each["station"] == station] for station in order]
        for row, order in zip(rows, orders, strict=True)
    ]
    most = max([1, *(len(places) for row in values for places in row)])
    table = np.full((len(rows), max(map(len, orders)), most), np.nan)
    for point, row in enumerate(values):
        for station, places in enumerate(row):
            table[point, station, : len(places)] = places
    return table


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
    numbers = dependent(sweep.scene, solved) if solved else []
    failed = tuple(
        (place_text(sweep.axes, task.point), outcome.ending, outcome.sentence)
        for task, outcome in sweep.points()
        if not outcome.completed
    )
    section = Section(
        "",
        figures=tuple(_figures(sweep, solved, numbers)) if solved else (),
        tables=(Table("Points that failed", ("point", "ending", "reason"), failed),) if failed else (),
    )
    put_section(folder, section)
    family = json.dumps(_slider(sweep, solved, numbers[0]) if numbers else {"curves": []}).replace("<", "\\u003c")
    write(folder / "index.html", rendered("sweep.html", {"sweep": sweep, "section": section, "family": family}))


def _figures(sweep: Sweep, solved: Solved, shown: Sequence[Measure]) -> Iterator[Figure]:
    """All figures of a sweep."""
    yield _over_parameters(sweep, solved, shown[:_PANELS])
    for stage in sweep.scene.stages:
        mine = [each for each in shown if each.stage == stage.name][:_PANELS]
        if mine:
            yield _curves(sweep, solved, stage, mine)
    if any(outcome.solver == "compare" for _, outcome in solved):
        yield _checked(sweep, solved)


def _fullest(solved: Solved) -> Outcome:
    """The first outcome with the most known numbers."""
    return max((outcome for _, outcome in solved), key=lambda outcome: len(outcome.numbers_with_values))


def dependent(scene: Scene, solved: Solved) -> list[Measure]:
    """Numbers above round-off that depend on the parameters at any station; without any all numbers above round-off."""
    whole = _fullest(solved)
    curves = {each: {one["station"]: one["value"] for one in each.numbers(whole)} for each in measures(scene)}
    sizes = {each: max(map(abs, curve.values()), default=0.0) for each, curve in curves.items()}
    largest = dict(sorted((each.unit, size) for each, size in sizes.items()))  # the last of a unit stays
    found = [each for each, size in sizes.items() if size > ROUND_OFF * largest[each.unit] and each.last(whole)]
    return [
        each
        for each in found
        if any(
            abs(one["value"] - curves[each].get(one["station"], one["value"])) > ROUND_OFF * sizes[each]
            for _, outcome in solved
            for one in each.numbers(outcome)
        )
    ] or found


def _unit_of(sweep: Sweep, numbers: Sequence[NumberRecord], kind: str = "") -> tuple[float, str]:
    """Displayed unit of the values, or with ``station`` of the stations, of numbers in one unit."""
    unit, value = (f"{kind}_unit", kind) if kind else ("unit", "value")
    return display_unit(sweep.scene, numbers[0][unit], max(abs(each[value]) for each in numbers))


def _over_parameters(sweep: Sweep, solved: Solved, shown: Sequence[Measure]) -> Figure:
    """Numbers of the last station over the parameters: curves, contours, or points of a sample."""
    grid, first = all(axis.count for axis in sweep.axes), sweep.axes[0]
    mapped = grid and len(sweep.axes) == 2
    failed = [task for task, outcome in sweep.points() if not outcome.completed]
    with canvas(*panels(len(shown), 3.0)) as (figure, plots):
        for axes, measure in zip(plots, shown, strict=True):
            known = [measure.last(outcome) for _, outcome in solved]
            size, label = _unit_of(sweep, [each for each in known if each is not None])
            numbers = [np.nan if each is None else each["value"] / size for each in known]
            axes.set(
                title=f"{measure.stage}: {measure.name}, {label}".rstrip(", "),
                xlabel=first.label,
                ylabel=sweep.axes[-1].label if mapped else "",
            )
            if mapped:
                _contours(figure, axes, sweep.axes, solved, numbers)
            else:
                _joined(axes, first, solved, numbers, join=grid and len(sweep.axes) == 1)
            low = [sweep.axes[1].of(task.point) if mapped else axes.get_ylim()[0] for task in failed]
            if failed:
                axes.plot([first.of(task.point) for task in failed], low, "x", color=RED, clip_on=False)
        return finished(
            figure,
            "parameters",
            caption="Numbers that depend on the parameters, at the last station. Crosses: points that failed.",
        )


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
    least, size = np.nanmin(values), np.nanmax(np.abs(values)) or 1.0
    levels = np.linspace(least, max(np.nanmax(values), least + ROUND_OFF * size), 12)
    x, y = (np.array(axis.values()) / axis.size for axis in pair)
    for branch in range(len(kinds)):
        own = np.ma.masked_where(branches != branch, values).reshape(first.count, second.count).T
        drawn = axes.contourf(x, y, own, levels=levels)
    figure.colorbar(drawn, ax=axes)


def _curves(sweep: Sweep, solved: Solved, stage: Stage, shown: Sequence[Measure]) -> Figure:
    """The curves of all points against the load or drive of a stage."""
    first, longest = sweep.axes[0], _fullest(solved)
    with canvas(*panels(len(shown), 3.0)) as (figure, plots):
        for axes, measure in zip(plots, shown, strict=True):
            whole = measure.numbers(longest)
            (size, label), (step, step_label) = _unit_of(sweep, whole[-1:]), _unit_of(sweep, whole, "station")
            axes.set(title=f"{measure.name}, {label}".rstrip(", "), xlabel=f"{stage.steps}, {step_label}")
            for task, outcome in solved:
                # a sample of a single point has no range
                share = (task.point[first.name] - first.low) / (first.high - first.low or 1.0)
                colour = 0.1 + 0.5 * share, 0.2 + 0.55 * share, 0.45 + 0.45 * share  # from dark to light blue
                curve = measure.numbers(outcome)
                for _, part in groupby(curve, lambda number: number["branch"]):
                    own = np.array([(number["station"] / step, number["value"] / size) for number in part])
                    look = "o" if len(own) == 1 else "-"
                    axes.plot(*own.T, look, color=colour, linewidth=1.0, markersize=2.0)
                if curve and not outcome.completed:
                    axes.plot(curve[-1]["station"] / step, curve[-1]["value"] / size, "x", color=RED)
        return finished(
            figure,
            f"curves-{stage.name}",
            caption=(
                f"Stage {stage.name}: curves of all points; colours from {first.text(first.low)} (dark) to "
                f"{first.text(first.high)} (light). Crosses: the last station of points that failed."
            ),
        )


def _slider(sweep: Sweep, solved: Solved, measure: Measure) -> Mapping[str, Any]:
    """Curves of a number for the slider."""
    curves = [measure.numbers(outcome) for _, outcome in solved]
    ends = [curve[-1] for curve in curves if curve]
    (size, unit), (step, step_unit) = _unit_of(sweep, ends), _unit_of(sweep, ends, "station")
    steps = stage_of(sweep.scene, measure.stage).steps
    return {
        "title": f"Stage {measure.stage}: {measure.name}, {unit}, against {steps}, {step_unit}",
        "curves": [
            {
                "label": f"{place_text(sweep.axes, task.point)}{'' if outcome.completed else f': {outcome.ending}'}",
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
    with canvas(6.4, 4.0) as (figure, (axes,)):
        axes.set(xlabel=sweep.axes[0].label, ylabel=sweep.axes[1].label if len(sweep.axes) > 1 else _RATIO)
        x, y = ([axis.of(point) for point, _ in checked] for axis in (sweep.axes * 2)[:2])
        if len(sweep.axes) > 1:
            figure.colorbar(axes.scatter(x, y, c=ratios, cmap="viridis"), ax=axes, label=_RATIO)
        else:
            axes.plot(x, ratios, "o", color=BLUE)
            axes.axhline(1.0, color=RED, linewidth=0.8)
        return finished(figure, "checked", "Largest difference over stated uncertainty at the checked points.")
