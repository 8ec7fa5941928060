"""The door to PyVista: stations in space, drawn without a screen, in an own process.

Without a drawing library of the system, VTK may end the process.
"""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple, ParamSpec, TypeVar

import numpy as np

from comparisons.executor import WorkerDiedError, call_fresh
from comparisons.present.figures import QUANTITIES, TINY, colour_unit, view_title
from comparisons.present.picture import ARROW, LEAST, Bounds, View
from comparisons.present.strips import Coloured
from comparisons.present.vtu import Block, beam_block, obstacle_block
from cprbm_scene import Scene
from cprbm_scene.answer import Array

T = TypeVar("T")
P = ParamSpec("P")

_SIZE = (1400, 1000)
_RIGID, _FORCE, _BODY = "#aeb6bf", "#0a7d33", "#3c4248"
_WAY = (-0.55, 0.75, 1.6)  # from the middle to the eye, over the mechanism's longer side


class DrawingError(RuntimeError):
    """VTK could not draw here; the text states the cause if known."""


class SpaceView(NamedTuple):
    """A station in space: beams, rigid edges, ``lines`` (2, 3) of bodies, ``arrows`` (k, 2, 3) as tails and ways; m."""

    title: str
    beams: Block
    obstacles: Block | None
    lines: Sequence[Array]
    arrows: Array


def space_pictures(scene: Scene, views: Sequence[View], bounds: Bounds, quantity: Coloured) -> list[bytes]:
    """Views as PNG, from the same eye.

    Raises:
        ImportError: PyVista is not installed.
        DrawingError: VTK cannot draw here.
    """
    factor, unit = colour_unit(scene, quantity, bounds.most)
    title = _plain(f"{QUANTITIES[quantity][0].partition(',')[0]}, {unit}")
    return pictures([_space_view(scene, view, bounds) for view in views], bounds, quantity, factor, title)


def pictures(views: list[SpaceView], bounds: Bounds, quantity: Coloured, factor: float, title: str) -> list[bytes]:
    """Views as PNG; ``factor`` is the size of the unit in the ``title`` of the colours, in SI.

    Raises:
        ImportError: PyVista is not installed.
        DrawingError: VTK cannot draw here.
    """
    return apart(_drawn, views, bounds, quantity, factor, title)


def apart(draws: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """Result of a function ``draws`` in an own process.

    Raises:
        DrawingError: the process was ended by force.
    """
    try:
        return call_fresh(_silent, draws, arguments, named)
    except WorkerDiedError:
        raise DrawingError("VTK ended as it began to draw") from None


def tried() -> str:
    """Cause for which VTK does not draw here; else empty."""
    corners = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))])
    cube = Block("hexahedron", corners, np.arange(8)[None], {"bending_stress": corners[:, 0]})
    bounds = Bounds(np.zeros(2), np.ones(2), 0.0, 1.0, {})
    try:
        pictures([SpaceView("", cube, None, (), np.zeros((0, 2, 3)))], bounds, "bending_stress", 1.0, "")
    except (DrawingError, ImportError) as trouble:
        return str(trouble)
    return ""


def _space_view(scene: Scene, view: View, bounds: Bounds) -> SpaceView:
    lines = []
    for part in view.of("body"):
        corners = np.pad(part.points, ((0, 0), (0, 1)))
        ring = np.concatenate([corners, corners[:1]]) if part.closed else corners
        lines += [np.stack(pair) for pair in pairwise(ring) if not np.array_equal(*pair)]
    wide = 0.55 * max(float(strip.width.max()) for strip in view.strips.values())  # in front of the beam
    largest, arrows = bounds.force.get("push", 0.0), [np.zeros((0, 2, 3))]
    for push in view.pushes:
        if np.hypot(*push.resultant) > LEAST * largest:
            way = ARROW * bounds.size / largest * push.resultant
            arrows.append(np.array([[[*(push.middle - way), wide], [*way, 0.0]]]))
    return SpaceView(
        _plain(view_title(scene, view)), beam_block(view), obstacle_block(view), lines, np.concatenate(arrows)
    )


