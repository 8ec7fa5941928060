"""Following a branch of minima by load steps that are cut where one fails and grow where they succeed.

A step is refused where no certified minimum is found, where a link turns too far, where a beam goes across what it may
touch, and where the links went another way than their rates say (:mod:`cprbm.rate`), which leads to another branch.
Where the rates leave a doubt the branch is looked for half-way (:mod:`cprbm.midway`), and if it is not there, a shorter
step is taken; none is begun on which the rates turn a link farther than may be.
Where ends of branches are asked for, a step is no longer than a small turn of the links, so that none hides in it.
After a step was refused, the way on is cut by what will soon be zero (:func:`cprbm.critical.foreseen`), so that a
branch's end is closed in on from the side where it stands.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from cprbm.certifying import certify
from cprbm.critical import Minimum, foreseen
from cprbm.edge import Edge
from cprbm.extrapolating import KEPT, continued
from cprbm.first_equilibrium import Equilibrium, equilibrium
from cprbm.kinematics import most_turned
from cprbm.locking import Locked, between_ends, drawn_taut, locked_on, pressed_on, taut
from cprbm.mechanism import Mechanism
from cprbm.midway import doubt, uneven
from cprbm.nearest import Pair
from cprbm.point import Point
from cprbm.rate import carried_by_others, rate, strayed
from cprbm.settings import Settings
from cprbm.slipping import slipped, slipped_off
from cprbm.stretching import stretched
from cprbm_scene import Certificate, Ending
from cprbm_scene.answer import Array

GROWTH = 2.0
AGAIN, NEARER = 0.5, 0.25  # of the way to what was refused before: from so near it is tried again, and once more
OVER = 4.0  # times a step at whose end links are too long to hold beams apart
FASTER = 4.0  # where no step was refused
LEAST = 0.06  # part of a step that is tried after it: what a rate makes too much of goes with the step's root
SETTLE = 0.1  # of the way: in shorter steps steady rows may settle which places there are
CLOSER = 0.98  # of the way that is left to where something ends
SOON = 6  # iterations to a state that is nearly known
SHORT = 0.2  # rad: the most that a link may turn in a step that hides no end of a branch
FAR = 10.0  # times the way that the rates make: up to a fold it is twice that
ISOLATED = 0.01  # rad: the most in which a contact or stop may close or open: what it catches did not fall far
ROUNDED = 1e-12  # of the way: less than this is left of it by round-off
NEARLY_TAUT = 1e-3  # of the way: so near what ends it, forces tell whether that is a beam which is taut
JUST = 2.0  # smallest steps, to see that there is nothing beyond
TRAIL = 30  # minima that are kept
ELSEWHERE = "half-way of a load step the branch is not where the rates at its ends say"


@dataclass(frozen=True, slots=True)
class Way:
    """What is stepped from one equilibrium that is wanted to the next: some values (SI) that go evenly.

    ``load`` is the one that the scene steps; an assembly steps none.
    """

    load: str
    begin: Mapping[str, float]
    target: Mapping[str, float]

    def at(self, fraction: float) -> dict[str, float]:
        """All values at a fraction of the way."""
        if fraction == 1.0:
            return dict(self.target)
        return {name: self.begin[name] + fraction * (end - self.begin[name]) for name, end in self.target.items()}

    def value(self, fraction: float) -> float:
        """That of the load; of an assembly the fraction."""
        return self.at(fraction)[self.load] if self.load else fraction

    @property
    def change(self) -> dict[str, float]:
        """What the values change by on the whole way."""
        return {name: end - self.begin[name] for name, end in self.target.items()}

    @property
    def aim(self) -> str:
        """Where it leads, for people."""
        return f"{self.load} = {self.target[self.load]:.6g}" if self.load else "the end of this part"


def to(load: str, values: Mapping[str, float], target: float) -> Way:
    """The way from present ``values`` to a ``target`` of one load or drive; what has no value is at zero."""
    begin = {**values, load: values.get(load, 0.0)}
    return Way(load, begin, {**begin, load: target})


@dataclass(frozen=True, slots=True)
class Reached:
    """How a way ended: with a ``certificate`` at its end, or none and the Ending and sentence that say why."""

    ending: Ending
    sentence: str
    certificate: Certificate | None


@dataclass
class Follower:
    """Where on a branch we are: the state of the one loop that steps.

    Attributes:
        mechanism, settings: what is followed.
        point, values: the state, and the values (SI) of all loads and drives.
        trail: minima since it was cleared, the last ones.
        reached, refused: the values up to which the last way was gone, and at which its last step was refused.
        beyond: those (SI) of all loads and drives at which it was.
        careful: whether no end of a branch may be passed.
        settles: whether steady rows may settle which places there are.
        locked: the straight beam that the last way asked to change its length, where it could not be gone.
    """

    mechanism: Mechanism
    settings: Settings
    point: Point
    values: dict[str, float]
    trail: list[Minimum]
    reached: float = 0.0
    refused: float = 0.0
    beyond: Mapping[str, float] = field(default_factory=dict)
    careful: bool = False
    settles: bool = True
    locked: Locked | None = None

    def go(self, way: Way, accept: Callable[[Point, dict[str, float]], None]) -> Reached:
        """Go all the way, directly or in steps; ``accept`` sees every next minimum before it is the present one."""
        done, step, iterations, refused = 0.0, 1.0, 0, False
        doubted: tuple[float, Equilibrium] | None = None
        believed: Certificate | None = None  # of what is doubted, if that is known
        bad, nearest, again = np.inf, np.inf, AGAIN  # what was refused last, and from how near
        before_leap: float | None = None  # the step whose end a longer one is to go over
        self.values, self.reached, self.locked = dict(way.begin), way.value(0.0), None
        problem = self.mechanism.problem
        here = there = rate(problem, self.point, way.change)
        while True:
            step = min(step, 1.0 - done, self._longest(here))
            fraction = 1.0 if done + step >= 1.0 - ROUNDED else done + step
            values = way.at(fraction)
            ahead = None if refused else continued(problem, values, self._known, way.value(fraction))
            doubtful = 0.0
            # what was found before in too long a step may be believed from nearer
            before = doubted[1] if doubted is not None and doubted[0] == fraction else None
            for start in self._starts(before, ahead, values):
                if before is not None and start is before.point:
                    found = before
                else:
                    most = SOON if start is ahead else self.settings.iterations
                    wary = self.careful or refused
                    farthest = self._farthest((fraction - done) * here) if wary else np.inf
                    found = self._solved(
                        values, start, most, farthest, settle=self.settles and step <= SETTLE and start is self.point
                    )
                    iterations += found.iterations
                if found is before and believed is not None:
                    certificate, ending = believed, Ending.COMPLETED
                else:
                    certificate, ending = certify(self.mechanism, self.settings, found)
                if ending is Ending.COMPLETED:
                    there = rate(problem, found.point, way.change)
                    ways = (fraction - done) * here, (fraction - done) * there
                    ending, sentence = self._strayed(found.point, *ways)
                    if ending is Ending.COMPLETED and self._uneven(found.point, *ways):
                        iterations += 1
                        doubtful = doubt(problem, way.at(0.5 * (done + fraction)), self.point, found.point, *ways)
                        if doubtful > 1.0:
                            ending, sentence, doubted = Ending.STEP_TOO_SMALL, ELSEWHERE, (fraction, found)
                else:
                    sentence = certificate.failures[0] if found.converged else "Newton's method did not settle"
                if ending is Ending.COMPLETED:
                    break
            if ending is Ending.COMPLETED:
                accept(found.point, values)
                self.point, self.values, done, here = found.point, values, fraction, there
                self.reached = way.value(fraction)
                self.trail = [*self.trail[-TRAIL:], Minimum(way.value(fraction), self.point.bare, certificate)]
                if fraction == 1.0:
                    return Reached(ending, "", replace(certificate, iterations=iterations))
                before_leap = None
                if fraction >= bad:
                    bad = np.inf
                step = self._next(way, done, GROWTH * step, bad, again * nearest) if refused else FASTER * step
                continue
            if doubtful > 1.0 and step > self.settings.smallest_step and iterations <= self.settings.iteration_limit:
                # nothing ends here: the step was too long to be believed
                believed = certificate if doubted is not None and found is doubted[1] else None
                step = max(min(0.5, max(doubtful**-2, LEAST)) * step, self.settings.smallest_step)
                continue
            self.refused, self.beyond = way.value(fraction), values
            if done == 0.0 and not refused:
                self.locked = locked_on(problem, self.point, way.change)
                if self.locked is not None:
                    return Reached(Ending.STEP_TOO_SMALL, self.locked.told, certificate=None)
            # where links are so long that beams overlap in between, what lies beyond may hold
            overlapping = ending is Ending.BEAMS_CROSSED and bool(certificate.failures)
            if overlapping and before_leap is None and fraction < 1.0:
                before_leap, step, refused = step, OVER * step, True
                continue
            if before_leap is not None:
                step = before_leap
                before_leap = None
            elif not overlapping:
                again = AGAIN if np.isinf(bad) else NEARER
                bad, nearest = fraction, step
            step, refused = self._cut(way, done, 0.5 * step), True
            if abs(self.refused - self.reached) <= NEARLY_TAUT * abs(way.value(1.0) - way.value(0.0)):
                limit = taut(self._minima, self.refused)
                if limit is not None:
                    return Reached(Ending.STEP_TOO_SMALL, drawn_taut(way.load, limit), certificate=None)
            if iterations > self.settings.iteration_limit or step < self.settings.smallest_step:
                beam = pressed_on(problem, self.point, found.point, values)
                if beam:
                    return Reached(Ending.STEP_TOO_SMALL, between_ends(beam), certificate=None)
            if iterations > self.settings.iteration_limit:
                return Reached(
                    Ending.STEP_TOO_SMALL, f"{iterations} iterations did not lead to {way.aim}", certificate=None
                )
            if step < self.settings.smallest_step:
                ending = ending if found.converged else Ending.STEP_TOO_SMALL
                return Reached(ending, sentence, certificate=None)

    def stand(self, point: Point, values: Mapping[str, float], certificate: Certificate, load: str) -> None:
        """Go on from a minimum found elsewhere, under the ``values`` (SI) of all loads and drives."""
        self.point, self.values, self.reached = point, dict(values), values.get(load, 0.0)
        self.trail = [*self.trail[-TRAIL:], Minimum(self.reached, point.bare, certificate)]

    def _starts(self, before: Equilibrium | None, ahead: Point | None, values: dict[str, float]) -> Iterator[Point]:
        """Where Newton's method begins, until it finds what is sought: first where the last minima lead, if known.

        What was found ``before`` under these values needs no solving, and comes before that.
        """
        if before is not None:
            yield before.point
        if ahead is not None:
            yield ahead
        yield self.point
        held = stretched(self.mechanism.problem, values, self.point)
        if held is not None:
            yield held

    def _longest(self, here: Array) -> float:
        """The largest part of the way that may be taken at once, on which links turn at the rate ``here``.

        So far that no end of a branch hides in it if none may be passed; else as far as a link may turn at all.
        """
        turn, most = float(np.max(np.abs(here))), SHORT if self.careful else self.settings.largest_turn
        return max(most / turn, self.settings.smallest_step) if turn > most else 1.0

    @property
    def _known(self) -> list[tuple[float, Point]]:
        """The last minima and their values."""
        return self._minima[-KEPT:]

    @property
    def _minima(self) -> list[tuple[float, Point]]:
        """All minima that are kept, and their values."""
        return [(one.value, one.point) for one in self.trail]

    def _farthest(self, way: Array) -> float:
        """The most that a link turns by before a step is given up on which links go a ``way`` by their rates."""
        return max(FAR * float(np.max(np.abs(way))), 2.0 * ISOLATED)

    def _solved(
        self, values: dict[str, float], start: Point, most: int, farthest: float, *, settle: bool
    ) -> Equilibrium:
        problem, tolerance = self.mechanism.problem, self.settings.tolerance
        return equilibrium(problem, values, start, tolerance, most, settle=settle, farthest=farthest)

    def _strayed(self, found: Point, start: Array, end: Array) -> tuple[Ending, str]:
        """Why a minimum is not on the branch; COMPLETED where it is.

        ``start`` and ``end`` are the ways that the rates at both ends of the step make of it, (n_links,).
        """
        turned = most_turned(self.point.state, found.state)
        if turned > self.settings.largest_turn:
            return Ending.STEP_TOO_SMALL, f"a link turned by {turned:.2f} rad in one load step"
        if crossed := self.mechanism.passed(self.point, found, (start, end)):
            return Ending.BEAMS_CROSSED, f"in contact '{crossed}' the beam went across what it may touch"
        for name in pressing(self.point):
            pair = self.mechanism.pairs.get(name)
            if isinstance(pair, Pair) and slipped(pair, self.point, found):
                return Ending.STEP_TOO_SMALL, f"in contact '{name}' an end slips off the other on the way"
            if isinstance(pair, Edge) and slipped_off(pair, self.point, found):
                return Ending.STEP_TOO_SMALL, f"in contact '{name}' an end slips off a corner on the way"
        if self.careful and turned > ISOLATED and pressing(found) != pressing(self.point):
            return Ending.STEP_TOO_SMALL, "a contact or stop closes or opens on the way"
        change = found.state.theta - self.point.state.theta
        model = self.mechanism.problem.model
        if strayed(model.lengths, change, start, end, carried_by_others(model, self.point, found)):
            return Ending.STEP_TOO_SMALL, "the links went another way than their rates say, to another branch"
        return Ending.COMPLETED, ""

    def _uneven(self, found: Point, start: Array, end: Array) -> bool:
        """Whether what the rates at both ends say leaves a doubt where the branch is between them."""
        model = self.mechanism.problem.model
        change = found.state.theta - self.point.state.theta
        return uneven(model.lengths, change, start, end, carried_by_others(model, self.point, found))

    def _next(self, way: Way, done: float, step: float, bad: float, near: float) -> float:
        """The step after one that succeeded: no farther than what was refused (``bad``), half-way there if not near."""
        cut = self._cut(way, done, min(step, bad - done))
        return cut if done + cut < bad or bad - done <= near else 0.5 * cut

    def _cut(self, way: Way, done: float, step: float) -> float:
        """A step that ends before what is about to end the branch does, or just beyond where that is near."""
        begin, ahead = way.value(done), way.value(min(1.0, done + step))
        zero = foreseen(self.trail, ahead)
        if zero is None:
            return step
        smallest, left = self.settings.smallest_step, CLOSER * step * (zero - begin) / (ahead - begin)
        return left if left > smallest else min(step, JUST * smallest)


def pressing(point: Point) -> frozenset[str]:
    """Names of the contacts and stops that press."""
    return frozenset(point.rows.pressing(point.lam))
