"""The door to PyVista: stations in space, drawn without a screen, in an own process.

Without a drawing library of the system, VTK may end the process.
"""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np

from comparisons.executor import WorkerDiedError, call_fresh
from comparisons.present.figures import QUANTITIES, TINY, colour_unit, view_title
from comparisons.present.picture import Bounds, View
from comparisons.present.strips import Coloured
from comparisons.present.vtu import Block, beam_block, obstacle_block
from cprbm_scene import Scene

T = TypeVar("T")

_SIZE = (1400, 1000)
_RIGID, _FORCE, _BODY = "#aeb6bf", "#0a7d33", "#3c4248"
_WAY = (-0.55, 0.75, 1.6)  # from the middle to the eye, over the mechanism's longer side


class DrawingError(RuntimeError):
    """VTK could not draw here; the text states the cause if known."""


def space_pictures(scene: Scene, views: Sequence[View], bounds: Bounds, quantity: Coloured) -> list[bytes]:
    """Views as PNG, from the same eye.

    Raises:
        ImportError: PyVista is not installed.
        DrawingError: VTK cannot draw here.
    """
    factor, unit = colour_unit(scene, quantity, bounds.most)
    titles = [f"{scene.name}, {view_title(scene, view)}" for view in views]
    title = f"{QUANTITIES[quantity][0].partition(',')[0]}, {unit}"
    return apart(_pictures, [*zip(titles, views, strict=True)], bounds, quantity, factor, title)


def apart(draws: Callable[..., T], *arguments: object) -> T:
    """Result of a function ``draws`` in an own process.

    Raises:
        DrawingError: the process was ended by force.
    """
    try:
        return call_fresh(_silent, draws, arguments)
    except WorkerDiedError:
        raise DrawingError("VTK ended as it began to draw") from None


def tried() -> str:
    """Cause for which VTK does not draw here; else empty."""
    try:
        apart(_cube)
    except (DrawingError, ImportError) as trouble:
        return str(trouble)
    return ""


def _silent(draws: Callable[..., T], arguments: tuple[object, ...]) -> T:
    """Draw without the messages of VTK on standard error."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    try:
        return draws(*arguments)
    except RuntimeError as trouble:
        raise DrawingError(str(trouble)) from None


def _cube() -> None:
    import pyvista

    plotter = pyvista.Plotter(off_screen=True)
    plotter.add_mesh(pyvista.Cube())
    plotter.screenshot(io.BytesIO(), return_img=False)
    plotter.close()


def _plain(text: str) -> str:
    """Text in the letters of VTK."""
    return text.replace("·", " ").replace("°", " deg").replace("µ", "u")


def _pictures(
    views: Sequence[tuple[str, View]], bounds: Bounds, quantity: Coloured, factor: float, title: str
) -> list[bytes]:
    """Titled views as PNG; ``factor`` is the size of the unit in the ``title`` of the colours, in SI."""
    import pyvista

    def grid(block: Block) -> pyvista.UnstructuredGrid:
        return pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: block.cells}, block.places)

    bar: dict[str, Any] = {"title": _plain(title), "color": "black", "vertical": True, "position_x": 0.88,
                           "position_y": 0.2, "height": 0.6, "width": 0.06, "title_font_size": 22,
                           "label_font_size": 20, "fmt": "%.4g"}  # fmt: skip
    found, size, margin = [], bounds.size, 0.06 * bounds.size
    (x, y), (right, top) = (bounds.low - margin).tolist(), (bounds.high + margin).tolist()
    middle, (wide, high) = np.array([*(0.5 * (bounds.low + bounds.high)), 0.0]), bounds.high - bounds.low
    for name, view in views:
        plotter = pyvista.Plotter(off_screen=True, window_size=list(_SIZE), lighting="light kit")
        plotter.set_background("white")
        block, obstacles, stream = beam_block(view), obstacle_block(view), io.BytesIO()
        limits = (bounds.least / factor, max(bounds.most, TINY) / factor)
        beams = grid(block)
        plotter.add_mesh(beams, scalars=block.values[quantity] / factor, cmap=QUANTITIES[quantity][2], clim=limits,
                         scalar_bar_args=bar, ambient=0.25)  # fmt: skip
        plotter.add_mesh(beams.extract_feature_edges(40.0), color="black", line_width=1.2)
        if obstacles is not None:
            surface = grid(obstacles).extract_surface(algorithm="dataset_surface")
            surface = surface.clip_box([x, right, y, top, -np.inf, np.inf], invert=False)
            plotter.add_mesh(surface, color=_RIGID, ambient=0.3)
        for part in view.of("body"):
            plotter.add_lines(np.pad(part.line, ((0, 0), (0, 1))), color=_BODY, width=7, connected=True)
        deep = float(np.ptp(block.places[:, 2]))
        for push in view.arrows_of("push"):
            vector = bounds.arrow(push)
            if vector is not None:
                tail = np.array([*(push.middle - vector), 0.55 * deep])  # in front of the beam
                plotter.add_arrows(tail, np.array([*vector, 0.0]), color=_FORCE, ambient=0.5)
        plotter.add_text(_plain(name), position="upper_left", color="black", font_size=10)
        plotter.enable_parallel_projection()
        plotter.camera_position = [(middle + 4.0 * size * np.array(_WAY)).tolist(), middle.tolist(), [0.0, 1.0, 0.0]]
        plotter.camera.parallel_scale = 0.62 * max(high, wide * _SIZE[1] / (0.75 * _SIZE[0])) + 0.3 * deep
        plotter.renderer.ResetCameraClippingRange()
        plotter.enable_anti_aliasing("ssaa")
        plotter.screenshot(stream, return_img=False)
        plotter.close()
        found.append(stream.getvalue())
    return found
