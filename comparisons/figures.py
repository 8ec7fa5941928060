"""The figures of a comparison; the only module that knows matplotlib, which it imports when it draws.

The same answers give the same bytes: no dates, and identifiers from a fixed salt.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import cycle, islice
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.bodies_drawn import draw_bodies, draw_edges, draw_names, draw_stops, joined_ends, places_at
from comparisons.case import Comparison
from comparisons.formats import number, scaled_unit
from comparisons.framing import frame
from comparisons.geometry import length, points
from comparisons.pairing import Runs
from comparisons.quantities import load_unit, norm
from comparisons.sheets import last_rows, shown_rows
from comparisons.stations import station_of
from comparisons.verdict.rows import Row
from cprbm_scene import CircleContact, Scene
from cprbm_scene.statement import FreeEnd

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLUE, RED, GREY = "#1f5fa8", "#c8321e", "#8a8a8a"
_STYLE: dict[Any, Any] = {  # the stubs name every key of every version
    "svg.hashsalt": "cprbm",
    "svg.fonttype": "path",
    "font.family": "DejaVu Sans",
    "font.size": 10.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "savefig.dpi": 150.0,
}
LOOKS = (("-", "o"), ("--", "s"), (":", "^"), ("-.", "D"))  # of the probes in one figure: lines and markers
FEW_PLACES = 8  # of contact, that are drawn large


@dataclass(frozen=True, slots=True)
class Picture:
    """A drawn figure: what it shows, and its bytes in two formats."""

    name: str
    caption: str
    svg: bytes
    png: bytes


def of_comparison(compared: Comparison) -> tuple[Picture, ...]:
    """All figures of a comparison; none where a run gave no whole answer."""
    if not compared.rows:
        return ()
    stations = [(rows[0].stage, rows[0].station) for rows in shown_rows(compared)]
    pictures = [_shapes(compared.scene, compared.runs, *stations[-1])]
    if len(stations) > 1:
        pictures.append(_stations(compared.scene, compared.runs, stations))
    stresses = [row for row in last_rows(compared) if row.probe.quantity == "bending_stress"]
    if stresses:
        pictures.append(_stresses(stresses))
    for quantity, what in (("rotation", "Rotation"), ("force", "Contact force")):
        rows = [row for row in compared.rows if row.probe.quantity == quantity]
        if len(rows) > 1:
            pictures.append(_against_load(compared.scene, rows, quantity, what))
    return tuple(pictures)


def _shapes(scene: Scene, runs: Runs, stage: str, value: float) -> Picture:
    """The mechanism before and after, in the manner of the paper's Fig. 8."""
    with canvas(6.4, 6.0) as figure:
        axes = figure.add_subplot()
        _as_drawn(axes, scene)
        _mechanism(axes, scene, runs, stage, value)
        draw_names(axes, scene)
        axes.set_xlabel("x, mm")
        axes.set_ylabel("y, mm")
        figure.legend(loc="outside lower center", ncols=3)
        apart = " Dotted: the way of an end that is drawn apart from its pin." if scene.assembly is not None else ""
        return picture(
            figure,
            "shapes",
            f"Neutral lines before and at {stage} {value:g}, with the places of contact.{apart}",
        )


def _stations(scene: Scene, runs: Runs, stations: list[tuple[str, float]]) -> Picture:
    """The mechanism at several stations, in the manner of the paper's Fig. 17."""
    columns = min(2, len(stations))
    lines = -(-len(stations) // columns)
    stages = {stage.name: stage for stage in scene.stages}
    with canvas(3.6 * columns, 0.6 + 3.4 * lines) as figure:
        for place, (name, value) in enumerate(stations):
            axes = figure.add_subplot(lines, columns, place + 1)
            _mechanism(axes, scene, runs, name, value)
            factor, unit = along_axis(load_unit(scene, stages[name]), value)
            shown = f"{number(value / factor, 4)}{'' if unit == '°' else ' '}{unit}"
            axes.set_title(f"{name}, {stages[name].steps} = {shown}", loc="left", fontsize=9)
            axes.tick_params(labelsize=8)
        handles, labels = figure.axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=3)
        return picture(figure, "stations", "Neutral lines, mm, at several stations, with the places of contact.")


def along_axis(unit: str, size: float) -> tuple[float, str]:
    """By what a load or drive of about a ``size`` is divided on an axis, and the unit there; of a rotation degrees."""
    return (math.radians(1.0), "°") if unit == "rad" else scaled_unit(unit, abs(size))


def _as_drawn(axes: Axes, scene: Scene) -> None:
    """The mechanism before anything happens, and the way of the ends that are apart from their points."""
    for place, beam in enumerate(scene.beams.values()):
        x, y = 1e3 * points(beam.curve, np.linspace(0.0, length(beam.curve), 200)).T
        axes.plot(x, y, "--", color=GREY, linewidth=1.0, label="undeformed" if place == 0 else None)
        for end, point in ((beam.start, 0), (beam.end, -1)):
            if not isinstance(end, FreeEnd):
                to_x, to_y = scene.place_of(end.point)
                axes.plot([x[point], 1e3 * to_x], [y[point], 1e3 * to_y], ":", color=GREY, linewidth=0.9)
    drawn = {end.point: scene.place_of(end.point) for _, end, _ in joined_ends(scene)}
    draw_bodies(axes, scene, drawn, "--", GREY)


