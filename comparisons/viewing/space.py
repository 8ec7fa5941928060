"""The door to PyVista: stations in space, drawn without a screen, in a process of its own.

Where VTK finds no library of the system that draws, it may end the process that asks it to.
"""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ParamSpec, TypeVar

import numpy as np

from comparisons.executor import WorkerDiedError, call_fresh
from comparisons.viewing.frames import COLOURS, TINY, Bounds, Coloured
from comparisons.viewing.solids import Block
from cprbm_scene.answer import Array

T = TypeVar("T")
P = ParamSpec("P")

_SIZE = (1400, 1000)
_SKY, _RIGID, _FORCE = "white", "#aeb6bf", "#0a7d33"
_WAY = (-0.55, 0.75, 1.6)  # from the middle to the eye, of the mechanism's larger side


class DrawingError(RuntimeError):
    """VTK could not draw here; the words say why, as far as it is known."""


@dataclass(frozen=True, slots=True)
class View:
    """A station in space: its beams and what is rigid, ``lines`` (2, 3) each between points of a body, and forces.

    ``arrows`` are tails and ways (k, 2, 3), m, of contacts' resultants; ``title`` says which station it is.
    """

    title: str
    beams: Block
    obstacles: Block | None
    lines: tuple[Array, ...]
    arrows: Array


def pictures(views: Sequence[View], bounds: Bounds, quantity: Coloured, factor: float, bar: str) -> list[bytes]:
    """Views as PNG, from one place; ``factor`` scales the quantity to the unit that the title of the ``bar`` says.

    Raises:
        ImportError: PyVista is not there.
        DrawingError: VTK finds nothing to draw with, or ends.
    """
    return apart(_drawn, list(views), bounds, quantity, factor, bar)


def apart(draws: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """What a function ``draws`` in a process of its own.

    Raises:
        DrawingError: the process was ended by force.
    """
    try:
        return call_fresh(_silent, draws, arguments, named)
    except WorkerDiedError:
        raise DrawingError("VTK ended as it began to draw") from None


def tried() -> str:
    """Why VTK does not draw here; empty if it does."""
    block = Block("hexahedron", _CUBE, np.arange(8)[None], {"bending_stress": _CUBE[:, 0]})
    corner = np.ones(2)
    bounds = Bounds(0.0 * corner, corner, 0.0, 1.0, 0.0, 1.0)
    try:
        pictures([View("", block, None, (), np.zeros((0, 2, 3)))], bounds, "bending_stress", 1.0, "")
    except (DrawingError, ImportError) as trouble:
        return str(trouble)
    return ""


_CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))])


def _silent(draws: Callable[..., T], arguments: tuple[object, ...], named: dict[str, object]) -> T:
    """Draw, and keep what VTK says on its way to its end off standard error, where one line is to stand."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    return draws(*arguments, **named)


def _drawn(views: list[View], bounds: Bounds, quantity: Coloured, factor: float, bar: str) -> list[bytes]:
    import pyvista

    pyvista.OFF_SCREEN = True
    try:
        return [_picture(view, bounds, quantity, factor, bar) for view in views]
    except RuntimeError as trouble:
        raise DrawingError(str(trouble)) from None


def _picture(view: View, bounds: Bounds, quantity: Coloured, factor: float, bar: str) -> bytes:
    import pyvista

    def grid(block: Block) -> pyvista.UnstructuredGrid:
        return pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: block.cells}, block.places)

    plotter = pyvista.Plotter(off_screen=True, window_size=list(_SIZE), lighting="light kit")
    plotter.set_background(_SKY)
    size = float(max(bounds.high - bounds.low))
    strips = grid(view.beams)
    plotter.add_mesh(
        strips,
        scalars=view.beams.values[quantity] / factor,
        cmap=COLOURS[quantity],
        clim=(bounds.least / factor, max(bounds.most, TINY) / factor),
        scalar_bar_args={"title": bar, "color": "black", "vertical": True, "position_x": 0.88, "position_y": 0.2,
                         "height": 0.6, "width": 0.06, "title_font_size": 22, "label_font_size": 20, "fmt": "%.4g"},
        show_scalar_bar=bool(bar),
        ambient=0.25,
    )  # fmt: skip
    plotter.add_mesh(strips.extract_feature_edges(40.0), color="black", line_width=1.2)
    if view.obstacles is not None:
        shown = grid(view.obstacles).extract_surface(algorithm="dataset_surface")
        plotter.add_mesh(shown.clip_box(_box(bounds), invert=False), color=_RIGID, ambient=0.3)
    for start, end in view.lines:
        plotter.add_mesh(pyvista.Line(start, end).tube(radius=0.005 * size), color="#3c4248")
    for tail, way in view.arrows:
        length = float(np.linalg.norm(way))
        plotter.add_mesh(
            pyvista.Arrow(tail, way, scale=length, tip_length=min(0.9, 0.03 * size / length),
                          tip_radius=0.009 * size / length, shaft_radius=0.004 * size / length),
            color=_FORCE,
            ambient=0.5,
        )  # fmt: skip
    plotter.add_text(view.title, position="upper_left", color="black", font_size=10)
    plotter.enable_parallel_projection()
    deep = 0.3 * float(np.ptp(view.beams.places[:, 2]))
    middle = np.array([*(0.5 * (bounds.low + bounds.high)), 0.0])
    plotter.camera.focal_point = middle
    plotter.camera.position = middle + 4.0 * size * np.array(_WAY)
    plotter.camera.up = (0.0, 1.0, 0.0)
    wide, high = bounds.high - bounds.low
    plotter.camera.parallel_scale = 0.62 * max(high, wide * _SIZE[1] / (0.75 * _SIZE[0])) + deep
    plotter.renderer.ResetCameraClippingRange()
    plotter.enable_anti_aliasing("ssaa")
    stream = io.BytesIO()
    plotter.screenshot(stream, return_img=False)
    plotter.close()
    return stream.getvalue()


def _box(bounds: Bounds) -> list[float]:
    """What of a large obstacle is shown."""
    margin = 0.06 * float(max(bounds.high - bounds.low))
    (x, y), (X, Y) = bounds.low - margin, bounds.high + margin
    return [float(x), float(X), float(y), float(Y), -np.inf, np.inf]
