"""What a drive or load meets along its way, branch by branch, in the manner of the paper's Fig. 18.

A figure for each drive or load that is stepped back and forth, or on whose way a branch ends: its reaction (of a load
the displacement or rotation that it does work on) and the potential energy, as far as the scene asks for them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from comparisons.case import Comparison
from comparisons.display_units import axis_unit, display_unit
from comparisons.figures import BLUE, GREY, RED, Picture, canvas, picture
from comparisons.formats import number
from comparisons.quantities import UNITS, load_unit
from comparisons.reactions import ENERGY, multiplier, reaction_probe
from comparisons.stages import begins_at
from cprbm_scene import Answer, Critical, Probe, Scene, Stage, StationAnswer
from cprbm_scene.freedoms import unit
from cprbm_scene.statement import DisplacementDrive, Force, Moment, RotationDrive

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LOOKS = {"FEA": (RED, "-", 2.6), "CPRBM": (BLUE, "none", 0.0)}
_JUMPS = {"FEA": 2.6, "CPRBM": 1.0}  # widths of lines, so that one is seen under the other


@dataclass(frozen=True, slots=True)
class _Ordinate:
    """Something that is shown against the load or drive: what it is called, its unit, and its value at a station."""

    title: str
    unit: str
    of: Callable[[StationAnswer], float]


def of_comparison(compared: Comparison) -> tuple[Picture, ...]:
    """The figures; none where a run gave no whole answer."""
    return tuple(
        found
        for stepped, stages in _ways(compared).items()
        if len(stages) > 1 or any(row.stage == stage.name for row in compared.criticals for stage in stages)
        if (found := _drawn(compared, stepped, stages)) is not None
    )


def of_every_way(compared: Comparison) -> tuple[Picture, ...]:
    """The same also of a drive or load that is stepped once, and on whose way no branch ends."""
    drawn = (_drawn(compared, stepped, stages) for stepped, stages in _ways(compared).items())
    return tuple(found for found in drawn if found is not None)


def _ways(compared: Comparison) -> dict[str, list[Stage]]:
    """By drive or load the stages that step it, to two values at least; none where a run gave no whole answer."""
    stages = compared.scene.stages if compared.rows else ()
    found: dict[str, list[Stage]] = {}
    for stage in stages:
        found.setdefault(stage.steps, []).append(stage)
    return {
        stepped: each for stepped, each in found.items() if len({value for one in each for value in one.stations}) > 1
    }


def _ordinates(scene: Scene, stages: list[Stage]) -> Iterator[_Ordinate]:
    asked = {probe.name for probe in scene.probes if all(probe.asked_in(stage.name) for stage in stages)}
    stepped = scene.stepped(stages[0])

    def value(probe: Probe) -> Callable[[StationAnswer], float]:
        return lambda station: float(station.values[probe.name][0])

    if isinstance(stepped, Force):
        probe, way = Probe(of=stepped.point, quantity="displacement"), unit(stepped.direction)
        if probe.name in asked:
            yield _Ordinate("displacement along it", "m", lambda at: float(np.dot(at.values[probe.name], way)))
    elif isinstance(stepped, Moment):
        probe = Probe(of=stepped.body, quantity="rotation")
        if probe.name in asked:
            yield _Ordinate(f"rotation of {stepped.body}", "rad", value(probe))
    elif isinstance(stepped, DisplacementDrive | RotationDrive):
        probe = reaction_probe(stepped)
        if probe.name in asked:
            what = "reaction moment" if probe.quantity == "reaction_moment" else "reaction force"
            yield _Ordinate(what, UNITS[probe.quantity], lambda station: multiplier(scene, stages[0], station))
    if ENERGY.name in asked:
        yield _Ordinate("potential energy", "J", value(ENERGY))


def _drawn(compared: Comparison, stepped: str, stages: list[Stage]) -> Picture | None:
    scene, runs = compared.scene, compared.runs
    shown = list(_ordinates(scene, stages))
    if not shown:
        return None
    largest = max(abs(value) for stage in stages for value in stage.stations)
    step, step_unit = axis_unit(scene, load_unit(scene, stages[0]), largest)
    answers = {"FEA": runs.reference, "CPRBM": runs.cprbm[0]}
    names = {stage.name for stage in stages}
    with canvas(7.2, 0.8 + 3.0 * len(shown)) as figure:
        panels = np.atleast_1d(figure.subplots(len(shown), 1, sharex=True))
        for axes, ordinate in zip(panels, shown, strict=True):
            mine = [station for answer in answers.values() for station in answer.stations if station.stage in names]
            factor, shown_unit = display_unit(scene, ordinate.unit, max(abs(ordinate.of(station)) for station in mine))
            for name, answer in answers.items():
                _path(axes, scene, stages, name, answer, ordinate, step, factor)
                for critical in answer.critical:
                    if critical.stage in names:
                        axes.axvline(critical.value / step, color=_LOOKS[name][0], linewidth=0.7, linestyle=":")
            if min(map(ordinate.of, mine)) < 0.0 < max(map(ordinate.of, mine)):
                axes.axhline(0.0, color=GREY, linewidth=0.5)
            axes.set_ylabel(f"{ordinate.title}, {shown_unit}")
        for place, critical in enumerate(each for each in runs.cprbm[0].critical if each.stage in names):
            _mark(panels[0], critical, step, step_unit, place)
        panels[-1].set_xlabel(f"{stepped}, {step_unit}")
        handles, labels = panels[0].get_legend_handles_labels()
        order = sorted(range(len(labels)), key=lambda place: (labels[place] != "FEA", labels[place]))
        figure.legend([handles[i] for i in order], [labels[i] for i in order], loc="outside lower center", ncols=3)
        titles = " and ".join(each.title for each in shown)
        jumps = any(station.branch > 0 for station in mine)
        ends = any(critical.stage in names for answer in answers.values() for critical in answer.critical)
        return picture(
            figure,
            f"path-{stepped}",
            f"{titles[:1].upper()}{titles[1:]} against {stepped}: triangles point the way of the stage."
            + (" Dashed: jumps, from the last station before to the first behind." if jumps else "")
            + (" Dotted: critical values of either solver, those of the CPRBM named above." if ends else ""),
        )


def _path(
    axes: Axes,
    scene: Scene,
    stages: list[Stage],
    name: str,
    answer: Answer,
    ordinate: _Ordinate,
    step: float,
    factor: float,
) -> None:
    """One answer, a line or markers for every branch in every stage, and a dashed line for every jump."""
    colour, line, width = _LOOKS[name]
    labelled: set[str] = set()
    before: StationAnswer | None = None
    for stage in stages:
        up = stage.stations[-1] > begins_at(scene, stage)
        stations = [station for station in answer.stations if station.stage == stage.name]
        for branch in dict.fromkeys(station.branch for station in stations):
            mine = [station for station in stations if station.branch == branch]
            if before is not None and before.branch != branch:
                jump = [(at.value / step, ordinate.of(at) / factor) for at in (before, mine[0])]
                axes.plot(
                    *zip(*jump, strict=True),
                    "--",
                    color=colour,
                    linewidth=_JUMPS[name],
                    label=None if "jump" in labelled else f"{name}, jump",
                )
                labelled.add("jump")
            way = "" if name == "FEA" else ", upwards" if up else ", downwards"
            label = f"{name}{way}"
            axes.plot(
                [station.value / step for station in mine],
                [ordinate.of(station) / factor for station in mine],
                linestyle=line,
                linewidth=width,
                marker="" if name == "FEA" else ">" if up else "<",
                markersize=3.5,
                markerfacecolor=colour if up else "white",
                markeredgewidth=0.7,
                color=colour,
                label=None if label in labelled else label,
            )
            labelled.add(label)
            before = mine[-1]


def _mark(axes: Axes, critical: Critical, step: float, step_unit: str, place: int) -> None:
    """The value above the panel, those that stand near each other not at one height."""
    sign = step_unit if step_unit == "°" else f" {step_unit}"
    axes.annotate(
        f"{number(critical.value / step, 4)}{sign}, {critical.loss.value}",
        (critical.value / step, 1.0),
        xycoords=("data", "axes fraction"),
        textcoords="offset points",
        xytext=(0, 3 + 11 * (place % 2)),
        ha="center",
        fontsize=8.5,
    )
