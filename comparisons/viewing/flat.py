"""A mechanism in its plane: beams at their true thickness, coloured by what stresses them, over the undeformed."""

from __future__ import annotations

import io
from collections.abc import Mapping
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from comparisons.bodies_drawn import draw_bodies, draw_stops
from comparisons.display_units import load_text, with_unit
from comparisons.figures import canvas, show_lengths
from comparisons.viewing.frames import (
    ARROW,
    COLOURS,
    LEAST,
    TINY,
    Bounds,
    Coloured,
    Frame,
    colour_values,
    shown_unit,
)
from cprbm_scene import Scene
from cprbm_scene.answer import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, PALE, RIGID, FORCE = "#202428", "#d3d6da", "#b9bfc6", "#0a7d33"
TITLES: Mapping[Coloured, str] = {
    "bending_stress": "bending stress",
    "combined_stress": "combined stress, largest of the section",
    "moment": "bending moment",
}
_LONGEST, _SHORTEST = 7.4, 3.2  # inches of the drawing's sides


def picture(scene: Scene, frame: Frame, bounds: Bounds, quantity: Coloured, kind: str, dots: float) -> bytes:
    """One frame as ``png`` or ``svg``, with ``dots`` to the inch of what is no line; the same frame, the same bytes."""
    width, height = _sides(bounds)
    with canvas(width + 1.5, height + 0.75) as figure:
        _draw(figure, scene, frame, bounds, quantity)
        stream = io.BytesIO()
        nothing = {"Date": None} if kind == "svg" else {"Software": None}
        figure.savefig(stream, format=kind, dpi=dots, metadata=nothing)
        return stream.getvalue()


def title_of(scene: Scene, frame: Frame, *, symbols: bool = True) -> str:
    """The scene's name, and the stage and its load or drive at the station; without ``symbols`` in plain letters."""
    station = frame.station
    stage = next(each for each in scene.stages if each.name == station.stage)
    said = f"{scene.name}, {station.stage}: {stage.steps} = {load_text(scene, stage.name, station.value)}"
    return said if symbols else said.replace("·", " ").replace("°", " deg").replace("µ", "u")


def _sides(bounds: Bounds) -> tuple[float, float]:
    low, high = _window(bounds)
    x, y = high - low
    scale = _LONGEST / max(x, y)
    return max(_SHORTEST, x * scale), max(0.6 * _SHORTEST, y * scale)


def _window(bounds: Bounds) -> tuple[Array, Array]:
    margin = 0.06 * max(bounds.high - bounds.low)
    return bounds.low - margin, bounds.high + margin


def _draw(figure: Figure, scene: Scene, frame: Frame, bounds: Bounds, quantity: Coloured) -> None:
    axes = figure.add_subplot()
    low, high = _window(bounds)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal", adjustable="box")
    for obstacle in frame.obstacles:
        line = "-" if obstacle.known else "--"
        around = obstacle.outline if obstacle.round else np.concatenate([obstacle.outline, obstacle.solid[::-1]])
        axes.fill(*around.T, facecolor=RIGID, alpha=0.55, linewidth=0.0, zorder=0.5)
        axes.plot(*obstacle.outline.T, line, color=INK, linewidth=0.9, zorder=0.6)
    for strip in frame.strips.values():
        band = np.concatenate([strip.rest_layer(-1.0), strip.rest_layer(1.0)[::-1]])
        axes.fill(*band.T, facecolor=PALE, edgecolor="#aab0b7", linewidth=0.5, zorder=1.0)
    factor, unit = shown_unit(scene, quantity, bounds.most)
    coloured = None
    for strip in frame.strips.values():
        right, left = strip.layer(-1.0), strip.layer(1.0)
        values = colour_values(strip, quantity) / factor
        coloured = axes.pcolormesh(
            np.stack([right[:, 0], left[:, 0]]),
            np.stack([right[:, 1], left[:, 1]]),
            np.stack([values, values]),
            shading="gouraud",
            cmap=COLOURS[quantity],
            vmin=bounds.least / factor,
            vmax=max(bounds.most, TINY) / factor,
            rasterized=True,
            zorder=2.0,
        )
        around = np.concatenate([right, left[::-1], right[:1]])
        axes.plot(*around.T, "-", color=INK, linewidth=0.45, zorder=2.1, solid_joinstyle="round")
    draw_bodies(axes, scene, frame.places, "-", INK)
    draw_stops(axes, scene, frame.places)
    _arrows(axes, scene, frame, bounds)
    show_lengths(scene, axes.xaxis, "x")
    show_lengths(scene, axes.yaxis, "y")
    axes.set_title(title_of(scene, frame), loc="left", fontsize=10)
    if coloured is not None:
        bar = figure.colorbar(coloured, ax=axes, shrink=0.85, pad=0.02, aspect=28)
        bar.set_label(f"{TITLES[quantity]}, {unit}")
        bar.outline.set_linewidth(0.4)


def _arrows(axes: Axes, scene: Scene, frame: Frame, bounds: Bounds) -> None:
    """Resultants of contacts, each with its head where it presses, and dots at all places of a zone."""
    if bounds.force <= 0.0:
        for spots in frame.station.touching.values():
            axes.plot(*spots.T, ".", color=FORCE, markersize=3.0, zorder=5.0)
        return
    longest = ARROW * float(max(bounds.high - bounds.low)) / bounds.force
    named: set[str] = set()
    for push in frame.pushes:
        size = hypot(*push.resultant)
        if size < LEAST * bounds.force:
            continue
        if len(push.places) > 1:
            axes.plot(*push.places.T, ".", color=FORCE, markersize=1.6, zorder=4.9)
        head = push.middle
        tail = head - longest * push.resultant
        axes.annotate(
            "",
            xy=(head[0], head[1]),
            xytext=(tail[0], tail[1]),
            arrowprops={"arrowstyle": "-|>", "color": FORCE, "linewidth": 1.5, "shrinkA": 0.0, "shrinkB": 0.0},
            zorder=5.0,
        )
        if push.contact not in named:
            named.add(push.contact)
            way = push.resultant / size
            axes.annotate(
                with_unit(scene, size, "N", 3),
                (tail[0], tail[1]),
                textcoords="offset points",
                xytext=(-13.0 * way[0], -9.0 * way[1]),
                ha="center" if abs(way[1]) > abs(way[0]) else ("right" if way[0] > 0.0 else "left"),
                va="center",
                fontsize=8.5,
                color=FORCE,
                zorder=6.0,
            )
