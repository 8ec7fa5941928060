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

The moment of a stop is an unknown and vanishes exactly where the stop opens.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from cprbm_scene.answer import Array, Loss
from fea_reference.advance import advance
from fea_reference.branch import Branch, BranchPoint, branch_point, point_at, sign_change
from fea_reference.curvature import Mode, softest
from fea_reference.energy import potential_energy
from fea_reference.march import March
from fea_reference.mass import lumped_mass
from fea_reference.off_a_corner import Segment, cut_short, find_slip, leaves_corner
from fea_reference.slipping import distance_to_end, passed_end
from fea_reference.system import System, assemble, with_stiffness_factor
from fea_reference.taut import TurningPoint, continue_beyond
from fea_reference.touch import Touch

WEAKER = 0.6  # times the curvature under tight penalties: below, penalties are tightened again
_FIRST = 0.01  # arc length of the first step
_MOST = 0.03  # rad (and lengths): largest motion of a step
_LEAST = 1e-9
_STEPS = 400
_CHECK_INTERVAL = 30  # steps between two checks of progress
_STRAIGHT = 0.9  # cosine between the tangents at both ends of a step
_LONGER = 2.0  # step lengths: a farther point is on another branch
_SHARP = 1e-6  # arc length of a turn that counts as sharp
_PAST_MINIMUM = 1.2  # times the least curvature so far: the minimum of the curvature has been passed
_PAST = 5  # steps
_ROOTS = 60
_FINE = 1e-8  # times the span
_SHORT = 1e-4  # times a step
_WIDE = 1e-4  # times the span: a critical point with a larger uncertainty may vanish with shorter steps
_SEGMENTS = 20  # path segments
_FARTHER = 30.0  # arc lengths between two points: a larger distance means different branches
_BETWEEN = 1.0  # elements: gap between contact points that separates zones
_FOLD_COSINE = 0.5  # cosine between tangent and φ at a fold
_FOLD_TANGENT = 0.1  # times the initial dλ/ds: largest value at a fold
_CLEAR, _NEAR = 1e-5, 1e-2  # times the initial μ: above round-off, and near enough for dλ/ds at the critical point
_APPROACHED = 1e-8  # times the span: distance at which a contact force counts as zero
_SHARE = 0.9  # share of the remaining distance per step
_SLIPPING = 0.1  # times the span: distance from which an end is followed until it slips off
_BACK = 2.0  # times the distance passed, if the slip has been passed already
_AS_GOOD = 1e-6  # times the span: distance at which the slip counts as reached
_FORESEEN = 1e-3  # times the span: largest distance over which the slip is extrapolated, if no step leads nearer
_DIFFERENCE = 1e-7  # times the span: increment of finite differences
_RIGID = 1e4  # stiffness factor that stands for a rigid contact
_STABLE_SHARE = 1e-2  # times the initial curvature: a contact with a larger one is stable
# times the initial contact force: negligible, or small while the rigid contact is unchanged
_NOTHING, _LITTLE = 1e-2, 0.1
_SOON = 1e-4  # times the span: distance from which a contact force is on its final decrease
_UNCHANGED_SHARE = 0.5  # times the initial curvature with a rigid contact: the contact is unchanged


@dataclass(frozen=True, slots=True)
class CriticalPoint:
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


def follow_branch(march: March, load: int, target: float, span: float) -> CriticalPoint | None:
    """Follow the branch towards ``target``; returns the critical point before ``target``, or None.

    Without a critical point the state has moved along the branch, possibly not at all. If the branch turns back and
    stays a branch of minima, the state moves on to the branch that starts beyond, if any.
    """
    saved = march.saved()
    critical = _follow(march, load, target, span, tight=False)
    if isinstance(critical, CutShort):
        # penetration under the penalties of load stepping shifts the slip
        march.restore(saved)
        march.tighten()
        critical = _follow(march, load, target, span, tight=True)
    if isinstance(critical, TurningPoint) and not continue_beyond(march, critical, target):
        march.restore(saved)
    return critical if isinstance(critical, CriticalPoint) else None


