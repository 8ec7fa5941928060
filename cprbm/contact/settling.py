"""Feet and moving places on a frozen state, compiled, with counters.

A foot is the closest point near the last foot.  A moving place makes λ stationary; the change with the
unknowns follows from the linear equation of :mod:`cprbm.contact.gap`.
"""

import numpy as np

from cprbm.chain import compiled, compiled_inner
from cprbm.contact.closest import (
    ARRIVED,
    GROUPS,
    TURNED_BACK,
    closest_chord,
    closest_of,
    closest_point,
    curve_boxes,
    curve_jet,
    curve_point,
    depth_beyond,
    moved_along,
    thickness_between,
    weight_at,
    write_chords,
)
from cprbm.contact.curve import STENCIL, CurveArrays
from cprbm.contact.gap import LOCAL, SHIFT, Places, gap_frame, gap_row, local_indices
from cprbm_scene.answer import Array, Flags, Ints

BOX_TESTS, SEARCHES, GAPS = range(3)
"""Entries of the counters: tests of two boxes, searches over all pieces of a curve, evaluations of a gap."""

FINDING = 40
"""Iterations of a moving place on a frozen state."""

STEEP = 0.5
"""Sine of the angle between two beams from which a joint between the ends of a beam does not touch the other beam."""

LONGEST_STEP = 0.7
"""Change of a place in one iteration, pieces: less than a piece, so that a minimum is not jumped over."""


def new_counters() -> Ints:
    """Counters (3,), all zero."""
    return np.zeros(3, dtype=np.int64)


@compiled
def near_pairs(z: Array, curves: CurveArrays, pairs: Ints, reach: float, counters: Ints) -> Flags:  # pragma: no cover
    """Whether the boxes of two curves (pairs, 2) are nearer than ``reach``; one test per pair."""
    boxes = curve_boxes(z, curves)
    a, b = boxes[pairs[:, 0]], boxes[pairs[:, 1]]
    counters[BOX_TESTS] += len(pairs)
    apart = np.maximum(a[:, :2] - b[:, 2:], b[:, :2] - a[:, 2:])
    return np.asarray((apart[:, 0] < reach) & (apart[:, 1] < reach))


@compiled
def find_feet(
    z: Array, curves: CurveArrays, places: Places, distance: Array, counters: Ints
) -> None:  # pragma: no cover
    """Find the feet of all places by search over all pieces; write the distances to the nearest chords.

    The distance of a place on a beam from the beam itself is inf where the beam has not turned back.
    """
    chords, waiting = np.empty((2 * curves.span.size, 5)), np.empty(GROUPS, np.int64)
    near = np.full(curves.first.size, -1)
    for k in range(places.piece.size):
        piece, other, least_turn = places.piece[k], places.other[k], 0.0
        if near[other] < 0:
            write_chords(z, curves, other, chords)
            near[other] = curves.first[other]
        if places.curve[k] == other:
            least_turn = TURNED_BACK
        x, y = curve_point(z, curves, piece, places.xi[k])
        counters[SEARCHES] += 1
        turn = z[curves.angle[piece]], least_turn
        foot, eta, distance[k] = closest_of(z, curves, other, chords, waiting, near[other], x, y, turn)
        places.foot[k], places.eta[k], near[other] = foot, eta, foot


@compiled
def find_bends(z: Array, curves: CurveArrays, places: Places, rounds: int) -> None:  # pragma: no cover
    """Move places on bends to the beams, from chord to chord and back in some rounds; write the feet."""
    for k in range(places.piece.size):
        if curves.angle[places.piece[k]] >= 0 or curves.is_point[places.curve[k]]:
            continue
        for _ in range(rounds):
            x, y = curve_point(z, curves, places.foot[k], places.eta[k])
            places.piece[k], places.xi[k], _ = closest_chord(z, curves, places.curve[k], x, y)
            x, y = curve_point(z, curves, places.piece[k], places.xi[k])
            places.foot[k], places.eta[k], _ = closest_chord(z, curves, places.other[k], x, y)


