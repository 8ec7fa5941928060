"""Newton's method with an active set of contact places.

Every iteration moves the feet, opens pulling places, closes overlapping places, and solves the linear system of the
closed places.  Where more than a few places have a wrong sign, the linearised problem chooses the set
(:mod:`cprbm.equilibrium.complementary`).  The first iteration keeps the set: under new targets it is the prediction
along the path's tangent.  A moving place is an unknown; a closed moving place stands for the fixed places within a
piece.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from cprbm.contact import (
    FINDING,
    Contacts,
    CurveArrays,
    Geometry,
    Places,
    choose_sides,
    find_bends,
    fixed_places,
    half_thicknesses,
    joined,
    near_pairs,
    on_edge,
    separations,
    settle,
    settle_near,
    sweeps_any_circle,
    taken,
)
from cprbm.equilibrium.columns import contact_terms
from cprbm.equilibrium.complementary import closed_forces
from cprbm.equilibrium.factors import Factors, SingularError, Springs, factors_of, new_work, pulls, solved_border
from cprbm.equilibrium.iteration import (
    begin_by_law,
    begin_iteration,
    change_set,
    closable,
    end_iteration,
    follow_leaders,
)
from cprbm.equilibrium.linear import Numbers, Work, reduced_system
from cprbm.equilibrium.newton import NotConvergedError, has_converged
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array, Flags, Ints

FEW_CHANGES = 4
"""Places that change together by their signs; the linearised problem chooses where more have a wrong sign."""

FREE_CHANGES = 12
"""Iterations with any change of the set where the linearised problem cannot choose; later a single place changes."""

RETURNS = 2
"""Returns of a set after which the iteration counts as a cycle."""

ISOLATED = 4
"""Pieces around a moving place without other closed places of the pair."""

ARRIVED = 1e-6
"""Largest last change of a moving place, pieces."""

ROUNDS = 5
"""Rounds from chord to chord for the place of a bend."""

REACH = 0.1
"""Distance of two boxes, over the longest beam, up to which a pair has places."""

BEYOND = 0.1
"""Share of the half thicknesses, or of a piece for lines, by which a place is on the other side of a beam."""

Linear = tuple[Array, Numbers, Flags, Array, Array, Array, Work]
Settling = tuple[CurveArrays, Places, Flags, Array, Array, Array, Ints]


@dataclass(frozen=True, eq=False)
class Touched:
    """An equilibrium with contacts: state, contacts, factors, gaps and curvatures of the places, iterations."""

    state: State
    contacts: Contacts
    factors: Factors
    gaps: Array
    curvatures: Array
    iterations: int


def with_fixed_places(geometry: Geometry, z: Array, contacts: Contacts) -> Contacts:
    """Contacts with fixed places at the nearest feet; known places keep force and state, moving places stay.

    A new place of a beam in self-contact has the present side, and a new place beyond the end of another beam too.
    """
    old = contacts.places
    near = near_pairs(z, geometry.arrays, geometry.columns, np.full(len(geometry.pairs), REACH), contacts.counters)
    near[old.pair[contacts.closed]] = True
    near[list(contacts.kept_open)] = False
    fixed = fixed_places(geometry, z, contacts.sides, near, contacts.counters)
    moving = old.moves & ~on_edge(geometry.arrays, old)
    find_bends(z, geometry.arrays, fixed, ROUNDS)
    known = {_identity(old, k): k for k in np.flatnonzero(~moving).tolist()}
    apart = {} if contacts.apart is None else _sides_of(contacts.apart)
    closed, corner = np.zeros(len(fixed.pair), dtype=bool), on_edge(geometry.arrays, fixed)
    between = ~geometry.ends.rigid[fixed.curve] & ~geometry.ends.rigid[fixed.other] & (fixed.curve != fixed.other)
    choose_sides(z, geometry.arrays, fixed)
    for k in range(len(closed)):
        before = known.get(_identity(fixed, k))
        if before is None:
            if between[k] and _identity(fixed, k) in apart:
                fixed.side[k], between[k] = apart[_identity(fixed, k)], False
            continue
        if contacts.closed[before]:
            closed[k], fixed.force[k] = True, old.force[before]
            fixed.piece[k], fixed.xi[k] = old.piece[before], old.xi[before]
            fixed.foot[k], fixed.eta[k] = old.foot[before], old.eta[before]
        if contacts.closed[before] or between[k]:
            fixed.side[k], between[k] = old.side[before], False
    _turn_sides(geometry, z, fixed, between, contacts.counters)
    fixed.side[corner] = contacts.corner_sides[fixed.curve[corner]]
    both = joined(fixed, taken(old, moving))
    return replace(contacts, places=both, closed=np.concatenate([closed, contacts.closed[moving]]))


def _sides_of(places: Places) -> dict[tuple[int, int, int, float], float]:
    """Sides by place."""
    return {_identity(places, k): float(places.side[k]) for k in range(len(places.pair))}


def _turn_sides(geometry: Geometry, z: Array, places: Places, which: Flags, counters: Ints) -> None:
    """Turn the sides of places beyond another beam: there they have come round an end, and not through the beam.

    Beams that overlap by less than ``BEYOND`` of their half thicknesses, or lines of a piece, are in contact.  A place
    before an end has no side until it is seen beside the beam.
    """
    arrays, mine = geometry.arrays, np.flatnonzero(which)
    trial, gaps = taken(places, mine), np.empty(len(mine))
    settle(z, arrays, trial, gaps, np.empty(len(mine)), counters, 0)
    thickness = half_thicknesses(arrays, trial)
    depth = BEYOND * np.where(thickness > 0.0, thickness, arrays.span[trial.piece])
    turned = mine[~trial.at_point & (gaps + thickness < -depth)]
    places.side[turned] *= -1.0
    places.side[mine[trial.at_point]] = 0.0


def passed_through(geometry: Geometry, before: Array, old: Places, after: Array, new: Places, counters: Ints) -> bool:
    """True if a beam went through itself or over a circle: the vector from a foot or a centre to a place turned round.

    The gaps of a beam to itself and to a circle have no sign: only the way between two states shows a passage.
    """
    if geometry.arrays.is_point.any() and sweeps_any_circle(before, after, geometry.arrays, geometry.columns, counters):
        return True
    first, second = separations(before, geometry.arrays, old), separations(after, geometry.arrays, new)
    number = {_identity(new, k): k for k in range(len(new.pair)) if not new.moves[k]}
    # joints of lines slide past the end of a line at no distance; the end's own place has a side
    thick = geometry.arrays.thickness[old.piece] + geometry.arrays.thickness[old.foot] > 0.0
    unsigned = (old.curve == old.other) | ((old.side == 0.0) & thick)
    for k in np.flatnonzero(unsigned & ~old.moves & (np.hypot(*first.T) < REACH)).tolist():
        at = number.get(_identity(old, k))
        if at is not None and first[k] @ second[at] < 0.0:
            return True
    return False


def _identity(places: Places, k: int) -> tuple[int, int, int, float]:
    """Pair, curve, piece and parameter of a place; a bend has a single place."""
    piece, xi = (-1, 0.0) if places.moves[k] else (int(places.piece[k]), float(places.xi[k]))
    return int(places.pair[k]), int(places.curve[k]), piece, xi


def solve_set(
    system: System,
    geometry: Geometry,
    start: State,
    contacts: Contacts,
    iterations: int,
    springs: Springs | None = None,
) -> Touched:
    """Equilibrium near a state under the state's targets, and the set of closed places.

    Args:
        system, geometry: the mechanism and its contacts.
        start: state with targets.
        contacts: places at the start; not changed.
        iterations: largest number of Newton iterations.
        springs: springs on the links' angles, of a descent.

    Raises:
        NotConvergedError: no equilibrium was found, or the set of closed places returns.
    """
    z, driven = start.z.copy(), start.driven
    z[system.rows.first :][~driven] = start.target[~driven] * ~start.repeated[~driven]
    m, work, curves = system.numbers, new_work(system), geometry.arrays
    places, closed = taken(contacts.places, np.ones(len(contacts.closed), dtype=bool)), contacts.closed.copy()
    gaps, curvatures, room = np.empty(len(closed)), np.empty(len(closed)), np.zeros(len(closed))
    linear = z, m, driven, start.target, *pulls(system, springs), work
    settling = curves, places, closed, gaps, curvatures, room, contacts.counters
    begin = begin_iteration if geometry.law is None else partial(begin_by_law, geometry.law)
    settle_near(z, *settling, FINDING)
    last, seen = np.inf, dict[bytes, int]()
    for iteration in range(1, iterations + 1):
        before = closed.copy()
        most = 0 if iteration == 1 else FEW_CHANGES
        changes, bordered, change, reduced = begin(*linear, *settling, geometry.columns, most)
        if changes > most:
            chosen = _choose_set(geometry, linear, settling)
            if chosen and _point_in_length(geometry, places, closed):
                raise NotConvergedError("a point of contact becomes a length")
            most = 0 if chosen else len(closed) if iteration <= FREE_CHANGES else 1
            _, bordered, change, reduced = begin(*linear, *settling, geometry.columns, most)
            seen[closed.tobytes()] = seen.get(closed.tobytes(), 0) + 1
            if seen[closed.tobytes()] > RETURNS:
                raise NotConvergedError("the set of closed places returns")
        changed = bool(np.any(closed != before))
        try:
            factors = factors_of(system, driven, work, bordered)
        except SingularError as singular:
            raise NotConvergedError("the system is singular") from singular
        moving = m.beams, m.border, m.turns, m.motions, curves, places, closed, bordered.reached, change
        size, moved = end_iteration(z, *moving, solved_border(factors.factored, factors.order, reduced), room)
        if not np.isfinite(size):
            raise NotConvergedError("the correction is not finite")
        size = size if moved < ARRIVED else max(size, moved)
        arrived = has_converged(size, last)
        last = size
        if arrived and not changed:
            room[:] = 0.0
            settle_near(z, *settling, FINDING)
            if geometry.law is not None:
                geometry.law.write_gaps(z, places, gaps)
            if not change_set(curves, places, closed, gaps, geometry.columns, len(closed)):
                settled = replace(contacts, places=places, closed=closed)
                return Touched(replace(start, z=z), settled, factors, gaps, curvatures, iteration)
    raise NotConvergedError(f"{iterations} iterations did not converge")


def _choose_set(geometry: Geometry, linear: Linear, settling: Settling) -> bool:
    """Close the places that press in the linearised problem and open all others; False where nothing can choose."""
    z, m, curves, places, closed = linear[0], linear[1], *settling[:3]
    allowed, beside, depth = closable(curves, places, closed, geometry.columns)
    leaders = np.arange(len(closed)) + places.shares
    trial = (allowed | (closed & ~beside))[leaders]
    columns, gradient = contact_terms(geometry, z, places, trial)
    bordered, _, reduced = reduced_system(*linear, columns, gradient)
    own = trial & (places.shares == 0)
    pressed = closed_forces(bordered, reduced, m.border.size, places.force[own], np.where(closed, 0.0, depth)[own])
    if pressed is None:
        return False
    closed[:] = False
    closed[own] = pressed
    follow_leaders(places, closed)
    return True


def _point_in_length(geometry: Geometry, places: Places, closed: Flags) -> bool:
    """True if a moving place has closed joints nearby."""
    arcs, joints = arc_of(geometry, places), closed & ~places.moves
    points = np.flatnonzero(closed & places.moves & ~on_edge(geometry.arrays, places))
    near = np.abs(arcs[joints, None] - arcs[points]) < ISOLATED * geometry.arrays.span[places.piece[points]]
    return bool(np.any(near & (places.pair[joints, None] == places.pair[points])))


def arc_of(geometry: Geometry, places: Places) -> Array:
    """Arc lengths of places on their beams: of the feet of corners."""
    corner = on_edge(geometry.arrays, places)
    piece, at = np.where(corner, places.foot, places.piece), np.where(corner, places.eta, places.xi)
    return np.asarray(geometry.arrays.arc[piece] + at * geometry.arrays.span[piece])
