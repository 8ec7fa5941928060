"""Gaps of a state: at joints, and the least gap between joints.

The gap of a pair may be least between two joints.  A moving place without a force finds the minimum.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cprbm.contact import CORNER, FINDING, Contacts, Geometry, Places, may_move, on_edge, settle, taken
from cprbm.equilibrium.contact_set import arc_of, with_fixed_places
from cprbm.equilibrium.iteration import beside_points
from cprbm.equilibrium.newton import Solved
from cprbm_scene.answer import Array, Flags, Ints

NEIGHBOURS = 1.6
"""Pieces between neighbouring joints: half links at a beam's end are neighbours too."""

RESTING = 1e-6
"""Last change of a place that has come to the minimum of the gap, pieces."""

LEANING = 1e-9
"""Least change of the thickness's slope at a corner: round-off."""

WITHIN = 0.5
"""Gap, in pieces, of a joint beside which the curves may meet."""


def joints_of(geometry: Geometry, places: Places, pair: int) -> tuple[Ints, Flags]:
    """Joints of a pair's first curve in order (k,), without places of a shared force; neighbours (k − 1,)."""
    own = (places.pair == pair) & (places.curve == geometry.pairs[pair].first) & ~places.moves & (places.shares == 0)
    joints = np.flatnonzero(own & (places.xi < 1.0))
    arcs, span = arc_of(geometry, places), geometry.arrays.span[places.piece]
    joints = joints[np.argsort(arcs[joints])]
    return joints, np.asarray(np.diff(arcs[joints]) < NEIGHBOURS * span[joints[:-1]])


def minima(geometry: Geometry, contacts: Contacts, gaps: Array, pair: int) -> Ints:
    """Open joints of a pair with the locally least gap, without a closed neighbour; empty where no place moves."""
    if geometry.joints_alone:
        return np.zeros(0, dtype=np.int64)
    joints, beside = joints_of(geometry, contacts.places, pair)
    gap, closed = gaps[joints], contacts.closed[joints]
    other = np.where(beside, gap[1:], np.inf), np.where(beside, gap[:-1], np.inf)
    least = (gap <= np.append(other[0], np.inf)) & (gap <= np.append(np.inf, other[1]))
    touched = np.append(closed[1:], False) | np.append(False, closed[:-1]) | closed
    near = gap < WITHIN * geometry.arrays.span[contacts.places.piece[joints]]
    return np.asarray(joints[least & near & ~touched])


def as_point(geometry: Geometry, z: Array, contacts: Contacts, k: int, force: float) -> tuple[Places, float, float]:
    """A joint as a moving place at the minimum of the gap; gap and curvature there.

    Inf and 0 without a minimum between the neighbouring joints, and at a corner, which is a place.  At a corner of the
    thickness the slope changes its sign, and the place does not come to rest.
    """
    trial = taken(contacts.places, np.array([k]))
    trial.moves[:], trial.force[:] = True, force
    gap, curvature = np.empty(1), np.empty(1)
    settle(z, geometry.arrays, trial, gap, curvature, contacts.counters, FINDING)
    arrays, curve, piece, found = geometry.arrays, trial.curve[0], trial.piece[0], arc_of(geometry, trial)[0]
    apart = abs(found - arc_of(geometry, contacts.places)[k])
    at_corner = trial.at_point[0] and arrays.corner[trial.foot[0]] == CORNER
    settle(z, arrays, trial, gap, curvature, contacts.counters, 1)
    near = slice(max(piece - 1, arrays.first[curve]), min(piece + 1, arrays.last[curve]) + 1)
    leans = np.ptp(arrays.thickening[near] / arrays.span[near]) > LEANING
    restless = leans and abs(arc_of(geometry, trial)[0] - found) > RESTING * arrays.span[piece]
    if at_corner or restless or apart > NEIGHBOURS * arrays.span[piece]:
        return trial, np.inf, 0.0
    return trial, float(gap[0]), float(curvature[0])


def least_gap(geometry: Geometry, z: Array, contacts: Contacts, pair: int) -> float:
    """Least gap of an open pair, between joints too; inf if the curves are far apart."""
    full = with_fixed_places(geometry, z, replace(contacts, kept_open=frozenset()))
    gaps = full.gaps(geometry, z)
    mine = gaps[full.places.pair == pair]
    least = float(mine.min(initial=np.inf))
    for k in minima(geometry, full, gaps, pair).tolist():
        trial, gap, curvature = as_point(geometry, z, full, k, 0.0)
        if curvature > 0.0 and may_move(geometry, trial)[0]:
            least = min(least, gap)
    return least


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
    if geometry is None or contacts is None or not len(contacts.closed):
        return ContactMeasures(0.0, 0.0, 0.0)
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
