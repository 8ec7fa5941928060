"""The figures of a comparison; the only module that knows matplotlib, which it imports when it draws.

The same answers give the same bytes: no dates, and identifiers from a fixed salt.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import cycle, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.bodies_drawn import draw_bodies, draw_edges, draw_names, draw_stops, joined_ends, places_at
from comparisons.case import Comparison
from comparisons.display_units import at_station, axis_unit, display_unit, load_text
from comparisons.framing import frame
from comparisons.geometry import length, longest, points
from comparisons.pairing import Runs
from comparisons.quantities import load_unit, norm
from comparisons.sheets import last_rows, shown_rows
from comparisons.stations import station_of
from comparisons.verdict.rows import Row
from comparisons.writing import write
from cprbm_scene import Answer, CircleContact, Scene
from cprbm_scene.statement import FreeEnd

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
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
    svg: bytes = field(repr=False)
    png: bytes = field(repr=False)

    def _repr_svg_(self) -> str:
        """The figure in a notebook."""
        return self.svg.decode()

    def save(self, path: Path) -> None:
        """Write the figure to a file that ends in ``.svg`` or ``.png``.

        Raises:
            ValueError: the path ends otherwise.
            OSError: the file cannot be written.
        """
        content = {".svg": self.svg, ".png": self.png}.get(path.suffix.lower())
        if content is None:
            raise ValueError(f"found the file name {path.name!r}; allowed: a name that ends in .svg or .png")
        write(path, content)


def of_comparison(compared: Comparison) -> tuple[Picture, ...]:
    """All figures of a comparison; none where a run gave no whole answer."""
    if not compared.rows:
        return ()
    stations = [(rows[0].stage, rows[0].station) for rows in shown_rows(compared)]
    pictures = [shapes(compared.scene, _pair(compared.runs), *stations[-1])]
    if len(stations) > 1:
        pictures.append(_stations(compared.scene, _pair(compared.runs), stations))
    stresses = [row for row in last_rows(compared) if row.probe.quantity == "bending_stress"]
    if stresses:
        pictures.append(_stresses(compared.scene, stresses))
    for quantity, what in (("rotation", "Rotation"), ("force", "Contact force")):
        rows = [row for row in compared.rows if row.probe.quantity == quantity]
        if len(rows) > 1:
            pictures.append(_against_load(compared.scene, rows, quantity, what))
    return tuple(pictures)


def of_answer(scene: Scene, answer: Answer) -> Picture:
    """Drawing of an answer at its last station.

    Raises:
        ValueError: the answer has no station.
    """
    if not answer.stations:
        raise ValueError(f"{scene.name}: no drawing, since {answer.solver} reached no station. {answer.sentence}")
    label = {"cprbm": "CPRBM", "fea": "FEA"}.get(answer.solver, answer.solver)
    return shapes(scene, {label: answer}, answer.stations[-1].stage, answer.stations[-1].value)


def of_designs(designs: Sequence[Comparison]) -> Picture:
    """Drawing of one comparison, or of the finite elements of several, at the last stations; all have rows."""
    if len(designs) == 1:
        return of_comparison(designs[0])[0]
    return _overlay([(each.scene, each.runs.reference) for each in designs])


def _pair(runs: Runs) -> dict[str, Answer]:
    """The two compared answers by their labels, the finite elements first."""
    return {f"FEA ({runs.kinematics})": runs.reference, "CPRBM": runs.cprbm[0]}


def shapes(scene: Scene, answers: Mapping[str, Answer], stage: str, value: float) -> Picture:
    """The mechanism before and after, in the manner of the paper's Fig. 8.

    Args:
        scene: the question.
        answers: by label, at most one of the CPRBM; bodies and edges are drawn as the first has them.
        stage, value: the station, which all answers have.
    """
    with canvas(6.4, 6.0) as figure:
        axes = figure.add_subplot()
        _as_drawn(axes, scene)
        _mechanism(axes, scene, answers, stage, value)
        draw_names(axes, scene)
        show_lengths(scene, axes.xaxis, "x")
        show_lengths(scene, axes.yaxis, "y")
        figure.legend(loc="outside lower center", ncols=3)
        apart = " Dotted: the way of an end that is drawn apart from its pin." if scene.assembly is not None else ""
        return picture(
            figure,
            "shapes",
            f"Neutral lines before and at {at_station(scene, stage, value)}, with the places of contact.{apart}",
        )


def _stations(scene: Scene, answers: Mapping[str, Answer], stations: list[tuple[str, float]]) -> Picture:
    """The mechanism at several stations, in the manner of the paper's Fig. 17."""
    columns = min(2, len(stations))
    lines = -(-len(stations) // columns)
    stages = {stage.name: stage for stage in scene.stages}
    with canvas(3.6 * columns, 0.6 + 3.4 * lines) as figure:
        for place, (name, value) in enumerate(stations):
            axes = figure.add_subplot(lines, columns, place + 1)
            _mechanism(axes, scene, answers, name, value)
            title = f"{name}, {stages[name].steps} = {load_text(scene, name, value)}"
            axes.set_title(title, loc="left", fontsize=9)
            show_lengths(scene, axes.xaxis)
            show_lengths(scene, axes.yaxis)
            axes.tick_params(labelsize=8)
        _, unit = display_unit(scene, "m", longest(scene))
        handles, labels = figure.axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=3)
        return picture(
            figure,
            "stations",
            f"Neutral lines, {unit}, at several stations, with the places of contact.",
        )


