"""Newton's method with an active set of contact places.

Every iteration moves the feet, opens pulling places, closes overlapping places, and solves the linear system of the
closed places.  Where the set returns, the linearised problem chooses the set.  The first iteration keeps the set:
under new targets it is the prediction along the path's tangent.  A moving place is an unknown; a closed moving place
stands for the fixed places within a link.

**Linearised problem**, a linear complementarity problem in the contact forces.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
F        contact forces of all places that may close, after the correction
w        gaps of the linearised problem
G, r     border with the columns of these places, and its load; index f: forces, o: all other unknowns
M, q     compliance of the forces, gaps without any force
L        Cholesky's factor of M
=======  ====================================================================================

The elimination of all other unknowns leaves

    w = q + M F,    F ≥ 0,    w ≥ 0,    F w = 0,    M = G_fo G_oo⁻¹ G_of − G_ff.

M is positive definite where the state without contacts is a minimum.  Then F is the least-squares solution with F ≥ 0
of Lᵀ F = −L⁻¹ q (Lawson and Hanson 1974), and the solution is unique.  Newton's method with this set in every iteration
is the method of Josephy (1979) for F ≥ 0, g ≥ 0.  An exchange of all places with a wrong sign instead may return to the
same sets: the forces of a zone that is too long alternate in sign from joint to joint.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError, cholesky, solve_triangular

from cprbm.contact import (
    FINDING,
    REACH,
    Contacts,
    CurveArrays,
    Geometry,
    Places,
    contact_places,
    copied,
    matched,
    on_edge,
    separations,
    settle_near,
    sweeps_any_point,
)
from cprbm.equilibrium.columns import contact_terms
from cprbm.equilibrium.factors import SingularError, Springs, factored_border, pulls, solved_border
from cprbm.equilibrium.iteration import (
    LONGEST_MOVE,
    OVERLAP,
    arcs_of,
    change_set,
    closable,
    follow_leaders,
    newton_step,
    settle_set,
    step_with_columns,
)
from cprbm.equilibrium.linear import Bordered, Numbers, reduced_system
from cprbm.equilibrium.neighbours import ISOLATED
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Array, Flags, Ints

CLOSE = 1e-9
"""Correction of angles (rad) and positions (longest beam) whose square is below round-off."""

ROUNDED = 1e-6
"""Largest correction that round-off leaves on the finest meshes."""

SHRINKING = 0.25
"""Ratio of corrections above which an iteration below ``ROUNDED`` no longer converges: round-off is reached."""

FREE_CHANGES = 12
"""Iterations in which all places with a wrong sign change."""

RETURNS = 2
"""Returns of a set after which the linearised problem chooses."""

FEW_CHANGES = 4
"""Places that may change together where the linearised problem is not convex."""

NEAR = 2.0
"""Largest gap of a place in the linearised problem, over the deepest overlap: a farther place may follow later."""

SOFT = 1e-14
"""Compliance of every place over the largest: two places at one point share their force."""

ARRIVED = 1e-6
"""Largest last change of a moving place, pieces."""

Linear = tuple[Array, Numbers, Flags, Array, Array, Array]
Settling = tuple[CurveArrays, Places, Flags, Array, Array, Array, Ints, Ints, Flags]


class NotConvergedError(Exception):
    """Newton's method found no equilibrium."""


class ContactClosesError(Exception):
    """Pairs that stay open overlap in the equilibrium; the pairs ``met`` overlap there or in an iteration."""

    def __init__(self, overlapping: Ints, met: Ints) -> None:
        super().__init__("a contact closes")
        self.overlapping, self.met = frozenset(overlapping.tolist()), frozenset(met.tolist())


@dataclass(frozen=True, eq=False)
class Touched:
    """An equilibrium: state, gaps and curvatures of the places, number of iterations."""

    state: State
    gaps: Array
    curvatures: Array
    iterations: int


def with_fixed_places(geometry: Geometry, z: Array, contacts: Contacts, *, turning: bool = False) -> Contacts:
    """Contacts with fixed places at the nearest feet; known places keep force and state, moving places stay.

    With ``turning`` known open places that came round an end change the side; not within a step, where places overlap.
    """
    places, closed = contact_places(
        z,
        geometry.arrays,
        geometry.sites,
        contacts.sides,
        contacts.corner_sides,
        contacts.places,
        contacts.closed,
        contacts.of_pairs(contacts.kept_open) | (not turning),
        contacts.counters,
    )
    # a joint that shared a force may have been replaced by a point of contact
    follow_leaders(places, closed)
    return replace(contacts, places=places, closed=closed)


