"""The relations, by name: of each the images of a scene that are to have the same answer."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from tests.relations.company import far_circle
from tests.relations.frames import MIRROR, QUARTER, Frame, has_graphs, turned_by
from tests.relations.image import Data, Image
from tests.relations.naming import backwards, other_way_round
from tests.relations.reactions import on_drives
from tests.relations.reversing import may_run_back, reversed_beam
from tests.relations.stepping import coarser, finer

ANGLE = 2.1991
"""Of the turn, rad: near no special angle."""

SHIFT = (0.0313, -0.0171)
"""Of the motion, in extents of the longest beam's coordinates."""


@dataclass(frozen=True, slots=True)
class Relation:
    """Something that may be done to a scene.

    Attributes:
        name: of the relation.
        says: what holds, in words.
        images: of a scene's data, one for each way in which it can be done.
    """

    name: str
    says: str
    images: Callable[[Data], Iterator[Image]]


def _motion(data: Data) -> Iterator[Image]:
    turn = QUARTER if has_graphs(data) else turned_by(ANGLE)
    yield Frame(Q=turn, b=_shift(data)).image(data, "turned and moved")


def _mirror(data: Data) -> Iterator[Image]:
    yield Frame(Q=MIRROR).image(data, "mirrored")


def _order(data: Data) -> Iterator[Image]:
    yield backwards(data)


def _direction(data: Data) -> Iterator[Image]:
    for beam in data["beams"]:
        if may_run_back(data, beam):
            yield reversed_beam(data, beam)


def _modulus(data: Data) -> Iterator[Image]:
    for factor in (1e-9, 1e9):
        yield Frame(modulus=factor).image(data, f"E and loads × {factor:g}")


def _length(data: Data) -> Iterator[Image]:
    for factor in (1e-6, 1e6):
        yield Frame(length=factor).image(data, f"lengths × {factor:g}")


def _steps(data: Data) -> Iterator[Image]:
    yield finer(data)
    if any(len(stage["stations"]) > 1 for stage in data["stages"]):
        yield coarser(data)


def _company(data: Data) -> Iterator[Image]:
    yield far_circle(data)


def _reaction(data: Data) -> Iterator[Image]:
    yield on_drives(data)


def _pair(data: Data) -> Iterator[Image]:
    for name, contact in data.get("contacts", {}).items():
        if contact["kind"] == "beam-beam":
            yield other_way_round(data, name)


RELATIONS = (
    Relation("motion", "moved and turned as a whole, the answer moves and turns with it", _motion),
    Relation("mirror", "the mirror image of a scene has the mirror image of its answer", _mirror),
    Relation("order", "the order in which things are named does not matter", _order),
    Relation("direction", "nor from which end a beam is drawn", _direction),
    Relation("modulus", "E and all loads a thousand million times as large: the same shape", _modulus),
    Relation("length", "all lengths a million times as large, and loads to match: the same shape", _length),
    Relation("steps", "the way to a load in other steps ends in the same state", _steps),
    Relation("company", "what is far away does not matter", _company),
    Relation("reaction", "what pushes is pushed, and all forces and moments balance", _reaction),
    Relation("pair", "two beams touch each other, whichever is named first", _pair),
)


def _shift(data: Data) -> tuple[float, float]:
    """A shift of the size of the scene."""
    places = [place for body in data["bodies"].values() for place in body["points"].values()]
    size = max(abs(c) for place in places for c in place) or 1.0
    return SHIFT[0] * size, SHIFT[1] * size
