"""Figures of a mechanism: shapes of both answers, designs side by side, colours of stress, stresses along beams."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from comparisons.case import Comparison
from comparisons.display_units import at_station, display_unit, load_text, with_unit
from comparisons.geometry import length, longest, points
from comparisons.present.canvas import (
    BLUE,
    GREEN,
    GREY,
    INK,
    RED,
    canvas,
    common_legend,
    draw_names,
    draw_parts,
    finished,
    image,
    show_lengths,
)  # fmt: skip
from comparisons.present.columns import Figure
from comparisons.present.contact_forces import contact_figures
from comparisons.present.curves import curve_figures, reaction_figures
from comparisons.present.picture import ARROW, LEAST, Bounds, Part, View, bounds_of, view_of
from comparisons.present.row_tables import Judged, shown_stations
from comparisons.present.strips import Coloured
from comparisons.quantities import norm
from comparisons.stations import station_of
from cprbm_scene import Answer, FreeEnd, Scene, StationAnswer
from cprbm_scene.answer import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

QUANTITIES: Mapping[Coloured, tuple[str, str, str]] = {
    "bending_stress": ("bending stress", "Pa", "RdYlBu_r"),
    "combined_stress": ("combined stress, largest of the section", "Pa", "plasma_r"),
    "moment": ("bending moment", "N·m", "RdYlBu_r"),
}
"""Title, SI unit and Matplotlib's colour map by colouring quantity."""

TINY = 1e-300
"""Least span of a scale of colours."""

_SIDES = (7.4, 3.2)  # inches: the longer side of a picture, and the least length of a side
_DESIGNS = (RED, BLUE, "#3a8a3a", "#8a4fb0", "#b07a1a")
_SMALL = 2.0  # a window this many times the loaded mechanism shows the loaded mechanism alone
_FEW = 8  # places of contact with large marks


def comparison_figures(compared: Comparison) -> tuple[Figure, ...]:
    """Mechanism, curves, reactions, stresses, and contact forces; none without a common station."""
    stations = shown_stations(compared)
    if not stations:
        return ()
    runs, names = compared.runs, [rows[0][0].where for rows in stations]
    answers = {f"FEA ({runs.theory})": runs.reference, "CPRBM": runs.cprbm[0]}
    found = [shapes(compared.scene, answers, names[-1:])]
    found += [shapes(compared.scene, answers, names)] if len(names) > 1 else []
    found += [*curve_figures(compared.scene, runs.reference, runs.cprbm[0]), *reaction_figures(compared)]
    stresses = [judged for judged in stations[-1] if judged[0].probe.quantity == "bending_stress"]
    found += [_stresses(compared.scene, stresses)] if stresses else []
    return (*found, *contact_figures(compared))


def answer_figure(scene: Scene, answer: Answer) -> Figure:
    """Drawing of an answer at its last station.

    Raises:
        ValueError: the answer has no station.
    """
    if not answer.stations:
        raise ValueError(f"{scene.name}: no drawing, since {answer.solver} reached no station. {answer.sentence}")
    label = {"cprbm": "CPRBM", "fea": "FEA"}.get(answer.solver, answer.solver)
    return shapes(scene, {label: answer}, [(answer.stations[-1].stage, answer.stations[-1].value)])


def designs_figure(designs: Sequence[Comparison]) -> Figure:
    """Drawing of one comparison, or of the finite elements of several, at the last stations; all have rows."""
    if len(designs) == 1:
        return comparison_figures(designs[0])[0]
    views = [view_of(each.scene, each.runs.reference.stations[-1]) for each in designs]
    low = np.min(
        [bounds_of(each.scene, [view], "moment").low for each, view in zip(designs, views, strict=True)], axis=0
    )
    high = np.max(
        [bounds_of(each.scene, [view], "moment").high for each, view in zip(designs, views, strict=True)], axis=0
    )
    with canvas(*_canvas_sides(low, high, room=(0.9, 1.1))) as drawing:
        axes = drawing.add_subplot()
        for each, view, colour in zip(designs, views, cycle(_DESIGNS), strict=False):
            draw_parts(axes, view.of("body", "weld", "pin", "pivot"), colour)
            label = f"{each.scene.name}: {at_station(each.scene, view.station.stage, view.station.value)}"
            for place, strip in enumerate(view.strips.values()):
                axes.plot(*strip.line.T, "-", color=colour, linewidth=2.0, label=None if place else label)
        _window(axes, designs[0].scene, low, high, names=("x", "y"))
        common_legend(drawing, "lower center", 2)
        return finished(drawing, "designs", "Neutral lines of several designs, each at its last station.")


