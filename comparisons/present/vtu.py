"""Stations as cells in space, as VTU files by meshio, and as the PVD collection for ParaView.

A beam is extruded to its width along z: hexahedra between neighbouring sections, ``ACROSS`` of them through the
thickness.  The plane of the mechanism is in the middle.  The time of a station is the value of its load or drive where
a single stage goes up; otherwise the stations count from 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal, NamedTuple
from xml.sax.saxutils import quoteattr

import numpy as np

from comparisons.present.picture import View
from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import Scene

ACROSS = 4
_BASE = [(0, 0), (1, 0), (1, 1), (0, 1)]  # along x(s), then to its left: counter-clockwise seen from +z


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
        moved = places - np.stack([strip.rest_layer(each) for each in eta], axis=1)
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
    if len(scene.stages) > 1 or any(later <= earlier for earlier, later in pairwise(times)):
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