def _as_drawn(axes: Axes, scene: Scene) -> None:
    """The mechanism before anything happens, and the way of the ends that are apart from their points."""
    for place, beam in enumerate(scene.beams.values()):
        x, y = points(beam.curve, np.linspace(0.0, length(beam.curve), 200)).T
        axes.plot(x, y, "--", color=GREY, linewidth=1.0, label="undeformed" if place == 0 else None)
        for end, point in ((beam.start, 0), (beam.end, -1)):
            if not isinstance(end, FreeEnd):
                to_x, to_y = scene.place_of(end.point)
                axes.plot([x[point], to_x], [y[point], to_y], ":", color=GREY, linewidth=0.9)
    drawn = {end.point: scene.place_of(end.point) for _, end, _ in joined_ends(scene)}
    draw_bodies(axes, scene, drawn, "--", GREY)


def _overlay(designs: Sequence[tuple[Scene, Answer]]) -> Picture:
    """Several designs at the last station of each, in one figure."""
    with canvas(6.4, 6.0) as figure:
        axes = figure.add_subplot()
        for (scene, answer), colour in zip(designs, cycle((RED, BLUE, "#3a8a3a", "#8a4fb0", "#b07a1a")), strict=False):
            last = answer.stations[-1]
            draw_bodies(axes, scene, places_at(scene, last), "-", colour)
            for place, shape in enumerate(last.shapes.values()):
                label = f"{scene.name}: {at_station(scene, last.stage, last.value)}" if place == 0 else None
                axes.plot(shape.x, shape.y, "-", color=colour, linewidth=2.0, label=label)
        axes.set_aspect("equal", adjustable="datalim")
        show_lengths(designs[0][0], axes.xaxis, "x")
        show_lengths(designs[0][0], axes.yaxis, "y")
        figure.legend(loc="outside lower center", ncols=2)
        return picture(figure, "designs", "Neutral lines of several designs, each at its last station.")


