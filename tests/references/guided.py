"""A beam clamped at both ends to guides that do not turn: two cantilevers of half its length, back to back.

The middle of the beam is its point of inflection, where there is no moment, and by symmetry the force there is
the one that the guides exert across the beam's first direction.  Each half is the elastica of
:mod:`tests.references.elastica` in the axes of its own clamp.
"""

from __future__ import annotations

from dataclasses import dataclass

from tests.references.elastica import cantilever_under_tip_force


@dataclass(frozen=True, slots=True)
class Guided:
    """Shortening along the beam's first direction and offset across it, over the length; moment at a clamp.

    ``force`` is P L²/(EI), ``moment`` M L/(EI).
    """

    force: float
    shortening: float
    offset: float
    moment: float


def guided_beam(force: float) -> Guided:
    """The beam under P L²/(EI) across; each half carries the force at its end with half the lever."""
    half = cantilever_under_tip_force(force / 4.0)
    return Guided(force, 1.0 - half.x, half.y, 0.5 * force * half.x)