def passed_through(geometry: Geometry, before: Array, old: Places, after: State) -> bool:
    """True if a beam went through itself or over a circle, a corner or an end: the vector to a place turned round.

    The gaps of a beam to itself and to a point have no sign: only the way between two states shows a passage.  Beams of
    pairs that are kept open overlap until the closing is located.
    """
    points, arrays, z, contacts = geometry.points, geometry.arrays, after.z, after.contacts
    if len(points) and not contacts.kept_open and sweeps_any_point(before, z, arrays, points, contacts.counters):
        return True
    unsigned = (old.curve == old.other) & ~old.moves
    if not unsigned.any():
        return False
    new = with_fixed_places(geometry, z, contacts).places
    first, second, number = separations(before, arrays, old), separations(z, arrays, old), matched(arrays, old, new)
    near = np.flatnonzero((number >= 0) & (np.hypot(*first.T) < REACH))
    # near the beam a place slides away from the old foot, far from the beam the foot leaps to another part
    second[near] = separations(z, arrays, new)[number[near]]
    return bool(np.any(np.einsum("ij,ij->i", first, second)[unsigned] < 0.0))


def solve_set(
    system: System,
    start: State,
    iterations: int,
    springs: Springs | None = None,
    awaited: frozenset[int] = frozenset(),
) -> Touched:
    """Equilibrium near a state under the state's targets, and the set of closed places.

    Args:
        system: the mechanism.
        start: state with targets; not changed.
        iterations: largest number of Newton iterations.
        springs: springs on the links' angles, of a descent.
        awaited: pairs that stay open.

    Raises:
        ContactClosesError: awaited pairs overlap in the equilibrium or in an iteration.
        NotConvergedError: no equilibrium was found, the set of closed places returns, or a point becomes a length.
    """
    geometry, contacts, z, driven = system.geometry, start.contacts, start.z.copy(), start.driven
    z[system.rows.first :][~driven] = start.target[~driven] * ~start.repeated[~driven]
    m, curves = system.numbers, geometry.arrays
    places, closed = copied(contacts.places), contacts.closed.copy()
    # the fixed places of pairs that stay open wait for the end of the iterations
    passive = np.where(contacts.of_pairs(contacts.kept_open) & ~places.moves, np.inf, 0.0)
    gaps, curvatures, room = np.full(len(closed), np.inf), np.empty(len(closed)), passive.copy()
    linear = z, m, driven, start.target, *pulls(system, springs)
    waits, met = contacts.of_pairs(contacts.kept_open | awaited), np.zeros(len(closed), dtype=bool)
    settling = curves, places, closed, gaps, curvatures, room, contacts.counters, geometry.sites.columns, waits
    settle_near(z, *settling[:7], FINDING)
    seen, last, returned = dict[bytes, int](), np.inf, False
    for iteration in range(1, iterations + 1):
        before = closed.copy()
        if returned:
            _choose_set(geometry, linear, settling)
        size, moved = _step(geometry, linear, settling, settles=iteration > 1 and not returned)
        met |= waits & (gaps < -OVERLAP)
        changed = bool(np.any(closed != before))
        if changed:
            times = seen[closed.tobytes()] = seen.get(closed.tobytes(), 0) + 1
            if times > 2 * RETURNS:
                raise NotConvergedError("the set of closed places returns")
            returned = returned or times > RETURNS or iteration >= FREE_CHANGES
        if not np.isfinite(size) or moved > LONGEST_MOVE:
            raise NotConvergedError("the correction is not finite, or a point of contact moves far along the beam")
        size = size if moved < ARRIVED else max(size, moved)
        arrived, last = size < CLOSE or SHRINKING * last < size < ROUNDED, size
        if arrived and not changed:
            room[:], rest = passive, arcs_of(curves, places)
            wrong = _settle_set(geometry, z, settling, len(closed), FINDING)
            leaves = np.abs(arcs_of(curves, places) - rest) > ARRIVED * curves.span[places.piece]
            if wrong == 0 and not np.any(leaves & closed & ~on_edge(curves, places)):  # no place slides off a maximum
                overlaps = waits & (gaps < -OVERLAP)
                met |= overlaps
                if awaited.intersection(places.pair[met].tolist()):
                    raise ContactClosesError(places.pair[overlaps], places.pair[met])
                known = replace(contacts, places=places, closed=closed)
                return Touched(replace(start, z=z, contacts=known), gaps, curvatures, iteration)
    raise NotConvergedError(f"{iterations} iterations did not converge")