def shapes(scene: Scene, answers: Mapping[str, Answer], stations: Sequence[tuple[str, float]]) -> Figure:
    """The mechanism at rest and at stations, in the manner of the paper's Figs. 8 and 17.

    Args:
        scene: the question.
        answers: by label, at most one of the CPRBM; bodies and edges are those of the first answer.
        stations: stages and stations, which all answers have; several stations have equal windows.
    """
    found = [{label: station_of(answer, *where) for label, answer in answers.items()} for where in stations]
    views = [view_of(scene, next(iter(each.values()))) for each in found]
    low, high = _extent(scene, views)
    columns = 1 if len(views) == 1 else 2 if float(np.ptp((high - low) / max(high - low))) < 0.6 else 1
    rows = -(-len(views) // columns)
    width, height = _canvas_sides(low, high, longest_side=6.0 / columns + 0.6, room=(0.8 / columns, 0.5))
    steps = {stage.name: stage.steps for stage in scene.stages}
    with canvas(columns * width, rows * height + 0.6) as drawing:
        for place, (view, pair, (stage, value)) in enumerate(zip(views, found, stations, strict=True)):
            axes = drawing.add_subplot(rows, columns, place + 1)
            _draw_mechanism(axes, scene, view, pair)
            if len(views) == 1:
                draw_names(axes, scene)
            axes.set_title(f"{stage}: {steps[stage]} = {load_text(scene, stage, value)}", loc="left", fontsize=9)
            _window(axes, scene, low, high, names=("x", "y") if len(views) == 1 else ("", ""))
        common_legend(drawing, "lower center", 3)
        where = f"at {at_station(scene, *stations[0])}" if len(views) == 1 else "at several stations"
        unit_name = "" if len(views) == 1 else f", {display_unit(scene, 'm', longest(scene))[1]},"
        apart = " Dotted: the way of an end that is drawn apart from its pin." if scene.assembly is not None else ""
        caption = f"Neutral lines{unit_name} at rest and {where}, with the places of contact.{apart}"
        return finished(drawing, "shapes" if len(views) == 1 else "stations", caption)


def _draw_mechanism(axes: Axes, scene: Scene, view: View, stations: Mapping[str, StationAnswer]) -> None:
    """Neutral lines at rest, edges and bodies of the view, dots of the CPRBM, and lines of all other answers."""
    draw_parts(axes, view.of("rigid", "edge", "body", "weld", "pin", "pivot", "stop"))
    for place, (name, beam) in enumerate(scene.beams.items()):
        rest = points(beam.curve, np.linspace(0.0, length(beam.curve), 200))
        axes.plot(*rest.T, "--", color=GREY, linewidth=1.0, label=None if place else "at rest")
        for end, index in ((beam.start, 0), (beam.end, -1)):
            if scene.assembly is not None and not isinstance(end, FreeEnd):
                axes.plot(*np.stack([rest[index], scene.place_of(end.point)]).T, ":", color=GREY, linewidth=0.9)
        for label, station in stations.items():
            line, colour = (".", BLUE) if label == "CPRBM" else ("-", RED)
            shape = station.shapes[name]
            axes.plot(
                shape.x, shape.y, line, color=colour, markersize=3.5, linewidth=2.2, label=None if place else label
            )
    for label, station in stations.items():
        marker, colour = ("o", BLUE) if label == "CPRBM" else ("x", RED)
        for place, spots in enumerate(station.touching.values()):
            axes.plot(
                *spots.T,
                marker,
                color=colour,
                markersize=9.0 if len(spots) <= _FEW else 2.5,  # many large marks would hide the beam
                markerfacecolor="none",
                label=None if place else f"contact, {label.partition(' (')[0]}",
            )


def _extent(scene: Scene, views: Sequence[View]) -> tuple[Array, Array]:
    """Corners of the window: all parts, or the beams alone where they are small beside the mechanism at rest."""
    bounds = bounds_of(scene, views, "moment")
    loaded = np.concatenate([strip.line for view in views for strip in view.strips.values()])
    low, high = loaded.min(axis=0), loaded.max(axis=0)
    return (low, high) if bounds.size > _SMALL * float(np.max(high - low)) else (bounds.low, bounds.high)


def _canvas_sides(
    low: Array, high: Array, longest_side: float = _SIDES[0], room: tuple[float, float] = (0.0, 0.0)
) -> tuple[float, float]:
    """Width and height, inches, of a drawing with equal scales, with room beside and below the axes."""
    x, y = (high - low) * longest_side / float(np.max(high - low))
    return max(_SIDES[1], float(x)) + room[0], max(0.5 * _SIDES[1], float(y)) + room[1]


def _window(axes: Axes, scene: Scene, low: Array, high: Array, names: tuple[str, str]) -> None:
    """Equal scales, margins of six hundredths of the longer side, and displayed units."""
    margin = 0.06 * float(np.max(high - low))
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal", adjustable="box")
    for axis, name in zip((axes.xaxis, axes.yaxis), names, strict=True):
        show_lengths(scene, axis, name)
    axes.tick_params(labelsize=10 if names[0] else 8)


def stress_picture(scene: Scene, view: View, bounds: Bounds, quantity: Coloured, kind: str, dots: float) -> bytes:
    """A view as ``png`` or ``svg``: beams at true thickness with colours of a quantity, over the beams at rest."""
    width, height = _canvas_sides(bounds.low, bounds.high)
    with canvas(width + 1.5, height + 0.75) as drawing:
        axes = drawing.add_subplot()
        draw_parts(axes, view.of("rigid", "edge", "rest"))
        _draw_colours(drawing, axes, scene, view, bounds, quantity)
        draw_parts(axes, view.of("body", "weld", "pin", "pivot", "stop"))
        _draw_pushes(axes, scene, view, bounds)
        _window(axes, scene, bounds.low, bounds.high, names=("x", "y"))
        axes.set_title(view_title(scene, view), loc="left", fontsize=10)
        return image(drawing, kind, dots)


def view_title(scene: Scene, view: View) -> str:
    """Name of the scene, stage, and load or drive at the station."""
    stage = next(each for each in scene.stages if each.name == view.station.stage)
    return f"{scene.name}, {stage.name}: {stage.steps} = {load_text(scene, stage.name, view.station.value)}"


def colour_unit(scene: Scene, quantity: Coloured, most: float) -> tuple[float, str]:
    """Displayed unit of a quantity with the largest value ``most``; MPa for stresses of a file without this unit."""
    si = QUANTITIES[quantity][1]
    stated = "stress" in scene.display_units.model_fields_set
    return (1e6, "MPa") if si == "Pa" and not stated else display_unit(scene, si, most)


def _draw_colours(drawing: Drawing, axes: Axes, scene: Scene, view: View, bounds: Bounds, quantity: Coloured) -> None:
    """Beams with the colours of a quantity, their outlines, and the bar of colours."""
    title, _, colours = QUANTITIES[quantity]
    factor, unit_name = colour_unit(scene, quantity, bounds.most)
    for strip in view.strips.values():
        edges, values = (strip.layer(-1.0), strip.layer(1.0)), getattr(strip, quantity) / factor
        mesh = axes.pcolormesh(
            *(np.stack([edge[:, axis] for edge in edges]) for axis in (0, 1)),
            np.stack([values, values]),
            shading="gouraud",
            cmap=colours,
            vmin=bounds.least / factor,
            vmax=max(bounds.most, TINY) / factor,
            rasterized=True,
            zorder=2.0,
        )
        around = strip.outline()
        axes.plot(*np.concatenate([around, around[:1]]).T, "-", color=INK, linewidth=0.45, zorder=2.1)
    bar = drawing.colorbar(mesh, ax=axes, shrink=0.85, pad=0.02, aspect=28)
    bar.set_label(f"{title}, {unit_name}")
    bar.outline.set_linewidth(0.4)


def _draw_pushes(axes: Axes, scene: Scene, view: View, bounds: Bounds) -> None:
    """Arrows of contact forces with their heads where the contacts press, and dots at all places of a zone."""
    largest, named = max(bounds.force["push"], TINY), set[str]()
    if not view.pushes:
        draw_parts(axes, view.of("contact"))
    for push in view.pushes:
        size = hypot(*push.resultant)
        if size < LEAST * largest:
            continue
        if len(push.places) > 1:
            draw_parts(axes, [Part("contact", push.contact, push.places)])
        tail, way = push.middle - ARROW * bounds.size / largest * push.resultant, push.resultant / size
        axes.annotate("", xy=tuple(push.middle), xytext=tuple(tail), zorder=5.0, arrowprops={
            "arrowstyle": "-|>", "color": GREEN, "linewidth": 1.5, "shrinkA": 0.0, "shrinkB": 0.0})  # fmt: skip
        if push.contact not in named:
            named.add(push.contact)
            axes.annotate(
                with_unit(scene, size, "N", 3),
                tuple(tail),
                textcoords="offset points",
                xytext=(-13.0 * way[0], -9.0 * way[1]),
                ha="center" if abs(way[1]) > abs(way[0]) else ("right" if way[0] > 0.0 else "left"),
                va="center",
                fontsize=8.5,
                color=GREEN,
                zorder=6.0,
            )


def _stresses(scene: Scene, rows: Sequence[Judged]) -> Figure:
    """Bending stress along each beam, in the manner of the paper's Fig. 10."""
    factor, unit_name = display_unit(scene, "Pa", max(norm("bending_stress", row.fea) for row, *_ in rows))
    with canvas(7.2, 2.8 * len(rows)) as drawing:
        for place, (row, *_) in enumerate(rows):
            axes = drawing.add_subplot(len(rows), 1, place + 1)
            axes.axhline(0.0, color=GREY, linewidth=0.6)
            assert row.arc_length is not None
            axes.plot(row.arc_length, row.fea / factor, "-", color=RED, linewidth=1.8, label="FEA")
            axes.plot(row.arc_length, row.cprbm / factor, ".", color=BLUE, markersize=5, label="CPRBM")
            axes.set_title(row.probe.of, loc="left")
            axes.set_ylabel(f"bending stress, {unit_name}")
            axes.legend(loc="best")
            show_lengths(scene, axes.xaxis, "initial arc length")
        caption = (
            f"Bending stress along the beams at {at_station(scene, *rows[0][0].where)}, positive where the load turns "
            "the tangent counter-clockwise along the beam."
        )
        return finished(drawing, "stress", caption)