def _mechanism(axes: Axes, scene: Scene, runs: Runs, stage: str, value: float) -> None:
    """Both answers at a station."""
    from matplotlib.patches import Circle

    for contact in scene.contacts.values():
        if isinstance(contact, CircleContact):
            (x, y), stands = contact.center, scene.bodies[contact.body].motion == "fixed"
            style = "-" if stands else "--"  # one that moves is shown where it began
            # an artist, no patch: a large circle must not make the beams small
            axes.add_artist(
                Circle((1e3 * x, 1e3 * y), 1e3 * contact.radius, fill=False, edgecolor=GREY, linestyle=style)
            )
    cprbm, fea = (station_of(answer, stage, value) for answer in (runs.cprbm[0], runs.reference))
    places = places_at(scene, fea)
    draw_edges(axes, scene, places, GREY)
    draw_bodies(axes, scene, places, "-", "black")
    draw_stops(axes, scene, places)
    for place, beam_name in enumerate(scene.beams):
        shape = fea.shapes[beam_name]
        label = f"FEA ({runs.kinematics})" if place == 0 else None
        axes.plot(1e3 * shape.x, 1e3 * shape.y, "-", color=RED, linewidth=2.2, label=label)
        shape = cprbm.shapes[beam_name]
        label = "CPRBM" if place == 0 else None
        axes.plot(1e3 * shape.x, 1e3 * shape.y, ".", color=BLUE, markersize=3.5, label=label)
    for name, station, marker, colour in (("FEA", fea, "x", RED), ("CPRBM", cprbm, "o", BLUE)):
        for place, spots in enumerate(station.touching.values()):
            label = f"contact, {name}" if place == 0 else None
            x, y = 1e3 * spots.T
            # the many places of a zone would hide the beam behind them
            size = 9.0 if len(spots) <= FEW_PLACES else 2.5
            axes.plot(x, y, marker, color=colour, markersize=size, markerfacecolor="none", linestyle="", label=label)
    frame(axes, fea)


def _stresses(rows: list[Row]) -> Picture:
    """Bending stress along each beam, in the manner of the paper's Fig. 10."""
    with canvas(7.2, 2.8 * len(rows)) as figure:
        factor, unit = scaled_unit("Pa", max(norm("bending_stress", row.fea) for row in rows))
        for place, row in enumerate(rows):
            axes = figure.add_subplot(len(rows), 1, place + 1)
            if row.arc_length is None:
                continue
            axes.axhline(0.0, color=GREY, linewidth=0.6)
            axes.plot(1e3 * row.arc_length, row.fea / factor, "-", color=RED, linewidth=1.8, label="FEA")
            axes.plot(1e3 * row.arc_length, row.cprbm / factor, ".", color=BLUE, markersize=5, label="CPRBM")
            axes.set_title(row.probe.of, loc="left")
            axes.set_ylabel(f"bending stress, {unit}")
            axes.legend(loc="best")
            axes.set_xlabel("initial arc length, mm")
        return picture(
            figure,
            "stress",
            f"Bending stress along the beams at {rows[0].stage} {rows[0].station:g}; where it is "
            "positive the load turns the tangent counter-clockwise along the beam.",
        )


def _against_load(scene: Scene, rows: list[Row], quantity: str, what: str) -> Picture:
    with canvas(6.4, 3.6) as figure:
        axes = figure.add_subplot()
        factor, unit = scaled_unit(rows[0].unit, max(row.scale for row in rows))
        last = scene.stages[-1]
        step, step_unit = along_axis(load_unit(scene, last), 1.0)
        names = list(dict.fromkeys(row.probe.name for row in rows))
        told: set[str] = set()
        for name, (line, marker) in zip(names, islice(cycle(LOOKS), len(names)), strict=True):
            for stage in scene.stages:
                if stage.steps != last.steps:  # another load or drive has another axis
                    continue
                here = [row for row in rows if row.probe.name == name and row.stage == stage.name]
                for branch in dict.fromkeys(row.branch for row in here):
                    mine = [row for row in here if row.branch == branch]
                    load = [row.station / step for row in mine]
                    # where the answers are not on one branch there is none to draw a line of
                    style = line if branch is not None else "none"
                    first = name not in told
                    told.add(name)
                    axes.plot(
                        load,
                        [row.fea[0] / factor for row in mine],
                        linestyle=style,
                        marker="" if branch is not None else "x",
                        color=RED,
                        label=f"{name}, FEA" if first else None,
                    )
                    axes.plot(
                        load,
                        [row.cprbm[0] / factor for row in mine],
                        marker,
                        color=BLUE,
                        markersize=4,
                        label=f"{name}, CPRBM" if first else None,
                    )
        axes.set_xlabel(f"{last.steps}, {step_unit}")
        axes.set_ylabel(f"{what.lower()}, {unit}")
        axes.legend(loc="best")
        return picture(figure, quantity, f"{what} against {last.steps}.")


@contextmanager
def canvas(width: float, height: float) -> Iterator[Figure]:
    """An empty figure of ``width`` and ``height``, inches, in the style that it must also be drawn and saved in."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(_STYLE):
        yield Figure(figsize=(width, height), layout="constrained")


def picture(figure: Figure, name: str, caption: str) -> Picture:
    """A figure drawn to the end."""
    svg, png = io.BytesIO(), io.BytesIO()
    layout = figure.get_layout_engine()
    if layout is not None:  # made once, it serves both
        layout.execute(figure)
        figure.set_layout_engine("none")
    figure.savefig(svg, format="svg", metadata={"Date": None})
    figure.savefig(png, format="png", metadata={"Software": None})
    return Picture(name, caption, svg.getvalue(), png.getvalue())