def _follow(
    march: March, load: int, target: float, span: float, *, tight: bool
) -> CriticalPoint | TurningPoint | CutShort | None:
    """Critical point, turning point, or None; stops where a zone is cut short that loose penalties widen."""
    march.update_sides()
    if march.loosened:
        march.tighten()
    critical = _vanishing_contact(march, load, target, span) or _end_slip(march, load, target, span)
    if critical is not None:
        return critical
    # under a loose penalty a contact may hold a state, on another branch, that a rigid contact does not
    if march.has_soft_penalty():
        march.tighten()
    sense = float(np.sign(target - march.values[load]))
    branch = _branch(march, load, span)
    here = branch_point(branch, float(march.values[load]), march.system, (np.zeros(march.model.size), sense))
    if not tight and cut_short(march.model, march.system):
        return CutShort()
    if here is None or not here.curvature > 0.0:
        return None
    first, least, steps_past_minimum, tight_curvature = here, here.curvature, 0, here.curvature
    length = _FIRST
    known, turn = (here.curvature, length), None
    segments: list[Segment] = []
    uncertain: tuple[CriticalPoint, March] | None = None
    for tried in range(_STEPS):
        if tried % _CHECK_INTERVAL == 0 and tried > 0:
            # at this rate of decrease no critical point comes within the limit of steps
            if here.curvature > (1.0 - _CHECK_INTERVAL / _STEPS) * known[0] and length <= known[1]:
                return turn
            known = here.curvature, length
        length = min(length, _MOST / max(float(np.abs(here.way[march.model.moving]).max()), _MOST))
        there = point_at(branch, here, length)
        other_branch = there is not None and length > _SHARP and not _same_branch(branch, here, there, length)
        if there is None or other_branch or leaves_corner(march.model, here.system, there.system):
            length *= 0.25
            if length < _LEAST:
                segments = [*segments, Segment(branch, here, 0.0)]
                return _corner_slip(march, load, segments, here) or _restore_uncertain_end(march, uncertain) or turn
            continue
        if any(passed_end(march.model, contact, here.system.z, there.system.z) for contact in here.system.touches):
            critical = _end_slip(march, load, target, span)
            length *= 0.25
            if critical is not None or length < _LEAST:
                return critical or _restore_uncertain_end(march, uncertain) or turn
            continue
        if march.least_gap(there.system) < 0.0:
            event = sign_change(branch, here, length, lambda there: march.least_gap(there.system))
            if event is None:
                return turn
            critical = _apply_change(march, load, event)
            if critical is not None:
                return critical
            branch = _branch(march, load, span)
            restarted = branch_point(branch, float(march.values[load]), march.system, (event.way, event.rate))
            if restarted is None or not restarted.curvature > 0.0:
                return turn
            here, segments = restarted, []
            continue
        if there.curvature <= 0.0:
            if not tight and cut_short(march.model, there.system):
                return CutShort()
            critical = _critical_between(march, branch, first, here, there, length)
            slipped = critical and _corner_slip(march, load, [*segments, Segment(branch, here, length)], critical)
            known_well = critical is not None and critical.uncertainty <= _WIDE * span
            if slipped is not None or (
                critical is not None and known_well and (critical.value - target) * sense <= 0.0
            ):
                return slipped or critical
            # such a long step leads to another branch, or past a near miss of two branches
            uncertain = uncertain if critical is None else (critical, march.saved())
            march.values, march.system = branch.at(here.value), here.system
            if known_well:
                return turn  # the target comes before the critical point
            length *= 0.25
            if length < _LEAST:
                return _restore_uncertain_end(march, uncertain) or turn
            continue
        if not tight and cut_short(march.model, there.system):
            return CutShort()
        if (there.value - target) * sense >= 0.0:
            return turn
        if march.passing_failure(here.system.z, there.system, "") is not None:
            return turn
        march.values, march.system = branch.at(there.value), there.system
        if there.curvature < WEAKER * tight_curvature and march.has_soft_penalty():
            # a state of low curvature is sensitive to the penetration of contacts
            march.tighten()
            branch, tight_curvature = _branch(march, load, span), there.curvature
            restarted = branch_point(branch, float(march.values[load]), march.system, (there.way, there.rate))
            if restarted is None or not restarted.curvature > 0.0:
                return turn
            here, least, steps_past_minimum = restarted, min(least, restarted.curvature), 0
            continue
        if turn is None and here.rate * sense > 0.0 > there.rate * sense:
            turn = TurningPoint(branch, here, length)
        steps_past_minimum = steps_past_minimum + 1 if there.curvature > _PAST_MINIMUM * least else 0
        least = min(least, there.curvature)
        if steps_past_minimum >= _PAST:
            return turn
        segments = [*segments[-_SEGMENTS:], Segment(branch, here, length)]
        here, length = there, 1.5 * length
    return turn