def _settle_set(geometry: Geometry, z: Array, settling: Settling, most: int, steps: int = 0) -> int:
    """Settle places in at most ``steps`` and change the set; the number of places with a wrong sign."""
    if geometry.law is None:
        return settle_set(z, *settling, most, steps)
    curves, places, closed, gaps, *_, columns, waits = settling
    settle_near(z, *settling[:7], steps)
    geometry.law.write_gaps(z, places, gaps)
    return change_set(curves, places, closed, gaps, columns, waits, most)


def _step(geometry: Geometry, linear: Linear, settling: Settling, *, settles: bool) -> tuple[float, float]:
    """Sizes of a Newton step, :func:`cprbm.equilibrium.iteration.step_with_columns`, after a change of the set.

    Raises:
        NotConvergedError: the system is singular.
    """
    z, (curves, places, closed, gaps, curvatures, room, counters, pairs, waits) = linear[0], settling
    try:
        if geometry.law is None:
            known = gaps, curvatures, room, counters
            return newton_step(*linear, curves, places, closed, *known, pairs, waits, int(settles))
        if settles:
            _settle_set(geometry, z, settling, len(closed))
        return step_with_columns(*linear, curves, places, closed, room, *contact_terms(geometry, z, places, closed))
    except np.linalg.LinAlgError as singular:
        raise NotConvergedError("the system is singular") from singular


def _choose_set(geometry: Geometry, linear: Linear, settling: Settling) -> None:
    """Close the places that press in the linearised problem and open all others, where a place has a wrong sign.

    Where the problem is not convex, a few places change together, or the worst place alone.

    Raises:
        NotConvergedError: joints close beside a moving place.
    """
    wrong = _settle_set(geometry, linear[0], settling, 0)
    if not wrong:
        return
    z, m, curves, places, closed, gaps = linear[0], linear[1], *settling[:4]
    allowed, beside, depth = closable(curves, places, closed, settling[-2])
    leaders = np.arange(len(closed)) + places.shares
    trial = ((allowed & ~settling[-1] & (gaps < -NEAR * gaps.min(initial=0.0))) | (closed & ~beside))[leaders]
    columns, gradient = contact_terms(geometry, z, places, trial)
    bordered, _, reduced = reduced_system(*linear, columns, gradient)
    own = trial & (places.shares == 0)
    pressed = closed_forces(bordered, reduced, m.border.size, places.force[own], np.where(closed, 0.0, depth)[own])
    if pressed is None:
        _settle_set(geometry, z, settling, wrong if wrong <= FEW_CHANGES else 1)
        return
    closed[:] = False
    closed[own] = pressed
    follow_leaders(places, closed)
    arcs, joints = arcs_of(curves, places), closed & ~places.moves
    points = np.flatnonzero(closed & places.moves & ~on_edge(curves, places))
    near = np.abs(arcs[joints, None] - arcs[points]) < ISOLATED * curves.link[places.piece[points]]
    if np.any(near & (places.pair[joints, None] == places.pair[points])):
        raise NotConvergedError("a point of contact becomes a length")


def closed_forces(bordered: Bordered, reduced: Array, size: int, forces: Array, room: Array) -> Flags | None:
    """Which forces of a border press in the linearised problem; None where the problem is not convex.

    Args:
        bordered, reduced: border with the columns of all places that may close, and its load.
        size: number of border columns without contacts.
        forces: present forces (forces,).
        room: allowed overlaps (forces,).
    """
    from scipy.optimize import nnls  # sets that settle at once load no optimisers

    count = len(forces)
    if count == 0:
        return np.zeros(0, dtype=bool)  # SciPy's nnls frees its memory twice without unknowns
    G = np.tril(bordered.border) + np.tril(bordered.border, -1).T
    mine = np.zeros(len(G), dtype=bool)
    mine[size : size + count] = True
    beside = G[np.ix_(mine, ~mine)]
    try:
        solved = solved_border(*factored_border(G[np.ix_(~mine, ~mine)]), np.column_stack([beside.T, reduced[~mine]]))
        M = beside @ solved[:, :-1] - G[np.ix_(mine, mine)]
        L = cholesky(M + SOFT * np.max(np.diag(M), initial=0.0) * np.eye(count), lower=True)
        q = reduced[mine] - beside @ solved[:, -1] - M @ forces + room
        return np.asarray(nnls(L.T, -solve_triangular(L, q, lower=True))[0] > 0.0)
    except (SingularError, LinAlgError, ValueError, RuntimeError):
        # no minimum without contacts, numbers without a limit, or no least-squares solution
        return None
