"""An iteration with a closed set, compiled: changes of the set, linear system, changes of forces and places."""

from math import isfinite

import numpy as np

from cprbm.chain import compiled
from cprbm.contact import BEND, CORNER, Columns, CurveArrays, Places, move_places, settle_near
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
    opens, closes, gap = _wanted(curves, places, closed, gaps, pairs)
    count, any_closes = 0, False
    for k in range(closed.size):
        count += opens[k] or closes[k]
        any_closes = any_closes or closes[k]
    if count > most == 1:
        worst, least = -1, np.inf
        for k in range(closed.size):
            value = gap[k] if any_closes else places.force[k]
            if (closes[k] if any_closes else opens[k]) and value < least:
                worst, least = k, value
        closed[worst] = closes[worst]
    elif count <= most:
        for k in range(closed.size):
            closed[k] = closes[k] or (closed[k] and not opens[k])
    follow_leaders(places, closed)
    return count


@compiled
def follow_leaders(places: Places, closed: Flags) -> None:  # pragma: no cover
    """Places with a shared force follow the places that have the force; open places have no force."""
    for k in range(closed.size):
        closed[k] = closed[k + places.shares[k]]
        places.force[k] = places.force[k + places.shares[k]] if closed[k] else 0.0


@compiled
def _wanted(
    curves: CurveArrays, places: Places, closed: Flags, gaps: Array, pairs: Ints
) -> tuple[Flags, Flags, Array]:  # pragma: no cover
    """Places that should open, places that should close, and gaps with those of sharing places added."""
    count = closed.size
    opens, closes, gap = np.zeros(count, np.bool_), np.zeros(count, np.bool_), gaps.copy()
    allowed, beside, depth = closable(curves, places, closed, pairs)
    for k in range(count):
        if places.shares[k] != 0:
            gap[k + places.shares[k]] += gaps[k]
    for k in range(count):
        if places.shares[k] == 0:
            opens[k] = closed[k] and (places.force[k] < 0.0 or beside[k])
            closes[k] = allowed[k] and not closed[k] and gap[k] < -OVERLAP - depth[k]
    return opens, closes, gap


@compiled
def closable(
    curves: CurveArrays, places: Places, closed: Flags, pairs: Ints
) -> tuple[Flags, Flags, Array]:  # pragma: no cover
    """Places that may be closed, places beside a point of contact, and allowed overlaps."""
    beside, depth = beside_points(curves, places, closed)
    allowed = np.zeros(closed.size, np.bool_)
    for k in range(closed.size):
        thick = curves.thickness[places.piece[k]] + curves.thickness[places.foot[k]] > 0.0
        # a corner is a place of its own, but a round end of a beam presses on the corner by the end's place
        end = places.xi[k] == 0.0 and places.piece[k] == curves.first[places.curve[k]]
        end = end or (places.xi[k] == 1.0 and places.piece[k] == curves.last[places.curve[k]])
        at_corner = curves.corner[places.foot[k]] == CORNER and places.at_point[k]
        on_bend = curves.corner[places.foot[k]] == BEND and not places.moves[k]
        beside[k] = beside[k] or ((at_corner or on_bend) and not end)
        # a foot on a beam's end is the foot of that end's own place; of two ends the first curve has the place
        second = places.curve[k] != pairs[places.pair[k], 0]
        rolled = places.curve[k] == places.other[k]
        on_beam = not rolled and not end and curves.angle[places.foot[k]] >= 0
        doubled = places.at_point[k] and (second or on_beam or (rolled and places.xi[k] == 1.0))
        left = end and curves.angle[places.piece[k]] < 0 and not curves.is_point[places.curve[k]]
        allowed[k] = not beside[k] and (thick or not places.at_point[k]) and not doubled and not left
    return allowed, beside, depth


@compiled
def beside_points(curves: CurveArrays, places: Places, closed: Flags) -> tuple[Flags, Array]:  # pragma: no cover
    """Places within a piece of a closed point contact, and the overlap of every pair's point contact.

    Outside of the point the other places of the pair may overlap by as much without contact, corners only nearby.
    Closed point contacts stay closed beside each other, and two corners are two contacts.
    """
    beside, depth = np.zeros(closed.size, np.bool_), np.zeros(closed.size)
    for k in range(closed.size):
        if not (closed[k] and places.moves[k]):
            continue
        piece, foot, lost = places.piece[k], places.foot[k], 0.0
        for i in range(curves.lost.shape[1]):
            lost += (curves.lost[piece, i] + curves.lost[foot, i]) * 0.5**i
        corner = curves.angle[piece] < 0
        curve, arc, span = place_on_beam(curves, places, k)
        for j in range(closed.size):
            if places.pair[j] != places.pair[k] or (closed[j] and places.moves[j]):
                continue
            other, at, _ = place_on_beam(curves, places, j)
            pieces = abs(at - arc) / span if other == curve else np.inf
            at_corner = curves.angle[places.piece[j]] < 0
            if not at_corner or pieces < NEARBY:
                depth[j] = max(depth[j], lost * places.force[k])
            beside[j] = beside[j] or (pieces < 1.0 and not (corner and at_corner))
    return beside, depth


@compiled
def place_on_beam(curves: CurveArrays, places: Places, k: int) -> tuple[int, float, float]:  # pragma: no cover
    """Curve, arc length and span of the piece: of a place on a beam, or of the foot of a corner."""
    if curves.angle[places.piece[k]] < 0:
        piece, at, curve = places.foot[k], places.eta[k], places.other[k]
    else:
        piece, at, curve = places.piece[k], places.xi[k], places.curve[k]
    return curve, curves.arc[piece] + at * curves.span[piece], curves.span[piece]


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
    for i in range(reduced.size):
        for j in range(i):
            bordered.border[j, i] = bordered.border[i, j]
    solution = np.linalg.solve(bordered.border, reduced)
    restored(m.beams, m.border, bordered.coupling, solution, change)  # type: ignore[arg-type]
    size, share = correction(change, m.motions, m.turns)
    if not isfinite(size):
        return np.inf, 0.0
    by_force, column = np.zeros(closed.size), m.border.size
    for k in range(closed.size):
        if closed[k] and places.shares[k] == 0:
            by_force[k] = solution[column]
            column += 1
    for k in range(closed.size):
        if closed[k]:
            by_force[k] = by_force[k + places.shares[k]]
    moved = move_places(z, curves, places, change, by_force, share, LONGEST_MOVE)
    for i in range(z.size):
        z[i] += share * change[i]
    for k in range(closed.size):
        places.force[k] += share * by_force[k]
        room[k] -= share * size
    return size, moved
