"""Where a branch of minima ends, and why.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
μ, φ    smallest curvature of the potential energy on the feasible directions, and its motions
s, τ    arc length of the branch, and dλ/ds by it
P       force of a contact
======  =====================================================================================

The branch is followed by its arc length to where μ(s) changes its sign, and the zero is found between.  It is a fold
if λ turns back there, and the branch goes there along φ; otherwise it is a bifurcation.

A contact without friction holds with a force that may go to zero while μ, of what it holds, is positive; what is left
without it may have a negative curvature.  Its penalty's stiffness goes to zero with P, too, so that the equilibria
with the penalty have a fold at some P of the third power of the penetration, and beyond it lead back without contact
by a sharp turn.  Here P(λ) is followed to its zero.  Where a contact presses in several places, each of them may let
go.  A fold at which μ would be positive, were the penalty many times as stiff, is none of the mechanism's own either,
if P has gone to nothing: of what it was where the following began, or, where that began so close that there was little
left, if what a rigid contact holds has not changed since and P has fallen to a tenth or, at the rate of then, vanishes
within next to nothing.

A stop's moment is an unknown; it is zero to the last digits where it lets go.
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

WEAKER = 0.6  # of the curvature when contacts were tight: from there on they are to be so again
_FIRST = 0.01  # arc length of the first step
_MOST = 0.03  # rad (and lengths): the most that one may move anything
_LEAST = 1e-9
_STEPS = 400
_LOOK = 30  # of them after which it is seen whether they lead on
_STRAIGHT = 0.9  # cosine between the directions at both ends of a step
_LONGER = 2.0  # times as far away as a step is long: a place that is farther is on another branch
_SHARP = 1e-6  # arc length below which a turn is one
_GROWN = 1.2  # of the least curvature on the way: it has come past
_PAST = 5  # steps
_ROOTS = 60
_FINE = 1e-8  # of the span
_SHORT = 1e-4  # of a step
_WIDE = 1e-4  # of the span: an end that is not known better may be none, passed beside by shorter steps
_KEPT = 20  # stretches
_FARTHER = 30.0  # times the arc between them: places that are farther apart are on no one branch
_BETWEEN = 1.0  # elements: between places that are farther apart along the beam there is no contact
_ALONG = 0.5  # cosine between branch and φ at a fold
_TURNING = 0.1  # of dλ/ds at the beginning: the most that is left of it at a fold
_CLEAR, _NEAR = 1e-5, 1e-2  # of μ at the beginning: above round-off, and near enough for what is left of dλ/ds
_APPROACHED = 1e-8  # of the span: from where a contact's force is zero
_SHARE = 0.9  # of the way there, at a time
_SLIPPING = 0.1  # of the span: from how far an end is followed to where it slips off another
_BACK = 2.0  # times as far as it has come past it, if it has
_AS_GOOD = 1e-6  # of the span: from where it is as good as there
_FORESEEN = 1e-3  # of the span: from where an end is foreseen, if no step leads nearer
_DIFFERENCE = 1e-7  # of the span: what rates are seen by
_RIGID = 1e4  # times as stiff
_HELD = 1e-2  # of the curvature at the beginning: that of what is held
_NOTHING, _LITTLE = 1e-2, 0.1  # of a contact's force at the beginning: enough, or enough where it holds as ever
_SOON = 1e-4  # of the span: from where a contact's force is on its last way to zero
_AS_HELD = 0.5  # of what a rigid contact held at the beginning: it holds as ever


@dataclass(frozen=True, slots=True)
class Lost:
    """The end of a branch at ``value``: the ``system`` there, and φ as ``direction`` (size,) to leave it in.

    All without units; ``curvature``, ``left`` and ``what`` are :class:`cprbm_scene.answer.Critical`'s.
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
    """That a zone beside an end is cut short by that."""


def followed(march: March, load: int, target: float, span: float) -> Lost | None:
    """Follow the branch towards ``target``; how it is lost, or None where it is not before that.

    Then the march has gone some way along it, or none.  Where it turns back, and is one of minima still, the march has
    gone on to what begins there, or none.
    """
    saved = march.saved()
    end = _along(march, load, target, span, tight=False)
    if isinstance(end, CutShort):
        # what sinks into the penalties of a way slips elsewhere
        march.restore(saved)
        march.tighten()
        end = _along(march, load, target, span, tight=True)
    if isinstance(end, Turn) and not beyond(march, end, target):
        march.restore(saved)
    return end if isinstance(end, Lost) else None


