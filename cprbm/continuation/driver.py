"""Load steps between stations.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
t        fraction of the way to the next station
κ        smallest curvature of the energy
=======  ====================================================================================

A step starts Newton's method at the last state under the next targets.  A step is accepted if the equilibrium has a
certificate and loses no direction, no stop changes, and the test for jumps finds the same branch.  Otherwise the
step is halved; after an accepted step the next step is twice as long, but does not pass the end of a step that was
refused for another reason than its length.  A step ends where a stop closes or opens.

A step refused at the smallest size marks the end of the branch.  The zero of κ then tells a fold from a
bifurcation.  The stage chooses the end of the solve or a descent to a minimum.  Without a
choice of the stage a branch with two ways on ends, and others are passed only to a state near by.
"""

from dataclasses import dataclass, field, replace
from functools import partial
from typing import Literal

import numpy as np

from cprbm.continuation.closing import (
    TOGETHER,
    Change,
    apart_pairs,
    changed,
    contact_changes,
    kept_open,
    pressing,
    pressing_names,
    stop_changes,
)
from cprbm.continuation.critical import (
    ASKED,
    CriticalPoint,
    contact_ends,
    critical_point,
    locked_beam,
    opened,
    taut_value,
)
from cprbm.continuation.descent import descend
from cprbm.continuation.path import Reached, Way, energy_before, jumped, turned
from cprbm.equilibrium import (
    ContactClosesError,
    NotConvergedError,
    Solved,
    State,
    System,
    blocked,
    certify,
    equilibrium,
    softest,
    with_fixed_places,
)
from cprbm.settings import Settings
from cprbm_scene import Ending, Event, Loss
from cprbm_scene.answer import Array, Flags

CAREFUL_TURN = 0.2
"""Largest turn in a step, rad, where no critical point may be passed."""

BESIDE = 0.3
"""Largest turn, rad, to a state beside a critical point that no stage asks for."""

AHEAD = (0.001, 0.01, 0.03, 0.1)
"""Fractions of the rest of the way at which a minimum beyond a critical point is sought (nearby minima are soft)."""

ENDS = 10
"""Branches that may end between two stations."""

ENDLESS = 4
"""Changes of a stop or a contact without a step, per stop, after which the search ends."""

TRAIL = 30
"""Minima that are kept."""

Beyond = Literal["stop", "jump"] | None


class StepError(Exception):
    """No step leads on; ``ending`` and the sentence say why; ``too_long`` is a step with too large a turn."""

    def __init__(self, ending: Ending, sentence: str, *, too_long: bool = False) -> None:
        super().__init__(sentence)
        self.ending, self.too_long = ending, too_long


@dataclass(frozen=True, eq=False)
class Passed:
    """A critical point on the way, ``value`` and uncertainty (SI), and the minimum after the descent.

    ``after`` is the energy of the minimum, in units, less the work of the stepped load or drive since the point.
    """

    point: CriticalPoint
    value: float
    width: float
    landed: Solved | None = None
    after: float | None = None


