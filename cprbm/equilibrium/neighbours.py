"""Neighbouring places of a pair, compiled: runs of closed joints, minima of the gap, places near a moving place.

The joints of a pair's first curve are in the order of the curve; places of a shared force are no joints here.
"""

import numpy as np

from cprbm.chain import compiled
from cprbm.contact import CORNER, FINDING, CurveArrays, Places, Sites, movable, picked, settle
from cprbm.equilibrium.iteration import OVERLAP, arcs_of, beside_points
from cprbm_scene.answer import Array, Flags, Ints

NEIGHBOURS = 1.6
"""Pieces between neighbouring joints: half links at a beam's end are neighbours too."""

RESTING = 1e-6
"""Last change of a place at the minimum of the gap, pieces."""

LEANING = 1e-9
"""Least change of the thickness's slope at a corner: round-off."""

WITHIN = 0.5
"""Gap, in pieces, of a joint with a possible contact beside the joint."""

ISOLATED = 4
"""Pieces around a moving place without other closed places of the pair."""

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
    beside[:-1] = arcs[1:] - arcs[:-1] < NEIGHBOURS * curves.span[places.piece[joints[:-1]]]
    return joints, beside


@compiled
def minima_of(
    curves: CurveArrays, places: Places, closed: Flags, gaps: Array, columns: Ints, pair: int
) -> Ints:  # pragma: no cover
    """Open joints of a pair with the locally least gap, without a closed neighbour."""
    joints, beside = joints_of(curves, places, columns, pair)
    gap, free, apart = gaps[joints], ~closed[joints], ~beside[:-1]
    least = free & (gap < WITHIN * curves.span[places.piece[joints]])
    least[:-1] &= free[1:] & ((gap[:-1] <= gap[1:]) | apart)
    least[1:] &= free[:-1] & ((gap[1:] <= gap[:-1]) | apart)
    return joints[least]


@compiled
def as_point(
    z: Array, curves: CurveArrays, places: Places, k: int, force: float, counters: Ints
) -> tuple[Places, float, float]:  # pragma: no cover
    """A joint as a moving place at the minimum of the gap; gap and curvature there.

    Inf and 0 without a minimum between the neighbouring joints, and at a corner: the corner is a place.  At a corner of
    the thickness the slope changes its sign, and the place does not come to rest.
    """
    trial, gap, curvature = picked(places, np.array([k])), np.empty(1), np.empty(1)
    trial.moves[0], trial.force[0] = True, force
    settle(z, curves, trial, gap, curvature, counters, FINDING)
    curve, piece, found = trial.curve[0], trial.piece[0], arcs_of(curves, trial)[0]
    apart = abs(found - arcs_of(curves, places)[k])
    at_corner = trial.at_point[0] and curves.corner[trial.foot[0]] == CORNER
    settle(z, curves, trial, gap, curvature, counters, 1)
    low, high = np.inf, -np.inf
    for near in range(max(piece - 1, curves.first[curve]), min(piece + 1, curves.last[curve]) + 1):
        lean = curves.thickening[near] / curves.span[near]
        low, high = min(low, lean), max(high, lean)
    moved = abs(arcs_of(curves, trial)[0] - found)
    restless = high - low > LEANING and moved > RESTING * curves.span[piece]
    if at_corner or restless or apart > NEIGHBOURS * curves.span[piece]:
        return trial, np.inf, 0.0
    return trial, gap[0], curvature[0]


@compiled
def least_between(
    z: Array, curves: CurveArrays, sites: Sites, places: Places, closed: Flags, gaps: Array, pair: int, counters: Ints
) -> float:  # pragma: no cover
    """Least gap of a pair at minima between joints, where a point of contact may be; inf without any."""
    least = np.inf
    for k in minima_of(curves, places, closed, gaps, sites.columns, pair):
        trial, gap, curvature = as_point(z, curves, places, k, 0.0, counters)
        if curvature > 0.0 and movable(curves, sites, trial)[0]:
            least = min(least, gap)
    return least


@compiled
def _is_crowded(curves: CurveArrays, places: Places, closed: Flags, k: int) -> bool:  # pragma: no cover
    """True if another closed place of the pair is too near for an isolated point of contact beside a joint."""
    arcs, others = arcs_of(curves, places), closed & (places.pair == places.pair[k])
    others &= (places.curve == places.curve[k]) & (np.arange(closed.size) != k)
    near = np.abs(arcs - arcs[k]) < (ISOLATED - NEIGHBOURS) * curves.span[places.piece[k]]
    return bool(np.any(others & near))


@compiled
def short_runs(
    z: Array, curves: CurveArrays, sites: Sites, places: Places, closed: Flags, gaps: Array, counters: Ints
) -> Ints:  # pragma: no cover
    """First and last (runs, 2) of short runs of closed joints, and of open joints with an overlap beside the joint."""
    runs, count = np.empty((places.pair.size, 2), np.int64), 0
    depth = beside_points(curves, places, closed)[1]
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
                _, gap, curvature = as_point(z, curves, places, k, 0.0, counters)
                if gap < -OVERLAP - depth[k] and curvature > 0.0:
                    runs[count, 0], runs[count, 1] = k, k
                    count += 1
    return runs[:count]


@compiled
def given_up(
    curves: CurveArrays, sites: Sites, places: Places, closed: Flags, curvatures: Array, least: float
) -> tuple[Flags, Flags]:  # pragma: no cover
    """Whether moving places become joints again, and whether joints beside moving places open.

    Joints open with at most the ``least`` part of the moving place's force.
    """
    count = closed.size
    gone, light = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
    if not np.any(places.moves):
        return gone, light
    allowed, arcs = movable(curves, sites, places), arcs_of(curves, places)
    for k in range(count):
        if places.moves[k] and curves.angle[places.piece[k]] >= 0:
            apart, span = np.abs(arcs - arcs[k]), curves.span[places.piece[k]]
            near = closed & ~places.moves & (places.pair == places.pair[k]) & (places.curve == places.curve[k])
            near &= (span <= apart) & (apart < ISOLATED * span)
            heavy = places.force[near].sum() > least * places.force[k]
            gone[k] = heavy or not (closed[k] and curvatures[k] > 0.0 and allowed[k])
            if not gone[k]:
                light |= near
    return gone, light
