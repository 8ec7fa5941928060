"""From station to station along a branch: load steps that are cut and grow, and a look at the smallest curvature.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
μ       smallest curvature of the potential energy on the feasible directions
λ       value of the stepped load or drive
r       dz/dλ along the branch
======  =====================================================================================

A branch of minima ends where μ is zero.  Towards a fold μ² goes evenly with λ, towards a bifurcation μ does; the zero
of μ² by the last two steps is the nearer one, and no step goes more than half of the way to it.  Close to it, and
wherever an equilibrium that was found is no minimum, no step can be made or a contact is about to lose its force, the
branch is followed by :mod:`fea_reference.following`.

A step that stays on its branch moves by the mean of r at both ends, but for its third power, or where a contact
changes in between by something between both; one that does not is on another branch, however near.  Nor does it release
energy (:mod:`fea_reference.released`).
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from cprbm_scene.answer import Array, Critical, Ending, GoneOver, Loss
from fea_reference.descent import descended
from fea_reference.drawn import taut_at
from fea_reference.following import WEAKER, Lost, about_to_go, followed
from fea_reference.march import Left, March, StoppedError, Trouble
from fea_reference.model import SharePart
from fea_reference.released import released
from fea_reference.touch import Circle, Face, Pair

_PREDICTED = 0.3  # rad (and lengths): the most that one load step may be predicted to move anything
_CUTS = 10  # in a row, each to a quarter
_SHORTEST = 0.25**_CUTS  # of the span: as short as a step all along it that is cut so often
_PACE = 1e-3  # of the span: who has not come so far
_PATIENCE = 250  # in so many iterations, and fails, may creep up to where the branch ends, and looks for that
_EASY = 6  # iterations: a step that took more is not followed by a longer one
_FAR = 4.0  # elements: a zone that goes farther from station to station is sought with loose penalties, if it had to
_ASIDE = 0.15  # of a step's own way: by which it may end aside of the mean of its rates
_UNEVEN = 0.6  # of the way by which its rates differ
_NOWHERE = 1e-6  # rad (and lengths): a way that is none
_RISES = 10.0  # times what had sunk in: the way of something else
_BESIDE = 0.3  # rad: a state in which sections and bodies are turned by no more is beside another
_AGAIN = 1e-5  # of the span: an end that is met again, not another
_MANY, _CROWDED = 4, 0.01  # ends that follow each other within such a part of the span: they lead on to nothing
_HALF = 0.5  # of the way to where the curvature is foreseen to vanish
_NEAR = 1e-2  # of the span: a step shorter than this is left to following the branch
_FOLLOWINGS = 8  # one after the other, where penalties are to stay tight
_TIRED = 3  # cuts in a row after which that is tried
_WARY = 3  # cuts in all after which the curvature is looked at where steps look for no end


@dataclass(frozen=True, slots=True)
class Course:
    """What is stepped: number ``load``, over a ``span`` without units, in a ``stage``; what to do ``beyond`` its end.

    The assembly is no stage, and has no name.  Where nothing is asked of the end of the branch, steps go on over it to
    a state ``beside`` it.
    """

    load: int
    span: float
    stage: str = ""
    beyond: Literal["stop", "jump", "beside"] | None = "stop"


def reach(march: March, course: Course, target: float) -> None:
    """March to the value ``target`` and land on it exactly.

    Where nothing is asked of the end of the branch, steps look for ends first, and go on over an end with another
    branch beside.  Where this does not lead to the target, the march ends with the first end that was met.  Where no
    end was met, steps go again from their begin, and look for none.

    Raises:
        StoppedError: it cannot be reached.
    """
    if course.beyond is not None:
        _reach(march, course, target)
        return
    origin = march.saved()
    try:
        _reach(march, replace(course, beyond="beside"), target)
        if len(march.left) == len(origin.left) or march.minimum:
            return
        stopped = StoppedError(Ending.NOT_A_MINIMUM, "")
    except StoppedError as error:
        stopped = error
    if met := march.left[len(origin.left) :]:
        raise _first_met(march, origin, met) from None
    if stopped.ending is Ending.BRANCH_ENDS:
        raise stopped
    march.restore(origin)
    march.critical, march.left, march.behind = list(origin.critical), list(origin.left), None
    _reach(march, course, target)


def _first_met(march: March, origin: March, met: list[Left]) -> StoppedError:
    """The first of the ends that were gone on over in vain, as what the march ends with."""
    first = replace(met[0].record.end, after=None)
    march.critical, march.left = [*origin.critical, first], list(origin.left)
    return StoppedError(Ending.BRANCH_ENDS, met[0].sentence)


def _reach(march: March, course: Course, target: float) -> bool:
    """The same, and whether steps look for ends is the course's; whether one has released energy on the way."""
    load = course.load
    march.iterations = 0
    march.switched, march.firm = {}, {}
    march.watch_what_touches(load)
    origin, before = march.saved(), march.zones()
    if march.far and march.values[load] != target:
        march.loosen(Circle, Face)
    leapt = _arrive(march, course, target, watched=course.beyond is not None)
    march.settle(load)
    same = len(march.critical) == len(origin.critical) and march.values[load] != origin.values[load]
    if same and not (march.minimum and march.held):
        # with the penalties of the way it was a minimum: the branch ends before, with those of its beginning
        there, held = march.saved(), march.held
        march.restore(origin)
        lost = followed(march, load, target, course.span) if held else _held_on(march, course, target)
        if lost is None:
            # no end: a long step has left the branch for another, on which short ones may stay
            march.restore(origin)
            try:
                _arrive(march, course, target, watched=True)
                march.settle(load)
            except StoppedError:
                march.restore(there)
        else:
            _beyond(march, course, target, lost)
            march.iterations, march.behind = 0, None
            _arrive(march, course, target, watched=course.beyond is not None)
            march.settle(load)
    march.sharpen()
    after = march.zones()
    march.far = march.far and any(np.abs(after[one] - before[one]).max() > _FAR for one in before if one in after)
    return leapt


