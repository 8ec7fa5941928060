"""Smallest curvature of the potential energy on the feasible directions, and the mode.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
S        block of the angles in the inverse of the Hessian of the Lagrangian
M        lengths of the links: the metric is ∫ dθ² ds
κ, φ     √M S √M x = x/κ, φ = x/√M
=======  ====================================================================================

S vanishes on infeasible directions.  The largest eigenvalue belongs to the smallest curvature of a minimum.  At other
states the most negative eigenvalue belongs to the negative curvature nearest to zero.  κ is in EI/ℓ².

A touching place without force permits motions in a single sense.  A mode of falling energy counts where no touching gap
closes along φ, or no touching gap closes along −φ.  Otherwise the place with the fastest gap closes, for the next mode.

A beam that lies flat on an edge presses at both ends of the length alone.  The closed places between are idle: a small
imperfection and errors of the discretisation leave a faint force there, and a small disturbance makes the flat part
buckle off.  Idle places may open.
"""

from dataclasses import dataclass, replace

import numpy as np

from cprbm.contact import TOUCHING, Contacts
from cprbm.equilibrium.columns import gap_rates
from cprbm.equilibrium.iteration import arcs_of, closable
from cprbm.equilibrium.neighbours import with_minima
from cprbm.equilibrium.solving import Solved, at_state
from cprbm_scene.answer import Array, Flags

ACCURACY = 1e-6
"""Relative accuracy of a curvature: it judges and extrapolates, and no result contains it."""

STIFF = 1e-3
"""Share of the stiffest spring's compliance below which a compliance is round-off: no direction is free."""

NEUTRAL = 1e-9
"""Curvature, in EI/ℓ², that counts as none: round-off of a mechanism that moves without bending a beam is 1e-13."""

VECTORS = 6
"""Lanczos vectors before a restart: the softest mode is well apart from the others."""

IDLE = 1e-2
"""Sum of idle places' forces over all forces of the pair: an imperfection of 1e-3 L presses a flat strip by 1e-3."""

UNMOVED = 1e-4
"""Rate of a gap along a mode, over the largest rate of an unknown, below which the gap stays."""


@dataclass(frozen=True, eq=False)
class Mode:
    """Smallest ``curvature`` κ and the turns φ (links,) of the mode."""

    curvature: float
    turns: Array


def softest(solved: Solved) -> Mode:
    """Smallest curvature and mode at a state; infinite if no direction is free."""
    return _softest(blocked(solved))


def blocked(solved: Solved) -> Solved:
    """The state with open idle places, and with the closed touching places that block a mode in both senses."""
    system, state = solved.system, solved.state
    places, closed = state.contacts.places, state.contacts.closed.copy()
    arcs, order = arcs_of(system.geometry.arrays, places), np.argsort(places.force)
    for pair in set(places.pair[closed].tolist()):
        mine = order[(closed & (places.pair == pair))[order]]
        between = mine[(arcs[mine] > arcs[mine].min()) & (arcs[mine] < arcs[mine].max())]
        closed[between] = np.cumsum(places.force[between]) >= IDLE * places.force[mine].sum()
    if np.any(closed != state.contacts.closed):
        # places with a shared force open together
        shared = closed[np.arange(len(closed)) + places.shares]
        solved = at_state(system, replace(state, contacts=replace(state.contacts, closed=shared)))
    if not solved.lost or not system.geometry.pairs:
        return solved
    contacts, touching = _touching(solved)
    while solved.lost and touching.any():
        load = np.zeros(system.size)
        load[system.angles] = system.metric * _softest(solved).turns
        motion = solved.response(load)
        rates = gap_rates(system.geometry, state.z, contacts.places, touching, motion)
        least = UNMOVED * np.abs(motion[system.motions]).max()
        if not rates.min() < -least < least < rates.max():
            break
        place = np.flatnonzero(touching)[np.argmax(np.abs(rates))]
        contacts.closed[place], touching[place] = True, False
        solved = at_state(system, replace(state, contacts=contacts))
    return solved


def with_touching(solved: Solved) -> Solved:
    """The state with all touching places closed where a motion costs no energy; else the state.

    Raises:
        NotConvergedError: the touching places repeat one another.
    """
    if softest(solved).curvature > NEUTRAL:
        return solved
    contacts, touching = _touching(solved)
    return at_state(solved.system, replace(solved.state, contacts=replace(contacts, closed=contacts.closed | touching)))


def _touching(solved: Solved) -> tuple[Contacts, Flags]:
    """Contacts with places at touching minima between joints, and the touching open places."""
    geometry, z, contacts = solved.system.geometry, solved.state.z, solved.state.contacts
    places, gaps = with_minima(geometry, z, contacts, solved.gaps, range(len(geometry.pairs)))
    closed = np.concatenate([contacts.closed, np.zeros(len(places.pair) - len(contacts.closed), dtype=bool)])
    every = replace(contacts, places=places, closed=closed)
    open_places = closable(geometry.arrays, places, closed, geometry.sites.columns)[0] & ~closed
    return every, open_places & (places.shares == 0) & (np.abs(gaps) < TOUCHING)


def _softest(solved: Solved) -> Mode:
    """Smallest curvature and mode with the closed places of a state."""
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh  # scenes that end at once load no ARPACK

    system = solved.system
    root, count = np.sqrt(system.metric), len(system.metric)

    def turned(x: Array) -> Array:
        load = np.zeros(system.size)
        load[system.angles] = root * x.ravel()
        return np.asarray(root * solved.response(load)[system.angles])

    compliance = LinearOperator((count, count), matvec=turned, dtype=float)
    start, largest = root * (1.0 + np.cumsum(system.metric)), "SA" if solved.lost else "LA"
    try:
        found = eigsh(compliance, k=1, which=largest, v0=start, ncv=min(VECTORS, count), tol=ACCURACY)
    except ArpackNoConvergence:
        return Mode(float("nan"), np.zeros(count))
    value, vector = float(found[0][0]), found[1][:, 0]
    stiffest = float(np.max(np.maximum(system.metric[:-1], system.metric[1:]))) / float(np.max(system.joints.stiffness))
    if abs(value) <= STIFF * stiffest:
        return Mode(float("inf"), np.zeros(count))
    return Mode(1.0 / value, vector / root)
