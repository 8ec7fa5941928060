"""Where a branch of minima ends, and why: from the last states before, and what goes to zero there.

==========  =====================================================================================
v, v_c      value of what is stepped; that at which the branch ends
κ, φ        smallest curvature of the energy and its direction, :mod:`cprbm.stability`
F           resultant of a contact, moment of a stop: sum of its multipliers
τ           direction of the branch, dθ/dv
==========  =====================================================================================

* A contact or stop lets go: F goes to zero, linearly, with κ still positive; without it κ is negative.
* An end slips off another, or off a corner: what it has left to go there goes to zero, linearly, with F and κ still
  positive.
* A fold: the branch turns back.  κ² is linear in v_c − v, and τ turns into φ.
* A bifurcation: another branch crosses.  κ is linear in v_c − v; τ has no part in φ.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from cprbm.edge import Edge
from cprbm.mechanism import Mechanism
from cprbm.nearest import Pair
from cprbm.point import Point
from cprbm.slipping import left_of_side, left_to_go
from cprbm.stability import Softest, released, softest
from cprbm_scene import Certificate, Loss
from cprbm_scene.answer import Array

Row = tuple[str, int, int]  # its contact or stop, what it is there, and which of those that are the same there

LEAST = 2  # minima from which the end of a branch can be told
TURNED = 0.5  # part of τ in φ: a fold has all of it, a bifurcation nothing
STILL = 1e-6  # rad: a fold, where the branch moves ever faster, turns links by more between two states
NEAR = 20.0  # times as far as the branch's end is known from the last state: what goes to zero does so within
CLEARLY = 3.0  # times as near what is found: the law that foretells it
SPREAD = 2.0  # times as far from the end as the last state is the one that a law is continued from


@dataclass(frozen=True, slots=True)
class Minimum:
    """A minimum on the branch: the value v, its state, and its certificate."""

    value: float
    point: Point
    certificate: Certificate

    @property
    def curvature(self) -> float:
        """κ."""
        return self.certificate.smallest_curvature


@dataclass(frozen=True, slots=True)
class BranchEnd:
    """Where and how a branch ends.

    Attributes:
        value, uncertainty: v_c and how far it may be from there.
        loss, what: how, and of which contact or stop.
        curvature, left: κ at the end, and once nothing holds there.
        direction: in which the curvature is lost (n_links,).
        far: whether it is known already that nothing beside it is what it leads to.
    """

    value: float
    uncertainty: float
    loss: Loss
    what: str
    curvature: float
    left: float
    direction: Array
    far: bool = False


def told(loss: Loss, what: str) -> str:
    """How a branch ends, for people."""
    return f"{loss.value} ('{what}')" if what else loss.value


def branch_end(mechanism: Mechanism, trail: list[Minimum], beyond: float) -> BranchEnd | None:
    """Why there is no minimum near the last of the ``trail`` at the value ``beyond``; None where nothing says it.

    Args:
        mechanism: what was followed.
        trail: minima on the branch in order; the last are near its end.
        beyond: the nearest value at which no minimum was found that continues the branch.
    """
    if len(trail) < LEAST:
        return None
    last = trail[-1]
    width = beyond - last.value
    before = _from_afar(trail, beyond, SPREAD * abs(width)) or trail[0]
    if before is last:
        return None
    rows = _rows(last.point)
    let_go = _let_go(mechanism, last, before, width, _whole([*rows, *_rows(before.point)]))
    let_go = let_go or _slipped(mechanism, trail, before, width)
    if let_go is not None:
        return let_go
    soft = softest(mechanism.problem, last.point)
    fold = _part_in(mechanism, last, before, soft) > TURNED and not _falls_evenly(trail, before, beyond)
    power = 2.0 if fold else 1.0
    zero = _continued(last.value, last.curvature**power, before.value, before.curvature**power)
    if zero is not None and -1.0 <= (zero - last.value) / width <= NEAR:
        loss = Loss.FOLD if fold else Loss.BIFURCATION
        return BranchEnd(zero, abs(width), loss, "", last.curvature, last.curvature, soft.direction)
    # one place of several that a contact has: in a zone others take over, and κ falls little by little
    return _let_go(mechanism, last, before, width, [frozenset({row}) for row in rows])


def at_rest(mechanism: Mechanism, point: Point, value: float) -> BranchEnd:
    """The end where a beam is straight and is asked to become shorter, :mod:`cprbm.locking`: in this state itself."""
    soft = softest(mechanism.problem, point)
    return BranchEnd(value, 0.0, Loss.BIFURCATION, "", soft.curvature, soft.curvature, soft.direction)


def _let_go(
    mechanism: Mechanism, last: Minimum, before: Minimum, width: float, holders: Iterable[frozenset[Row]]
) -> BranchEnd | None:
    """The end at which one of the ``holders``, rows that press together, has no force left and κ < 0 without it."""
    for rows in holders:
        force, earlier = _force(last.point, rows), _force(before.point, rows)
        zero = _continued(last.value, force, before.value, earlier)
        if force <= 0.0 or zero is None or not 0.0 <= (zero - last.value) / width <= NEAR:
            continue
        others = np.array([row not in rows for row in _rows(last.point)], dtype=bool)
        soft = softest(mechanism.problem, released(last.point, others))
        if soft.curvature <= 0.0:
            (name,) = {contact for contact, _, _ in rows}
            loss = Loss.STOP if name in mechanism.stops else Loss.CONTACT
            return BranchEnd(zero, abs(width), loss, name, last.curvature, soft.curvature, soft.direction)
    return None


def _slipped(mechanism: Mechanism, trail: list[Minimum], before: Minimum, width: float) -> BranchEnd | None:
    """The end at which an end of a beam has come past the one of another on which it presses, or past a corner.

    A foot is one by a little more than that, so that the last minima may lie beyond.
    """
    last = trail[-1]
    for name in sorted(last.point.rows.pressing(last.point.lam)):
        if (left := _left(mechanism, name, last.point)) is None:
            continue
        here, there, behind, uncertain = last, left, before, abs(width)
        for one in reversed(trail[:-1]) if left <= 0.0 else ():
            behind, uncertain = one, uncertain + abs(here.value - one.value)
            earlier = _left(mechanism, name, one.point)
            if earlier is None or earlier > 0.0:
                break
            here, there = one, earlier
        earlier = _left(mechanism, name, behind.point)
        zero = None if earlier is None else _continued(here.value, there, behind.value, earlier)
        if zero is None or not (left <= 0.0 or 0.0 <= (zero - last.value) / width <= NEAR):
            continue
        others = np.array([row[0] != name for row in _rows(last.point)], dtype=bool)
        soft = softest(mechanism.problem, released(last.point, others))
        return BranchEnd(zero, uncertain, Loss.SLIP, name, last.curvature, soft.curvature, soft.direction)
    return None


def _left(mechanism: Mechanism, name: str, point: Point) -> float | None:
    """What an end has left to go in a contact until it slips off, units of length; None where that says nothing."""
    pair = mechanism.pairs.get(name)
    if isinstance(pair, Pair):
        return left_to_go(pair, point)
    return left_of_side(pair, point) if isinstance(pair, Edge) else None


def foreseen(trail: list[Minimum], ahead: float) -> float | None:
    """The nearest value on the way from the last minimum to ``ahead`` at which something that falls will be zero."""
    if len(trail) < LEAST:
        return None
    before, last = trail[-2:]
    whole = _whole([*_rows(before.point), *_rows(last.point)])
    falling = [(_force(last.point, rows), _force(before.point, rows)) for rows in whole]
    falling += [(last.curvature**power, before.curvature**power) for power in (1.0, 2.0)]
    zeros = [_continued(last.value, now, before.value, earlier) for now, earlier in falling if now > 0.0]
    reached = [zero for zero in zeros if zero is not None and 0.0 < (zero - last.value) / (ahead - last.value) < 1.0]
    return min(reached, key=lambda zero: abs(zero - last.value), default=None)


def _rows(point: Point) -> list[Row]:
    """Names of a state's rows: of places of their own that one contact has, which of them along the beam."""
    order = np.argsort(point.rows.arc, kind="stable").tolist()
    seen: Counter[tuple[str, int]] = Counter()
    which = [0] * len(order)
    for i in order:
        which[i] = seen[point.rows.keys[i]]
        seen[point.rows.keys[i]] += 1
    return [(contact, kind, nth) for (contact, kind), nth in zip(point.rows.keys, which, strict=True)]


