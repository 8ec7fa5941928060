"""Active constraints: pins of assembled ends, and closed stops."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict


@dataclass(frozen=True, slots=True)
class Acting:
    """Active constraints at a time.

    Attributes:
        ways: vectors (k, 2) from the points of assembled ends to the ends at the start of the assembly, zero for ends
            already at their points; None while the ends are free.
        stopping: True if stops can close.
        limits: angle limit (rad) of every closed stop, by name.
    """

    ways: Array | None
    stopping: bool
    limits: Mapping[str, float] = field(default_factory=frozendict)

    def stopped(self, name: str, limit: float) -> Acting:
        """The constraints with a stop closed at a limit."""
        return replace(self, limits=frozendict({**self.limits, name: limit}))

    def released(self, name: str) -> Acting:
        """The constraints with a stop open."""
        return replace(self, limits=frozendict({key: limit for key, limit in self.limits.items() if key != name}))