def _restore_uncertain_end(march: March, uncertain: tuple[CriticalPoint, March] | None) -> CriticalPoint | None:
    """The critical point with a large uncertainty, with the state restored; None without such a point.

    Called if no shorter step continues the branch.
    """
    if uncertain is None:
        return None
    march.restore(uncertain[1])
    return uncertain[0]


def _corner_slip(
    march: March, load: int, segments: list[Segment], end: CriticalPoint | BranchPoint
) -> CriticalPoint | None:
    """Critical point where an end slips off a corner, after the ``segments``; None if no end does.

    Called where the branch is lost to the penalty before the slip, or cannot be continued.
    """
    slip = find_slip(march.model, segments, end.system)
    if slip is None:
        return None
    march.values, march.system = segments[-1].branch.at(slip.place.value), slip.place.system
    mode_without = softest(march.model, _without(march, slip.contact))
    critical = _extrapolated_end(
        march, load, slip.value - slip.place.value, Loss.SLIP, slip.contact, slip.place.curvature, mode_without
    )
    return replace(critical, uncertainty=float(abs(slip.value - end.value)))


def _branch(march: March, load: int, span: float) -> Branch:
    return Branch(march.model, march.settings, dict(march.penalties), march.acting, march.values.copy(), load, span)


def _same_branch(branch: Branch, here: BranchPoint, there: BranchPoint, length: float) -> bool:
    """True if both points are on the same branch, a ``length`` of arc apart."""
    cosine = float(here.way @ (branch.weights * there.way)) + branch.weight * here.rate * there.rate
    return cosine >= _STRAIGHT and _distance(branch, here, there) <= _LONGER * length


def _distance(branch: Branch, here: BranchPoint, there: BranchPoint) -> float:
    """Distance of two points in the metric of the arc length."""
    difference = (there.system.z.values - here.system.z.values) + (there.system.z.rest - here.system.z.rest)
    return float(np.sqrt(difference @ (branch.weights * difference) + branch.weight * (there.value - here.value) ** 2))


def _apply_change(march: March, load: int, event: BranchPoint) -> CriticalPoint | None:
    """Close contacts and switch stops at ``event``; the critical point if an opening stop leaves an unstable state."""
    changing = [stop for stop in march.model.stops if march.stop_margin(stop, event.system) < 0.0]
    march.values[load], march.system = event.value, event.system
    march.close_touching(load)
    march.switch_stops(load, changing)
    return stop_instability(march, load, event.curvature, event.system)


def stop_instability(march: March, load: int, curvature: float, system: System) -> CriticalPoint | None:
    """Critical point of stops just opened in a ``system`` of the given ``curvature``; None if the state is stable."""
    opened = [
        stop.known_as
        for stop in march.model.stops
        if stop.name in system.acting.limits and stop.name not in march.acting.limits
    ]
    mode = softest(march.model, march.system)
    if not opened or mode.curvature > 0.0:
        return None
    value = float(march.values[load])
    energy = potential_energy(march.model, march.system, march.values)
    uncertainty = float(np.spacing(abs(value)))
    return CriticalPoint(
        value, uncertainty, Loss.STOP, opened[0], curvature, mode.curvature, energy, march.system, mode.direction
    )


