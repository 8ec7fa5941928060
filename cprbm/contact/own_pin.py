"""Angle stops of beams pinned on the edge of a contact.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
β        opening: angle from an edge's direction at the pin to the direction of the beam
=======  ====================================================================================

At the pin the beam has no gap: the pin lies on the edge, or half the beam's thickness above.  The edge limits the angle
of the beam and holds the beam by a moment, like a stop.  With the edge's direction away from the pin and the beam on
the left, β ≥ 0.  Where the edge runs on behind the pin, the angle from the beam to the rest of the edge is limited in
the same way.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import tau
from typing import Literal

import numpy as np

from cprbm.chain import Form, Mechanism, Row
from cprbm_scene.answer import Array
from cprbm_scene.statement import EdgeContact, PinnedEnd

ON_EDGE = 1e-6
"""Distance of a pin from the edge, over the beam's length, of a pin on the edge: coordinates are rounded."""

AT_CORNER = 1e-9
"""Distance of a pin from an end of a piece, over the piece's length, below which the piece leads one way only."""

STRAIGHT = 1e-5
"""Opening below 2π, rad, that counts as zero: rounded coordinates of a beam that lies on the edge."""


def pin_rows(m: Mechanism, name: str, contact: EdgeContact, points: Array, side: int) -> Iterator[Row]:
    """Rows of the angles between a contact's beam and the edge through ``points`` (k, 2), at pins on the edge."""
    chain, record = m.chains[contact.beam], m.scene.beams[contact.beam]
    ends: tuple[tuple[Literal["start", "end"], int], ...] = (("start", 0), ("end", -1))
    for end, link in ends:
        joint = getattr(record, end)
        if not isinstance(joint, PinnedEnd) or m.scene.body_of(joint.point) != contact.body:
            continue
        pin = m.units.place(m.scene.place_of(joint.point))
        turned = m.angle(contact.beam, link) - m.rotation(contact.body)
        above = 0.5 * float(chain.section.thickness(chain.arcs[[link]])[0]) if contact.thick else 0.0
        behind, ahead = _directions(pin, points, side * above, ON_EDGE * chain.length)
        for direction, sign in ((ahead, side), (behind, -side)):
            if direction is not None:
                opening = (sign * (chain.leaving_angle(end) - float(np.arctan2(direction[1], direction[0])))) % tau
                opening -= tau if opening > tau - STRAIGHT else 0.0
                yield Row(f"{name}.pin", turned * float(sign) + Form(opening), driven=False, limit=True)


def _directions(pin: Array, points: Array, above: float, near: float) -> tuple[Array | None, Array | None]:
    """Directions from a pin back and on along an edge; None beyond an end of the edge, and for a pin off the edge.

    A beam with thickness lies on the edge with the pin half the thickness ``above``, positive on the left.
    """
    behind: Array | None = None
    ahead: Array | None = None
    for a, b in pairwise(points):
        chord = b - a
        left = np.array([-chord[1], chord[0]]) / np.hypot(*chord)
        share = float((pin - a) @ chord / (chord @ chord))
        if np.hypot(*(a + min(1.0, max(0.0, share)) * chord + above * left - pin)) < near:
            ahead = chord if share < 1.0 - AT_CORNER else ahead
            behind = -chord if share > AT_CORNER else behind
    return behind, ahead