def _held_on(march: March, course: Course, target: float) -> Lost | None:
    """How the branch is lost that is followed with tight penalties for as long as it leads on; None if it is not."""
    for _ in range(_FOLLOWINGS):
        before = march.values[course.load]
        lost = followed(march, course.load, target, course.span)
        if lost is not None or abs(target - march.values[course.load]) >= abs(target - before):
            return lost
    return None


def _arrive(march: March, course: Course, target: float, *, watched: bool) -> bool:
    """March to the value ``target``, with penalties as they are; ``watched``, from minimum to minimum.

    Whether a step on the way has released energy, which a watched one may not.

    Raises:
        StoppedError: it cannot be reached.
    """
    load = course.load
    stride, cuts, searching, follow = np.inf, 0, False, True
    reason: Trouble = (Ending.STEP_TOO_SMALL, "")
    known: list[tuple[float, float]] = []
    limit = march.settings.iteration_limit
    rate: Array | None = None
    tight: March | None = None
    firm: float | None = None  # where penalties were tightened lest a step should lead through something
    paced, looked = (march.values[load], march.iterations), False
    leapt, failed = False, 0
    pulls: list[tuple[float, float]] = []
    while march.values[load] != target:
        if not pulls or march.values[load] != pulls[-1][0]:
            # none of what was gone back over
            pulls = [one for one in pulls if (march.values[load] - one[0]) * (target - one[0]) > 0.0]
            pulls.append((float(march.values[load]), march.pull))
        looking = watched or failed >= _WARY
        if abs(march.values[load] - paced[0]) >= _PACE * course.span:
            paced, looked = (march.values[load], march.iterations), False
        if cuts > _CUTS:
            raise _drawn_taut(march, load, pulls) or StoppedError(*reason)
        if march.iterations > limit:
            raise StoppedError(
                Ending.STEP_TOO_SMALL,
                f"{march.iterations} iterations only led to {march.shown(load, march.values[load])}",
            )
        if looking and not known:
            known = [*march.foregone(load), (float(march.values[load]), march.curvature)]
        onward = march.onward(load, march.rate(load) if rate is None else rate, target)
        rate = onward.rate
        speed = float(np.abs(rate[march.model.moving]).max())
        way = target - march.values[load]
        foreseen = _HALF * _vanishing(known)
        size = min(abs(way), stride, _PREDICTED / max(speed, 1e-300))
        minimum = not watched or known[-1][1] > 0.0
        stable = bool(known) and known[-1][1] > 0.0
        close = stable and foreseen < size and foreseen < _NEAR * course.span
        size = min(size, foreseen)
        value = target if size >= abs(way) else march.values[load] + np.copysign(size, way)
        if value == march.values[load]:
            raise _drawn_taut(march, load, pulls) or StoppedError(*reason)
        close = close or (stable and follow and about_to_go(march, load, float(value)))
        saved, spent = march.saved(), march.iterations
        trouble: Trouble | None = None
        unstable = False
        if not (follow and close):
            trouble = march.step(load, value, onward)
            failed += trouble is not None
            if trouble is None:
                ahead = march.rate(load)
                jumped = _jumped(saved, march, load, rate, ahead)
                if _aside(saved, march, load, rate, ahead) or (watched and jumped):
                    trouble = (
                        Ending.STEP_TOO_SMALL,
                        f"beyond {saved.shown(load, saved.values[load])} the nearest equilibrium is on another branch",
                    )
                else:
                    leapt = leapt or jumped
                    unstable = watched and minimum and march.curvature <= 0.0
        if unstable and not follow:
            # the branch has no end near by, and this is another one
            trouble = Ending.NOT_A_MINIMUM, f"beyond {saved.shown(load, saved.values[load])} no minimum is found"
        crept = trouble is not None and march.iterations - paced[1] > _PATIENCE
        # some of ever shorter steps may succeed, and lead nowhere together: what has no other end ends there
        tiny = trouble is not None and size < _SHORTEST * course.span and size * speed < _NOWHERE
        if tiny and looked and trouble is not None:
            raise _drawn_taut(march, load, pulls) or StoppedError(*trouble)
        tired = crept or tiny or (trouble is not None and cuts >= _TIRED)
        paced = (paced[0], march.iterations) if crept else paced
        if (unstable or tired) and (taut := _drawn_taut(saved, load, pulls)) is not None:
            raise taut
        if minimum and follow and (close or unstable or tired):
            lost, over, again = None, False, True
            if tight is not None:
                # with loose penalties the march may have come past where the branch ends with tight ones
                again = saved.values[load] != tight.values[load]
                march.restore(tight)
                tight, lost = None, followed(march, load, target, course.span)
                over = lost is None and abs(target - march.values[load]) < abs(target - value)
            if lost is None and not over and again:
                march.restore(saved)
                lost = followed(march, load, target, course.span) if march.curvature > 0.0 else None
                over = lost is None and abs(target - march.values[load]) < abs(target - value)
            if lost is not None:
                if not _held_firmer(march, load, target, lost):
                    _beyond(march, course, target, lost)
                stride, cuts, failed, searching = np.inf, 0, 0, False
                limit = march.iterations + march.settings.iteration_limit
                paced, looked = (march.values[load], march.iterations), False
            elif tired and not over:
                looked = looked or tiny
                march.restore(saved)
                stride, cuts, reason = 0.25 * size, cuts + 1, trouble or reason
                follow = False
            else:
                follow = False
            known, rate, march.behind = [], None, None
        elif trouble is None:
            if looking and 0.0 < march.curvature < WEAKER * known[-1][1] and march.soft():
                # what stands less firmly is as if drawn otherwise where contacts have sunk into their penalties
                march.tighten()
                ahead = march.rate(load)
            same = len(march.penalties) == len(saved.penalties) and march.acting is saved.acting
            known = [*known[-1:], (float(march.values[load]), march.curvature)] if same and looking else []
            march.course = (load, *known[-2]) if len(known) == 2 and not march.loose else None
            march.behind, rate = march.gone(load, saved, rate, ahead), ahead
            easy = march.iterations - spent <= _EASY
            stride, cuts, follow = 2.0 * size if easy else size, 0, True
            searching = searching and len(march.penalties) == len(saved.penalties)
            tight = tight if searching else None
        else:
            march.restore(saved)
            rate = None
            crossed = trouble[0] is Ending.BEAMS_CROSSED
            firmly = firm == march.values[load]
            if not firmly and (march.cut() or (crossed and march.sunk())):
                # what presses is not to go through what gives way
                march.tighten()
                known, march.behind, firm = [], None, march.values[load]
                stride, cuts, reason = size if crossed else 0.25 * size, cuts + 1, trouble
            elif not (firmly or searching) and march.loosen(Circle, Face, Pair):
                if watched and minimum and not march.curvature > 0.0:
                    # what stands by a contact alone does not stand by a loose one, and whatever follows would pass
                    march.restore(saved)
                    searching, stride, cuts, reason = True, 0.25 * size, cuts + 1, trouble
                else:
                    searching, march.far, known, tight = True, True, [], saved
            else:
                looked = looked or tiny
                stride, cuts, reason = 0.25 * size, cuts + 1, trouble
    return leapt