def force_about_to_vanish(march: March, load: int, value: float) -> bool:
    """True if a contact force, extrapolated linearly, vanishes before ``value`` and leaves an unstable state."""
    distance = value - float(march.values[load])
    next_contact = _next_vanishing(march, load, float(np.sign(distance)))
    return (
        next_contact is not None
        and abs(next_contact[1]) < abs(distance)
        and not softest(march.model, _without(march, next_contact[0])).curvature > 0.0
    )


def _vanishing_contact(march: March, load: int, target: float, span: float) -> CriticalPoint | None:
    """Critical point where a contact loses its force and leaves an unstable state; None if none is near."""
    sense = float(np.sign(target - march.values[load]))
    saved = march.saved()
    while True:
        next_contact = _next_vanishing(march, load, sense)
        if next_contact is None or next_contact[1] * sense > (target - march.values[load]) * sense:
            break
        contact, distance = next_contact
        mode_without = softest(march.model, _without(march, contact))
        if mode_without.curvature > 0.0:
            break
        if abs(distance) <= _APPROACHED * span:
            critical = _end_at_zero_force(march, load, contact, distance, mode_without)
            if critical is not None:
                return critical
            break
        before, rate = march.saved(), march.rate(load)
        size = min(_SHARE * abs(distance), _MOST / max(float(np.abs(rate[march.model.moving]).max()), 1e-300))
        trouble = march.step(
            load, float(march.values[load]) + np.copysign(size, distance), march.path_tangent(load, rate, target)
        )
        if trouble is not None or not softest(march.model, march.system).curvature > 0.0:
            march.restore(before)
            critical = (
                _end_at_zero_force(march, load, contact, distance, mode_without)
                if abs(distance) <= _FORESEEN * span
                else None
            )
            if critical is not None:
                return critical
            break
    march.restore(saved)
    return None


def _end_at_zero_force(
    march: March, load: int, contact: Touch, distance: float, mode_without: Mode
) -> CriticalPoint | None:
    """Critical point at the zero of a contact force, at ``distance``, with the mode ``mode_without`` the contact.

    None if the state is unstable with a rigid contact, too.
    """
    mode_with = softest(march.model, with_stiffness_factor(march.model, march.system, contact, _RIGID))
    if not mode_with.curvature > 0.0:
        return None
    return _extrapolated_end(march, load, distance, Loss.CONTACT, contact, mode_with.curvature, mode_without)


def _extrapolated_end(
    march: March, load: int, distance: float, loss: Loss, contact: Touch, curvature: float, mode_without: Mode
) -> CriticalPoint:
    """Critical point at ``distance`` in λ, where a contact ends; ``curvature`` is the value with the contact."""
    return CriticalPoint(
        float(march.values[load] + distance),
        abs(distance),
        loss,
        contact.pair.name,
        curvature,
        mode_without.curvature,
        potential_energy(march.model, march.system, march.values),
        march.system,
        mode_without.direction,
    )