@compiled_inner
def is_no_contact(z: Array, curves: CurveArrays, places: Places, k: int) -> bool:  # pragma: no cover
    """True if a place cannot touch: a beam that has not turned back to itself, a joint where two beams cross steeply.

    Only an end of a beam meets another beam under a steep angle.
    """
    curve, piece, foot = places.curve[k], places.piece[k], places.foot[k]
    turn = z[curves.angle[piece]] - z[curves.angle[foot]]
    if curve == places.other[k]:
        return bool(abs(turn) < TURNED_BACK)
    between = not places.moves[k] and curves.first[curve] < piece + places.xi[k] < curves.last[curve] + 1
    return bool(between and min(curves.angle[piece], curves.angle[foot]) >= 0 and abs(np.sin(turn)) > STEEP)


@compiled_inner
def settle_place(
    z: Array, curves: CurveArrays, places: Places, k: int, counters: Ints, steps: int
) -> tuple[float, float]:  # pragma: no cover
    """Gap and curvature of a place, after moves of the foot, and in at most ``steps`` of a moving place."""
    gap, curvature, last, longest = np.inf, 0.0, 0.0, LONGEST_STEP
    for _ in range(max(steps, 1)):
        x, y = curve_point(z, curves, places.piece[k], places.xi[k])
        force = places.force[k] if places.moves[k] else 0.0
        foot, eta, side = places.foot[k], places.eta[k], places.side[k]
        places.foot[k], places.eta[k], places.at_point[k] = closest_point(
            z, curves, places.other[k], x, y, foot, eta, force, side
        )
        if is_no_contact(z, curves, places, k):
            break
        f = gap_frame(z, curves, places, k)
        counters[GAPS] += 1
        gap, curvature = f.gap, f.curvature / curves.span[places.piece[k]] ** 2
        if not places.moves[k] or f.curvature == 0.0:
            break
        if steps == 0:
            # a place on a bend of an edge stays
            gap -= 0.5 * f.slope * f.slope / abs(f.curvature) * (curves.angle[places.piece[k]] >= 0)
            break
        step = -f.slope / abs(f.curvature)
        # beside a corner of the other beam's thickness the slope jumps: every step back halves the longest step
        longest *= 0.5 if step * last < 0.0 <= curves.angle[places.foot[k]] else 1.0
        last = min(longest, max(-longest, step))
        places.piece[k], places.xi[k], _ = moved_along(curves, places.curve[k], places.piece[k], places.xi[k], last)
        if abs(last) < ARRIVED:
            break
    return gap, curvature


@compiled
def settle(
    z: Array, curves: CurveArrays, places: Places, gaps: Array, curvatures: Array, counters: Ints, steps: int
) -> None:  # pragma: no cover
    """Move all feet, and in at most ``steps`` the moving places; write gaps and curvatures λ'' by arc length.

    Without steps the gap of a place that moves along a beam is the minimum of the parabola.
    """
    for k in range(places.piece.size):
        gaps[k], curvatures[k] = settle_place(z, curves, places, k, counters, steps)


@compiled
def settle_near(
    z: Array,
    curves: CurveArrays,
    places: Places,
    closed: Flags,
    gaps: Array,
    curvatures: Array,
    room: Array,
    counters: Ints,
    steps: int,
) -> None:  # pragma: no cover
    """Settle closed places and open places without ``room``: the way that nodes may go before the place can close.

    A place and the curve beneath move by at most the sum of the weights' sizes times the nodes' way.  The weights grow
    along a rigid curve; half the gap leaves them room.  Moving and sharing places and beams with themselves have none.
    """
    sharing = places.shares != 0
    sharing[(np.arange(closed.size) + places.shares)[sharing]] = True
    for k in range(closed.size):
        if room[k] > 0.0 and not closed[k]:
            continue
        gaps[k], curvatures[k] = settle_place(z, curves, places, k, counters, steps)
        room[k] = 0.0
        if not (places.moves[k] or sharing[k] or places.curve[k] == places.other[k]):
            sway = sway_of(curves, places.piece[k], places.xi[k]) + sway_of(curves, places.foot[k], places.eta[k])
            room[k] = 0.5 * gaps[k] / sway


@compiled_inner
def sway_of(curves: CurveArrays, piece: int, xi: float) -> float:  # pragma: no cover
    """Largest way of a point of a curve over the largest way of a node in x or y: the sum of the weights' sizes."""
    sway = 0.0
    for i in range(STENCIL):
        a, b = weight_at(curves, piece, i, xi, 0)
        sway += abs(a) + abs(b)
    return sway


