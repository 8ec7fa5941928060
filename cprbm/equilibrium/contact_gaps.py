"""Gaps of a state: at joints, and the least gap between joints.

The gap of a pair may be least between two joints.  A moving place without a force finds the minimum.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cprbm.contact import Contacts, Geometry, on_edge
from cprbm.equilibrium.contact_set import with_fixed_places
from cprbm.equilibrium.iteration import beside_points
from cprbm.equilibrium.neighbours import least_between
from cprbm.equilibrium.newton import Solved
from cprbm_scene.answer import Array


def least_gap(geometry: Geometry, z: Array, contacts: Contacts, pair: int) -> float:
    """Least gap of an open pair, between joints too; inf if the curves are far apart."""
    full = with_fixed_places(geometry, z, replace(contacts, kept_open=frozenset()))
    gaps = full.gaps(geometry, z)
    mine = gaps[full.places.pair == pair]
    least = float(mine.min(initial=np.inf))
    if geometry.joints_alone:
        return least
    known = full.places, full.closed, gaps, pair, contacts.counters
    return min(least, least_between(z, geometry.arrays, geometry.sites, *known))


class ContactMeasures(NamedTuple):
    """Largest violation of a closed place, largest overlap of an open place, and largest pull of a closed place."""

    violation: float
    overlap: float
    pull: float


def contact_measures(solved: Solved) -> ContactMeasures:
    """Complementarity of a solved state, in units.

    Joints within a piece of a point contact, and the compliance that the chain lacks there, are no overlaps.  Places
    with a shared force overlap by the sum of both gaps.
    """
    geometry, contacts = solved.system.geometry, solved.state.contacts
    places, closed = contacts.places, contacts.closed
    beside, depth = beside_points(geometry.arrays, places, closed)
    gaps, leaders = solved.gaps.copy(), np.arange(len(closed)) + places.shares
    follows = places.shares != 0
    np.add.at(gaps, leaders[follows], solved.gaps[follows])
    thick = geometry.arrays.thickness[places.piece] + geometry.arrays.thickness[places.foot] > 0.0
    corner = on_edge(geometry.arrays, places)
    free = ~closed & ~follows & ~beside & (~places.moves | corner) & (thick | ~places.at_point)
    overlap = float(np.max(-gaps[free] - depth[free], initial=0.0))
    violation = float(np.abs(solved.contact_values).max(initial=0.0))
    return ContactMeasures(violation, overlap, float(np.max(-places.force[closed], initial=0.0)))