def _end_slip(march: March, load: int, target: float, span: float) -> CriticalPoint | None:
    """Critical point where a pressing end passes the end of the other beam; None if none is near.

    The zone has a finite width, smaller for tighter penalties, and passes in part earlier. From there on the
    remaining distance is extrapolated, and is the uncertainty.
    """
    sense, saved = float(np.sign(target - march.values[load])), march.saved()
    tight = behind = False
    while (next_slip := _next_slip(march, load, sense * span)) is not None:
        contact, distance = next_slip
        if tight and not behind and -_SLIPPING * span <= distance * sense < 0.0:
            # under tight penalties the slip lies behind the current state
            march.restore(saved)
            if not _step_towards(march, load, _BACK * distance):
                break
            march.tighten()
            behind = True
            continue
        if not 0.0 <= distance * sense <= min(_SLIPPING * span, (target - march.values[load]) * sense):
            break
        if not tight:
            # penetration shifts the slip, possibly to a point behind the current state
            march.tighten()
            tight = True
            continue
        if abs(distance) > _AS_GOOD * span and _step_towards(march, load, distance):
            continue
        if abs(distance) > _FORESEEN * span:
            break
        return _extrapolated_end(
            march, load, distance, Loss.SLIP, contact, march.curvature, softest(march.model, _without(march, contact))
        )
    march.restore(saved)
    return None


def _step_towards(march: March, load: int, distance: float) -> bool:
    """Step over most of the ``distance``, within the limit of motion; True on success, else the state stays."""
    before, rate = march.saved(), march.rate(load)
    size = min(_SHARE * abs(distance), _MOST / max(float(np.abs(rate[march.model.moving]).max()), 1e-300))
    value = float(march.values[load] + np.copysign(size, distance))
    if march.step(load, value, march.path_tangent(load, rate, value)) is None:
        return True
    march.restore(before)
    return False


def _next_slip(march: March, load: int, ahead: float) -> tuple[Touch, float] | None:
    """The contact with the first end to slip off, and the distance in λ at the current rate."""
    step = _DIFFERENCE * ahead
    moved_state = advance(march.model, march.system.z, step * march.rate(load))
    first_slip: tuple[Touch, float] | None = None
    for contact in march.system.touches:
        here = distance_to_end(march.model, contact, march.system.z)
        there = None if here is None else distance_to_end(march.model, contact, moved_state)
        if here is None or there is None or not there < here:
            continue
        distance = step * here / (here - there)
        if first_slip is None or abs(distance) < abs(first_slip[1]):
            first_slip = contact, distance
    return first_slip


def _contact_parts_since(first: System, now: System) -> Iterator[tuple[Touch, Touch]]:
    """Pairs (contact at ``first``, contact ``now``) of all closed contacts, then of their zones if the counts agree."""
    initial_contacts = {
        initial_contact.pair: initial_contact for initial_contact in first.touches if initial_contact.closed
    }
    both = [
        (initial_contacts[contact.pair], contact)
        for contact in now.touches
        if contact.closed and contact.pair in initial_contacts
    ]
    for initial_contact, contact in both:
        yield initial_contact, contact
        zones, before = _zones(contact), _zones(initial_contact)
        if len(zones) == len(before) > 1:
            yield from zip(before, zones, strict=True)


def _parts(contact: Touch) -> list[Touch]:
    """Parts of a contact that may lose their force: the contact, and its zones if there are several."""
    zones = _zones(contact)
    return [contact, *zones] if len(zones) > 1 else [contact]


def _zones(contact: Touch) -> list[Touch]:
    """The contact restricted to every zone along the first beam."""
    order = np.argsort(contact.zeta, kind="stable")
    number = np.empty(len(order), dtype=int)
    number[order] = np.concatenate(([0], np.cumsum(np.diff(contact.zeta[order]) > _BETWEEN)))
    return [replace(contact, stiffness=np.where(number == i, contact.stiffness, 0.0)) for i in range(number.max() + 1)]


def _force_vanished(
    march: March, branch: Branch, first: BranchPoint, initial_contact: Touch, contact: Touch, curvature: float
) -> bool:
    """True if the force of a contact has vanished, where the rigid contact would give the ``curvature``."""
    if contact.push < _NOTHING * initial_contact.push:
        return True
    change = float(initial_contact.predicted_forces(first.way).sum()) - initial_contact.push
    soon = (
        change < 0.0
        and initial_contact.push * abs(first.rate) < -change * _SOON * branch.span
        and contact.push < initial_contact.push
    )
    if not (soon or contact.push < _LITTLE * initial_contact.push):
        return False
    return (
        curvature
        > _UNCHANGED_SHARE
        * softest(march.model, with_stiffness_factor(march.model, first.system, initial_contact, _RIGID)).curvature
    )


