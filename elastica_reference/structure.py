"""Closed contacts and their kind, which determine the form of the equations."""

from dataclasses import dataclass

from cprbm_scene.frozendict import frozendict


@dataclass(frozen=True, slots=True)
class Meeting:
    """Two beams in contact at a place.

    Attributes:
        contact: name of the contact.
        beam, at: first beam, and the arc length of its end in contact; None for a place between the ends.
        onto: second beam, in contact between its ends.
        side: +1 if ``beam`` lies to the left of ``onto``, else −1.
        apart: distance of the neutral lines, dimensionless.
    """

    contact: str
    beam: str
    at: float | None
    onto: str
    side: float
    apart: float


@dataclass(frozen=True, slots=True)
class Resting:
    """A beam and a circle in contact at a place; ``at`` as in :class:`Meeting`."""

    contact: str
    beam: str
    at: float | None


@dataclass(frozen=True, slots=True)
class Wrap:
    """A beam on a circle along a length, from its clamped start, to its clamped end, or between its ends.

    ``sense`` is +1 if the beam runs around the circle counter-clockwise.
    """

    contact: str
    beam: str
    sense: float
    from_start: bool = False
    to_end: bool = False

    @property
    def held(self) -> bool:
        """True if the wrap begins or ends at a clamp."""
        return self.from_start or self.to_end


Touch = Meeting | Resting | Wrap
Item = float | str


@dataclass(frozen=True, slots=True)
class Structure:
    """The closed contacts by name, and the order of interruptions of every beam.

    ``order`` lists for every beam the arc lengths of knots (numbers) and the names of contacts between its ends.
    """

    touches: frozendict[str, Touch]
    order: frozendict[str, tuple[Item, ...]]

    def wraps(self, beam: str) -> tuple[Wrap, ...]:
        """Wraps of a beam."""
        return tuple(touch for touch in self.touches.values() if isinstance(touch, Wrap) and touch.beam == beam)

    def piece_beyond(self, beam: str, contact: str) -> int:
        """Number of the beam's piece that begins at a contact."""
        held_wraps = {wrap.contact for wrap in self.wraps(beam) if wrap.held}
        passed = self.order[beam][: self.order[beam].index(contact) + 1]
        return sum(item not in held_wraps for item in passed)
