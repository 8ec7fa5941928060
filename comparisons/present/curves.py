"""Curves of a comparison: values against every load and drive, and reactions of drives."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from comparisons.case import Comparison
from comparisons.display_units import axis_unit, display_unit
from comparisons.formats import number
from comparisons.present.canvas import BLUE, GREY, LINES, RED, canvas, finished
from comparisons.present.columns import Figure
from comparisons.present.reaction_tables import by_drive
from comparisons.quantities import UNITS, load_unit
from comparisons.reactions import ENERGY, MESH_ALLOWANCE, WorkEnergyReaction, multiplier, reaction_probe
from comparisons.stages import begins_at
from cprbm_scene import Answer, Scene, Stage, StationAnswer
from cprbm_scene.answer import Array
from cprbm_scene.freedoms import unit
from cprbm_scene.statement import DisplacementDrive, Force, Probe, RotationDrive

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LOOKS = {"FEA": (RED, "-", 2.6), "CPRBM": (BLUE, "none", 1.0)}  # colour and line of curves, width of jumps


@dataclass(frozen=True, slots=True)
class Ordinate:
    """A panel of a curve: its title, SI unit, and values at a station by label of the line."""

    title: str
    unit: str
    lines: Mapping[str, Callable[[StationAnswer], Array]]

    def sizes(self, stations: Sequence[StationAnswer]) -> list[float]:
        """Magnitudes of all values."""
        return [float(np.max(np.abs(of(at)), initial=0.0)) for at in stations for of in self.lines.values()]


def _ordinates(scene: Scene, stages: Sequence[Stage]) -> Iterator[Ordinate]:
    """Force or displacement of the stepped load or drive, energy, rotations and contact forces, as far as asked."""
    asked = [probe for probe in scene.probes if all(probe.asked_in(stage.name) for stage in stages)]
    names, stepped = {probe.name for probe in asked}, scene.stepped(stages[0])

    def value(probe: Probe) -> Callable[[StationAnswer], Array]:
        return lambda at: at.values[probe.name][:1]

    if isinstance(stepped, Force):
        probe, way = Probe(of=stepped.point, quantity="displacement"), unit(stepped.direction)
        if probe.name in names:
            title = f"displacement of {stepped.point} along the force"
            yield Ordinate(title, "m", {"": lambda at: np.atleast_1d(at.values[probe.name] @ way)})
    elif isinstance(stepped, DisplacementDrive | RotationDrive):
        reaction = reaction_probe(stepped)
        if reaction.name in names:
            title = "reaction moment" if reaction.quantity == "reaction_moment" else "reaction force"
            first = stages[0]
            yield Ordinate(
                title, UNITS[reaction.quantity], {"": lambda at: np.atleast_1d(multiplier(scene, first, at))}
            )
    for quantity, title in (("rotation", "rotation"), ("force", "contact force")):
        lines = {probe.of: value(probe) for probe in asked if probe.quantity == quantity}
        if lines:
            yield Ordinate(title, UNITS[quantity], lines)  # type: ignore[index]
    if ENERGY.name in names:
        yield Ordinate("potential energy", "J", {"": value(ENERGY)})


def curve_figures(scene: Scene, fea: Answer, cprbm: Answer) -> Iterator[Figure]:
    """A figure for every load or drive with two stations or more, in the manner of the paper's Fig. 18."""
    ways: dict[str, list[Stage]] = {}
    for stage in scene.stages:
        ways.setdefault(stage.steps, []).append(stage)
    for steps, stages in ways.items():
        panels = list(_ordinates(scene, stages))
        if panels and len({value for stage in stages for value in stage.stations}) > 1:
            yield _curve(scene, {"FEA": fea, "CPRBM": cprbm}, steps, stages, panels)


def _curve(
    scene: Scene, answers: Mapping[str, Answer], steps: str, stages: Sequence[Stage], panels: Sequence[Ordinate]
) -> Figure:
    """Values of both answers against a load or drive, branch by branch, with critical points and jumps."""
    names = {stage.name for stage in stages}
    largest = max(abs(value) for stage in stages for value in stage.stations)
    step, step_unit = axis_unit(scene, load_unit(scene, stages[0]), largest)
    mine = [station for answer in answers.values() for station in answer.stations if station.stage in names]
    ends = {name: [each for each in answer.critical if each.stage in names] for name, answer in answers.items()}
    jumps = any(station.branch > 0 for station in mine)
    with canvas(7.2, 0.8 + 2.8 * len(panels)) as drawing:
        plots = np.atleast_1d(drawing.subplots(len(panels), 1, sharex=True))
        for axes, panel in zip(plots, panels, strict=True):
            factor, unit_name = display_unit(scene, panel.unit, max(panel.sizes(mine), default=0.0))
            for (line, of), (style, marker) in zip(panel.lines.items(), cycle(LINES), strict=False):
                for name, answer in answers.items():
                    label = f"{line}, {name}" if len(panel.lines) > 1 else name
                    marks = marker if len(panel.lines) > 1 else ""
                    _draw_path(axes, scene, stages, answer, of, (step, factor), (name, label, style, marks))
            for name, found in ends.items():
                for critical in found:
                    axes.axvline(critical.value / step, color=_LOOKS[name][0], linewidth=0.7, linestyle=":")
            axes.axhline(0.0, color=GREY, linewidth=0.5)
            axes.set_ylabel(f"{panel.title}, {unit_name}")
            if len(panel.lines) > 1 or axes is plots[0]:
                axes.legend(loc="best", fontsize=8.5)
        for place, critical in enumerate(ends["CPRBM"]):
            text = (
                f"{number(critical.value / step, 4)}{'' if step_unit == '°' else ' '}{step_unit}, {critical.loss.value}"
            )
            plots[0].annotate(text, (critical.value / step, 1.0), xycoords=("data", "axes fraction"), ha="center",
                              textcoords="offset points", xytext=(0, 3 + 11 * (place % 2)), fontsize=8.5)  # fmt: skip
        plots[-1].set_xlabel(f"{steps}, {step_unit}")
        titles = ", ".join(panel.title for panel in panels)
        caption = f"{titles[:1].upper()}{titles[1:]} against {steps}; triangles point along the stage."
        caption += " Dashed: jumps between the stations beside a critical point." if jumps else ""
        caption += " Dotted: critical values of either solver, the CPRBM's with names." if any(ends.values()) else ""
        return finished(drawing, f"path-{steps}", caption)