def _whole(rows: Iterable[Row]) -> list[frozenset[Row]]:
    """Those of each contact or stop together."""
    rows = list(rows)
    return [frozenset(row for row in rows if row[0] == name) for name in dict.fromkeys(row[0] for row in rows)]


def _force(point: Point, rows: frozenset[Row]) -> float:
    return float(sum(lam for lam, row in zip(point.lam, _rows(point), strict=True) if row in rows))


def _continued(value: float, amount: float, before: float, earlier: float) -> float | None:
    """Where what falls linearly is zero; None where it does not fall, or where nothing was free before."""
    if not amount < earlier < np.inf:
        return None
    return value + amount * (value - before) / (earlier - amount)


def _from_afar(trail: list[Minimum], beyond: float, distance: float) -> Minimum | None:
    """The last minimum that is so far from a value ``beyond``."""
    return next((one for one in reversed(trail) if abs(one.value - beyond) >= distance), None)


def _falls_evenly(trail: list[Minimum], before: Minimum, beyond: float) -> bool:
    """Whether κ goes evenly with v, as towards a bifurcation, and by far not κ², as towards a fold.

    It is foretold of the last of the ``trail`` from the minimum ``before`` it and one as many times farther off.
    """
    first, last = _from_afar(trail, beyond, SPREAD * abs(before.value - beyond)), trail[-1]
    if first is None or first is before:
        return False
    share = (last.value - before.value) / (before.value - first.value)
    kappas = np.array([one.curvature for one in (first, before, last)])
    even, squared = (k[1] + share * (k[1] - k[0]) for k in (kappas, kappas**2))
    return bool(abs(even - kappas[2]) * CLEARLY < abs(np.copysign(np.sqrt(abs(squared)), squared) - kappas[2]))


def _part_in(mechanism: Mechanism, last: Minimum, before: Minimum, soft: Softest) -> float:
    """|τ·φ| in the metric of lengths, τ from two states; nothing where the branch does not move or nothing is free."""
    lengths = mechanism.problem.model.lengths
    tau = last.point.state.theta - before.point.state.theta
    if float(np.max(np.abs(tau))) < STILL or not np.any(soft.direction):
        return 0.0
    sizes = np.sqrt((lengths @ tau**2) * (lengths @ soft.direction**2))
    return float(abs(lengths @ (tau * soft.direction)) / sizes)
