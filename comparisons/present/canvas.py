"""The door to Matplotlib, which loads at the first drawing: canvases, charts of lines, and finished figures.

The same answers give the same bytes: no dates, and identifiers from a fixed salt.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from comparisons.formats import display_unit
from comparisons.geometry import longest
from comparisons.present.columns import Figure
from comparisons.present.picture import Kind, Part, names_by_place
from cprbm_scene import Scene

if TYPE_CHECKING:
    import matplotlib.figure  # and with it the axes and the transforms

Axes: TypeAlias = "matplotlib.axes.Axes"
Drawing: TypeAlias = "matplotlib.figure.Figure"
Bbox: TypeAlias = "matplotlib.transforms.Bbox"
"""Matplotlib's classes for annotations: a module with a drawing loads no Matplotlib."""

BLUE, RED, GREY, INK, GREEN, RULE = "#1f5fa8", "#c8321e", "#8a8a8a", "#202428", "#0a7d33", "#e4e4e4"
LINES = (("-", "o"), ("--", "s"), (":", "^"), ("-.", "D"))
"""Lines and markers of the probes in one figure."""

Look = Mapping[str, Any]
"""Matplotlib's keywords of a line or of a text."""

Line: TypeAlias = tuple[ArrayLike, ArrayLike, Look]
"""Abscissae (k,), ordinates (k,) and look."""

Text: TypeAlias = tuple[str, tuple[float, float], Look]
"""A text, its place in the panel, and the look with the distance from the place in points."""

_BAND = "#eef2f7"
_MARGIN = 0.1
"""White margin of a figure, inches."""

_STYLE: dict[Any, Any] = {  # the stubs name every key of every version
    "svg.hashsalt": "cprbm",
    "svg.fonttype": "path",
    "font.family": "DejaVu Sans",
    "font.size": 11.0,
    "axes.formatter.limits": (-3, 5),  # powers of ten of longer numbers stand beside the axis
    "axes.titlelocation": "left",
    "axes.titlesize": 12.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "savefig.dpi": 150.0,
    "figure.constrained_layout.h_pad": 0.1,  # inches; with less a title at the upper edge is cut
    "figure.constrained_layout.w_pad": 0.1,
}

_LOOKS: dict[Kind, dict[str, Any]] = {
    "edge": {"color": INK, "linewidth": 0.9, "zorder": 0.6},
    "rest": {"facecolor": "#d3d6da", "edgecolor": "#aab0b7", "linewidth": 0.5, "zorder": 1.0},
    "beam": {"facecolor": RED, "linewidth": 0.0, "zorder": 2.0},
    "body": {"linestyle": "-", "linewidth": 1.2},
    "weld": {"linestyle": "", "marker": "s", "markersize": 4.0},
    "pin": {"linestyle": "", "marker": "o", "markersize": 5.0, "markerfacecolor": "white", "zorder": 3.0},
    "pivot": {"linestyle": "", "marker": "o", "markersize": 8.0, "markerfacecolor": "none"},
    "stop": {"linestyle": "-.", "linewidth": 0.8},
    "contact": {"linestyle": "", "marker": ".", "markersize": 3.0, "color": GREEN, "zorder": 5.0},
}
"""Matplotlib's keywords by kind of part; parts with a ``facecolor`` are areas."""

_RIGID: dict[str, Any] = {"facecolor": "#b9bfc6", "alpha": 0.55, "linewidth": 0.0, "zorder": 0.5}
"""Keywords of the solid side of an edge."""


