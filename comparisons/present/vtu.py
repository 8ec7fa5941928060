"""Stations as cells in space, as VTU files by meshio, and as the PVD collection for ParaView.

A beam is extruded to its width along z: hexahedra between neighbouring sections, ``ACROSS`` of them through the
thickness.  The plane of the mechanism is in the middle.  The time of a station is the value of its load or drive where
a single stage goes up; otherwise the stations count from 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal
from xml.sax.saxutils import quoteattr

import numpy as np

from comparisons.present.picture import Obstacle, View
from comparisons.present.strips import Strip
from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import Scene

ACROSS = 4
_BASE = [(0, 0), (1, 0), (1, 1), (0, 1)]  # along x(s), then to its left: counter-clockwise seen from +z


@dataclass(frozen=True, slots=True)
class Block:
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
    return _joined([_beam(number, strip) for number, strip in enumerate(view.strips.values())])


def obstacle_block(view: View) -> Block | None:
    """Rigid edges with their solid sides; None without rigid edges."""
    blocks = [_obstacle(number, each) for number, each in enumerate(view.obstacles)]
    return _joined(blocks) if blocks else None


def force_block(view: View) -> Block | None:
    """Pressed places with ``contact_force`` (k, 3), N; None without stated forces."""
    if not view.pushes:
        return None
    flat, forces = (np.concatenate([getattr(push, name) for push in view.pushes]) for name in ("places", "forces"))
    zero = np.zeros((len(flat), 1))
    values = {"contact_force": np.concatenate([forces, zero], axis=1)}
    return Block("vertex", np.concatenate([flat, zero], axis=1), np.arange(len(flat))[:, None], values)


def _beam(number: int, strip: Strip) -> Block:
    n, eta = len(strip.s), np.linspace(-1.0, 1.0, ACROSS + 1)
    flat = np.stack([strip.layer(each) for each in eta], axis=1)  # (n, ACROSS + 1, 2)
    moved = np.zeros((n, ACROSS + 1, 3))
    moved[..., :2] = flat - np.stack([strip.rest_layer(each) for each in eta], axis=1)
    i, j = (each.ravel() for each in np.meshgrid(np.arange(n - 1), np.arange(ACROSS), indexing="ij"))
    values = {
        "displacement": moved,
        "bending_stress": -eta * strip.bending_stress[:, None],
        "combined_stress": strip.combined_stress[:, None],
        "moment": strip.moment[:, None],
        "arc_length": strip.s[:, None],
        "beam": np.full((n, 1), float(number)),
    }
    wide = {name: np.broadcast_to(each, (n, ACROSS + 1, *each.shape[2:])) for name, each in values.items()}
    return Block(
        "hexahedron",
        _extruded(flat, np.broadcast_to(strip.width[:, None], (n, ACROSS + 1))),
        np.stack([((i + di) * (ACROSS + 1) + j + dj) * 2 + k for k in (0, 1) for di, dj in _BASE], axis=1),
        {name: np.repeat(each.reshape(-1, *each.shape[2:]), 2, axis=0) for name, each in wide.items()},
    )


def _extruded(flat: Array, width: Array) -> Array:
    """Places (n m 2, 3) at both ends of widths (n, m) of places (n, m, 2)."""
    sides = [np.concatenate([flat, 0.5 * side * width[..., None]], axis=2) for side in (-1.0, 1.0)]
    return np.stack(sides, axis=2).reshape(-1, 3)


def _obstacle(number: int, obstacle: Obstacle) -> Block:
    """Pieces of the outline with their solid sides as hexahedra; pieces to a middle have two edges in a place."""
    flat = np.stack([obstacle.outline, obstacle.solid], axis=1)  # (k, 2, 2)
    places = _extruded(flat, np.full(flat.shape[:2], obstacle.width))
    i = np.arange(len(flat) - 1)
    way, inwards = flat[1, 0] - flat[0, 0], flat[0, 1] - flat[0, 0]
    base = _BASE if way[0] * inwards[1] > way[1] * inwards[0] else _BASE[::-1]
    cells = np.stack([((i + di) * 2 + side) * 2 + k for k in (0, 1) for di, side in base], axis=1)
    return Block("hexahedron", places, cells, {"obstacle": np.full(len(places), float(number))})


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
    folder, lines = path.parent / path.stem, []
    for number, (time, view) in enumerate(zip(_times(scene, views), views, strict=True)):
        blocks = {"beams": beam_block(view), "obstacles": obstacle_block(view), "contacts": force_block(view)}
        for part, (name, block) in enumerate(blocks.items()):
            if block is not None:
                file = folder / f"{name}-{number:04d}.vtu"
                yield file, vtu(block)
                source = quoteattr(f"{folder.name}/{file.name}")
                lines.append(f'    <DataSet timestep="{time!r}" part="{part}" name="{name}" file={source}/>\n')
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n'
    yield path, f"{head}  <Collection>\n{''.join(lines)}  </Collection>\n</VTKFile>\n".encode()


def _times(scene: Scene, views: Sequence[View]) -> list[float]:
    values = [view.station.value for view in views]
    if len(scene.stages) == 1 and all(later > earlier for earlier, later in pairwise(values)):
        return values
    return [float(number) for number in range(len(values))]