def _drawn_taut(march: March, load: int, pulls: list[tuple[float, float]]) -> StoppedError | None:
    """What the march ends with where what bends alone has been drawn taut, by its ``pulls`` on the way; None if not."""
    value = taut_at(pulls) if march.settings.kinematics == "bending" and march.held else None
    if value is None:
        return None
    told = f"forces grow without limit as {march.shown(load, value)} is neared, where beams would have to become longer"
    return StoppedError(Ending.STEP_TOO_SMALL, told)


def _vanishing(known: list[tuple[float, float]]) -> float:
    """How far from the last of two values the square of the curvature is zero, on a straight line through both."""
    if len(known) < 2:
        return np.inf
    (one, before), (other, now) = known
    if not 0.0 < now < before:
        return np.inf
    return abs(other - one) * now**2 / (before**2 - now**2)


def _jumped(saved: March, march: March, load: int, rate: Array, ahead: Array) -> bool:
    """Whether a step has released energy, where that can be told: by a load or drive, while what acts stays."""
    if isinstance(march.model.stepped[load], SharePart) or march.acting is not saved.acting:
        return False
    if any(march.penalties.get(one) != penalty for one, penalty in saved.penalties.items()):
        return False
    here, there = (saved.system, saved.values, rate), (march.system, march.values, ahead)
    return released(march.model, load, march.acting, (here, there))


