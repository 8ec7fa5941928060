"""Figures of a mechanism: shapes of both answers, designs side by side, and colours of stress."""

from collections.abc import Mapping, Sequence
from itertools import cycle

import numpy as np

from comparisons.case import Comparison
from comparisons.formats import at_station, display_unit, load_text, with_unit
from comparisons.geometry import length, points
from comparisons.present.canvas import (
    BLUE,
    GREEN,
    GREY,
    INK,
    RED,
    Axes,
    Drawing,
    canvas,
    draw_names,
    draw_parts,
    finished,
    image,
    show_lengths,
)
from comparisons.present.columns import Figure
from comparisons.present.curves import contact_figures, curve_figures, reaction_figures, stress_figures
from comparisons.present.picture import Bounds, Part, View, bounds_of, view_of
from comparisons.present.row_tables import shown_stations
from comparisons.present.strips import Coloured
from comparisons.quantities import stage_of
from comparisons.stations import station_of
from cprbm_scene import Answer, Array, FreeEnd, Scene, StationAnswer

QUANTITIES: Mapping[Coloured, tuple[str, str, str]] = {
    "bending_stress": ("bending stress", "Pa", "RdYlBu_r"),
    "combined_stress": ("combined stress, largest of the section", "Pa", "plasma_r"),
    "moment": ("bending moment", "N·m", "RdYlBu_r"),
}
"""Title, SI unit and Matplotlib's colour map by colouring quantity."""

TINY = 1e-300
"""Least span of a scale of colours."""

_SHAPES, _STRESS = 4.6, 7.4  # inches: the longer side of the window in a figure of a page, and in a picture
_SHORTEST = (3.6, 1.6)  # inches: least width and height
_DESIGNS = (RED, BLUE, "#3a8a3a", "#8a4fb0", "#b07a1a")
_SMALL = 2.0  # a window this many times the loaded mechanism shows the loaded mechanism alone
_FEW = 8  # places of contact with large marks
_ROOM = 0.06  # margin of a window over its longer side


def comparison_figures(compared: Comparison) -> tuple[Figure, ...]:
    """Mechanism, curves, reactions, stresses, and contact forces; none without a common station."""
    stations, scene, runs = shown_stations(compared), compared.scene, compared.runs
    if not stations:
        return ()
    names = [rows[0].where for rows in stations]
    cprbm, fea = runs.pair
    answers = {f"FEA ({runs.theory})": fea, "CPRBM": cprbm}
    return (
        *(shapes(scene, answers, where) for where in ([names[-1:], names] if len(names) > 1 else [names])),
        *curve_figures(scene, fea, cprbm),
        *reaction_figures(compared),
        *stress_figures(scene, *(station_of(answer, *names[-1]) for answer in answers.values())),
        *contact_figures(compared),
    )


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
    views = [view_of(each.scene, each.runs.answers["fea"].stations[-1]) for each in designs]
    limits = [bounds_of(each.scene, [view], "moment") for each, view in zip(designs, views, strict=True)]
    low, high = np.min([each.low for each in limits], axis=0), np.max([each.high for each in limits], axis=0)
    with canvas(*_sides(low, high, _SHAPES, (0.9, 1.3))) as (drawing, (axes,)):
        for each, view, colour in zip(designs, views, cycle(_DESIGNS), strict=False):
            draw_parts(axes, view.of("body", "weld", "pin", "pivot"), colour)
            label = f"{each.scene.name}: {at_station(each.scene, view.station.stage, view.station.value)}"
            for place, strip in enumerate(view.strips.values()):
                axes.plot(*strip.line.T, "-", color=colour, linewidth=2.0, label=None if place else label)
        _set_window(axes, designs[0].scene, low, high)
        return finished(
            drawing,
            "designs",
            caption="Neutral lines of several designs, each at its last station.",
            legend=("lower center", 2),
        )