def _along(march: March, load: int, target: float, span: float, *, tight: bool) -> Lost | Turn | CutShort | None:
    """The same, or where the branch turned back without being lost.

    Where a zone is cut short that penalties that are not ``tight`` make wider, it goes no farther.
    """
    march.look()
    if march.loose:
        march.tighten()
    lost = _letting_go(march, load, target, span) or _slipping_off(march, load, target, span)
    if lost is not None:
        return lost
    # a contact that has sunk into its penalty since may be held where a rigid one is not, on another branch
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
            # at this pace it is not lost in all steps
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
            # a step that long leads to another branch, or past where two nearly meet
            wide = wide if lost is None else (lost, march.saved())
            march.values, march.system = branch.at(here.value), here.system
            if known_well:
                return turn  # the target comes before the end
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
            # what stands less firmly goes another way where contacts have sunk into their penalties
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
    """An end that is not known well, where no shorter step leads on; the march stands there again."""
    if wide is None:
        return None
    march.restore(wide[1])
    return wide[0]


def _slipped(march: March, load: int, gone: list[Stretch], end: Lost | Place) -> Lost | None:
    """An end that slips off a corner, where a branch that has ``gone`` so far is lost to the penalty before that, or
    leads on no more.
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
    """Whether the branch goes from one place to another, and that by a ``length`` of arc."""
    return _cosine(branch, here, there) >= _STRAIGHT and _apart(branch, here, there) <= _LONGER * length


def _apart(branch: Branch, one: Place, other: Place) -> float:
    """How far two places are from each other as the arc length has it."""
    way = (other.system.z.values - one.system.z.values) + (other.system.z.rest - one.system.z.rest)
    return float(np.sqrt(way @ (branch.weights * way) + branch.weight * (other.value - one.value) ** 2))


def _event(march: March, branch: Branch, here: Place, length: float) -> Place | None:
    """The place, before ``length``, at which a contact or stop changes: just behind it."""
    return sought(branch, here, length, lambda there: march.least_gap(there.system))


def _changed(march: March, load: int, event: Place) -> Lost | None:
    """Let contacts and stops change where they do; what is lost if one lets go of what cannot stand."""
    changing = [stop for stop in march.model.stops if march.room(stop, event.system) < 0.0]
    march.values[load], march.system = event.value, event.system
    march.watch_what_touches(load)
    march.switch(load, changing)
    return stop_lost(march, load, event.curvature, event.system)


def stop_lost(march: March, load: int, held: float, system: System) -> Lost | None:
    """What is lost by stops that have just let go of a ``system`` of curvature ``held``; None if it stands."""
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
    """Whether the force of a contact will vanish before ``value``, at the rate of now, that nothing stands without."""
    way = value - float(march.values[load])
    going = _next_to_go(march, load, float(np.sign(way)))
    return (
        going is not None
        and abs(going[1]) < abs(way)
        and not softest(march.model, _without(march, going[0])).curvature > 0.0
    )


def _letting_go(march: March, load: int, target: float, span: float) -> Lost | None:
    """A contact that lets go of what cannot stand without it, if one is about to."""
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
    """The end where one contact lets go, a ``way`` ahead, and what is ``left`` then; None if it does not hold now."""
    held = softest(march.model, stiffened(march.model, march.system, one, _RIGID))
    if not held.curvature > 0.0:
        return None
    return _ahead(march, load, way, Loss.CONTACT, one, held.curvature, left)


def _ahead(march: March, load: int, way: float, loss: Loss, one: Touch, held: float, left: Mode) -> Lost:
    """The end a ``way`` ahead of now at which one contact, with which the curvature is what is ``held``, is lost."""
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
    """An end that comes past the end of the beam on which it presses, if one is about to.

    Its zone has a width, the less the tighter its penalty, and some of that is past before: from there on the way that
    is left is foreseen, and is what is uncertain.
    """
    onward, saved = float(np.sign(target - march.values[load])), march.saved()
    tight = behind = False
    while (going := _next_to_slip(march, load, onward * span)) is not None:
        one, way = going
        if tight and not behind and -_SLIPPING * span <= way * onward < 0.0:
            # where tight penalties have it, the march has come past
            march.restore(saved)
            if not _nearer(march, load, _BACK * way):
                break
            march.tighten()
            behind = True
            continue
        if not 0.0 <= way * onward <= min(_SLIPPING * span, (target - march.values[load]) * onward):
            break
        if not tight:
            # what sinks into the penalties of a way slips elsewhere, and that may lie behind
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
    """Whether a step leads on for most of a ``way``, or for as much of it as one may; if not, the march stays."""
    before, rate = march.saved(), march.rate(load)
    size = min(_SHARE * abs(way), _MOST / max(float(np.abs(rate[march.model.moving]).max()), 1e-300))
    value = float(march.values[load] + np.copysign(size, way))
    if march.step(load, value, march.onward(load, rate, value)) is None:
        return True
    march.restore(before)
    return False


def _next_to_slip(march: March, load: int, ahead: float) -> tuple[Touch, float] | None:
    """The contact in which an end is first to come past another, and how far it is there at the rate of now."""
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
    """What may have let go: of each contact that presses ``now`` all of it at ``first`` and now, then each of its zones
    that are as many as then.
    """
    begun = {old.pair: old for old in first.touches if old.closed}
    both = [(begun[one.pair], one) for one in now.touches if one.closed and one.pair in begun]
    for old, one in both:
        yield old, one
        zones, before = _zones(one), _zones(old)
        if len(zones) == len(before) > 1:
            yield from zip(before, zones, strict=True)


def _parts(one: Touch) -> list[Touch]:
    """What of a contact may let go: its zones, where it has several, and all of it."""
    zones = _zones(one)
    return [one, *zones] if len(zones) > 1 else [one]


def _zones(one: Touch) -> list[Touch]:
    """A contact as that of each of its zones alone, along the first beam."""
    order = np.argsort(one.zeta, kind="stable")
    number = np.empty(len(order), dtype=int)
    number[order] = np.concatenate(([0], np.cumsum(np.diff(one.zeta[order]) > _BETWEEN)))
    return [replace(one, stiffness=np.where(number == i, one.stiffness, 0.0)) for i in range(number.max() + 1)]


def _gone(march: March, branch: Branch, first: Place, begun: Touch, one: Touch, held: float) -> bool:
    """Whether the force of what a rigid contact would hold with a curvature ``held`` has come to nothing."""
    if one.push < _NOTHING * begun.push:
        return True
    change = float(begun.foreseen(first.way).sum()) - begun.push
    soon = change < 0.0 and begun.push * abs(first.rate) < -change * _SOON * branch.span and one.push < begun.push
    if not (soon or one.push < _LITTLE * begun.push):
        return False
    return held > _AS_HELD * softest(march.model, stiffened(march.model, first.system, begun, _RIGID)).curvature


def _next_to_go(march: March, load: int, onward: float) -> tuple[Touch, float] | None:
    """The contact, or the zone of several, whose force is first to vanish at the rate of now, and how far that is."""
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
    """The state of now without one contact, or without one of its zones."""
    if all(one is not each for each in march.system.touches):
        return stiffened(march.model, march.system, one, 0.0)
    others = {pair: penalty for pair, penalty in march.penalties.items() if pair != one.pair}
    return assemble(march.model, others, march.settings.quadrature, march.values, march.system.z, march.acting)


def _lost(march: March, branch: Branch, first: Place, here: Place, there: Place, length: float) -> Lost | None:
    """What happens between two places, the one with a positive curvature and the other without.

    None where no places are found between them at which it goes to zero: they are on no one branch.
    """
    low, high, weights, clear = (0.0, here), (length, there), [1.0, 1.0], None
    for _ in range(_ROOTS):
        (s, before), (t, behind) = low, high
        if abs(behind.value - before.value) <= _FINE * branch.span and t - s <= _SHORT * length:
            break
        if length > _SHARP and _apart(branch, before, behind) > _FARTHER * (t - s):
            return None
        # regula falsi, with the weight halved of the end that stays (the Illinois variant)
        above, below = weights[0] * before.curvature, weights[1] * behind.curvature
        share = min(max(above / (above - below), 0.02), 0.98)
        # where the tangent is as good as singular there may be no place to be found
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
            # a zone of several leaves the others
            left = softest(march.model, stiffened(march.model, before.system, one, 0.0))
            lets_go = Loss.CONTACT, one.pair.name, held, left.curvature
            return Lost(value, uncertainty, *lets_go, energy, before.system, left.direction)
    mass = lumped_mass(march.model)
    along, size = float(before.mode.direction @ (mass * before.way)), float(np.sqrt(before.way @ (mass * before.way)))
    # τ goes to zero with μ, or not at all; round-off over the last μ makes τ small at a bifurcation too
    fold = abs((clear or before).rate) < _TURNING * abs(first.rate) and abs(along) > _ALONG * size
    loss, side = Loss.FOLD if fold else Loss.BIFURCATION, -1.0 if fold and along < 0.0 else 1.0
    zero = before.curvature if before.curvature < -behind.curvature else behind.curvature
    return Lost(value, uncertainty, loss, "", zero, zero, energy, before.system, side * before.mode.direction)
