"""An iteration with a closed set, compiled: changes of the set, linear system, changes of forces and places."""

from math import isfinite

import numpy as np

from cprbm.chain import compiled
from cprbm.contact import BEND, CORNER, Columns, CurveArrays, Places, lost_at, move_places, settle_near
from cprbm.equilibrium.columns import contact_columns
from cprbm.equilibrium.linear import Numbers, correction, reduced_system, restored
from cprbm_scene.answer import Array, Flags, Ints

OVERLAP = 1e-12
"""Overlap, over the longest beam, from which an open place closes: round-off."""

NEARBY = 4.0
"""Pieces around a point contact in which the chain's curve misses the lost compliance."""

LONGEST_MOVE = 2.0
"""Largest change of a moving place in an iteration, pieces."""


@compiled
def change_set(
    curves: CurveArrays, places: Places, closed: Flags, gaps: Array, pairs: Ints, most: int
) -> int:  # pragma: no cover
    """Close overlapping places and open pulling places; the number of places with a wrong sign.

    With more than ``most`` such places nothing changes; with ``most`` = 1 the worst overlap closes, or without overlaps
    the largest pull opens.  ``pairs`` (pairs, 2) holds the numbers of both curves of every pair.
    """
    allowed, beside, depth = closable(curves, places, closed, pairs)
    own, gap = places.shares == 0, gaps.copy()
    for k in np.flatnonzero(~own):
        gap[k + places.shares[k]] += gaps[k]
    opens = own & closed & ((places.force < 0.0) | beside)
    closes = own & allowed & ~closed & (gap < -OVERLAP - depth)
    count = int(np.count_nonzero(opens | closes))
    if count > most == 1:
        worst = np.argmin(np.where(closes, gap, np.inf) if np.any(closes) else np.where(opens, places.force, np.inf))
        closed[worst] = closes[worst]
    elif count <= most:
        closed[:] = closes | (closed & ~opens)
    follow_leaders(places, closed)
    return count


@compiled
def follow_leaders(places: Places, closed: Flags) -> None:  # pragma: no cover
    """Places with a shared force follow the places that have the force; open places have no force."""
    leader = np.arange(closed.size) + places.shares
    closed[:] = closed[leader]
    places.force[:] = np.where(closed, places.force[leader], 0.0)


@compiled
def closable(
    curves: CurveArrays, places: Places, closed: Flags, pairs: Ints
) -> tuple[Flags, Flags, Array]:  # pragma: no cover
    """Places that may be closed, places beside a point of contact, and allowed overlaps."""
    beside, depth = beside_points(curves, places, closed)
    piece, foot, rolled = places.piece, places.foot, places.curve == places.other
    thick = curves.thickness[piece] + curves.thickness[foot] > 0.0
    # a corner is a place of its own, but a round end of a beam presses on the corner by the end's place
    last = (places.xi == 1.0) & (piece == curves.last[places.curve])
    end = last | ((places.xi == 0.0) & (piece == curves.first[places.curve]))
    at_corner = (curves.corner[foot] == CORNER) & places.at_point
    beside |= (at_corner | ((curves.corner[foot] == BEND) & ~places.moves)) & ~end
    # a foot on a beam's end is the foot of that end's own place; of two ends the first curve has the place
    second = places.curve != pairs[:, 0][places.pair]
    on_beam = ~rolled & ~end & (curves.angle[foot] >= 0)
    doubled = places.at_point & (second | on_beam | (rolled & (places.xi == 1.0)))
    left = end & (curves.angle[piece] < 0) & ~curves.is_point[places.curve]
    return ~beside & (thick | ~places.at_point) & ~doubled & ~left, beside, depth