@contextmanager
def canvas(
    width: float,
    height: float,
    count: int = 1,
    columns: int = 1,
    shared: Literal["", "x", "y", "xy"] = "",
) -> Iterator[tuple[Drawing, list[Axes]]]:
    """Context with an empty drawing and its axes; draw and finish it inside the context.

    Args:
        width, height: of the drawing, inches.
        count: number of axes, row by row.
        columns: number of columns.
        shared: axes of abscissae, of ordinates or of both that have one range.
    """
    import matplotlib.figure

    with matplotlib.rc_context(_STYLE):
        drawing, rows = matplotlib.figure.Figure(figsize=(width, height), layout="constrained"), -(-count // columns)
        axes = drawing.subplots(rows, columns, sharex="x" in shared, sharey="y" in shared, squeeze=False).ravel()
        for spare in axes[count:]:
            spare.remove()
        for each in axes[:count]:
            each.locator_params(axis="x", nbins=int(width / columns))  # an inch for a number
        yield drawing, [*axes[:count]]


class Panel(NamedTuple):
    """Axes with lines.

    Attributes:
        ordinate: label.
        lines: all lines.
        title: of the axes.
        band: half of the height of a tinted band round zero on linear axes.
        texts: beside places.
    """

    ordinate: str
    lines: Sequence[Line]
    title: str = ""
    band: float = 0.0
    texts: Sequence[Text] = ()


def chart(
    name: str,
    caption: str,
    abscissa: str,
    panels: Sequence[Panel],
    *,
    panel: tuple[float, float] = (5.2, 2.5),
    columns: int = 1,
    shared: Literal["", "x", "y", "xy"] = "x",
    decades: Sequence[float] | None = None,
    marks: Sequence[tuple[float, str]] = (),
    legend: tuple[str, int] | None = None,
) -> Figure:
    """Figure of panels with lines, row by row.

    Args:
        name, caption: of the figure.
        abscissa: label of the abscissa.
        panels: of the figure.
        panel: width and height of a panel, inches.
        columns, shared: as of :func:`canvas`.
        decades: numbers on the abscissa of logarithmic axes, or none for whole decades; None for linear axes.
        marks: abscissa and colour of dotted lines across all panels.
        legend: common legend, as of :func:`finished`; None for a legend in every panel.
    """
    width, height = columns * panel[0], 0.8 + panel[1] * -(-len(panels) // columns)
    with canvas(width, height, len(panels), columns, shared) as (drawing, plots):
        for axes, each in zip(plots, panels, strict=True):
            if decades is None:
                axes.axhspan(-each.band, each.band, color=_BAND, linewidth=0.0, zorder=0)
                axes.axhline(0.0, color=GREY, linewidth=0.5)
            for xs, ys, look in each.lines:
                axes.plot(xs, ys, **look)
            for x, colour in marks:
                axes.axvline(x, color=colour, linewidth=0.7, linestyle=":")
            for text, place, look in each.texts:
                axes.annotate(text, place, textcoords="offset points", **look)
            axes.set(title=each.title, ylabel=each.ordinate)
            if legend is None and each.lines:
                axes.legend(loc="best")
        if decades is not None:
            for axes in plots:
                _logarithmic(axes, decades)
        for axes in plots[-columns:]:
            axes.set_xlabel(abscissa)
        return finished(drawing, name, caption, legend)


def panels(count: int, height: float) -> tuple[float, float, int, int]:
    """Arguments of :func:`canvas` for ``count`` panels of a ``height``, inches, in at most two columns."""
    columns = min(count, 2)
    return 4.2 * columns, height * -(-count // columns), count, columns


def finished(drawing: Drawing, name: str, caption: str, legend: tuple[str, int] | None = None) -> Figure:
    """The figure of a drawing, with a ``legend`` of every label once, outside all axes: place and number of columns."""
    if legend is not None:
        pairs = [pair for axes in drawing.axes for pair in zip(*axes.get_legend_handles_labels(), strict=True)]
        first = {label: handle for handle, label in reversed(pairs)}
        names = [*dict.fromkeys(label for _, label in pairs)]
        place, columns = legend
        drawing.legend([first[each] for each in names], names, loc=f"outside {place}", ncols=columns, fontsize=10.0)  # type: ignore[call-overload]
    layout = drawing.get_layout_engine()
    if layout is not None:  # made once, it serves both formats
        layout.execute(drawing)
        drawing.set_layout_engine("none")
    box = drawing.get_tightbbox().padded(_MARGIN)  # equal scales leave white bands beside the axes
    svg, png = (image(drawing, kind, box=box) for kind in ("svg", "png"))
    return Figure(name, caption, _short_svg(svg), _palette_png(png))


def _short_svg(svg: bytes) -> bytes:
    """The picture without indentation and metadata, with coordinates to a hundredth of a point.

    Equal markers of a line take their style from the line.
    """
    svg = re.sub(rb"\s*<metadata>.*?</metadata>", b"", svg, flags=re.DOTALL)
    svg = re.sub(rb'(?<= d=")[^"]*', lambda path: path[0].replace(b"\n", b""), svg)
    # six decimals are coordinates; the scale of a letter, 1/64 to a last digit 5, has its own attribute
    svg = re.sub(rb"(?<![(\d.])(-?\d+\.\d\d)\d+(?=[\s\"])", rb"\1", svg)
    svg = re.sub(rb"\n *", b"\n", svg)
    markers = rb'(<g[^>]*)>((?:\n<use [^>]*?( style="[^"]*")/>)+)'
    return re.sub(markers, lambda line: line[1] + line[3] + b">" + line[2].replace(line[3], b""), svg)


def _palette_png(png: bytes) -> bytes:
    """The picture with a palette of 64 colours: few colours and their blends with white take a quarter of the room."""
    from PIL import Image

    stream = io.BytesIO()
    Image.open(io.BytesIO(png)).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(stream, "png")
    return stream.getvalue()


def image(drawing: Drawing, kind: str, dots: float | None = None, box: Bbox | None = None) -> bytes:
    """The drawing, or a ``box`` of it in inches, as ``svg`` or ``png`` without dates, with ``dots`` to the inch."""
    stream = io.BytesIO()
    drawing.savefig(
        stream,
        format=kind,
        metadata={"Date" if kind == "svg" else "Software": None},
        dpi=dots or _STYLE["savefig.dpi"],
        bbox_inches=box,
    )
    return stream.getvalue()


def draw_parts(axes: Axes, parts: Iterable[Part], colour: str = INK) -> None:
    """Draw parts of the drawing list; lines and marks without a colour of their own take ``colour``."""
    for part in parts:
        look = _LOOKS[part.kind]
        if part.kind == "edge":
            axes.fill(*part.area.T, **_RIGID)
        if "facecolor" in look:
            axes.fill(*part.points.T, **look)
        else:
            axes.plot(*part.line.T, **{"color": colour, **look})


def draw_names(axes: Axes, scene: Scene) -> None:
    """Names of all points as drawn, at the left, or at the right beside a close point."""
    close = 0.05 * longest(scene)
    points = {name: np.array(place) for body in scene.bodies.values() for name, place in body.points.items()}
    named = names_by_place(points, 1e-3 * close)
    for text, (x, y) in named.items():
        crowded = any(0.0 < x - left < close and abs(y - height) < close for left, height in named.values())
        side, shift = ("left", 4) if crowded else ("right", -4)
        axes.annotate(text, (x, y), textcoords="offset points", xytext=(shift, 7), ha=side)


def show_lengths(scene: Scene, axis: matplotlib.axis.Axis, name: str) -> None:
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
    axis.set_label_text(f"{name}, {unit}")


def _logarithmic(axes: Axes, x: Sequence[float]) -> None:
    """Give axes logarithmic scales with a grid, and ticks at the numbers ``x``; otherwise an axis has whole decades."""
    axes.set(xscale="log", yscale="log")
    axes.set_ylim(_whole(axes.get_ylim()))
    if x:
        axes.set_xticks(x, [f"{each:g}" for each in x])
    else:
        axes.set_xlim(_whole(axes.get_xlim()))  # of all panels that share the axis
    axes.minorticks_off()
    axes.grid(visible=True, which="major", color=RULE, linewidth=0.6)


def _whole(interval: tuple[float, float]) -> tuple[float, float]:
    """The whole decades around an interval: an axis has two ticks or more."""
    low, high = np.log10(interval)
    return float(10.0 ** np.floor(low)), float(10.0 ** np.ceil(high))


def name_rows(axes: Axes, names: Sequence[str]) -> None:
    """Give the vertical axis a row for every name, from the top down."""
    axes.set(yticks=range(len(names)), yticklabels=names, ylim=(len(names) - 0.4, -0.6))
