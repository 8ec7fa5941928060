"""Newton's method with an active set of contact places.

Every iteration moves the feet, opens pulling places, closes overlapping places, and solves the linear system of the
closed places.  The first iteration keeps the set: under new targets it is the prediction along the
path's tangent.  A moving place is an unknown; a closed moving place stands for the fixed places within a piece.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cprbm.contact import (
    Contacts,
    Geometry,
    Places,
    choose_sides,
    fixed_places,
    joined,
    move_places,
    near_pairs,
    separations,
    settle,
    taken,
)
from cprbm.equilibrium.factors import Factors, SingularError, Springs, factorise
from cprbm.equilibrium.newton import NotConvergedError, correction, has_converged
from cprbm.equilibrium.system import State, System
from cprbm.equilibrium.touching import Touching, contact_terms, touching
from cprbm_scene.answer import Array, Flags

OVERLAP = 1e-12
"""Overlap, over the longest beam, from which an open place closes: round-off."""

FREE_CHANGES = 12
"""Iterations with any change of the set; later iterations change one place at a time."""

RETURNS = 2
"""Returns of a set after which the iteration counts as a cycle."""

LONGEST_MOVE = 2.0
"""Largest change of a moving place in an iteration, pieces."""

ARRIVED = 1e-6
"""Largest last change of a moving place, pieces."""

FINDING = 40
"""Iterations of moving places on a frozen state."""

REACH = 0.1
"""Distance of two boxes, over the longest beam, up to which a pair has places."""


@dataclass(frozen=True, eq=False)
class Touched:
    """An equilibrium with contacts: state, contacts, factors, gaps and curvatures of the places, iterations."""

    state: State
    contacts: Contacts
    factors: Factors | Touching
    gaps: Array
    curvatures: Array
    iterations: int


def with_fixed_places(geometry: Geometry, z: Array, contacts: Contacts) -> Contacts:
    """Contacts with fixed places at the nearest feet; known places keep force and state, moving places stay.

    A place of a beam in self-contact has the present side.
    """
    old = contacts.places
    near = near_pairs(z, geometry.arrays, geometry.columns, np.full(len(geometry.pairs), REACH), contacts.counters)
    near[old.pair[contacts.closed]] = True
    near[list(contacts.kept_open)] = False
    fixed = fixed_places(geometry, z, contacts.sides, near, contacts.counters)
    known = {_identity(old, k): k for k in range(len(old.pair)) if not old.moves[k]}
    closed = np.zeros(len(fixed.pair), dtype=bool)
    for k in range(len(closed)):
        before = known.get(_identity(fixed, k))
        if before is not None and contacts.closed[before]:
            closed[k], fixed.force[k] = True, old.force[before]
            fixed.foot[k], fixed.eta[k] = old.foot[before], old.eta[before]
    choose_sides(z, geometry.arrays, fixed)
    both = joined(fixed, taken(old, old.moves))
    return replace(contacts, places=both, closed=np.concatenate([closed, contacts.closed[old.moves]]))


def passed_through(geometry: Geometry, before: Array, old: Places, after: Array, new: Places) -> bool:
    """True if a beam in self-contact went through itself: the vector from a foot to a place turned round.

    The side of a beam over itself follows from the state, so that only the way between two states shows a passage.
    """
    first, second = separations(before, geometry.arrays, old), separations(after, geometry.arrays, new)
    number = {_identity(new, k): k for k in range(len(new.pair)) if not new.moves[k]}
    for k in np.flatnonzero((old.curve == old.other) & ~old.moves & (np.hypot(*first.T) < REACH)).tolist():
        at = number.get(_identity(old, k))
        if at is not None and first[k] @ second[at] < 0.0:
            return True
    return False


def _identity(places: Places, k: int) -> tuple[int, int, int, float]:
    return int(places.pair[k]), int(places.curve[k]), int(places.piece[k]), float(places.xi[k])


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
    state = replace(start, z=z)
    places, closed = taken(contacts.places, np.ones(len(contacts.closed), dtype=bool)), contacts.closed.copy()
    gaps, curvatures = np.empty(len(closed)), np.empty(len(closed))
    settle(z, geometry.arrays, places, gaps, curvatures, contacts.counters, FINDING)
    seen: dict[bytes, int] = {}
    last = np.inf
    for iteration in range(1, iterations + 1):
        settle(z, geometry.arrays, places, gaps, curvatures, contacts.counters, 0)
        changed = iteration > 1 and update_set(
            geometry, places, closed, gaps, len(closed) if iteration <= FREE_CHANGES else 1
        )
        if changed:
            seen[closed.tobytes()] = seen.get(closed.tobytes(), 0) + 1
            if seen[closed.tobytes()] > RETURNS:
                raise NotConvergedError("the set of closed places returns")
        factors, size = _iterate(system, geometry, state, places, closed, springs)
        arrived = has_converged(size, last)
        last = size
        if arrived and not changed:
            settle(z, geometry.arrays, places, gaps, curvatures, contacts.counters, FINDING)
            if not update_set(geometry, places, closed, gaps, len(closed)):
                settled = replace(contacts, places=places, closed=closed)
                return Touched(state, settled, factors, gaps, curvatures, iteration)
    raise NotConvergedError(f"{iterations} iterations did not converge")


def _iterate(
    system: System, geometry: Geometry, state: State, places: Places, closed: Flags, springs: Springs | None
) -> tuple[Factors | Touching, float]:
    """One Newton iteration in place: factors before the change, and the size of the change."""
    z, force = state.z, np.zeros(len(closed))
    try:
        free, gradient = factorise(system, state, springs)
        factors: Factors | Touching = free
        if closed.any():
            terms = contact_terms(geometry, z, places, closed)
            factors = touching(free, terms)
            change, by_force = factors.solve(-gradient - terms.gradient, terms.values)
            force[closed & (places.shares == 0)] = by_force
            force[:] = force[np.arange(len(force)) + places.shares] * closed
        else:
            change = free.solve(-gradient)
    except (SingularError, np.linalg.LinAlgError) as singular:
        raise NotConvergedError("the system is singular") from singular
    size, share = correction(system, change)
    moved = move_places(z, geometry.arrays, places, change, force, share, LONGEST_MOVE)
    change[system.rows.first :][~state.driven] = 0.0
    z += share * change
    places.force[:] += share * force
    return factors, size if moved < ARRIVED else max(size, moved)


def update_set(geometry: Geometry, places: Places, closed: Flags, gaps: Array, most: int) -> bool:
    """Close overlapping places, open pulling places, in place; True if the set changed.

    With more changes than ``most`` only the worst overlap closes, or without overlaps the largest pull opens.
    """
    own = places.shares == 0
    leaders = np.arange(len(closed)) + places.shares
    gap = gaps.copy()
    np.add.at(gap, leaders[~own], gaps[~own])
    beside, depth = beside_points(geometry, places, closed)
    thick = geometry.arrays.thickness[places.piece] + geometry.arrays.thickness[places.foot] > 0.0
    opens = closed & own & ((places.force < 0.0) | beside)
    closes = own & ~closed & ~beside & (gap < -OVERLAP - depth) & (thick | ~places.at_point)
    if opens.sum() + closes.sum() > most:
        worst = int(np.argmin(np.where(closes, gap, 0.0))) if closes.any() else int(np.argmin(places.force * opens))
        only = np.arange(len(closed)) == worst
        opens, closes = opens & only, closes & only
    closed[opens], closed[closes] = False, True
    closed[:] = closed[leaders]
    places.force[~closed] = 0.0
    return bool(opens.any() or closes.any())


def arc_of(geometry: Geometry, places: Places) -> Array:
    """Arc lengths of places on their own curves."""
    return np.asarray(geometry.arrays.arc[places.piece] + places.xi * geometry.arrays.span[places.piece])


def beside_points(geometry: Geometry, places: Places, closed: Flags) -> tuple[Flags, Array]:
    """Fixed places within a piece of a closed moving place, and the overlap of every pair's point contact.

    Outside of the point the other places of the pair may overlap by as much without contact.
    """
    beside, depth, arcs = np.zeros(len(closed), dtype=bool), np.zeros(len(closed)), arc_of(geometry, places)
    arrays = geometry.arrays
    middle = 0.5 ** np.arange(arrays.lost.shape[1])
    for k in np.flatnonzero(places.moves & closed):
        pair = ~places.moves & (places.pair == places.pair[k])
        near = np.abs(arcs - arcs[k]) < arrays.span[places.piece[k]]
        beside |= pair & (places.curve == places.curve[k]) & near
        lost = (arrays.lost[places.piece[k]] + arrays.lost[places.foot[k]]) @ middle
        depth[pair] = np.maximum(depth[pair], lost * places.force[k])
    return beside, depth
