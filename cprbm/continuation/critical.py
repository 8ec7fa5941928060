"""Where a branch of minima ends, and why: critical points, and beams that cannot change their length.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
κ, φ     smallest curvature of the energy, mode
τ        tangent dθ/dt of the branch
t_c      fraction of the way at the critical point
n, ν     forces of the links and multipliers of the rows in balance without any load
N        part of n along the link
v, v_t   stepped value, value of the taut state
F        largest force of a link
=======  ====================================================================================

At a fold the branch turns back: τ grows along φ, and κ² is linear in t_c − t.  At a bifurcation another branch
crosses: τ has no part in φ, and κ is linear in t_c − t.  An imperfection smaller than the least step bends the branch
to one side: τ grows along φ there, but κ is linear before.

After the opening of a stop or a contact the state may be no minimum: κ is positive just before, and the moment or the
force vanishes.

Beams may be unable to change their length.  A straight beam between held ends has forces n, ν, and a repeated row.
Their work in a change df* of the rows, −Σ ν df*, is Σ n times the elongation asked of the beam.  A beam in bending
alone cannot become longer; under shortening the beam buckles to either side, and the straight branch ends in a
bifurcation at once.  A bent beam may be drawn taut.  There F grows like (v_t − v)^−p, so that F/F′ = (v_t − v)/p falls
evenly to zero.  No force with a limit has this law.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial

import numpy as np

from cprbm.contact import taken
from cprbm.continuation.closing import Pressed, pressing
from cprbm.continuation.path import Reached, Way, tangent
from cprbm.equilibrium import Mode, NotConvergedError, Solved, at_state, balanced_forces, blocked, softest
from cprbm_scene import BeamContact, Loss, SelfContact
from cprbm_scene.answer import Array

FOLDING = 0.5
"""Part of τ along φ from which the branch turns back: a fold has all of it, a bifurcation nothing."""

STILL = 1e-8
"""Turn of a link over the way, rad, times κ, below which no load acts along the mode: round-off is less."""

NEAR = 50.0
"""Times as far as the bracket is wide: farther away no zero of κ explains the end of the branch."""

APART = 2.0
"""Times as far as the bracket is wide: the earlier state from which κ is extrapolated."""

EARLIER, EVEN = 4.0, 0.1
"""Times as far as the bracket is wide of a third state, and difference of two zeros of κ, over the states' distance."""

TAUT, GROWN = 4, 4.0
"""Minima over which F grows so many times before it may be said to have no limit."""

ASKED = 1e-9
"""Elongation, over the longest beam, below which a way asks nothing of a straight beam."""

EXPLAINED = 2.0
"""Times as far as the refused step: a limit farther away does not explain the refusal."""


@dataclass(frozen=True, eq=False)
class CriticalPoint:
    """End of a branch.

    Attributes:
        t, width: fraction of the way, and the width of its bracket.
        loss, what: how stability is lost, and of which stop or contact.
        last: the last minimum.
        curvature: smallest curvature there.
        start: the state from which the energy falls: the last minimum, or the state after an opening.
        left: smallest curvature once a stop or contact holds no more; of a fold or a bifurcation the curvature itself.
    """

    t: float
    width: float
    loss: Loss
    what: str
    last: Solved
    start: Solved
    curvature: float
    left: float

    @property
    def sentence(self) -> str:
        """How the branch ends, for people."""
        return f"{self.loss.value} ('{self.what}')" if self.what else self.loss.value

    @property
    def has_two_ways(self) -> bool:
        """True at a bifurcation, and at a slip off a beam's end: the beam may come back on either side of the other."""
        contact = self.last.system.mechanism.scene.contacts.get(self.what)
        return self.loss is Loss.BIFURCATION or (
            self.loss is Loss.SLIP and isinstance(contact, BeamContact | SelfContact)
        )


def opened(before: Solved, after: Solved | None, t: float, loss: Loss, what: str, width: float = 0.0) -> CriticalPoint:
    """Critical point at an opening stop or contact, with the states before and after; None where a body is loose."""
    kept, left = softest(before).curvature, softest(after).curvature if after else 0.0
    return CriticalPoint(t, width, loss, what, before, after or before, kept, left)


def contact_ends(trail: list[Reached], beyond: float) -> CriticalPoint | None:
    """The opening of a contact without which the last minimum is none, or the slip of a contact off an end; or None.

    The force of a contact that opens decreases to zero, and the distance to the end of a beam before a slip.

    Args:
        trail: last minima on the branch in order.
        beyond: fraction of the way at which no minimum was found that continues the branch.
    """
    last, width = trail[-1], beyond - trail[-1].t
    geometry, earlier = last.solved.system.geometry, _earlier(trail, width)
    if earlier is None:
        return None
    pairs, places = sorted(pressing(last.solved)), last.solved.state.contacts.places
    closed = taken(places, last.solved.state.contacts.closed)
    lifted = [*map(Pressed, pairs), *map(Pressed, closed.pair.tolist(), closed.piece.tolist())]
    ends = [(each, each.force, Loss.CONTACT) for each in lifted]
    for ended, value, loss in ends + [(Pressed(pair), partial(_to_end, pair=pair), Loss.SLIP) for pair in pairs]:
        zero = _vanishes(value, earlier, last)
        if zero - last.t <= NEAR * width:
            after = _without(last.solved, ended)
            if after is None or blocked(after).lost or loss is Loss.SLIP:
                return opened(last.solved, after, zero, loss, geometry.pairs[ended.pair].name, width)
    return None


