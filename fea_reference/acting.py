"""Which rows act of those that come and go: the pins of ends that are assembled, and the stops."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from frozendict import frozendict

from scene.answer import Array


@dataclass(frozen=True, slots=True)
class Acting:
    """What acts at a time.

    Attributes:
        ways: from the points of the ends that are assembled to where these were when they were caught (k, 2), and
            there is no way where they were drawn at their points; None while they are free.
        limits: angle (rad) at which each of the stops holds that act, by name.
    """

    ways: Array | None
    limits: Mapping[str, float] = field(default_factory=frozendict)

    def stopped(self, name: str, limit: float) -> Acting:
        """The same with a stop that holds at a limit."""
        return Acting(self.ways, frozendict({**self.limits, name: limit}))

    def released(self, name: str) -> Acting:
        """The same without a stop."""
        return Acting(self.ways, frozendict({key: limit for key, limit in self.limits.items() if key != name}))
