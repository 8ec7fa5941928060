"""An end of a beam and what it may touch, on two bodies whose places drives tell in every state.

======  =====================================================================================
z       a place as drawn, a complex number; units of length
g       where a body takes it: g(z) = t z + w, t = e^(iφ), w = r₀ + (u + iv) − t r₀
r₀      the body's reference place
G       g_e⁻¹ g_c, what the end's body e sees of the other one's motion
======  =====================================================================================

No unknown moves the one against the other.  Where they are in touch, whether as they are drawn or because drives have
brought them there, how a clamp and a contact that lies along it share their force is no question of equilibrium.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from cprbm.standing import Attachment
from cprbm_scene.answer import Array

AS_DRAWN = 1e-9  # rad, and units of length: what moves by no more than that is where it is drawn


@dataclass(frozen=True, slots=True)
class Brought:
    """An ``end`` of a beam and a place on ``other``, not of one frame; ``references`` of the bodies (B, 2)."""

    end: Attachment
    other: Attachment
    references: Array

    def seen(self, bodies: Array) -> tuple[complex, complex]:
        """G in a state of the bodies (B, 3): its turn, and where it takes the origin."""
        turn, way = self._moved(self.other.body, bodies)
        own_turn, own_way = self._moved(self.end.body, bodies)
        return turn / own_turn, (way - own_way) / own_turn

    def _moved(self, body: int, bodies: Array) -> tuple[complex, complex]:
        """t and w of a body."""
        if body < 0:
            return 1.0 + 0.0j, 0.0j
        u, v, phi = bodies[body]
        reference = complex(*self.references[body])
        turn = complex(np.cos(phi), np.sin(phi))
        return turn, complex(u, v) + reference - turn * reference


def brought(end: Attachment | None, other: Attachment, references: Array) -> Brought | None:
    """What drives may bring together of an ``end`` and a place on ``other``; None where nothing does, or one frame."""
    if end is None or end.frame == other.frame or not (end.told and other.told):
        return None
    return Brought(end, other, references)


def as_drawn(ends: Iterable[Attachment | None], bodies: Array) -> bool:
    """Whether drives lead bodies that some ``ends`` are on, and all those are where they are drawn; bodies (B, 3)."""
    led = [end.body for end in ends if end is not None and end.led]
    return bool(led) and float(np.abs(bodies[led]).max()) <= AS_DRAWN