def _without(solved: Solved, lifted: Pressed) -> Solved | None:
    """The state without closed places, of which the force is about zero; None where nothing else holds a body."""
    state, contacts = solved.state, solved.state.contacts
    closed = contacts.closed & ~lifted.places(solved)
    try:
        return at_state(solved.system, replace(state, contacts=replace(contacts, closed=closed)))
    except NotConvergedError:  # the Hessian is singular
        return None


def _vanishes(value: Callable[[Solved], float], earlier: Reached, last: Reached) -> float:
    """Fraction of the way at which a value of two states, continued linearly, is zero; inf without a decrease."""
    now, before = value(last.solved), value(earlier.solved)
    return last.t + now * (last.t - earlier.t) / (before - now) if now < before < np.inf else np.inf


def _to_end(solved: Solved, pair: int) -> float:
    """Least distance of the feet of a pair's closed places from an end of the beam that they lie on; inf without."""
    geometry, contacts = solved.system.geometry, solved.state.contacts
    places, arrays = taken(contacts.places, contacts.pressing(pair)), geometry.arrays
    arcs = arrays.arc[places.foot] + places.eta * arrays.span[places.foot]
    last = arrays.last[places.other]
    length = arrays.arc[last] + arrays.span[last]
    on_beam = arrays.angle[places.foot] >= 0
    return float(np.min(np.minimum(arcs, length - arcs)[on_beam], initial=np.inf))


def _earlier(trail: list[Reached], width: float) -> Reached | None:
    """An earlier minimum some widths of the bracket away, else the first; None without any."""
    return next(
        (one for one in reversed(trail) if trail[-1].t - one.t >= APART * width), trail[0] if len(trail) > 1 else None
    )


def critical_point(trail: list[Reached], beyond: float, change: Array) -> CriticalPoint | None:
    """The fold or bifurcation between the last minimum of a branch and ``beyond``; None without an explanation.

    Args:
        trail: last minima on the branch in order.
        beyond: fraction of the way at which no minimum was found that continues the branch.
        change: of the targets on the whole way.
    """
    last, width = trail[-1], beyond - trail[-1].t
    mode, earlier, first = softest(last.solved), _earlier(trail, width), _earlier(trail, EARLIER * width)
    if earlier is None or first is None:
        return None
    curvature = cache(lambda solved: softest(solved).curvature)
    zero = _vanishes(curvature, earlier, last)
    even = abs(zero - _vanishes(curvature, first, earlier)) < EVEN * (earlier.t - first.t)
    fold = _along(last.solved, mode, change) > FOLDING and not even
    zero = _vanishes(lambda solved: curvature(solved) ** 2, earlier, last) if fold else zero
    if not zero - last.t <= NEAR * width:
        return None
    return CriticalPoint(
        zero,
        width,
        Loss.FOLD if fold else Loss.BIFURCATION,
        "",
        last.solved,
        blocked(last.solved),
        mode.curvature,
        mode.curvature,
    )


def _along(solved: Solved, mode: Mode, change: Array) -> float:
    """Part of the branch's tangent along the mode, from 0 to 1."""
    system = solved.system
    tau, phi = tangent(solved, change)[system.angles], mode.turns
    if float(np.abs(tau).max()) * mode.curvature < STILL or not np.any(phi):
        return 0.0
    sizes = np.sqrt((system.metric @ tau**2) * (system.metric @ phi**2))
    return float(abs(system.metric @ (tau * phi)) / sizes)


def locked_beam(solved: Solved, change: Array) -> tuple[str, float]:
    """Name of the straight beam in balance with a repeated row, and the elongation asked of straight beams.

    The elongation belongs to a ``change`` of the targets, over the longest beam.  Without a repeated row the name is
    empty.
    """
    system, repeated = solved.system, np.flatnonzero(solved.state.repeated)
    if not len(repeated):
        return "", 0.0
    forces = balanced_forces(solved, int(repeated[0]))
    angles = solved.state.z[system.angles]
    pull = (_forces(solved, forces) * np.column_stack([np.cos(angles), np.sin(angles)])).sum(axis=1)
    largest = np.maximum.reduceat(np.abs(pull), system.beams.first_link)
    longer = float(-(forces[system.rows.first :] @ change) / (system.metric @ pull) * len(pull))
    return list(system.mechanism.chains)[int(np.argmax(largest))], longer


def taut_value(trail: list[Reached], way: Way, refused: float) -> float | None:
    """v_t from the last minima before a refused fraction of the way; None where forces have a limit."""
    if len(trail) < TAUT:
        return None
    v = np.array([way.value(one.t) for one in trail[-TAUT:]])
    F = np.array([float(np.abs(_forces(one.solved, one.solved.state.z)).max()) for one in trail[-TAUT:]])
    if not np.all(np.diff(F) > 0.0) or F[-1] < GROWN * F[0]:
        return None
    ratio, middle = np.abs(0.5 * (F[1:] + F[:-1]) * np.diff(v) / np.diff(F)), 0.5 * (v[1:] + v[:-1])
    if not np.all(np.diff(ratio) < 0.0):
        return None
    limit = middle[-1] + ratio[-1] * (middle[-1] - middle[-2]) / (ratio[-2] - ratio[-1])
    return float(limit) if 0.0 < (limit - v[-1]) / (way.value(refused) - v[-1]) <= EXPLAINED else None


def _forces(solved: Solved, vector: Array) -> Array:
    """Forces (links, 2) in a vector of unknowns."""
    return np.asarray(vector[solved.system.links.first[:, None] + [2, 3]])