@compiled
def move_places(
    z: Array, curves: CurveArrays, places: Places, change: Array, by_force: Array, share: float, limit: float
) -> float:  # pragma: no cover
    """Move places by a share of their linear change; the largest whole change, in pieces.

    A place that a change leads beyond an end of the place's curve stays at the end, without a change.

    Args:
        z, curves, places: the state whose row was eliminated; piece and parameter of moving places are changed.
        change: of the unknowns.
        by_force: change of the force of every place.
        share: of the change that the unknowns are given.
        limit: largest change of a place, in pieces.
    """
    vectors, index = np.empty((5, LOCAL)), np.empty(LOCAL, np.int64)
    largest = 0.0
    for k in range(places.piece.size):
        if not places.moves[k]:
            continue
        row = gap_row(z, curves, places, k, vectors)
        if row.shift == 0.0:
            continue
        local_indices(curves, places, k, index)
        slope = row.frame.slope + row.frame.slope_by_force * by_force[k]
        slope += (vectors[SHIFT] * change[index]).sum()
        whole, piece, at = -slope * abs(row.shift), places.piece[k], places.xi[k]
        step = min(limit, max(-limit, whole)) * share
        places.piece[k], places.xi[k], ended = moved_along(curves, places.curve[k], piece, at, step)
        largest = max(largest, 0.0 if ended and places.xi[k] == at and places.piece[k] == piece else abs(whole))
    return largest


@compiled
def separations(z: Array, curves: CurveArrays, places: Places) -> Array:  # pragma: no cover
    """Vectors (k, 2) from the feet to the places; zero for places that cannot touch."""
    vectors = np.zeros((places.piece.size, 2))
    for k in range(places.piece.size):
        if not is_no_contact(z, curves, places, k):
            ax, ay = curve_point(z, curves, places.piece[k], places.xi[k])
            bx, by = curve_point(z, curves, places.foot[k], places.eta[k])
            vectors[k, 0], vectors[k, 1] = ax - bx, ay - by
    return vectors


@compiled
def sweeps_any_point(
    before: Array, after: Array, curves: CurveArrays, points: Ints, counters: Ints
) -> bool:  # pragma: no cover
    """True if a beam sweeps over one of the ``points`` of :class:`cprbm.contact.candidates.Geometry` in a step."""
    old, new = curve_boxes(before, curves), curve_boxes(after, curves)
    low, high = np.minimum(old[:, :2], new[:, :2]), np.maximum(old[:, 2:], new[:, 2:])
    for k in range(len(points)):
        a, b, piece, at_end = points[k]
        counters[BOX_TESTS] += 1
        apart = max((low[a] - high[b]).max(), (low[b] - high[a]).max())
        if apart < 0.0 and _sweeps_over(before, after, curves, b, piece, float(at_end)):
            return True
    return False


@compiled
def _sweeps_over(
    before: Array, after: Array, curves: CurveArrays, beam: int, point: int, at: float
) -> bool:  # pragma: no cover
    """True if the part of a beam next to a point of a piece lies on the other side of the point after a step.

    A point near the beam's neutral line has no side: a common joint, and a line that touches.
    """
    for z in (before, after):
        cx, cy = curve_point(z, curves, point, at)
        piece, xi, _ = closest_chord(z, curves, beam, cx, cy)
        ax, ay = curve_point(before, curves, piece, xi)
        bx, by = curve_point(before, curves, point, at)
        cx, cy = curve_point(after, curves, piece, xi)
        dx, dy = curve_point(after, curves, point, at)
        nearest = min(np.hypot(ax - bx, ay - by), np.hypot(cx - dx, cy - dy))
        beside = nearest > depth_beyond(curves, piece, thickness_between(curves, piece, xi, point, at))
        if beside and (ax - bx) * (cx - dx) + (ay - by) * (cy - dy) < 0.0:
            return True
    return False


@compiled
def choose_sides(z: Array, curves: CurveArrays, places: Places) -> None:  # pragma: no cover
    """Write the present sides of places of a beam on itself; the feet must be found."""
    for k in range(places.piece.size):
        if places.curve[k] == places.other[k] and not is_no_contact(z, curves, places, k):
            ax, ay = curve_point(z, curves, places.piece[k], places.xi[k])
            bx, by, tx, ty, _, _ = curve_jet(z, curves, places.foot[k], places.eta[k])
            places.side[k] = 1.0 if (ay - by) * tx - (ax - bx) * ty >= 0.0 else -1.0
