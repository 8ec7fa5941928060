"""Neighbouring places of a pair: runs of closed joints, minima of the gap, places near a moving place.

The joints of a pair's first curve are in the order of the curve; places of a shared force are no joints here.

Loops over joints are compiled.  Array expressions are not: their machine code is long, and the first solve loads it.
"""

from collections.abc import Iterable

import numpy as np

from cprbm.chain import compiled
from cprbm.contact import (
    CORNER,
    FINDING,
    Contacts,
    CurveArrays,
    Geometry,
    Places,
    Sites,
    is_movable,
    joined,
    settle,
    taken,
)
from cprbm.equilibrium.iteration import arcs_of
from cprbm_scene.answer import Array, Flags, Ints

NEIGHBOURS = 1.6
"""Links between neighbouring joints: half links at a beam's end are neighbours too."""

RESTING = 1e-6
"""Last change of a place at the minimum of the gap, pieces."""

LEANING = 1e-9
"""Least change of the thickness's slope at a corner: round-off."""

ALIKE, SPLINED = 1e-4, 1 / 64
"""Turn of two curves against each other over a link, over the turn t of two links and over t³: least of a point.

Flatter minima of the gap are no points of contact.  The spline of links that turn by τ leaves the direction of an arc
by τ³/12: the gap of nested arcs has a minimum in most links.
"""

WITHIN = 0.5
"""Gap, in links, of a joint with a possible contact beside the joint."""

ISOLATED = 4
"""Links around a moving place without other closed places of the pair."""

LONGEST_RUN = 2
"""Longest run of closed neighbours for a point."""

LIGHT = 0.02
"""Smallest part of a point's force on a joint beside the point: a smaller force is left from the way."""


@compiled
def joints_of(curves: CurveArrays, places: Places, columns: Ints, pair: int) -> tuple[Ints, Flags]:  # pragma: no cover
    """Joints of a pair's first curve in order (k,), and whether each joint is a neighbour of the next (k,)."""
    own = (places.pair == pair) & (places.curve == columns[pair, 0]) & ~places.moves & (places.shares == 0)
    joints = np.flatnonzero(own & ~((places.curve == places.other) & (places.xi == 1.0)))
    arcs, beside = arcs_of(curves, places)[joints], np.zeros(joints.size, np.bool_)
    beside[:-1] = arcs[1:] - arcs[:-1] < NEIGHBOURS * curves.link[places.piece[joints[:-1]]]
    return joints, beside


@compiled
def minima_of(
    curves: CurveArrays, places: Places, closed: Flags, gaps: Array, columns: Ints, pair: int
) -> Ints:  # pragma: no cover
    """Open joints of a pair with the locally least gap, without a closed neighbour."""
    joints, beside = joints_of(curves, places, columns, pair)
    gap, free, apart = gaps[joints], ~closed[joints], ~beside[:-1]
    least = free & (gap < WITHIN * curves.link[places.piece[joints]])
    least[:-1] &= free[1:] & ((gap[:-1] <= gap[1:]) | apart)
    least[1:] &= free[:-1] & ((gap[1:] <= gap[:-1]) | apart)
    return joints[least]


def points_at(
    z: Array, curves: CurveArrays, places: Places, joints: Ints, forces: Array, counters: Ints
) -> tuple[Places, Array, Array]:
    """Joints (k,) as moving places with ``forces`` (k,) at the minima of the gap; gaps and curvatures there.

    Inf and 0 without a minimum between the neighbouring joints, at a minimum that the splines of nested arcs make, and
    at a corner: the corner is a place.  At a corner of the thickness the slope changes its sign: no place rests there.
    """
    points, gaps, curvatures = taken(places, joints), np.empty(joints.size), np.empty(joints.size)
    points.moves[:], points.force[:] = True, forces
    settle(z, curves, points, gaps, curvatures, counters, FINDING)
    found, pieces = arcs_of(curves, points), points.piece.copy()
    missing = np.abs(found - arcs_of(curves, places)[joints]) > NEIGHBOURS * curves.link[pieces]
    missing |= points.at_point & (curves.corner[points.foot] == CORNER)
    settle(z, curves, points, gaps, curvatures, counters, 1)
    moved = np.abs(arcs_of(curves, points) - found) > RESTING * curves.span[pieces]
    near = np.clip(
        pieces[:, None] + np.array([-1, 0, 1]), curves.first[points.curve, None], curves.last[points.curve, None]
    )
    leans, turns = np.ptp(curves.thickening[near] / curves.span[near], axis=1), np.ptp(z[curves.angle[near]], axis=1)
    flat = curvatures * curves.link[pieces] < turns * np.maximum(ALIKE, SPLINED * turns**2)
    missing |= flat | (moved & (leans > LEANING))
    gaps[missing], curvatures[missing] = np.inf, 0.0
    return points, gaps, curvatures


