"""The relations, by name: of each the images of a scene that are to have the same answer."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from comparisons.relations.company import far_circle
from comparisons.relations.frames import MIRROR, QUARTER, Frame, has_graphs, turned_by
from comparisons.relations.image import Data, Image
from comparisons.relations.naming import backwards, other_way_round
from comparisons.relations.reactions import on_drives
from comparisons.relations.reversing import reversed_beam
from comparisons.relations.stepping import coarser, finer

ANGLE = 2.1991
"""Of the turn, rad: near no special angle."""

SHIFT = (0.0313, -0.0171)
"""Of the motion, in extents of the longest beam's coordinates."""


@dataclass(frozen=True, slots=True)
class Relation:
    """Something that may be done to a scene.

    Attributes:
        name: of the relation.
        images: of a scene's data, one for each way in which it can be done.
        within: what is to bound the change of the answer: round-off, or the uncertainty of the discretisation where
            that is another.
    """

    name: str
    images: Callable[[Data], Iterator[Image]]
    within: str = "round-off"


def _motion(data: Data) -> Iterator[Image]:
    turn = QUARTER if has_graphs(data) else turned_by(ANGLE)
    yield Frame(Q=turn, b=_shift(data)).image(data, "turned and moved")


def _mirror(data: Data) -> Iterator[Image]:
    yield Frame(Q=MIRROR).image(data, "mirrored")


def _order(data: Data) -> Iterator[Image]:
    yield backwards(data)


def _direction(data: Data) -> Iterator[Image]:
    for beam in data["beams"]:
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
    Relation("motion", _motion),
    Relation("mirror", _mirror),
    Relation("order", _order),
    Relation("direction", _direction),
    Relation("modulus", _modulus),
    Relation("length", _length),
    Relation("steps", _steps),
    Relation("company", _company),
    Relation("reaction", _reaction),
    Relation("pair", _pair, within="discretisation"),
)


def _shift(data: Data) -> tuple[float, float]:
    """A shift of the size of the scene."""
    places = [place for body in data["bodies"].values() for place in body["points"].values()]
    size = max(abs(c) for place in places for c in place) or 1.0
    return SHIFT[0] * size, SHIFT[1] * size