@dataclass(eq=False)
class Driver:
    """Load stepping of a system.

    Attributes:
        system, settings: what is solved.
        solved: the present minimum.
        acting: which stops act.
        reached: fraction of the way to the present station.
        spent: Newton iterations since the last station.
        passed: critical points on the way to the present station.
        events: closings and openings of contacts on the way to the present station.
        drawn: names of the contacts that touch as drawn.
        touching: names of the contacts that press, and of those that touch as drawn.
    """

    system: System
    settings: Settings
    solved: Solved
    acting: Flags
    reached: float = 0.0
    spent: int = 0
    passed: list[Passed] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    drawn: frozenset[str] = frozenset()
    touching: frozenset[str] = frozenset()

    def follow(self, way: Way, beyond: Beyond = None) -> None:
        """Follow the equilibria along a way.

        Raises:
            StepError: no step leads to the end of the way.
        """
        self.passed, self.events, self.reached = [], [], 0.0
        trail = [Reached(0.0, self.solved)]
        largest = min(CAREFUL_TURN, self.settings.largest_turn) if beyond is not None else self.settings.largest_turn
        step, refused, events = 1.0, np.inf, 0
        while self.reached < 1.0:
            t = min(1.0, self.reached + step)
            trial = self._trial(way, t, largest)
            if isinstance(trial, StepError):
                if self.spent > self.settings.iteration_limit:
                    raise StepError(Ending.STEP_TOO_SMALL, f"{self.spent} iterations did not lead to the next station")
                step, refused = 0.5 * (t - self.reached), refused if trial.too_long else t
                if step < self.settings.smallest_step:
                    ended = contact_ends(trail, t) or critical_point(trail, t, way.change)
                    trail = self._leave(way, ended or self._locked(way, t, trail, trial), beyond)
                    step = max(step, AHEAD[0])
                continue
            at, solved, change = trial
            events = 0 if at > self.reached else events + 1
            if events > ENDLESS * (1 + len(self.acting)):
                raise StepError(Ending.STEP_TOO_SMALL, "stops or contacts close and open again without a step")
            refused = refused if refused > at else np.inf
            step = min(2.0 * (t - self.reached), refused - at)
            # a contact that closes without an event has touched at the begin of the step
            self._note(way, pressing_names(solved), self.reached, at)
            self.reached, self.solved = at, solved
            trail = [*trail, Reached(at, solved)][-TRAIL:]
            if change is not None:
                trail = self._changed(way, at, change, beyond)

    def _trial(self, way: Way, t: float, largest: float) -> tuple[float, Solved, Change | None] | StepError:
        """Fraction and state at the end of the next step, and the change there, or why there is no step."""
        begin, start, closing, states = self.reached, self.solved.state, frozenset[int](), dict[float, Solved]()
        awaited = frozenset(range(len(self.system.geometry.pairs))) - pressing(self.solved)

        def solve(share: float) -> Solved:
            # events ask again for the states at the ends of the step and at the located share
            if share not in states:
                near = states[min(states, key=lambda known: abs(known - share))].state
                states[share] = self._equilibrium(
                    replace(near, target=way.target(begin + share * (t - begin))), awaited
                )
            return states[share]

        try:
            while 1.0 not in states:
                states[0.0] = replace(self.solved, state=kept_open(start, closing))
                try:
                    solve(1.0)
                except ContactClosesError as overlap:
                    closing |= apart_pairs(self.solved, overlap.overlapping)
                    awaited -= overlap.met
                    # overlapping pairs keep the sides of the begin
                    start = replace(
                        start, contacts=with_fixed_places(self.system.geometry, start.z, start.contacts, turning=True)
                    )
            solved = solve(1.0)
            # an event is not sought in a step that is too long
            if (turn := turned(self.solved, solved)) > largest:
                return StepError(
                    Ending.STEP_TOO_SMALL, f"a link turned by {turn:.2f} rad in one load step", too_long=True
                )
            changes: list[Change] = [*stop_changes(self.solved, solved, self.acting, solve)]
            changes += contact_changes(self.solved, solved, closing, solve)
            at, change = t, min(changes, key=lambda change: change.share, default=None)
            if change is not None:
                at, change = begin + change.share * (t - begin), change._replace(early=change.early * (t - begin))
                solved = solve(change.share)
                if change.share < 1.0 - TOGETHER and pressing(self.solved) - pressing(solved) - change.pairs:
                    # a pair opens before, and is back at the end of the step: a shorter step sees the pair
                    return StepError(Ending.STEP_TOO_SMALL, "a contact opens and is back in a load step", too_long=True)
            elif closing:
                # the contact alone leads to the end of a short step
                solved = self._equilibrium(replace(start, target=solved.state.target))
        except (ContactClosesError, NotConvergedError, ValueError) as failure:
            return StepError(Ending.STEP_TOO_SMALL, str(failure))
        certificate, ending = certify(solved, self.settings.tolerance, 0, self.acting, with_curvature=False)
        if ending is not Ending.COMPLETED:
            return StepError(ending, certificate.failures[0])
        if jumped(self.solved, solved, (at - begin) * way.change):
            return StepError(Ending.STEP_TOO_SMALL, "the links went another way than the path's tangents")
        return at, solved, change

    def _equilibrium(self, state: State, awaited: frozenset[int] = frozenset()) -> Solved:
        solved = equilibrium(self.system, state, self.settings.iterations, awaited=awaited)
        self.spent += solved.iterations
        return solved

    def _note(self, way: Way, names: frozenset[str], closed: float, opened: float | None = None) -> None:
        """Add the contacts ``closed`` or ``opened`` at fractions of the way since the last state to the events."""
        before, self.touching = self.touching, names | self.drawn
        changes = ("closes", closed, self.touching - before), ("opens", opened, before - self.touching)
        self.events += [
            Event(way.stage, name, kind, way.value(at))
            for kind, at, changing in changes
            if at is not None
            for name in sorted(changing)
        ]

    def _changed(self, way: Way, t: float, change: Change, beyond: Beyond) -> list[Reached]:
        """Close or open a stop or contacts at the present state; the trail from there on.

        Raises:
            StepError: the branch ends there.
        """
        before, rows, geometry = self.solved, self.system.mechanism.rows, self.system.geometry
        if not change.pairs:
            state = changed(before.state, change.row, self.system)
            name = rows[change.row].name.rpartition(".")[0]
        else:
            state = kept_open(before.state, frozenset() if change.closes else change.pairs)
            name = geometry.pairs[change.first].name
        try:
            after = self._equilibrium(state)
        except NotConvergedError as failure:
            raise StepError(Ending.STEP_TOO_SMALL, f"'{name}' closes or opens and {failure}") from failure
        after = replace(after, state=kept_open(after.state, frozenset()))
        if blocked(after).lost:
            loss = Loss.CONTACT if name in self.system.mechanism.scene.contacts else Loss.STOP
            return self._leave(way, opened(before, after, t, loss, name), beyond)
        self._note(way, pressing_names(after) | ({name} if change.closes else set()), t - change.early, t)
        self.solved = after
        return [Reached(t, after)]

    def _locked(self, way: Way, t: float, trail: list[Reached], refused: StepError) -> CriticalPoint:
        """The bifurcation of a straight beam under shortening.

        Raises:
            StepError: something else keeps the step from being made.
        """
        if self.system.lengthening:
            raise refused
        solved = self.solved
        beam, longer = locked_beam(solved, way.change)
        limit = taut_value(trail, way, t)
        if limit is not None:
            raise StepError(
                Ending.STEP_TOO_SMALL,
                f"forces grow without limit as {way.name} comes to {limit:.6g}, where beams would have to become "
                "longer",
            )
        if not beam:
            raise refused
        if longer > -ASKED:
            change = "longer" if longer >= ASKED else "longer or shorter"
            raise StepError(
                Ending.STEP_TOO_SMALL,
                f"beam '{beam}' is straight between its ends, and cannot become {change} by bending",
            )
        kept = softest(solved).curvature
        return CriticalPoint(self.reached, 0.0, Loss.BIFURCATION, "", solved, solved, kept, kept)

    def _leave(self, way: Way, point: CriticalPoint, beyond: Beyond) -> list[Reached]:
        """Go down from a critical point to a minimum, if the stage goes on; the trail from there on.

        Raises:
            StepError: the branch ends.
        """
        passed = partial(Passed, point, way.value(point.t), abs(way.value(point.width) - way.value(0.0)))
        if beyond == "stop" or (beyond is None and point.has_two_ways) or len(self.passed) >= ENDS:
            self.passed.append(passed())
            raise StepError(Ending.BRANCH_ENDS, self._sentence(way, point))
        furthest = max(point.t, self.reached) + 10.0 * point.width
        for ahead in AHEAD:
            t = min(1.0, furthest + ahead * max(0.0, 1.0 - furthest))
            landed = self._landed(point, way.target(t), beside=beyond is None)
            if landed is not None:
                self.passed.append(passed(landed, energy_before(landed, way.change, t - point.t)))
                # a contact that closes in the descent closes at the critical load
                self._note(way, pressing_names(landed), point.t)
                self.solved, self.reached = landed, t
                return [Reached(t, landed)]
        self.passed.append(passed())
        if beyond == "jump":
            raise StepError(Ending.STEP_TOO_SMALL, f"no minimum found to which {self._sentence(way, point)} leads")
        raise StepError(Ending.BRANCH_ENDS, self._sentence(way, point))

    def _sentence(self, way: Way, point: CriticalPoint) -> str:
        return f"{point.sentence} at {way.name} = {way.value(point.t):.6g}" if way.name else point.sentence

    def _landed(self, point: CriticalPoint, target: Array, *, beside: bool) -> Solved | None:
        """The certified minimum of a descent under a target; None without a minimum, or with a minimum too far away."""
        try:
            landed = descend(self.system, point.start, point.curvature, target, self.acting, self.settings.iterations)
        except NotConvergedError:
            return None
        self.spent += landed.iterations
        _, ending = certify(landed, self.settings.tolerance, 0, self.acting, with_curvature=False)
        far = beside and turned(point.last, landed) > BESIDE
        return landed if ending is Ending.COMPLETED and not far else None