def with_minima(
    geometry: Geometry, z: Array, contacts: Contacts, gaps: Array, pairs: Iterable[int]
) -> tuple[Places, Array]:
    """All places, and moving places where a point of contact of ``pairs`` may be between open joints; their gaps."""
    curves, sites, places = geometry.arrays, geometry.sites, contacts.places
    known = curves, contacts.places, contacts.closed, gaps
    for pair in () if geometry.joints_alone else pairs:
        joints = minima_of(*known, sites.columns, pair)
        points, least, curvatures = points_at(
            z, curves, contacts.places, joints, np.zeros(joints.size), contacts.counters
        )
        movable = np.array([is_movable(curves, sites, points, k) for k in range(joints.size)], dtype=bool)
        possible = movable & (curvatures > 0.0)
        places, gaps = joined(places, taken(points, possible)), np.append(gaps, least[possible])
    return places, gaps


@compiled
def _is_crowded(curves: CurveArrays, places: Places, closed: Flags, k: int) -> bool:  # pragma: no cover
    """True if another closed place of the pair is too near for an isolated point of contact beside a joint."""
    arcs, others = arcs_of(curves, places), closed & (places.pair == places.pair[k])
    others &= (places.curve == places.curve[k]) & (np.arange(closed.size) != k)
    near = np.abs(arcs - arcs[k]) < (ISOLATED - NEIGHBOURS) * curves.link[places.piece[k]]
    return bool(np.any(others & near))


@compiled
def short_runs(
    curves: CurveArrays, sites: Sites, places: Places, closed: Flags, gaps: Array
) -> Ints:  # pragma: no cover
    """First and last (runs, 2) of short runs of closed joints, and of open joints with a minimum of the gap beside."""
    runs, count = np.empty((places.pair.size, 2), np.int64), 0
    for pair in range(len(sites.columns)):
        joints, beside = joints_of(curves, places, sites.columns, pair)
        begin = 0
        for i in range(joints.size):
            if i < joints.size - 1 and beside[i] and closed[joints[i]] and closed[joints[i + 1]]:
                continue
            # beside another closed place an end keeps the contact: a point moves on a single curvature of the gap
            k = joints[i]
            crowded = places.xi[k] == 1.0 and _is_crowded(curves, places, closed, k)
            if closed[k] and i - begin < LONGEST_RUN and not crowded:
                runs[count, 0], runs[count, 1] = joints[begin], joints[i]
                count += 1
            begin = i + 1
        for k in minima_of(curves, places, closed, gaps, sites.columns, pair):
            if not _is_crowded(curves, places, closed, k):
                runs[count, 0], runs[count, 1] = k, k
                count += 1
    return runs[:count]


def given_up(
    curves: CurveArrays, sites: Sites, places: Places, closed: Flags, curvatures: Array, least: float
) -> tuple[Flags, Flags]:
    """Whether moving places become joints again, and whether joints beside moving places open.

    Joints open with at most the ``least`` part of the moving place's force.
    """
    gone, light = np.zeros((2, len(closed)), dtype=bool)
    moving, arcs = places.moves & (curves.angle[places.piece] >= 0), arcs_of(curves, places)
    for k in np.flatnonzero(moving).tolist():
        apart, link = np.abs(arcs - arcs[k]), curves.link[places.piece[k]]
        near = closed & ~places.moves & (places.pair == places.pair[k]) & (places.curve == places.curve[k])
        near &= (link <= apart) & (apart < ISOLATED * link)
        heavy = places.force[near].sum() > least * places.force[k]
        gone[k] = heavy or not (closed[k] and curvatures[k] > 0.0 and is_movable(curves, sites, places, k))
        light |= near & ~gone[k]
    return gone, light