def _next_vanishing(march: March, load: int, sense: float) -> tuple[Touch, float] | None:
    """The contact or zone whose force vanishes first at the current rate, and the distance in λ."""
    rate = march.rate(load)
    first_part: tuple[Touch, float] | None = None
    for part in (part for contact in march.system.touches if contact.closed for part in _parts(contact)):
        change = float(part.predicted_forces(sense * rate).sum()) - part.push
        if change >= 0.0:
            continue
        distance = float(-part.push / change)
        if first_part is None or distance < abs(first_part[1]):
            first_part = part, sense * distance
    return first_part


def _without(march: March, contact: Touch) -> System:
    """The current state without a contact, or without a zone of a contact."""
    if all(contact is not other for other in march.system.touches):
        return with_stiffness_factor(march.model, march.system, contact, 0.0)
    others = {pair: penalty for pair, penalty in march.penalties.items() if pair != contact.pair}
    return assemble(march.model, others, march.settings.quadrature, march.values, march.system.z, march.acting)


def _critical_between(
    march: March, branch: Branch, first: BranchPoint, here: BranchPoint, there: BranchPoint, length: float
) -> CriticalPoint | None:
    """Critical point between two points with positive and non-positive curvature.

    None if no point with a vanishing curvature is found between: the points are on different branches.
    """
    low, high, weights, clear = (0.0, here), (length, there), [1.0, 1.0], None
    for _ in range(_ROOTS):
        (s, before), (t, behind) = low, high
        if abs(behind.value - before.value) <= _FINE * branch.span and t - s <= _SHORT * length:
            break
        if length > _SHARP and _distance(branch, before, behind) > _FARTHER * (t - s):
            return None
        # regula falsi, with the weight of the unchanged end halved (Illinois variant)
        above, below = weights[0] * before.curvature, weights[1] * behind.curvature
        share = min(max(above / (above - below), 0.02), 0.98)
        # near a singular tangent there may be no solution
        tried = ((part, point_at(branch, here, s + part * (t - s))) for part in (share, 0.5 * share, 0.5 + 0.5 * share))
        share, middle = next(
            ((part, place_found) for part, place_found in tried if place_found is not None), (share, None)
        )
        if middle is None:
            if min(before.curvature, -behind.curvature) > _STABLE_SHARE * first.curvature:
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
    for initial_contact, contact in _contact_parts_since(first.system, before.system):
        curvature = softest(march.model, with_stiffness_factor(march.model, before.system, contact, _RIGID)).curvature
        if curvature > _STABLE_SHARE * first.curvature and _force_vanished(
            march, branch, first, initial_contact, contact, curvature
        ):
            # the other zones stay in contact
            mode_without = softest(march.model, with_stiffness_factor(march.model, before.system, contact, 0.0))
            lets_go = Loss.CONTACT, contact.pair.name, curvature, mode_without.curvature
            return CriticalPoint(value, uncertainty, *lets_go, energy, before.system, mode_without.direction)
    mass = lumped_mass(march.model)
    along, size = float(before.mode.direction @ (mass * before.way)), float(np.sqrt(before.way @ (mass * before.way)))
    # τ vanishes with μ at a fold only; round-off over the last μ makes τ small at a bifurcation too
    fold = abs((clear or before).rate) < _FOLD_TANGENT * abs(first.rate) and abs(along) > _FOLD_COSINE * size
    loss, side = Loss.FOLD if fold else Loss.BIFURCATION, -1.0 if fold and along < 0.0 else 1.0
    zero = before.curvature if before.curvature < -behind.curvature else behind.curvature
    return CriticalPoint(value, uncertainty, loss, "", zero, zero, energy, before.system, side * before.mode.direction)
