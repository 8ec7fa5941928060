"""Neighbouring places of a pair, compiled: runs of closed joints, minima of the gap, places near a moving place.

The joints of a pair's first curve are in the order of the curve; places of a shared force are no joints here.
"""

import numpy as np

from cprbm.chain import compiled
from cprbm.contact import CORNER, FINDING, CurveArrays, Places, Sites, movable, picked, settle
from cprbm.equilibrium.iteration import OVERLAP, beside_points, place_on_beam
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
    joints, count = np.empty(places.pair.size, np.int64), 0
    for k in range(places.pair.size):
        own = places.pair[k] == pair and places.curve[k] == columns[pair, 0]
        rolled_end = places.curve[k] == places.other[k] and places.xi[k] == 1.0
        if own and not places.moves[k] and places.shares[k] == 0 and not rolled_end:
            joints[count] = k
            count += 1
    beside = np.zeros(count, np.bool_)
    for i in range(count - 1):
        apart = place_on_beam(curves, places, joints[i + 1])[1] - place_on_beam(curves, places, joints[i])[1]
        beside[i] = apart < NEIGHBOURS * curves.span[places.piece[joints[i]]]
    return joints[:count], beside


@compiled
def minima_of(
    curves: CurveArrays, places: Places, closed: Flags, gaps: Array, columns: Ints, pair: int
) -> Ints:  # pragma: no cover
    """Open joints of a pair with the locally least gap, without a closed neighbour."""
    joints, beside = joints_of(curves, places, columns, pair)
    found, count = np.empty(joints.size, np.int64), 0
    for i in range(joints.size):
        k = joints[i]
        least = not closed[k] and gaps[k] < WITHIN * curves.span[places.piece[k]]
        if i > 0:
            j = joints[i - 1]
            least = least and not closed[j] and (gaps[k] <= gaps[j] or not beside[i - 1])
        if i < joints.size - 1:
            j = joints[i + 1]
            least = least and not closed[j] and (gaps[k] <= gaps[j] or not beside[i])
        if least:
            found[count] = k
            count += 1
    return found[:count]


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
    curve, piece, found = trial.curve[0], trial.piece[0], place_on_beam(curves, trial, 0)[1]
    apart = abs(found - place_on_beam(curves, places, k)[1])
    at_corner = trial.at_point[0] and curves.corner[trial.foot[0]] == CORNER
    settle(z, curves, trial, gap, curvature, counters, 1)
    low, high = np.inf, -np.inf
    for near in range(max(piece - 1, curves.first[curve]), min(piece + 1, curves.last[curve]) + 1):
        lean = curves.thickening[near] / curves.span[near]
        low, high = min(low, lean), max(high, lean)
    moved = abs(place_on_beam(curves, trial, 0)[1] - found)
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
    arc, reach = place_on_beam(curves, places, k)[1], (ISOLATED - NEIGHBOURS) * curves.span[places.piece[k]]
    for j in range(closed.size):
        same = places.pair[j] == places.pair[k] and places.curve[j] == places.curve[k]
        if closed[j] and same and j != k and abs(place_on_beam(curves, places, j)[1] - arc) < reach:
            return True
    return False


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
    allowed, near = movable(curves, sites, places), np.zeros(count, np.bool_)
    for k in range(count):
        if not places.moves[k] or curves.angle[places.piece[k]] < 0:
            continue
        arc, span, force = place_on_beam(curves, places, k)[1], curves.span[places.piece[k]], 0.0
        for j in range(count):
            apart = abs(place_on_beam(curves, places, j)[1] - arc)
            near[j] = places.pair[j] == places.pair[k] and places.curve[j] == places.curve[k] and closed[j]
            near[j] = near[j] and not places.moves[j] and span <= apart < ISOLATED * span
            force += places.force[j] if near[j] else 0.0
        gone[k] = force > least * places.force[k] or not (closed[k] and curvatures[k] > 0.0 and allowed[k])
        if not gone[k]:
            light |= near
    return gone, light
