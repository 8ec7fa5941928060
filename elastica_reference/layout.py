"""Positions of the unknowns of a structure."""

from collections.abc import Mapping
from dataclasses import dataclass

from elastica_reference.model import Model
from elastica_reference.structure import Meeting, Structure, Wrap


@dataclass(frozen=True, slots=True)
class Layout:
    """Positions of the unknowns in z.

    Attributes:
        bodies, drives: degrees of freedom of bodies and reactions of drives, by name.
        forces: P by contact, except wraps.
        places: arc length of a place by (contact, beam), for wraps by (contact, "begin") and (contact, "end").
        pieces: six unknowns per piece, by beam.
        size: number of unknowns.
    """

    bodies: Mapping[str, slice]
    drives: Mapping[str, int]
    forces: Mapping[str, int]
    places: Mapping[tuple[str, str], int]
    pieces: Mapping[str, tuple[slice, ...]]
    size: int


def layout(model: Model, structure: Structure) -> Layout:
    """The layout of a structure's unknowns."""
    size = 0

    def take(n: int) -> slice:
        nonlocal size
        size += n
        return slice(size - n, size)

    bodies = {name: take(n) for name, n in model.moving.items()}
    drives = {name: int(take(1).start) for name in model.scene.drives}
    forces: dict[str, int] = {}
    places: dict[tuple[str, str], int] = {}
    for name, touch in structure.touches.items():
        if isinstance(touch, Wrap):
            if not touch.from_start:
                places[name, "begin"] = int(take(1).start)
            if not touch.to_end:
                places[name, "end"] = int(take(1).start)
            continue
        forces[name] = int(take(1).start)
        if touch.at is None:
            places[name, touch.beam] = int(take(1).start)
        if isinstance(touch, Meeting):
            places[name, touch.onto] = int(take(1).start)
    pieces = {}
    for beam in model.strips:
        number = len(structure.order[beam]) + 1
        number -= sum(wrap.from_start + wrap.to_end for wrap in structure.wraps(beam))
        pieces[beam] = tuple(take(6) for _ in range(number))
    return Layout(bodies, drives, forces, places, pieces, size)
