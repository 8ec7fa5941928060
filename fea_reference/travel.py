"""Load stepping from station to station along a branch: step control and supervision of the smallest curvature.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
μ       smallest curvature of the potential energy on the feasible directions
λ       value of the stepped parameter
r       dz/dλ along the branch
======  =====================================================================================

A branch of minima ends where μ is zero. Towards a fold μ² is linear in λ, towards a bifurcation μ is. The zero of μ²,
extrapolated from the last two steps, is the nearer estimate; no step exceeds half of the distance to the zero.
:mod:`fea_reference.following` follows the branch by arc length near the zero. The same happens where a step fails,
where an equilibrium is no minimum, or where a contact is about to lose its force.

Branch jump test: along a branch a step equals the mean of r at both ends up to third order. With a change of contact
in between, the step lies between both. A larger deviation means another branch, however near. A step on its branch
does not release energy either (:mod:`fea_reference.released`).
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from cprbm_scene.answer import Array, Critical, Ending, GoneOver, Loss
from fea_reference.descent import descend
from fea_reference.drawn import taut_at
from fea_reference.following import WEAKER, CriticalPoint, follow_branch, force_about_to_vanish
from fea_reference.march import BypassedPoint, March, StoppedError, Trouble
from fea_reference.model import SharePart
from fea_reference.released import releases_energy
from fea_reference.touch import Circle, Face, Pair

_PREDICTED = 0.3  # rad (and lengths): largest predicted motion of a load step
_CUTS = 10  # consecutive cuts of a step, to a quarter
_SHORTEST = 0.25**_CUTS  # times the span: length of a step over the whole span after all cuts
_PROGRESS = 1e-3  # times the span: progress
_PATIENCE = 250  # iterations without this progress: a failing step then starts the search for a critical point
_EASY = 6  # iterations: a step with more is not followed by a longer step
_FAR = 4.0  # elements: larger motion of a zone between stations, which calls for loose penalties again
_DEVIATION = 0.15  # times the motion of a step: accepted deviation from the mean of the tangents
_TANGENT_CHANGE = 0.6  # times the difference of the tangents: further accepted deviation
_NO_MOTION = 1e-6  # rad (and lengths): negligible motion
_PENETRATION_FACTOR = 10.0  # times the earlier penetration: further accepted deviation after a change of penalty
_NEIGHBOUR_ROTATION = 0.3  # rad: largest rotation of sections and bodies to a neighbouring state
_SAME_POINT = 1e-5  # times the span: distance of two values for the same critical point
_MANY, _CROWDED = 4, 0.01  # this many critical points within this share of the span lead to no stable branch
_HALF = 0.5  # times the distance to the extrapolated zero of the curvature
_NEAR = 1e-2  # times the span: a shorter step is left to path following
_FOLLOWINGS = 8  # consecutive runs of path following with tight penalties
_CUTS_BEFORE_FOLLOWING = 3  # consecutive cuts before path following starts
_CUTS_BEFORE_WATCHING = 3  # cuts in total before the curvature is computed although no critical point is sought


@dataclass(frozen=True, slots=True)
class Course:
    """Load stepping of parameter number ``load`` over a dimensionless ``span`` in a ``stage``.

    ``beyond`` says how to continue at a critical point: stop, jump to the next minimum, or step to a neighbouring
    state. Without a request (None) the latter is tried. The assembly is not a stage and has an empty name.
    """

    load: int
    span: float
    stage: str = ""
    beyond: Literal["stop", "jump", "beside"] | None = "stop"


def reach(march: March, course: Course, target: float) -> None:
    """Step the parameter to ``target`` exactly.

    Without a request for critical points, the steps first watch for critical points and continue to a neighbouring
    branch. If the target is not reached, stepping ends at the first critical point. Without any critical point the
    steps are repeated without supervision.

    Raises:
        StoppedError: the target cannot be reached.
    """
    if course.beyond is not None:
        _reach(march, course, target)
        return
    origin = march.saved()
    try:
        _reach(march, replace(course, beyond="beside"), target)
        if len(march.bypassed) == len(origin.bypassed) or march.is_minimum:
            return
        stopped = StoppedError(Ending.NOT_A_MINIMUM, "")
    except StoppedError as error:
        stopped = error
    if new_points := march.bypassed[len(origin.bypassed) :]:
        raise _ending_at_first(march, origin, new_points) from None
    if stopped.ending is Ending.BRANCH_ENDS:
        raise stopped
    march.restore(origin)
    march.critical, march.bypassed, march.last_step = list(origin.critical), list(origin.bypassed), None
    _reach(march, course, target)


def _ending_at_first(march: March, origin: March, new_points: list[BypassedPoint]) -> StoppedError:
    """Ending at the first critical point passed, after a continuation without success."""
    march.critical = [*origin.critical, replace(new_points[0].record.end, after=None)]
    march.bypassed = list(origin.bypassed)
    return StoppedError(Ending.BRANCH_ENDS, new_points[0].sentence)


def _reach(march: March, course: Course, target: float) -> bool:
    """Step to ``target`` with supervision as the course says; True if a step released energy."""
    load = course.load
    march.iterations, march.switched, march.least_penalties = 0, {}, {}
    march.close_touching(load)
    origin, before = march.saved(), march.zones()
    if march.zones_far and march.values[load] != target:
        march.loosen(Circle, Face)
    released_energy = _step_to(march, course, target, watched=course.beyond is not None)
    march.settle(load)
    same = len(march.critical) == len(origin.critical) and march.values[load] != origin.values[load]
    if same and not (march.is_minimum and march.penetrations_bounded):
        # a minimum under the penalties of load stepping only: the critical point lies before, under the initial
        # penalties
        unstable, bounded = march.saved(), march.penetrations_bounded
        march.restore(origin)
        critical = follow_branch(march, load, target, course.span) if bounded else _follow_tight(march, course, target)
        if critical is None:
            # no critical point: a long step jumped to another branch, shorter steps may not
            march.restore(origin)
            try:
                _step_to(march, course, target, watched=True)
                march.settle(load)
            except StoppedError:
                march.restore(unstable)
        else:
            _continue_beyond(march, course, target, critical)
            march.iterations, march.last_step = 0, None
            _step_to(march, course, target, watched=course.beyond is not None)
            march.settle(load)
    march.iterate_to_round_off()
    after = march.zones()
    march.zones_far = march.zones_far and any(
        np.abs(after[contact] - before[contact]).max() > _FAR for contact in before if contact in after
    )
    return released_energy


def _follow_tight(march: March, course: Course, target: float) -> CriticalPoint | None:
    """Critical point found by path following with tight penalties while there is progress; None without any."""
    for _ in range(_FOLLOWINGS):
        before = march.values[course.load]
        critical = follow_branch(march, course.load, target, course.span)
        if critical is not None or abs(target - march.values[course.load]) >= abs(target - before):
            return critical
    return None


def _step_to(march: March, course: Course, target: float, *, watched: bool) -> bool:
    """Step to ``target`` with the current penalties; if ``watched``, along minima only.

    Returns True if a step released energy, which a watched step may not.

    Raises:
        StoppedError: the target cannot be reached.
    """
    load = course.load
    stride, cuts, searching, follow = np.inf, 0, False, True
    reason: Trouble = (Ending.STEP_TOO_SMALL, "")
    known: list[tuple[float, float]] = []
    limit = march.settings.iteration_limit
    rate: Array | None = None
    tight: March | None = None
    tightened_at: float | None = None  # value of λ at a tightening against passing through
    last_progress, search_done = (march.values[load], march.iterations), False
    released_energy, failed = False, 0
    pulls: list[tuple[float, float]] = []
    while march.values[load] != target:
        if not pulls or march.values[load] != pulls[-1][0]:
            # drop values that a restored state went back over
            pulls = [
                previous for previous in pulls if (march.values[load] - previous[0]) * (target - previous[0]) > 0.0
            ]
            pulls.append((float(march.values[load]), march.largest_axial_force))
        watching = watched or failed >= _CUTS_BEFORE_WATCHING
        if abs(march.values[load] - last_progress[0]) >= _PROGRESS * course.span:
            last_progress, search_done = (march.values[load], march.iterations), False
        if cuts > _CUTS:
            raise _taut_ending(march, load, pulls) or StoppedError(*reason)
        if march.iterations > limit:
            raise StoppedError(
                Ending.STEP_TOO_SMALL,
                f"{march.iterations} iterations reach no farther than {march.described(load, march.values[load])}",
            )
        if watching and not known:
            known = [*march.points_before(load), (float(march.values[load]), march.curvature)]
        tangent = march.path_tangent(load, march.rate(load) if rate is None else rate, target)
        rate = tangent.rate
        speed = float(np.abs(rate[march.model.moving]).max())
        remaining = target - march.values[load]
        predicted = _HALF * _distance_to_zero(known)
        size = min(abs(remaining), stride, _PREDICTED / max(speed, 1e-300))
        minimum = not watched or known[-1][1] > 0.0
        stable = bool(known) and known[-1][1] > 0.0
        close = stable and predicted < size and predicted < _NEAR * course.span
        size = min(size, predicted)
        value = target if size >= abs(remaining) else march.values[load] + np.copysign(size, remaining)
        if value == march.values[load]:
            raise _taut_ending(march, load, pulls) or StoppedError(*reason)
        close = close or (stable and follow and force_about_to_vanish(march, load, float(value)))
        saved, spent = march.saved(), march.iterations
        trouble: Trouble | None = None
        unstable = False
        if not (follow and close):
            trouble = march.step(load, value, tangent)
            failed += trouble is not None
            if trouble is None:
                ahead = march.rate(load)
                jumped = _released_energy(saved, march, load, rate, ahead)
                if _off_branch(saved, march, load, rate, ahead) or (watched and jumped):
                    trouble = (
                        Ending.STEP_TOO_SMALL,
                        f"beyond {saved.described(load, saved.values[load])} the nearest equilibrium is on another "
                        "branch",
                    )
                else:
                    released_energy = released_energy or jumped
                    unstable = watched and minimum and march.curvature <= 0.0
        if unstable and not follow:
            # the branch has no critical point nearby: this state is on another branch
            trouble = Ending.NOT_A_MINIMUM, f"beyond {saved.described(load, saved.values[load])} no minimum is found"
        slow = trouble is not None and march.iterations - last_progress[1] > _PATIENCE
        # tiny steps may succeed without progress: without a critical point the branch ends here
        tiny = trouble is not None and size < _SHORTEST * course.span and size * speed < _NO_MOTION
        if tiny and search_done and trouble is not None:
            raise _taut_ending(march, load, pulls) or StoppedError(*trouble)
        give_up_stepping = slow or tiny or (trouble is not None and cuts >= _CUTS_BEFORE_FOLLOWING)
        last_progress = (last_progress[0], march.iterations) if slow else last_progress
        if (unstable or give_up_stepping) and (taut_ending := _taut_ending(saved, load, pulls)) is not None:
            raise taut_ending
        if minimum and follow and (close or unstable or give_up_stepping):
            critical, progressed, retry_from_saved = None, False, True
            if tight is not None:
                # under loose penalties the state may lie beyond the critical point under tight ones
                retry_from_saved = saved.values[load] != tight.values[load]
                march.restore(tight)
                tight, critical = None, follow_branch(march, load, target, course.span)
                progressed = critical is None and abs(target - march.values[load]) < abs(target - value)
            if critical is None and not progressed and retry_from_saved:
                march.restore(saved)
                critical = follow_branch(march, load, target, course.span) if march.curvature > 0.0 else None
                progressed = critical is None and abs(target - march.values[load]) < abs(target - value)
            if critical is not None:
                if not _raise_penalty(march, load, target, critical):
                    _continue_beyond(march, course, target, critical)
                stride, cuts, failed, searching = np.inf, 0, 0, False
                limit = march.iterations + march.settings.iteration_limit
                last_progress, search_done = (march.values[load], march.iterations), False
            elif give_up_stepping and not progressed:
                search_done = search_done or tiny
                march.restore(saved)
                stride, cuts, reason = 0.25 * size, cuts + 1, trouble or reason
                follow = False
            else:
                follow = False
            known, rate, march.last_step = [], None, None
        elif trouble is None:
            if watching and 0.0 < march.curvature < WEAKER * known[-1][1] and march.has_soft_penalty():
                # a state of low curvature is sensitive to the penetration of contacts
                march.tighten()
                ahead = march.rate(load)
            same = len(march.penalties) == len(saved.penalties) and march.acting is saved.acting
            known = [*known[-1:], (float(march.values[load]), march.curvature)] if same and watching else []
            march.previous_point = (load, *known[-2]) if len(known) == 2 and not march.loosened else None
            march.last_step, rate = march.step_record(load, saved, rate, ahead), ahead
            easy = march.iterations - spent <= _EASY
            stride, cuts, follow = 2.0 * size if easy else size, 0, True
            searching = searching and len(march.penalties) == len(saved.penalties)
            tight = tight if searching else None
        else:
            march.restore(saved)
            rate = None
            crossed = trouble[0] is Ending.BEAMS_CROSSED
            already_tightened = tightened_at == march.values[load]
            if not already_tightened and (march.has_deep_tip() or (crossed and march.has_deep_pair())):
                # raise the penalties of contacts that may pass through
                march.tighten()
                known, march.last_step, tightened_at = [], None, march.values[load]
                stride, cuts, reason = size if crossed else 0.25 * size, cuts + 1, trouble
            elif not (already_tightened or searching) and march.loosen(Circle, Face, Pair):
                if watched and minimum and not march.curvature > 0.0:
                    # a state held by a contact alone is unstable under a loose penalty, and path following would miss
                    # its end
                    march.restore(saved)
                    searching, stride, cuts, reason = True, 0.25 * size, cuts + 1, trouble
                else:
                    searching, march.zones_far, known, tight = True, True, [], saved
            else:
                search_done = search_done or tiny
                stride, cuts, reason = 0.25 * size, cuts + 1, trouble
    return released_energy


def _taut_ending(march: March, load: int, pulls: list[tuple[float, float]]) -> StoppedError | None:
    """Ending for inextensible beams drawn taut, from the axial forces ``pulls`` of the steps; None otherwise."""
    value = taut_at(pulls) if march.settings.kinematics == "bending" and march.penetrations_bounded else None
    if value is None:
        return None
    sentence = (
        f"forces grow without limit as {march.described(load, value)} is neared, where beams would have to stretch"
    )
    return StoppedError(Ending.STEP_TOO_SMALL, sentence)


def _distance_to_zero(known: list[tuple[float, float]]) -> float:
    """Distance from the last value to the zero of the squared curvature, extrapolated linearly from two values."""
    if len(known) < 2:
        return np.inf
    (previous, before), (last, now) = known
    if not 0.0 < now < before:
        return np.inf
    return abs(last - previous) * now**2 / (before**2 - now**2)


def _released_energy(saved: March, march: March, load: int, rate: Array, ahead: Array) -> bool:
    """True if a step released energy; only decidable under a load or drive with unchanged constraints and penalties."""
    if isinstance(march.model.stepped[load], SharePart) or march.acting is not saved.acting:
        return False
    if any(march.penalties.get(pair) != penalty for pair, penalty in saved.penalties.items()):
        return False
    here, there = (saved.system, saved.values, rate), (march.system, march.values, ahead)
    return releases_energy(march.model, load, march.acting, (here, there))


def _off_branch(saved: March, march: March, load: int, rate: Array, ahead: Array) -> bool:
    """True if a step deviates from the mean of its path tangents: another branch."""
    moving = march.model.moving
    step = march.values[load] - saved.values[load]
    first, last = step * rate[moving], step * ahead[moving]
    if not (first.any() and last.any()):
        return False  # a singular stiffness matrix gives no tangent
    motion = (march.system.z.values - saved.system.z.values)[moving]
    deviation = float(np.abs(motion - 0.5 * (first + last)).max())
    # after tightening, contacts lose their previous penetration
    now = {pair.name: penalty for pair, penalty in march.penalties.items()}
    changed = [
        contact for contact in saved.system.touches if now.get(contact.pair.name) != saved.penalties[contact.pair]
    ]
    deviation -= _PENETRATION_FACTOR * max((contact.penetration for contact in changed), default=0.0)
    largest_motion, uneven = max(np.abs(first).max(), np.abs(last).max()), np.abs(last - first).max()
    return bool(deviation > _TANGENT_CHANGE * uneven + _DEVIATION * largest_motion + _NO_MOTION)


def _record(march: March, course: Course, critical: CriticalPoint, after: float | None) -> Critical:
    """Critical point in SI units, with the dimensionless energy ``after`` the jump."""
    unit, moment = march.model.stepped[course.load].unit, march.model.units.moment
    return Critical(
        stage=course.stage,
        value=critical.value * unit,
        uncertainty=critical.uncertainty * unit,
        loss=critical.loss,
        what=critical.what,
        curvature=critical.curvature,
        left=critical.left,
        energy=critical.energy * moment,
        after=None if after is None else after * moment,
    )


def _descent_possible(march: March, load: int, target: float, critical: CriticalPoint) -> bool:
    """True if an energy descent may continue from the critical point at the current state.

    After a slip off another beam's end the gap is undefined at first. A corner has a gap on all sides; but a slip
    beyond ``target`` at a corner is only due to the penalty.
    """
    if critical.loss is not Loss.SLIP:
        return True
    corner = any(
        contact.pair.name == critical.what and isinstance(contact.pair, Face) for contact in critical.system.touches
    )
    return corner and abs(critical.value - march.values[load]) < abs(target - march.values[load])


def _raise_penalty(march: March, load: int, target: float, critical: CriticalPoint) -> bool:
    """True if a slip beyond ``target`` is due to the penalty and a firmer penalty now holds up to the target."""
    return (
        critical.loss is Loss.SLIP
        and bool((critical.value - target) * np.sign(target - march.values[load]) > 0.0)
        and march.raise_penalty(critical.what)
    )


def _may_bypass(march: March, course: Course, critical: CriticalPoint) -> bool:
    """True if stepping may continue beyond a critical point without request.

    Bifurcations are excluded, because both sides are equivalent. Repeated points and many points in close sequence
    are excluded, too.
    """
    unit = march.model.stepped[course.load].unit
    distances = [
        abs(critical.value - point.record.end.value / unit) / course.span
        for point in march.bypassed
        if point.record.end.stage == course.stage
    ]
    return (
        critical.loss is not Loss.BIFURCATION
        and not (distances and distances[-1] <= _SAME_POINT)
        and not (len(distances) >= _MANY and distances[-_MANY] <= _CROWDED)
    )


def _continue_beyond(march: March, course: Course, target: float, critical: CriticalPoint) -> None:
    """Record a critical point and continue beyond it as the course says.

    Raises:
        StoppedError: there is no continuation.
    """
    load = course.load
    why = {
        Loss.FOLD: "it folds back",
        Loss.BIFURCATION: "another one branches off",
        Loss.CONTACT: f"the contact {critical.what} lets go",
        Loss.STOP: f"the stop {critical.what} lets go",
        Loss.SLIP: f"a beam's end slips off in contact {critical.what}",
    }[critical.loss]
    sentence = (
        f"at {march.described(load, critical.value)} the branch of minima ends, {why}: the smallest curvature comes to "
        f"{critical.curvature:.3g} there, and to {critical.left:.3g} after the loss"
    )
    after = None
    leads_on = _descent_possible(march, load, target, critical)
    if course.beyond == "jump" and leads_on:
        after = descend(march, load, target, course.span, critical)
    elif course.beyond not in ("stop", "jump") and leads_on and _may_bypass(march, course, critical):
        before = march.saved()
        energy = descend(march, load, target, course.span, critical, _NEIGHBOUR_ROTATION)
        if energy is not None:
            turned = march.largest_rotation(march.system, critical.system.z)
            march.bypassed.append(BypassedPoint(sentence, GoneOver(_record(march, course, critical, energy), turned)))
            return
        march.restore(before)
    if course.stage:
        march.critical.append(_record(march, course, critical, after))
    if after is None:
        if course.beyond == "jump":
            sentence += "; the energy descent from there finds no minimum"
        raise StoppedError(Ending.BRANCH_ENDS, sentence)