def _plain(text: str) -> str:
    """Text in the letters of VTK."""
    return text.replace("·", " ").replace("°", " deg").replace("µ", "u")


def _silent(draws: Callable[..., T], arguments: tuple[object, ...], named: dict[str, object]) -> T:
    """Draw without the messages of VTK on standard error."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    return draws(*arguments, **named)


def _drawn(views: list[SpaceView], bounds: Bounds, quantity: Coloured, factor: float, title: str) -> list[bytes]:
    import pyvista

    pyvista.OFF_SCREEN = True
    try:
        return [_picture(view, bounds, quantity, factor, title) for view in views]
    except RuntimeError as trouble:
        raise DrawingError(str(trouble)) from None


def _picture(view: SpaceView, bounds: Bounds, quantity: Coloured, factor: float, title: str) -> bytes:
    import pyvista

    def grid(block: Block) -> pyvista.UnstructuredGrid:
        return pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: block.cells}, block.places)

    bar: dict[str, Any] = {"title": title, "color": "black", "vertical": True, "position_x": 0.88, "position_y": 0.2,
                           "height": 0.6, "width": 0.06, "title_font_size": 22, "label_font_size": 20,
                           "fmt": "%.4g"}  # fmt: skip
    plotter = pyvista.Plotter(off_screen=True, window_size=list(_SIZE), lighting="light kit")
    plotter.set_background("white")
    beams, size, margin = grid(view.beams), bounds.size, 0.06 * bounds.size
    plotter.add_mesh(
        beams,
        scalars=view.beams.values[quantity] / factor,
        cmap=QUANTITIES[quantity][2],
        clim=(bounds.least / factor, max(bounds.most, TINY) / factor),
        scalar_bar_args=bar,
        show_scalar_bar=bool(title),
        ambient=0.25,
    )
    plotter.add_mesh(beams.extract_feature_edges(40.0), color="black", line_width=1.2)
    if view.obstacles is not None:
        (x, y), (right, top) = (bounds.low - margin).tolist(), (bounds.high + margin).tolist()
        surface = grid(view.obstacles).extract_surface(algorithm="dataset_surface")
        plotter.add_mesh(surface.clip_box([x, right, y, top, -np.inf, np.inf], invert=False), color=_RIGID, ambient=0.3)
    for start, end in view.lines:
        plotter.add_mesh(pyvista.Line(start, end).tube(radius=0.005 * size), color=_BODY)
    for tail, way in view.arrows:
        whole = float(np.linalg.norm(way))
        arrow = pyvista.Arrow(tail, way, scale=whole, tip_length=min(0.9, 0.03 * size / whole),
                              tip_radius=0.009 * size / whole, shaft_radius=0.004 * size / whole)  # fmt: skip
        plotter.add_mesh(arrow, color=_FORCE, ambient=0.5)
    plotter.add_text(view.title, position="upper_left", color="black", font_size=10)
    plotter.enable_parallel_projection()
    middle = np.array([*(0.5 * (bounds.low + bounds.high)), 0.0])
    plotter.camera.focal_point, plotter.camera.position = middle, middle + 4.0 * size * np.array(_WAY)
    plotter.camera.up = (0.0, 1.0, 0.0)
    wide, high = bounds.high - bounds.low
    deep = 0.3 * float(np.ptp(view.beams.places[:, 2]))
    plotter.camera.parallel_scale = 0.62 * max(high, wide * _SIZE[1] / (0.75 * _SIZE[0])) + deep
    plotter.renderer.ResetCameraClippingRange()
    plotter.enable_anti_aliasing("ssaa")
    stream = io.BytesIO()
    plotter.screenshot(stream, return_img=False)
    plotter.close()
    return stream.getvalue()
