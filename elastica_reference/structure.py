"""Which contacts are closed, and how: what decides the equations' form."""

from dataclasses import dataclass

from cprbm_scene.frozendict import frozendict


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

    @property
    def held(self) -> bool:
        """Whether it begins or ends at a clamp."""
        return self.from_start or self.to_end


Touch = Meeting | Resting | Wrap
Item = float | str


@dataclass(frozen=True, slots=True)
class Structure:
    """The closed contacts by name, and by beam the order of what interrupts it.

    ``order`` holds for every beam the arc lengths of knots (numbers) and the names of contacts between its ends.
    """

    touches: frozendict[str, Touch]
    order: frozendict[str, tuple[Item, ...]]

    def wraps(self, beam: str) -> tuple[Wrap, ...]:
        """A beam's wraps."""
        return tuple(touch for touch in self.touches.values() if isinstance(touch, Wrap) and touch.beam == beam)

    def piece_beyond(self, beam: str, contact: str) -> int:
        """Number of a beam's piece that begins where a contact touches."""
        held = {wrap.contact for wrap in self.wraps(beam) if wrap.held}
        passed = self.order[beam][: self.order[beam].index(contact) + 1]
        return sum(item not in held for item in passed)
