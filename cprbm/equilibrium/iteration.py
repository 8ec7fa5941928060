"""An iteration with a closed set, compiled: changes of the set, linear system, changes of forces and places."""

from math import isfinite

import numpy as np

from cprbm.chain import compiled, compiled_inner
from cprbm.contact import BEND, CORNER, Columns, CurveArrays, Places, lost_at, move_places, settle_near
from cprbm.equilibrium.columns import contact_columns
from cprbm.equilibrium.linear import Numbers, correction, reduced_system, restored
from cprbm_scene.answer import Array, Flags, Ints

OVERLAP = 1e-12
"""Overlap, over the longest beam, from which an open place closes: round-off."""

PULL = 1e-14
"""Pull of a closed place, in EI/ℓ², up to which the place touches without force: round-off."""

NEARBY = 4.0
"""Links around a point contact in which the chain's curve misses the lost compliance."""

LONGEST_MOVE = 2.0
"""Largest change of a moving place in an iteration, pieces: joints find a place that is farther away."""


@compiled
def change_set(
    curves: CurveArrays, places: Places, closed: Flags, gaps: Array, pairs: Ints, waits: Flags, most: int
) -> int:  # pragma: no cover
    """Close overlapping places and open pulling places; the number of places with a wrong sign.

    With more than ``most`` such places nothing changes; with ``most`` = 1 the worst overlap closes, or without overlaps
    the largest pull opens.  Without a closed place the worst overlap closes first: far beyond a closing curves overlap
    over a length and press in a point.  ``pairs`` (pairs, 2) holds the numbers of both curves of every pair; places
    marked ``waits`` stay open.
    """
    allowed, beside, depth = closable(curves, places, closed, pairs)
    own, gap = places.shares == 0, gaps.copy()
    for k in np.flatnonzero(~own):
        gap[k + places.shares[k]] += gaps[k]
    opens = own & closed & ((places.force < -PULL) | beside)
    closes = own & allowed & ~waits & ~closed & (gap < -OVERLAP - depth)
    count = int(np.count_nonzero(opens | closes))
    if count > 1 and (most == 1 or (most > 1 and not np.any(closed))):
        wrong, size = (closes, gap) if np.any(closes) else (opens, places.force)
        worst = np.flatnonzero(wrong)[np.argmin(size[wrong])]
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
    places.force[:] = closed * places.force[leader]


@compiled
def closable(
    curves: CurveArrays, places: Places, closed: Flags, pairs: Ints
) -> tuple[Flags, Flags, Array]:  # pragma: no cover
    """Places that may be closed, places beside a point of contact, and allowed overlaps."""
    beside, depth = beside_points(curves, places, closed)
    allowed = np.empty(closed.size, np.bool_)
    for k in range(closed.size):
        curve, piece, foot, at_point = places.curve[k], places.piece[k], places.foot[k], places.at_point[k]
        rolled, last = curve == places.other[k], places.xi[k] == 1.0
        # a corner is a place of its own, but a round end of a beam presses on the corner by the end's place
        end = (last and piece == curves.last[curve]) or (places.xi[k] == 0.0 and piece == curves.first[curve])
        if not end:
            at_corner = curves.corner[foot] == CORNER and at_point
            beside[k] |= at_corner or (curves.corner[foot] == BEND and not places.moves[k])
        # a foot on a beam's end is the foot of that end's own place; of two ends the first curve has the place
        on_beam = not rolled and not end and curves.angle[foot] >= 0
        doubled = curve != pairs[places.pair[k], 0] or on_beam or (rolled and last)
        left = end and curves.angle[piece] < 0 and not curves.is_point[curve]
        thick = curves.thickness[piece] + curves.thickness[foot] > 0.0
        allowed[k] = not (beside[k] or left or (at_point and (doubled or not thick)))
    return allowed, beside, depth


@compiled
def beside_points(curves: CurveArrays, places: Places, closed: Flags) -> tuple[Flags, Array]:  # pragma: no cover
    """Places within a link of a closed point contact, and the overlap of every pair's point contact.

    Outside of the point the other places of the pair may overlap by as much without contact, corners only nearby.
    Closed point contacts stay closed beside each other, and two corners are two contacts.
    """
    beside, depth, arcs = np.zeros(closed.size, np.bool_), np.zeros(closed.size), arcs_of(curves, places)
    for k in np.flatnonzero(closed & places.moves):
        beam, piece, _ = beam_place(curves, places, int(k))
        lost = lost_at(curves, places.piece[k], 0.5, 0) + lost_at(curves, places.foot[k], 0.5, 0)
        for j in range(closed.size):
            if places.pair[j] != places.pair[k] or (closed[j] and places.moves[j]):
                continue
            corner, same = curves.angle[places.piece[j]] < 0, beam_place(curves, places, j)[0] == beam
            links = abs(arcs[j] - arcs[k]) / curves.link[piece]
            if not corner or (same and links < NEARBY):
                depth[j] = max(depth[j], lost * places.force[k])
            beside[j] |= same and links < 1.0 and not (corner and curves.angle[places.piece[k]] < 0)
    return beside, depth


@compiled
def arcs_of(curves: CurveArrays, places: Places) -> Array:  # pragma: no cover
    """Arc lengths of places on their beams: of the feet of corners."""
    arcs = np.empty(places.piece.size)
    for k in range(arcs.size):
        _, piece, at = beam_place(curves, places, k)
        arcs[k] = curves.arc[piece] + at * curves.span[piece]
    return arcs


@compiled_inner
def beam_place(curves: CurveArrays, places: Places, k: int) -> tuple[int, int, float]:  # pragma: no cover
    """Curve, piece and parameter of a place on the beam: of the foot of a corner."""
    if curves.angle[places.piece[k]] < 0:
        return places.other[k], places.foot[k], places.eta[k]
    return places.curve[k], places.piece[k], places.xi[k]


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
    waits: Flags,
    most: int,
    steps: int,
) -> int:  # pragma: no cover
    """Settle the places that may close in at most ``steps``, and change the set by :func:`change_set`."""
    settle_near(z, curves, places, closed, gaps, curvatures, room, counters, steps)
    return change_set(curves, places, closed, gaps, pairs, waits, most)


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
    waits: Flags,
    changes: int,
) -> tuple[float, float]:  # pragma: no cover
    """A step of Newton's method with the closed places of the smooth curves, :func:`step_with_columns`.

    ``changes`` is the number of changes of the set before the step.
    """
    for _ in range(changes):
        settle_set(z, curves, places, closed, gaps, curvatures, room, counters, pairs, waits, closed.size, 0)
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
        bordered.border[:i, i] = bordered.border[i, :i]
    solution = np.linalg.solve(bordered.border, reduced)
    restored(m.beams, m.border, bordered.coupling, solution, change)  # type: ignore[arg-type]
    size, share = correction(change, m.motions, m.turns)
    if not isfinite(size):
        return np.inf, 0.0
    by_force, leader = np.zeros(closed.size), np.arange(closed.size) + places.shares
    by_force[np.flatnonzero(closed & (places.shares == 0))] = solution[m.border.size :][: columns.values.size]
    by_force = closed * by_force[leader]
    moved = move_places(z, curves, places, change, by_force, share, LONGEST_MOVE)
    z += share * change
    places.force[:] += share * by_force
    room -= share * size
    return size, moved
