"""Files of an answer: the ending of the file's name selects pictures, animations, pictures in space, or VTU files.

The door to PyVista and meshio.  Matplotlib brings Pillow, which joins the pictures of an animation.  The same pictures
give the same bytes.  PyVista draws without a screen in an own process: without a drawing library of the system, VTK may
end the process.

In space a beam is extruded to its width along z: hexahedra between neighbouring sections, ``ACROSS`` of them through
the thickness.  The plane of the mechanism is in the middle.  The time of a station in a PVD collection is the value of
its load or drive where a single stage goes up; otherwise the stations count from 0.
"""

import io
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Literal, NamedTuple, TypeVar, get_args
from xml.sax.saxutils import quoteattr

import numpy as np

from comparisons.executor import WorkerDiedError, call_fresh
from comparisons.present.figures import QUANTITIES, TINY, colour_unit, stress_picture, view_title
from comparisons.present.picture import Bounds, View, bounds_of, view_of
from comparisons.present.strips import Coloured
from cprbm_scene import Answer, Array, Ints, Scene

T = TypeVar("T")

Kind = Literal[".3d.png", ".3d.gif", ".3d.apng", ".png", ".svg", ".gif", ".apng", ".vtu", ".pvd"]
KINDS: tuple[Kind, ...] = get_args(Kind)
"""Endings of files; ``.3d.png`` stands before ``.png``."""

_MOVING = (".3d.gif", ".3d.apng", ".gif", ".apng", ".pvd")  # kinds with all stations
_MOST = 120  # pictures of an animation; of more stations some are shown, evenly
_DOTS = {".png": 170.0, ".svg": 300.0}  # to the inch
_MOVING_DOTS = 90.0
_WHOLE, _SHORTEST, _LONGEST, _REST = 6000, 40, 500, 1500  # ms: all pictures, one picture, the last picture

_SIZE = (1400, 1000)
_RIGID, _FORCE, _BODY = "#aeb6bf", "#0a7d33", "#3c4248"
_WAY = (-0.55, 0.75, 1.6)  # from the middle to the eye, over the mechanism's longer side

ACROSS = 4
_BASE = [(0, 0), (1, 0), (1, 1), (0, 1)]  # along x(s), then to its left: counter-clockwise seen from +z


def kind_of(path: Path) -> Kind | None:
    """Kind of a file by name; None for an unknown ending."""
    return next((kind for kind in KINDS if path.name.lower().endswith(kind) and len(path.name) > len(kind)), None)


def files(scene: Scene, answer: Answer, path: Path, kind: Kind, quantity: Coloured) -> Iterator[tuple[Path, bytes]]:
    """Files and their content, ``path`` as the last.

    Args:
        scene: with probes for stresses, :func:`comparisons.present.strips.with_stresses`.
        answer: with one station at least; a single picture shows the last.
        path: of the file.
        kind: of the content.
        quantity: quantity of the colours.

    Raises:
        ImportError: a library for the kind is not installed.
        DrawingError: VTK cannot draw here.
    """
    views = [view_of(scene, station) for station in answer.stations[0 if kind in _MOVING else -1 :]]
    bounds = bounds_of(scene, views, quantity).around(each for view in views for each in view.arrows_of("push"))
    if kind == ".pvd":
        yield from series(scene, views, path)
    elif kind == ".vtu":
        yield path, vtu(beam_block(views[-1]))
    elif kind in _DOTS:
        yield path, stress_picture(scene, views[-1], bounds, quantity, kind[1:], _DOTS[kind])
    else:
        few = [views[round(place)] for place in np.linspace(0, len(views) - 1, min(_MOST, len(views)))]
        pictures = (
            space_pictures(scene, few, bounds, quantity)
            if kind.startswith(".3d")
            else [stress_picture(scene, view, bounds, quantity, "png", _MOVING_DOTS) for view in few]
        )
        yield path, pictures[0] if kind == ".3d.png" else animation(pictures, "gif" if "gif" in kind else "apng")


def animation(pictures: Sequence[bytes], kind: Literal["gif", "apng"]) -> bytes:
    """PNG ``pictures`` of one size as an animation without end."""
    from PIL import Image

    each = int(min(_LONGEST, max(_SHORTEST, 10 * round(_WHOLE / 10 / len(pictures)))))
    stays = [each] * (len(pictures) - 1) + [max(each, _REST)]
    frames = [Image.open(io.BytesIO(content)).convert("RGB") for content in pictures]
    stream = io.BytesIO()
    if kind == "gif":
        # one palette for all, of the last picture with all colours: otherwise the pictures flicker
        palette = frames[-1].quantize(colors=255)
        frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
        frames[0].save(stream, "GIF", save_all=True, append_images=frames[1:], duration=stays, loop=0, disposal=1)
    else:
        frames[0].save(stream, "PNG", save_all=True, append_images=frames[1:], duration=stays, loop=0)
    return stream.getvalue()


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


class Block(NamedTuple):
    """Cells of a ``kind``: ``places`` (k, 3), m, ``cells`` (c, corners), ``values`` (k,) or (k, 3) by name, SI."""

    kind: Literal["hexahedron", "vertex"]
    places: Array
    cells: Ints
    values: Mapping[str, Array]