@compiled
def beside_points(curves: CurveArrays, places: Places, closed: Flags) -> tuple[Flags, Array]:  # pragma: no cover
    """Places within a piece of a closed point contact, and the overlap of every pair's point contact.

    Outside of the point the other places of the pair may overlap by as much without contact, corners only nearby.
    Closed point contacts stay closed beside each other, and two corners are two contacts.
    """
    beside, depth, points = np.zeros(closed.size, np.bool_), np.zeros(closed.size), closed & places.moves
    corner, arcs = curves.angle[places.piece] < 0, arcs_of(curves, places)
    curve, piece = np.where(corner, places.other, places.curve), np.where(corner, places.foot, places.piece)
    for k in range(closed.size):
        if points[k]:
            lost = lost_at(curves, places.piece[k], 0.5, 0) + lost_at(curves, places.foot[k], 0.5, 0)
            others = (places.pair == places.pair[k]) & ~points
            pieces = np.where(curve == curve[k], np.abs(arcs - arcs[k]) / curves.span[piece[k]], np.inf)
            near = others & (~corner | (pieces < NEARBY))
            depth = np.maximum(depth, np.where(near, lost * places.force[k], 0.0))
            beside |= others & (pieces < 1.0) & ~(corner & corner[k])
    return beside, depth


@compiled
def arcs_of(curves: CurveArrays, places: Places) -> Array:  # pragma: no cover
    """Arc lengths of places on their beams: of the feet of corners."""
    corner = curves.angle[places.piece] < 0
    piece, at = np.where(corner, places.foot, places.piece), np.where(corner, places.eta, places.xi)
    return curves.arc[piece] + at * curves.span[piece]


@compiled
def settle_set(
    z: Array,
    curves: CurveArrays,
    places: Places,
    closed: Flags,
    gaps: Array,
    curvatures: Array,
    room: Array,
    counters: Ints,
    pairs: Ints,
    most: int,
    steps: int,
) -> int:  # pragma: no cover
    """Settle the places that may close in at most ``steps``, and change the set by :func:`change_set`."""
    settle_near(z, curves, places, closed, gaps, curvatures, room, counters, steps)
    return change_set(curves, places, closed, gaps, pairs, most)


@compiled
def newton_step(
    z: Array,
    m: Numbers,
    driven: Flags,
    target: Array,
    stiffness: Array,
    anchor: Array,
    curves: CurveArrays,
    places: Places,
    closed: Flags,
    gaps: Array,
    curvatures: Array,
    room: Array,
    counters: Ints,
    pairs: Ints,
    changes: int,
) -> tuple[float, float]:  # pragma: no cover
    """A step of Newton's method with the closed places of the smooth curves, :func:`step_with_columns`.

    ``changes`` is the number of changes of the set before the step.
    """
    for _ in range(changes):
        settle_set(z, curves, places, closed, gaps, curvatures, room, counters, pairs, closed.size, 0)
    gradient = np.zeros(z.size)
    columns = contact_columns(z, curves, places, closed, gradient)
    return step_with_columns(z, m, driven, target, stiffness, anchor, curves, places, closed, room, columns, gradient)


@compiled
def step_with_columns(
    z: Array,
    m: Numbers,
    driven: Flags,
    target: Array,
    stiffness: Array,
    anchor: Array,
    curves: CurveArrays,
    places: Places,
    closed: Flags,
    room: Array,
    columns: Columns,
    gradient: Array,
) -> tuple[float, float]:  # pragma: no cover
    """Largest correction of a displacement or an angle, inf if not finite, and of a place, in pieces.

    Changes unknowns, forces and places, a link by at most ``LARGEST_TURN``; nothing if the correction is not finite.
    A place with ``room`` loses as much as the nodes move.

    Raises:
        LinAlgError: the border is singular.
    """
    bordered, change, reduced = reduced_system(z, m, driven, target, stiffness, anchor, columns, gradient)
    border = np.tril(bordered.border) + np.tril(bordered.border, -1).T
    solution = np.linalg.solve(border, reduced)
    restored(m.beams, m.border, bordered.coupling, solution, change)  # type: ignore[arg-type]
    size, share = correction(change, m.motions, m.turns)
    if not isfinite(size):
        return np.inf, 0.0
    by_force, leader = np.zeros(closed.size), np.arange(closed.size) + places.shares
    by_force[np.flatnonzero(closed & (places.shares == 0))] = solution[m.border.size :][: columns.values.size]
    by_force = np.where(closed, by_force[leader], 0.0)
    moved = move_places(z, curves, places, change, by_force, share, LONGEST_MOVE)
    z += share * change
    places.force[:] += share * by_force
    room -= share * size
    return size, moved
