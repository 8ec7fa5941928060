"""Which rows act of those that come and go: the pins of ends that are assembled, and the stops."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict


@dataclass(frozen=True, slots=True)
class Acting:
    """What acts at a time.

    Attributes:
        ways: from the points of the ends that are assembled to where these were when they were caught (k, 2), and
            there is no way where they were drawn at their points; None while they are free.
        stopping: whether stops would act where a limit is reached.
        limits: angle (rad) at which each of the stops holds that act, by name.
    """

    ways: Array | None
    stopping: bool
    limits: Mapping[str, float] = field(default_factory=frozendict)

    def stopped(self, name: str, limit: float) -> Acting:
        """The same with a stop that holds at a limit."""
        return replace(self, limits=frozendict({**self.limits, name: limit}))

    def released(self, name: str) -> Acting:
        """The same without a stop."""
        return replace(self, limits=frozendict({key: limit for key, limit in self.limits.items() if key != name}))
