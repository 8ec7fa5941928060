"""Which contacts are closed, and how: what decides the equations' form."""

from __future__ import annotations

from dataclasses import dataclass, field

from frozendict import frozendict


@dataclass(frozen=True, slots=True)
class Meeting:
    """Two beams touch at one place.

    Attributes:
        contact: its name.
        beam, at: one beam, and the arc length where it touches if that is one of its ends; None between them.
        onto: the other, which touches between its ends.
        side: +1 where ``beam`` lies to the left of ``onto``, else −1.
        apart: distance of the neutral lines, no dimension.
    """

    contact: str
    beam: str
    at: float | None
    onto: str
    side: float
    apart: float


@dataclass(frozen=True, slots=True)
class Resting:
    """A beam touches a circle at one place; ``at`` as in :class:`Meeting`."""

    contact: str
    beam: str
    at: float | None


@dataclass(frozen=True, slots=True)
class Wrap:
    """A beam lies on a circle along a length, from its clamped start, to its clamped end, or between its ends.

    ``sense`` is +1 where the beam runs round the circle counter-clockwise.
    """

    contact: str
    beam: str
    sense: float
    from_start: bool = False
    to_end: bool = False


Touch = Meeting | Resting | Wrap


@dataclass(frozen=True, slots=True)
class Structure:
    """The closed contacts by name, and by beam the order of what interrupts it.

    ``order`` holds for every beam the arc lengths of knots (numbers) and the names of contacts between its ends.
    """

    touches: frozendict[str, Touch] = field(default_factory=frozendict)
    order: frozendict[str, tuple[float | str, ...]] = field(default_factory=frozendict)