def _aside(saved: March, march: March, load: int, rate: Array, ahead: Array) -> bool:
    """Whether a step has not ended where the rates at its beginning and its end lead."""
    moving = march.model.moving
    step = march.values[load] - saved.values[load]
    first, last = step * rate[moving], step * ahead[moving]
    if not (first.any() and last.any()):
        return False  # one of the tangents is singular, and says nothing
    gone = (march.system.z.values - saved.system.z.values)[moving]
    aside = float(np.abs(gone - 0.5 * (first + last)).max())
    # what had sunk into loose penalties has come out of tight ones
    now = {pair.name: penalty for pair, penalty in march.penalties.items()}
    other = [one for one in saved.system.touches if now.get(one.pair.name) != saved.penalties[one.pair]]
    aside -= _RISES * max((one.penetration for one in other), default=0.0)
    way, uneven = max(np.abs(first).max(), np.abs(last).max()), np.abs(last - first).max()
    return bool(aside > _UNEVEN * uneven + _ASIDE * way + _NOWHERE)


def _record(march: March, course: Course, lost: Lost, after: float | None) -> Critical:
    """An end in SI, and the energy ``after`` it, without units."""
    unit, moment = march.model.stepped[course.load].unit, march.model.units.moment
    return Critical(
        stage=course.stage,
        value=lost.value * unit,
        uncertainty=lost.uncertainty * unit,
        loss=lost.loss,
        what=lost.what,
        curvature=lost.curvature,
        left=lost.left,
        energy=lost.energy * moment,
        after=None if after is None else after * moment,
    )