def _mechanism(axes: Axes, scene: Scene, answers: Mapping[str, Answer], stage: str, value: float) -> None:
    """Answers at a station: dots of the CPRBM, lines of all others."""
    from matplotlib.patches import Circle

    for contact in scene.contacts.values():
        if isinstance(contact, CircleContact):
            (x, y), stands = contact.center, scene.bodies[contact.body].motion == "fixed"
            style = "-" if stands else "--"  # one that moves is shown where it began
            # an artist, no patch: a large circle must not make the beams small
            axes.add_artist(Circle((x, y), contact.radius, fill=False, edgecolor=GREY, linestyle=style))
    stations = {label: station_of(answer, stage, value) for label, answer in answers.items()}
    first = next(iter(stations.values()))
    places = places_at(scene, first)
    draw_edges(axes, scene, places, GREY)
    draw_bodies(axes, scene, places, "-", "black")
    draw_stops(axes, scene, places)
    for number_of_beam, beam_name in enumerate(scene.beams):
        for label, station in stations.items():
            shape = station.shapes[beam_name]
            marker, colour = (".", BLUE) if label == "CPRBM" else ("-", RED)
            shown = label if number_of_beam == 0 else None
            axes.plot(shape.x, shape.y, marker, color=colour, markersize=3.5, linewidth=2.2, label=shown)
    for label, station in stations.items():
        name = label.partition(" (")[0]
        marker, colour = ("o", BLUE) if label == "CPRBM" else ("x", RED)
        for place, spots in enumerate(station.touching.values()):
            shown = f"contact, {name}" if place == 0 else None
            x, y = spots.T
            # the many places of a zone would hide the beam behind them
            size = 9.0 if len(spots) <= FEW_PLACES else 2.5
            axes.plot(x, y, marker, color=colour, markersize=size, markerfacecolor="none", linestyle="", label=shown)
    frame(axes, first)


def _stresses(scene: Scene, rows: list[Row]) -> Picture:
    """Bending stress along each beam, in the manner of the paper's Fig. 10."""
    with canvas(7.2, 2.8 * len(rows)) as figure:
        factor, unit = display_unit(scene, "Pa", max(norm("bending_stress", row.fea) for row in rows))
        for place, row in enumerate(rows):
            axes = figure.add_subplot(len(rows), 1, place + 1)
            if row.arc_length is None:
                continue
            axes.axhline(0.0, color=GREY, linewidth=0.6)
            axes.plot(row.arc_length, row.fea / factor, "-", color=RED, linewidth=1.8, label="FEA")
            axes.plot(row.arc_length, row.cprbm / factor, ".", color=BLUE, markersize=5, label="CPRBM")
            axes.set_title(row.probe.of, loc="left")
            axes.set_ylabel(f"bending stress, {unit}")
            axes.legend(loc="best")
            show_lengths(scene, axes.xaxis, "initial arc length")
        return picture(
            figure,
            "stress",
            f"Bending stress along the beams at {at_station(scene, rows[0].stage, rows[0].station)}; where it is "
            "positive the load turns the tangent counter-clockwise along the beam.",
        )


def _against_load(scene: Scene, rows: list[Row], quantity: str, what: str) -> Picture:
    with canvas(6.4, 3.6) as figure:
        axes = figure.add_subplot()
        factor, unit = display_unit(scene, rows[0].unit, max(row.scale for row in rows))
        last = scene.stages[-1]
        step, step_unit = axis_unit(scene, load_unit(scene, last), max(map(abs, last.stations)))
        names = list(dict.fromkeys(row.probe.name for row in rows))
        labelled: set[str] = set()
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
                    first = name not in labelled
                    labelled.add(name)
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


def show_lengths(scene: Scene, axis: Axis, name: str = "") -> None:
    """Give an axis of lengths, m, ticks in the displayed unit, and a label."""
    from matplotlib.ticker import AutoLocator, FuncFormatter

    factor, unit = display_unit(scene, "m", longest(scene))

    class Locator(AutoLocator):
        """Ticks at round numbers of the displayed unit."""

        def tick_values(self, vmin: float, vmax: float) -> Sequence[float]:
            """Ticks between two lengths, m."""
            return [factor * tick for tick in super().tick_values(vmin / factor, vmax / factor)]

    axis.set_major_locator(Locator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / factor:g}".replace("-", "\N{MINUS SIGN}")))
    if name:
        axis.set_label_text(f"{name}, {unit}")


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
