"""Contacts of a state: possible places, and the places that are closed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cprbm.contact.candidates import TOUCHING, Geometry, copied, fixed_places, half_thicknesses, sides_at_rest, taken
from cprbm.contact.gap import Places
from cprbm.contact.settling import new_counters, settle
from cprbm_scene.answer import Array, Flags, Ints


@dataclass(frozen=True, eq=False)
class Contacts:
    """Possible places of contact, marks of the closed places, sides of the pairs and of corners' curves, counters.

    ``given_up`` holds pairs and pieces at which a moving place failed; the pairs ``kept_open`` have no places.
    ``apart`` holds the open places that these pairs had before, for their sides.
    """

    places: Places
    closed: Flags
    sides: Array
    corner_sides: Array
    counters: Ints
    given_up: frozenset[tuple[int, int]] = frozenset()
    kept_open: frozenset[int] = frozenset()
    apart: Places | None = None

    def pressing(self, pair: int) -> Flags:
        """Closed places of a pair."""
        return np.asarray(self.closed & (self.places.pair == pair))

    def gaps(self, geometry: Geometry, z: Array) -> Array:
        """Gaps of all places at a state, the feet moved; the present feet stay."""
        places, gaps = copied(self.places), np.empty(len(self.closed))
        settle(z, geometry.arrays, places, gaps, np.empty(len(gaps)), self.counters, 0)
        if geometry.law is not None:
            geometry.law.write_gaps(z, places, gaps)
        return gaps


def touching_as_drawn(geometry: Geometry, z: Array, contacts: Contacts) -> frozenset[int]:
    """Pairs that touch in a state as drawn, at a weld on the rigid body of the foot too."""
    places = fixed_places(
        geometry, z, contacts.sides, np.ones(len(geometry.pairs), dtype=bool), contacts.counters, welds=True
    )
    gaps = replace(contacts, places=places, closed=np.zeros(len(places.pair), dtype=bool)).gaps(geometry, z)
    # a weld behind the end of the other beam is on neither side of the beam
    deepest = -TOUCHING - half_thicknesses(geometry.arrays, places)
    return frozenset(places.pair[(gaps > deepest) & (gaps < TOUCHING)].tolist())


def open_contacts(geometry: Geometry, z: Array) -> Contacts:
    """Contacts of a state as drawn, without any place."""
    counters = new_counters()
    nothing = taken(geometry.possible, np.zeros(0, dtype=np.int64))
    sides = sides_at_rest(geometry, z, counters), np.zeros(len(geometry.curves))
    return Contacts(nothing, np.zeros(0, dtype=bool), *sides, counters)