def _draw_path(
    axes: Axes,
    scene: Scene,
    stages: Sequence[Stage],
    answer: Answer,
    of: Callable[[StationAnswer], Array],
    scales: tuple[float, float],
    look: tuple[str, str, str, str],
) -> None:
    """One line: the finite elements as lines, the CPRBM as markers, for every branch of every stage."""
    name, label, style, marks = look
    colour, line, width = _LOOKS[name]
    before: StationAnswer | None = None
    for stage in stages:
        up = stage.stations[-1] > begins_at(scene, stage)
        stations = [at for at in answer.stations if at.stage == stage.name and of(at).size]
        for branch in dict.fromkeys(at.branch for at in stations):
            mine = [at for at in stations if at.branch == branch]
            if before is not None and before.branch != branch:
                jump = [(at.value / scales[0], of(at)[0] / scales[1]) for at in (before, mine[0])]
                axes.plot(*zip(*jump, strict=True), "--", color=colour, linewidth=width)
            axes.plot(
                [at.value / scales[0] for at in mine],
                [of(at)[0] / scales[1] for at in mine],
                linestyle=style if line == "-" else line,
                linewidth=1.8,
                marker="" if name == "FEA" else marks or (">" if up else "<"),
                markersize=4.0,
                markerfacecolor=colour if up else "white",
                markeredgewidth=0.7,
                color=colour,
                label=label,
            )
            label, before = "_", mine[-1]


def reaction_figures(compared: Comparison) -> Iterator[Figure]:
    """A figure for every drive with two stations or more, in the manner of the paper's Fig. 15."""
    scene = compared.scene
    for drive, found in by_drive(compared.reactions).items():
        if len({each.station for each in found}) < 2:
            continue
        factor, unit_name = display_unit(scene, found[0].unit, max(abs(each.multiplier) for each in found))
        si = load_unit(scene, next(stage for stage in scene.stages if stage.name == found[0].stage))
        step, step_unit = axis_unit(scene, si, max(abs(each.station) for each in found))
        band, title = 100.0 * MESH_ALLOWANCE, "moment" if si == "rad" else "force"
        with canvas(6.4, 6.0) as drawing:
            above, below = drawing.subplots(2, 1, sharex=True, height_ratios=(3, 2))
            for place, branch in enumerate(dict.fromkeys((each.stage, each.branch) for each in found)):
                mine = [each for each in found if (each.stage, each.branch) == branch]
                _draw_reactions(above, below, mine, (step, factor), first=place == 0)
            above.set_ylabel(f"reaction {title}, {unit_name}")
            below.axhspan(-band, band, color="#eef2f7", zorder=0)
            below.axhline(0.0, color=GREY, linewidth=0.6)
            below.set_ylabel("relative difference, %")
            below.set_xlabel(f"{drive}, {step_unit}")
            for axes in (above, below):
                axes.legend(loc="best")
            caption = (
                f"Reaction at the drive {drive}. Below: relative differences from the CPRBM's multiplier. The band of "
                f"{band:g} % to either side is the allowance for the motion of the mesh where contacts are closed. "
                "Stations beside an event have no work–energy reaction."
            )
            yield finished(drawing, f"reaction-{drive}", caption)


def _draw_reactions(
    above: Axes, below: Axes, mine: Sequence[WorkEnergyReaction], scales: tuple[float, float], *, first: bool
) -> None:
    """The three reactions of one branch, and differences from the multiplier; only the first branch has labels."""
    step, factor = scales
    ring = {"color": BLUE, "markersize": 4.5, "markerfacecolor": "none"}
    for axes, values, look, style, label in (
        (above, [each.fea / factor for each in mine], "x", {"color": RED}, "FEA"),
        (above, [each.multiplier / factor for each in mine], "-", {"color": BLUE}, "CPRBM, multiplier"),
        (above, [_scaled(each.work_energy, 1.0 / factor) for each in mine], "o", ring, "CPRBM, work–energy"),
        (below, [_scaled(each.from_fea, -100.0) for each in mine], "x", {"color": RED}, "FEA"),
        (below, [_scaled(each.difference, 100.0) for each in mine], ".", {"color": BLUE}, "work–energy"),
    ):
        stations = [each.station / step for each in mine]
        axes.plot(stations, values, look, label=label if first else None, **style)


def _scaled(value: float | None, factor: float) -> float:
    return np.nan if value is None else factor * value