def _leads_on(march: March, load: int, target: float, lost: Lost) -> bool:
    """Whether a way down may lead on from an end at which the march stands.

    What has slipped off another beam's end lies between where it was and where its gap is seen.  A corner is seen from
    all sides; but where it is slipped off behind the ``target``, the penalty alone ends the branch before.
    """
    if lost.loss is not Loss.SLIP:
        return True
    corner = any(one.pair.name == lost.what and isinstance(one.pair, Face) for one in lost.system.touches)
    return corner and abs(lost.value - march.values[load]) < abs(target - march.values[load])


def _held_firmer(march: March, load: int, target: float, lost: Lost) -> bool:
    """Whether an end that is lost only behind the ``target``, but for a penalty, is now held as far as that."""
    behind = (lost.value - target) * np.sign(target - march.values[load]) > 0.0
    return lost.loss is Loss.SLIP and bool(behind) and march.firmer(lost.what)


def _goes_on(march: March, course: Course, lost: Lost) -> bool:
    """Whether the march may go on over an end: not where another branch goes off, either of whose sides is as good as
    the other, nor where it has been before, nor from one end to the next of many.
    """
    unit = march.model.stepped[course.load].unit
    ends = [left.record.end for left in march.left]
    gone = [end.value / unit for end in ends if end.stage == course.stage]
    again = len(gone) > 0 and abs(lost.value - gone[-1]) <= _AGAIN * course.span
    again = again or (len(gone) >= _MANY and abs(lost.value - gone[-_MANY]) <= _CROWDED * course.span)
    return lost.loss is not Loss.BIFURCATION and not again


def _beyond(march: March, course: Course, target: float, lost: Lost) -> None:
    """Record where a branch ends, and go on from there or not.

    Raises:
        StoppedError: not.
    """
    load = course.load
    why = {
        Loss.FOLD: "it folds back",
        Loss.BIFURCATION: "another one branches off",
        Loss.CONTACT: f"the contact {lost.what} lets go",
        Loss.STOP: f"the stop {lost.what} lets go",
        Loss.SLIP: f"an end slips off in {lost.what}",
    }[lost.loss]
    sentence = (
        f"at {march.shown(load, lost.value)} the branch of minima ends, {why}: the smallest curvature comes to "
        f"{lost.curvature:.3g} there, and what is left has {lost.left:.3g}"
    )
    after = None
    leads_on = _leads_on(march, load, target, lost)
    if course.beyond == "jump" and leads_on:
        after = descended(march, load, target, course.span, lost)
    elif course.beyond not in ("stop", "jump") and leads_on and _goes_on(march, course, lost):
        before = march.saved()
        energy = descended(march, load, target, course.span, lost, _BESIDE)
        if energy is not None:
            turned = march.turned(march.system, lost.system.z)
            march.left.append(Left(sentence, GoneOver(_record(march, course, lost, energy), turned)))
            return
        march.restore(before)
    if course.stage:
        march.critical.append(_record(march, course, lost, after))
    if after is None:
        if course.beyond == "jump":
            sentence += "; the decrease of the energy from there leads to no minimum that was found"
        raise StoppedError(Ending.BRANCH_ENDS, sentence)