def shapes(scene: Scene, answers: Mapping[str, Answer], stations: Sequence[tuple[str, float]]) -> Figure:
    """The mechanism at rest and at stations, in the manner of the paper's Figs. 8 and 17.

    Args:
        scene: the question.
        answers: by label, at most one of the CPRBM; bodies and edges are those of the first answer.
        stations: stages and stations, which all answers have; several stations have equal windows.
    """
    found = [{label: station_of(answer, *where) for label, answer in answers.items()} for where in stations]
    views, alone = [view_of(scene, next(iter(each.values()))) for each in found], len(stations) == 1
    low, high = extent(scene, views)
    columns = 1 if alone or float(np.ptp((high - low) / max(high - low))) >= 0.6 else 2
    rows, steps = -(-len(views) // columns), {stage.name: stage.steps for stage in scene.stages}
    width, height = _sides(low, high, _SHAPES, (0.8, 0.8))
    with canvas(columns * width, rows * height + 0.6, len(views), columns) as (drawing, plots):
        for axes, view, pair, (stage, value) in zip(plots, views, found, stations, strict=True):
            _draw_mechanism(axes, scene, view, pair)
            if alone:
                draw_names(axes, scene)
            _set_window(axes, scene, low, high, f"{stage}: {steps[stage]} = {load_text(scene, stage, value)}")
        where = f"at {at_station(scene, *stations[0])}" if alone else "at several stations"
        apart = " Dotted: the way of an end that is drawn apart from its pin." if scene.assembly is not None else ""
        return finished(
            drawing,
            "shapes" if alone else "stations",
            caption=f"Neutral lines at rest and {where}, with the places of contact.{apart}",
            legend=("lower center", 2),
        )


def _draw_mechanism(axes: Axes, scene: Scene, view: View, stations: Mapping[str, StationAnswer]) -> None:
    """Neutral lines at rest, edges and bodies of the view, dots of the CPRBM, and lines of all other answers."""
    draw_parts(axes, view.of("edge", "body", "weld", "pin", "pivot", "stop"))
    looks = {label: (".", "o", BLUE) if label == "CPRBM" else ("-", "x", RED) for label in stations}
    for place, (name, beam) in enumerate(scene.beams.items()):
        rest = points(beam.curve, np.linspace(0.0, length(beam.curve), 200))
        axes.plot(*rest.T, "--", color=GREY, linewidth=1.0, label=None if place else "at rest")
        for end, index in ((beam.start, 0), (beam.end, -1)):
            if scene.assembly is not None and not isinstance(end, FreeEnd):
                axes.plot(*np.stack([rest[index], scene.place_of(end.point)]).T, ":", color=GREY, linewidth=0.9)
        for label, (line, _, colour) in looks.items():
            shape, named = stations[label].shapes[name], None if place else label
            axes.plot(shape.x, shape.y, line, color=colour, markersize=3.5, linewidth=2.2, label=named)
    for label, (_, marker, colour) in looks.items():
        for place, spots in enumerate(stations[label].touching.values()):
            size = 9.0 if len(spots) <= _FEW else 2.5  # many large marks would hide the beam
            named = None if place else f"contact, {label.partition(' (')[0]}"
            axes.plot(*spots.T, marker, color=colour, markersize=size, markerfacecolor="none", label=named)


def extent(scene: Scene, views: Sequence[View]) -> tuple[Array, Array]:
    """Corners of the window: all parts, or the beams alone where they are small beside the mechanism at rest."""
    bounds = bounds_of(scene, views, "moment")
    loaded = np.concatenate([strip.line for view in views for strip in view.strips.values()])
    low, high = loaded.min(axis=0), loaded.max(axis=0)
    return (low, high) if bounds.size > _SMALL * float(np.max(high - low)) else (bounds.low, bounds.high)


def _sides(low: Array, high: Array, longest_side: float, room: tuple[float, float]) -> tuple[float, float]:
    """Width and height, inches, of a drawing with equal scales, with room beside and below the axes."""
    x, y = (high - low) * longest_side / float(np.max(high - low))
    return max(_SHORTEST[0], float(x)) + room[0], max(_SHORTEST[1], float(y)) + room[1]


def _set_window(axes: Axes, scene: Scene, low: Array, high: Array, title: str = "") -> None:
    """Title, equal scales, margins, and displayed units."""
    margin = _ROOM * float(np.max(high - low))
    (left, below), (right, above) = low - margin, high + margin
    axes.set(title=title, xlim=(left, right), ylim=(below, above), aspect="equal")
    show_lengths(scene, axes.xaxis, "x")
    show_lengths(scene, axes.yaxis, "y")


def stress_picture(scene: Scene, view: View, bounds: Bounds, quantity: Coloured, kind: str, dots: float) -> bytes:
    """A view as ``png`` or ``svg``: beams at true thickness with colours of a quantity, over the beams at rest."""
    with canvas(*_sides(bounds.low - _ROOM * bounds.size, bounds.high + _ROOM * bounds.size, _STRESS, (1.7, 0.8))) as (
        drawing,
        (axes,),
    ):
        draw_parts(axes, view.of("edge", "rest"))
        _draw_colours(drawing, axes, scene, view, bounds, quantity)
        draw_parts(axes, view.of("body", "weld", "pin", "pivot", "stop"))
        _draw_pushes(axes, scene, view, bounds)
        _set_window(axes, scene, bounds.low, bounds.high, f"{scene.name}, {view_title(scene, view)}")
        return image(drawing, kind, dots)


def view_title(scene: Scene, view: View) -> str:
    """Stage, and load or drive at the station."""
    stage, value = view.station.stage, view.station.value
    return f"{stage}, {stage_of(scene, stage).steps} = {load_text(scene, stage, value)}"


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
        edges, values = np.stack([strip.layer(-1.0), strip.layer(1.0)]), getattr(strip, quantity) / factor
        mesh = axes.pcolormesh(
            edges[..., 0],
            edges[..., 1],
            np.stack([values, values]),
            shading="gouraud",
            cmap=colours,
            vmin=bounds.least / factor,
            vmax=max(bounds.most, TINY) / factor,
            rasterized=True,
            zorder=2.0,
        )
    for part in view.of("beam"):
        axes.plot(*part.line.T, "-", color=INK, linewidth=0.45, zorder=2.1)
    bar = drawing.colorbar(mesh, ax=axes, shrink=0.85, pad=0.02, aspect=28)
    bar.set_label(f"{title}, {unit_name}")
    bar.outline.set_linewidth(0.4)


def _draw_pushes(axes: Axes, scene: Scene, view: View, bounds: Bounds) -> None:
    """Arrows of contact forces with their heads where the contacts press, and dots at all places of a zone."""
    if not view.arrows_of("push"):
        draw_parts(axes, view.of("contact"))
    drawn = [(push, vector) for push in view.arrows_of("push") if (vector := bounds.arrow(push)) is not None]
    firsts = {push.name: vector for push, vector in reversed(drawn)}
    for push, vector in drawn:
        if len(push.places) > 1:
            draw_parts(axes, [Part("contact", push.name, push.places)])
        tail, way = tuple(push.middle - vector), push.resultant / push.size
        axes.annotate("", xy=tuple(push.middle), xytext=tail, zorder=5.0, arrowprops={
            "arrowstyle": "-|>", "color": GREEN, "linewidth": 1.5, "shrinkA": 0.0, "shrinkB": 0.0})  # fmt: skip
        if firsts[push.name] is vector:
            aside = "center" if abs(way[1]) > abs(way[0]) else "right" if way[0] > 0.0 else "left"
            axes.annotate(with_unit(scene, push.size, "N", 3), tail, textcoords="offset points", ha=aside, va="center",
                          xytext=(-13.0 * way[0], -9.0 * way[1]), fontsize=8.5, color=GREEN, zorder=6.0)  # fmt: skip
