"""The door to meshio: stations as VTU files, and the PVD collection that tells ParaView their times.

The time of a station is the value of its load or drive where one stage goes up; else stations are counted from 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.sax.saxutils import quoteattr

from comparisons.viewing.frames import Frame
from comparisons.viewing.solids import Block, beams, contact_forces, obstacles
from cprbm_scene.statement import Scene


def vtu(block: Block) -> bytes:
    """A block as a VTU file.

    Raises:
        ImportError: meshio is not there.
    """
    import meshio

    mesh = meshio.Mesh(block.places, [(block.kind, block.cells)], point_data=dict(block.values))
    with TemporaryDirectory() as folder:  # it takes nothing but a path
        path = Path(folder, "block.vtu")
        meshio.write(path, mesh, file_format="vtu")
        return path.read_bytes()


def series(scene: Scene, frames: Sequence[Frame], path: Path) -> Iterator[tuple[Path, bytes]]:
    """The files of a series and what they hold, the collection ``path`` as the last.

    Each station has the parts 0 (beams), 1 (obstacles) and 2 (contact forces), of which those are left out that are
    empty; they stand in a folder beside the collection that has its name.

    Raises:
        ImportError: meshio is not there.
    """
    listed = []
    folder = path.parent / path.stem
    for number, (time, frame) in enumerate(zip(times(scene, frames), frames, strict=True)):
        parts = (("beams", beams(frame)), ("obstacles", obstacles(frame)), ("contacts", contact_forces(frame)))
        for part, (name, block) in enumerate(parts):
            if block is not None:
                file = folder / f"{name}-{number:04d}.vtu"
                yield file, vtu(block)
                listed.append(
                    f'    <DataSet timestep="{time!r}" part="{part}" name="{name}" '
                    f"file={quoteattr(f'{folder.name}/{file.name}')}/>\n"
                )
    head = (
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n  <Collection>\n'
    )
    yield path, (head + "".join(listed) + "  </Collection>\n</VTKFile>\n").encode("utf-8")


def times(scene: Scene, frames: Sequence[Frame]) -> list[float]:
    """The time of each station."""
    values = [frame.station.value for frame in frames]
    if len(scene.stages) == 1 and all(b > a for a, b in pairwise(values)):
        return values
    return [float(number) for number in range(len(values))]
