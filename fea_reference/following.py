"""Path following to the critical point of a branch of minima, and the type of instability.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
μ, φ    smallest curvature of the potential energy on the feasible directions, and its mode
s, τ    arc length of the branch, and dλ/ds
P       force of a contact
======  =====================================================================================

The branch is followed by arc length until μ(s) changes sign; the zero is then bracketed. The critical point is a fold
if λ turns back there and the path tangent is along φ, else a bifurcation.

A frictionless contact may lose its force P while μ with the contact is still positive. The mechanism without the
contact may then have a negative curvature. The stiffness of a penalty contact vanishes with P. The penalised
equilibria therefore have a fold at P of order penetration³, and return without contact after a sharp turn. Hence P(λ)
is extrapolated to its zero instead. In a contact with several zones every zone may lose its force.

A fold is also attributed to the penalty if two conditions hold. With a much stiffer penalty μ would be positive, and
P is negligible against its value at the start of the following. If the start was too close for this test, the
stiffness of the rigid contact has to be unchanged. Then P must have fallen to a tenth or, at the initial rate, must
vanish almost at once.

The moment of a stop is an unknown; it vanishes exactly where the stop opens.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from cprbm_scene.answer import Array, Loss
from fea_reference.advance import advance
from fea_reference.branch import Branch, Place, onwards, place, sought
from fea_reference.curvature import Mode, softest
from fea_reference.energy import potential_energy
from fea_reference.march import March
from fea_reference.mass import lumped_mass
from fea_reference.off_a_corner import Stretch, cut_short, left_a_corner, slips
from fea_reference.slipping import gone_past, left_to_go
from fea_reference.system import System, assemble, stiffened
from fea_reference.taut import Turn, beyond
from fea_reference.touch import Touch

WEAKER = 0.6  # times the curvature under tight penalties: below, penalties are tightened again
_FIRST = 0.01  # arc length of the first step
_MOST = 0.03  # rad (and lengths): largest motion of a step
_LEAST = 1e-9
_STEPS = 400
_LOOK = 30  # steps between two checks of progress
_STRAIGHT = 0.9  # cosine between the tangents at both ends of a step
_LONGER = 2.0  # step lengths: a farther point is on another branch
_SHARP = 1e-6  # arc length of a turn that counts as sharp
_GROWN = 1.2  # times the least curvature so far: the minimum of the curvature has been passed
_PAST = 5  # steps
_ROOTS = 60
_FINE = 1e-8  # times the span
_SHORT = 1e-4  # times a step
_WIDE = 1e-4  # times the span: a critical point with a larger uncertainty may vanish with shorter steps
_KEPT = 20  # path segments
_FARTHER = 30.0  # arc lengths between two points: a larger distance means different branches
_BETWEEN = 1.0  # elements: gap between contact points that separates zones
_ALONG = 0.5  # cosine between tangent and φ at a fold
_TURNING = 0.1  # times the initial dλ/ds: largest value at a fold
_CLEAR, _NEAR = 1e-5, 1e-2  # times the initial μ: above round-off, and near enough for dλ/ds at the critical point
_APPROACHED = 1e-8  # times the span: distance at which a contact force counts as zero
_SHARE = 0.9  # share of the remaining distance per step
_SLIPPING = 0.1  # times the span: distance from which an end is followed until it slips off
_BACK = 2.0  # times the distance passed, if the slip has been passed already
_AS_GOOD = 1e-6  # times the span: distance at which the slip counts as reached
_FORESEEN = 1e-3  # times the span: largest distance over which the slip is extrapolated, if no step leads nearer
_DIFFERENCE = 1e-7  # times the span: increment of finite differences
_RIGID = 1e4  # stiffness factor that stands for a rigid contact
_HELD = 1e-2  # times the initial curvature: a contact with a larger one is stable
# times the initial contact force: negligible, or small while the rigid contact is unchanged
_NOTHING, _LITTLE = 1e-2, 0.1
_SOON = 1e-4  # times the span: distance from which a contact force is on its final decrease
_AS_HELD = 0.5  # times the initial curvature with a rigid contact: the contact is unchanged


@dataclass(frozen=True, slots=True)
class Lost:
    """Critical point of a branch at ``value``: the ``system`` and the unit mode φ as ``direction`` (size,).

    All values are dimensionless. ``loss``, ``what``, ``curvature`` and ``left`` as in
    :class:`cprbm_scene.answer.Critical`.
    """

    value: float
    uncertainty: float
    loss: Loss
    what: str
    curvature: float
    left: float
    energy: float
    system: System
    direction: Array


@dataclass(frozen=True, slots=True)
class CutShort:
    """Marker: an end of a beam cuts a zone short."""


def followed(march: March, load: int, target: float, span: float) -> Lost | None:
    """Follow the branch towards ``target``; returns the critical point before ``target``, or None.

    Without a critical point the state has moved along the branch, possibly not at all. If the branch turns back and
    stays a branch of minima, the state moves on to the branch that starts beyond, if any.
    """
    saved = march.saved()
    end = _along(march, load, target, span, tight=False)
    if isinstance(end, CutShort):
        # penetration under the penalties of load stepping shifts the slip
        march.restore(saved)
        march.tighten()
        end = _along(march, load, target, span, tight=True)
    if isinstance(end, Turn) and not beyond(march, end, target):
        march.restore(saved)
    return end if isinstance(end, Lost) else None


def _along(march: March, load: int, target: float, span: float, *, tight: bool) -> Lost | Turn | CutShort | None:
    """Critical point, turning point, or None; stops where a zone is cut short that loose penalties widen."""
    march.look()
    if march.loose:
        march.tighten()
    lost = _letting_go(march, load, target, span) or _slipping_off(march, load, target, span)
    if lost is not None:
        return lost
    # under a loose penalty a contact may hold a state, on another branch, that a rigid contact does not
    if march.soft():
        march.tighten()
    onward = float(np.sign(target - march.values[load]))
    branch = _branch(march, load, span)
    here = place(branch, float(march.values[load]), march.system, (np.zeros(march.model.size), onward))
    if not tight and cut_short(march.model, march.system):
        return CutShort()
    if here is None or not here.curvature > 0.0:
        return None
    first, least, past, firm = here, here.curvature, 0, here.curvature
    length = _FIRST
    known, turn = (here.curvature, length), None
    gone: list[Stretch] = []
    wide: tuple[Lost, March] | None = None
    for tried in range(_STEPS):
        if tried % _LOOK == 0 and tried > 0:
            # at this rate of decrease no critical point comes within the limit of steps
            if here.curvature > (1.0 - _LOOK / _STEPS) * known[0] and length <= known[1]:
                return turn
            known = here.curvature, length
        length = min(length, _MOST / max(float(np.abs(here.way[march.model.moving]).max()), _MOST))
        there = onwards(branch, here, length)
        elsewhere = there is not None and length > _SHARP and not _goes_on_to(branch, here, there, length)
        if there is None or elsewhere or left_a_corner(march.model, here.system, there.system):
            length *= 0.25
            if length < _LEAST:
                gone = [*gone, Stretch(branch, here, 0.0)]
                return _slipped(march, load, gone, here) or _back_at(march, wide) or turn
            continue
        if any(gone_past(march.model, one, here.system.z, there.system.z) for one in here.system.touches):
            lost = _slipping_off(march, load, target, span)
            length *= 0.25
            if lost is not None or length < _LEAST:
                return lost or _back_at(march, wide) or turn
            continue
        if march.least_gap(there.system) < 0.0:
            event = _event(march, branch, here, length)
            if event is None:
                return turn
            lost = _changed(march, load, event)
            if lost is not None:
                return lost
            branch = _branch(march, load, span)
            again = place(branch, float(march.values[load]), march.system, (event.way, event.rate))
            if again is None or not again.curvature > 0.0:
                return turn
            here, gone = again, []
            continue
        if there.curvature <= 0.0:
            if not tight and cut_short(march.model, there.system):
                return CutShort()
            lost = _lost(march, branch, first, here, there, length)
            slipped = lost and _slipped(march, load, [*gone, Stretch(branch, here, length)], lost)
            known_well = lost is not None and lost.uncertainty <= _WIDE * span
            if slipped is not None or (lost is not None and known_well and (lost.value - target) * onward <= 0.0):
                return slipped or lost
            # such a long step leads to another branch, or past a near miss of two branches
            wide = wide if lost is None else (lost, march.saved())
            march.values, march.system = branch.at(here.value), here.system
            if known_well:
                return turn  # the target comes before the critical point
            length *= 0.25
            if length < _LEAST:
                return _back_at(march, wide) or turn
            continue
        if not tight and cut_short(march.model, there.system):
            return CutShort()
        if (there.value - target) * onward >= 0.0:
            return turn
        if march.passed(here.system.z, there.system, "") is not None:
            return turn
        march.values, march.system = branch.at(there.value), there.system
        if there.curvature < WEAKER * firm and march.soft():
            # a state of low curvature is sensitive to the penetration of contacts
            march.tighten()
            branch, firm = _branch(march, load, span), there.curvature
            again = place(branch, float(march.values[load]), march.system, (there.way, there.rate))
            if again is None or not again.curvature > 0.0:
                return turn
            here, least, past = again, min(least, again.curvature), 0
            continue
        if turn is None and here.rate * onward > 0.0 > there.rate * onward:
            turn = Turn(branch, here, length)
        past = past + 1 if there.curvature > _GROWN * least else 0
        least = min(least, there.curvature)
        if past >= _PAST:
            return turn
        gone = [*gone[-_KEPT:], Stretch(branch, here, length)]
        here, length = there, 1.5 * length
    return turn


def _back_at(march: March, wide: tuple[Lost, March] | None) -> Lost | None:
    """The critical point with a large uncertainty, and the saved state there, if no shorter step continues; else
    None.
    """
    if wide is None:
        return None
    march.restore(wide[1])
    return wide[0]


def _slipped(march: March, load: int, gone: list[Stretch], end: Lost | Place) -> Lost | None:
    """Critical point where an end slips off a corner, after the segments ``gone``; None if no end does.

    Called where the branch is lost to the penalty before the slip, or cannot be continued.
    """
    slip = slips(march.model, gone, end.system)
    if slip is None:
        return None
    march.values, march.system = gone[-1].branch.at(slip.place.value), slip.place.system
    left = softest(march.model, _without(march, slip.one))
    found = _ahead(march, load, slip.value - slip.place.value, Loss.SLIP, slip.one, slip.place.curvature, left)
    return replace(found, uncertainty=float(abs(slip.value - end.value)))


def _branch(march: March, load: int, span: float) -> Branch:
    return Branch(march.model, march.settings, dict(march.penalties), march.acting, march.values.copy(), load, span)


def _cosine(branch: Branch, here: Place, there: Place) -> float:
    return float(here.way @ (branch.weights * there.way)) + branch.weight * here.rate * there.rate


def _goes_on_to(branch: Branch, here: Place, there: Place, length: float) -> bool:
    """True if both points are on the same branch, a ``length`` of arc apart."""
    return _cosine(branch, here, there) >= _STRAIGHT and _apart(branch, here, there) <= _LONGER * length


def _apart(branch: Branch, one: Place, other: Place) -> float:
    """Distance of two points in the metric of the arc length."""
    way = (other.system.z.values - one.system.z.values) + (other.system.z.rest - one.system.z.rest)
    return float(np.sqrt(way @ (branch.weights * way) + branch.weight * (other.value - one.value) ** 2))


def _event(march: March, branch: Branch, here: Place, length: float) -> Place | None:
    """Point just behind the first change of a contact or stop within ``length``."""
    return sought(branch, here, length, lambda there: march.least_gap(there.system))


def _changed(march: March, load: int, event: Place) -> Lost | None:
    """Close contacts and switch stops at ``event``; the critical point if an opening stop leaves an unstable state."""
    changing = [stop for stop in march.model.stops if march.room(stop, event.system) < 0.0]
    march.values[load], march.system = event.value, event.system
    march.watch_what_touches(load)
    march.switch(load, changing)
    return stop_lost(march, load, event.curvature, event.system)


def stop_lost(march: March, load: int, held: float, system: System) -> Lost | None:
    """Critical point of stops just opened in a ``system`` of curvature ``held``; None if the state is stable."""
    gone = [
        stop.known_as
        for stop in march.model.stops
        if stop.name in system.acting.limits and stop.name not in march.acting.limits
    ]
    left = softest(march.model, march.system)
    if not gone or left.curvature > 0.0:
        return None
    value = float(march.values[load])
    energy = potential_energy(march.model, march.system, march.values)
    uncertainty = float(np.spacing(abs(value)))
    return Lost(value, uncertainty, Loss.STOP, gone[0], held, left.curvature, energy, march.system, left.direction)


def about_to_go(march: March, load: int, value: float) -> bool:
    """True if a contact force, extrapolated linearly, vanishes before ``value`` and leaves an unstable state."""
    way = value - float(march.values[load])
    going = _next_to_go(march, load, float(np.sign(way)))
    return (
        going is not None
        and abs(going[1]) < abs(way)
        and not softest(march.model, _without(march, going[0])).curvature > 0.0
    )


def _letting_go(march: March, load: int, target: float, span: float) -> Lost | None:
    """Critical point where a contact loses its force and leaves an unstable state; None if none is near."""
    onward = float(np.sign(target - march.values[load]))
    saved = march.saved()
    while True:
        going = _next_to_go(march, load, onward)
        if going is None or going[1] * onward > (target - march.values[load]) * onward:
            break
        one, way = going
        left = softest(march.model, _without(march, one))
        if left.curvature > 0.0:
            break
        if abs(way) <= _APPROACHED * span:
            lost = _let_go(march, load, one, way, left)
            if lost is not None:
                return lost
            break
        before, rate = march.saved(), march.rate(load)
        size = min(_SHARE * abs(way), _MOST / max(float(np.abs(rate[march.model.moving]).max()), 1e-300))
        trouble = march.step(load, float(march.values[load]) + np.copysign(size, way), march.onward(load, rate, target))
        if trouble is not None or not softest(march.model, march.system).curvature > 0.0:
            march.restore(before)
            lost = _let_go(march, load, one, way, left) if abs(way) <= _FORESEEN * span else None
            if lost is not None:
                return lost
            break
    march.restore(saved)
    return None


def _let_go(march: March, load: int, one: Touch, way: float, left: Mode) -> Lost | None:
    """Critical point at the zero of a contact force, at distance ``way``, with ``left`` the mode without contact.

    None if the state is unstable with a rigid contact, too.
    """
    held = softest(march.model, stiffened(march.model, march.system, one, _RIGID))
    if not held.curvature > 0.0:
        return None
    return _ahead(march, load, way, Loss.CONTACT, one, held.curvature, left)


def _ahead(march: March, load: int, way: float, loss: Loss, one: Touch, held: float, left: Mode) -> Lost:
    """Critical point at distance ``way`` in λ, where a contact ends; ``held`` is the curvature with the contact."""
    return Lost(
        float(march.values[load] + way),
        abs(way),
        loss,
        one.pair.name,
        held,
        left.curvature,
        potential_energy(march.model, march.system, march.values),
        march.system,
        left.direction,
    )


def _slipping_off(march: March, load: int, target: float, span: float) -> Lost | None:
    """Critical point where a pressing end passes the end of the other beam; None if none is near.

    The zone has a finite width, smaller for tighter penalties, and part of it passes earlier. From there on the
    remaining distance is extrapolated, and is the uncertainty.
    """
    onward, saved = float(np.sign(target - march.values[load])), march.saved()
    tight = behind = False
    while (going := _next_to_slip(march, load, onward * span)) is not None:
        one, way = going
        if tight and not behind and -_SLIPPING * span <= way * onward < 0.0:
            # under tight penalties the slip lies behind the current state
            march.restore(saved)
            if not _nearer(march, load, _BACK * way):
                break
            march.tighten()
            behind = True
            continue
        if not 0.0 <= way * onward <= min(_SLIPPING * span, (target - march.values[load]) * onward):
            break
        if not tight:
            # penetration shifts the slip, possibly to a point behind the current state
            march.tighten()
            tight = True
            continue
        if abs(way) > _AS_GOOD * span and _nearer(march, load, way):
            continue
        if abs(way) > _FORESEEN * span:
            break
        return _ahead(march, load, way, Loss.SLIP, one, march.curvature, softest(march.model, _without(march, one)))
    march.restore(saved)
    return None


def _nearer(march: March, load: int, way: float) -> bool:
    """Step over most of the distance ``way``, within the limit of motion; True on success, else the state stays."""
    before, rate = march.saved(), march.rate(load)
    size = min(_SHARE * abs(way), _MOST / max(float(np.abs(rate[march.model.moving]).max()), 1e-300))
    value = float(march.values[load] + np.copysign(size, way))
    if march.step(load, value, march.onward(load, rate, value)) is None:
        return True
    march.restore(before)
    return False


def _next_to_slip(march: March, load: int, ahead: float) -> tuple[Touch, float] | None:
    """The contact with the first end to slip off, and the distance in λ at the current rate."""
    step = _DIFFERENCE * ahead
    moved = advance(march.model, march.system.z, step * march.rate(load))
    found: tuple[Touch, float] | None = None
    for one in march.system.touches:
        here = left_to_go(march.model, one, march.system.z)
        there = None if here is None else left_to_go(march.model, one, moved)
        if here is None or there is None or not there < here:
            continue
        way = step * here / (here - there)
        if found is None or abs(way) < abs(found[1]):
            found = one, way
    return found


def _holding(first: System, now: System) -> Iterator[tuple[Touch, Touch]]:
    """Pairs (contact at ``first``, contact ``now``) of all closed contacts, then of their zones if the counts agree."""
    begun = {old.pair: old for old in first.touches if old.closed}
    both = [(begun[one.pair], one) for one in now.touches if one.closed and one.pair in begun]
    for old, one in both:
        yield old, one
        zones, before = _zones(one), _zones(old)
        if len(zones) == len(before) > 1:
            yield from zip(before, zones, strict=True)


def _parts(one: Touch) -> list[Touch]:
    """Parts of a contact that may lose their force: the contact, and its zones if there are several."""
    zones = _zones(one)
    return [one, *zones] if len(zones) > 1 else [one]


def _zones(one: Touch) -> list[Touch]:
    """The contact restricted to every zone along the first beam."""
    order = np.argsort(one.zeta, kind="stable")
    number = np.empty(len(order), dtype=int)
    number[order] = np.concatenate(([0], np.cumsum(np.diff(one.zeta[order]) > _BETWEEN)))
    return [replace(one, stiffness=np.where(number == i, one.stiffness, 0.0)) for i in range(number.max() + 1)]


def _gone(march: March, branch: Branch, first: Place, begun: Touch, one: Touch, held: float) -> bool:
    """True if the force of a contact has vanished, where the rigid contact would give the curvature ``held``."""
    if one.push < _NOTHING * begun.push:
        return True
    change = float(begun.foreseen(first.way).sum()) - begun.push
    soon = change < 0.0 and begun.push * abs(first.rate) < -change * _SOON * branch.span and one.push < begun.push
    if not (soon or one.push < _LITTLE * begun.push):
        return False
    return held > _AS_HELD * softest(march.model, stiffened(march.model, first.system, begun, _RIGID)).curvature


def _next_to_go(march: March, load: int, onward: float) -> tuple[Touch, float] | None:
    """The contact or zone whose force vanishes first at the current rate, and the distance in λ."""
    rate = march.rate(load)
    found: tuple[Touch, float] | None = None
    for one in (part for each in march.system.touches if each.closed for part in _parts(each)):
        change = float(one.foreseen(onward * rate).sum()) - one.push
        if change >= 0.0:
            continue
        way = float(-one.push / change)
        if found is None or way < abs(found[1]):
            found = one, onward * way
    return found


def _without(march: March, one: Touch) -> System:
    """The current state without a contact, or without a zone of a contact."""
    if all(one is not each for each in march.system.touches):
        return stiffened(march.model, march.system, one, 0.0)
    others = {pair: penalty for pair, penalty in march.penalties.items() if pair != one.pair}
    return assemble(march.model, others, march.settings.quadrature, march.values, march.system.z, march.acting)


def _lost(march: March, branch: Branch, first: Place, here: Place, there: Place, length: float) -> Lost | None:
    """Critical point between two points with positive and non-positive curvature.

    None if no point with a vanishing curvature is found between: the points are on different branches.
    """
    low, high, weights, clear = (0.0, here), (length, there), [1.0, 1.0], None
    for _ in range(_ROOTS):
        (s, before), (t, behind) = low, high
        if abs(behind.value - before.value) <= _FINE * branch.span and t - s <= _SHORT * length:
            break
        if length > _SHARP and _apart(branch, before, behind) > _FARTHER * (t - s):
            return None
        # regula falsi, with the weight of the unchanged end halved (Illinois variant)
        above, below = weights[0] * before.curvature, weights[1] * behind.curvature
        share = min(max(above / (above - below), 0.02), 0.98)
        # near a singular tangent there may be no solution
        tried = ((part, onwards(branch, here, s + part * (t - s))) for part in (share, 0.5 * share, 0.5 + 0.5 * share))
        share, middle = next(((part, found) for part, found in tried if found is not None), (share, None))
        if middle is None:
            if min(before.curvature, -behind.curvature) > _HELD * first.curvature:
                return None
            break
        clear = middle if _CLEAR < abs(middle.curvature) / first.curvature < _NEAR else clear
        if middle.curvature > 0.0:
            low, weights = (s + share * (t - s), middle), [1.0, 0.5 * weights[1]]
        else:
            high, weights = (s + share * (t - s), middle), [0.5 * weights[0], 1.0]
    before, behind = low[1], high[1]
    share = before.curvature / (before.curvature - behind.curvature)
    value = float(before.value + share * (behind.value - before.value))
    uncertainty = float(abs(behind.value - before.value) + np.spacing(abs(value)))
    march.values, march.system = branch.at(before.value), before.system
    energy = potential_energy(march.model, march.system, march.values)
    for begun, one in _holding(first.system, before.system):
        held = softest(march.model, stiffened(march.model, before.system, one, _RIGID)).curvature
        if held > _HELD * first.curvature and _gone(march, branch, first, begun, one, held):
            # the other zones stay in contact
            left = softest(march.model, stiffened(march.model, before.system, one, 0.0))
            lets_go = Loss.CONTACT, one.pair.name, held, left.curvature
            return Lost(value, uncertainty, *lets_go, energy, before.system, left.direction)
    mass = lumped_mass(march.model)
    along, size = float(before.mode.direction @ (mass * before.way)), float(np.sqrt(before.way @ (mass * before.way)))
    # τ vanishes with μ at a fold only; round-off over the last μ makes τ small at a bifurcation too
    fold = abs((clear or before).rate) < _TURNING * abs(first.rate) and abs(along) > _ALONG * size
    loss, side = Loss.FOLD if fold else Loss.BIFURCATION, -1.0 if fold and along < 0.0 else 1.0
    zero = before.curvature if before.curvature < -behind.curvature else behind.curvature
    return Lost(value, uncertainty, loss, "", zero, zero, energy, before.system, side * before.mode.direction)