def beam_block(view: View) -> Block:
    """All beams, by number in the scene's order.

    Values: ``displacement`` (k, 3), ``bending_stress`` of the place, positive in tension, ``combined_stress`` (the
    largest magnitude of the section), ``moment``, ``arc_length`` and ``beam``.
    """
    blocks, eta = [], np.linspace(-1.0, 1.0, ACROSS + 1)
    for number, strip in enumerate(view.strips.values()):
        places = np.stack([strip.layer(each) for each in eta], axis=1)  # (n, ACROSS + 1, 2)
        moved = places - np.stack([strip.layer(each, rest=True) for each in eta], axis=1)
        values = {
            "displacement": np.pad(moved, ((0, 0), (0, 0), (0, 1))),
            "bending_stress": -eta * strip.bending_stress[:, None],
            "combined_stress": strip.combined_stress[:, None],
            "moment": strip.moment[:, None],
            "arc_length": strip.s[:, None],
            "beam": np.array([[float(number)]]),
        }
        blocks.append(_extruded(places, strip.width, values))
    return _joined(blocks)


def obstacle_block(view: View) -> Block | None:
    """Rigid edges with their solid sides, as wide as the widest beam; None without rigid edges.

    Pieces to a middle have two edges in a place.
    """
    wide, blocks = max(float(strip.width.max()) for strip in view.strips.values()), []
    for number, part in enumerate(view.of("edge")):
        sides = np.stack([part.points, part.solid], axis=1)  # (k, 2, 2)
        along, inwards = sides[1, 0] - sides[0, 0], sides[0, 1] - sides[0, 0]
        left = along[0] * inwards[1] > along[1] * inwards[0]
        blocks.append(
            _extruded(
                sides if left else sides[:, ::-1], np.full(len(sides), wide), {"obstacle": np.array([[float(number)]])}
            )
        )
    return _joined(blocks) if blocks else None


def force_block(view: View) -> Block | None:
    """Pressed places with ``contact_force`` (k, 3), N; None without stated forces."""
    pushes = view.arrows_of("push")
    if not pushes:
        return None
    places, forces = (np.pad(np.concatenate([getattr(push, name) for push in pushes]), ((0, 0), (0, 1)))
                      for name in ("places", "forces"))  # fmt: skip
    return Block("vertex", places, np.arange(len(places))[:, None], {"contact_force": forces})


def _extruded(places: Array, width: Array, values: Mapping[str, Array]) -> Block:
    """Hexahedra between places (n, m, 2) at both ends of widths (n,), with values that broadcast to (n, m)."""
    n, m, _ = places.shape
    side = np.array([-0.5, 0.5]) * width[:, None, None]
    space = np.concatenate(
        [np.repeat(places[:, :, None], 2, axis=2), np.broadcast_to(side, (n, m, 2))[..., None]], axis=3
    )
    i, j = (each.ravel() for each in np.meshgrid(np.arange(n - 1), np.arange(m - 1), indexing="ij"))
    cells = np.stack([((i + di) * m + j + dj) * 2 + k for k in (0, 1) for di, dj in _BASE], axis=1)
    wide = {
        name: np.broadcast_to(each, (n, m, *each.shape[2:])).reshape(-1, *each.shape[2:])
        for name, each in values.items()
    }
    return Block(
        "hexahedron", space.reshape(-1, 3), cells, {name: np.repeat(each, 2, axis=0) for name, each in wide.items()}
    )


def _joined(blocks: Sequence[Block]) -> Block:
    """Blocks of the same kind and values as a single block."""
    first = np.cumsum([0, *(len(block.places) for block in blocks)])[:-1]
    return Block(
        blocks[0].kind,
        np.concatenate([block.places for block in blocks]),
        np.concatenate([block.cells + shift for block, shift in zip(blocks, first, strict=True)]),
        {name: np.concatenate([block.values[name] for block in blocks]) for name in blocks[0].values},
    )


def vtu(block: Block) -> bytes:
    """A block as a VTU file.

    Raises:
        ImportError: meshio is not installed.
    """
    import meshio

    mesh = meshio.Mesh(block.places, [(block.kind, block.cells)], point_data=dict(block.values))
    with TemporaryDirectory() as folder:  # meshio takes nothing but a path
        path = Path(folder, "block.vtu")
        meshio.write(path, mesh, file_format="vtu")
        return path.read_bytes()


def series(scene: Scene, views: Sequence[View], path: Path) -> Iterator[tuple[Path, bytes]]:
    """The files of a series, the collection ``path`` as the last.

    A station has the parts 0 (beams), 1 (obstacles) and 2 (contact forces) without empty parts, in a folder beside the
    collection with the same name.

    Raises:
        ImportError: meshio is not installed.
    """
    folder, lines, times = path.parent / path.stem, [], [view.station.value for view in views]
    if len(scene.stages) > 1 or (np.diff(times) <= 0.0).any():
        times = [float(number) for number in range(len(views))]
    for number, (time, view) in enumerate(zip(times, views, strict=True)):
        blocks = {"beams": beam_block(view), "obstacles": obstacle_block(view), "contacts": force_block(view)}
        for part, (name, block) in enumerate(blocks.items()):
            if block is not None:
                file = folder / f"{name}-{number:04d}.vtu"
                yield file, vtu(block)
                source = quoteattr(f"{folder.name}/{file.name}")
                lines.append(f'    <DataSet timestep="{time!r}" part="{part}" name="{name}" file={source}/>\n')
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n'
    yield path, f"{head}  <Collection>\n{''.join(lines)}  </Collection>\n</VTKFile>\n".encode()
