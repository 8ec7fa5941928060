"""Where the march stands, and one step of it: contacts and stops that close, penalties that tighten."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.optimize import brentq

from cprbm_scene.answer import Array, Critical, Ending, GoneOver
from cprbm_scene.frozendict import frozendict
from fea_reference.acting import Acting
from fea_reference.advance import advance, bend, way_to
from fea_reference.carrying import at_ends
from fea_reference.contact import least_at_ends
from fea_reference.contacts import (
    CLOSED,
    against,
    clear,
    least_gap,
    looked_at,
    open_in,
    passed_through,
    resting_pressure,
    room,
    touch,
    zones_of,
)
from fea_reference.curvature import positive, softest
from fea_reference.face import cut
from fea_reference.model import Model
from fea_reference.newton import equilibrium
from fea_reference.off_a_corner import slipped_off
from fea_reference.onward import Onward, onward
from fea_reference.poised import poised
from fea_reference.settings import Settings
from fea_reference.sinking import Depth, known_depths, sunk
from fea_reference.slipping import gone_past
from fea_reference.state import State
from fea_reference.stops import StopPart
from fea_reference.system import System, assemble, load_direction
from fea_reference.touch import LACKING, Circle, Contact, Face, Pair, Penalty, Rigid, Touch
from fea_reference.yielding import FELT, POINT, ROUNDED, felt, in_points

_CORRECTED = 0.2  # the most by which the equilibrium may differ from its prediction: farther is another branch
_AHEAD = 2.0  # of the last step: the longest for which its change of rate tells anything
_BENT = 0.3  # of what a step moves by its rate: the most that its change may add
_TURNED = 1.0  # rad: of an element's end against its chord; beyond, a shallow arch is no longer shallow
_TIGHTEN = 100.0  # the most by which a penalty is raised at once
_NARROW = 2.0  # the power of that for a contact in a point, whose depth can be foreseen
_GENTLEST = 1.03  # the factor that is tried at last
_TIGHTENINGS = 40
_FELT = 5.0  # times the penetration asked: what may be felt of it elsewhere, as a share of pushes and motions
_HELD = 200.0  # times the penetration allowed: what is deeper, as penalties cannot be tightened, is not held
_SETTLINGS = 8
_LED = 1e-5  # of a known pressure, that may be another than the one led with
_NEARBY = (1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0)  # of a step: where to look for a closing under tighter penalties
_SINKING = 0.1  # of the thickness: an overlap that tight penalties are to press out on the way
_DEEPER = 1e-3  # of the shortest element: by how much a contact sinks that is about to be passed
_THROUGH = 0.5  # of the thickness: a way on which nothing passes through it unseen
_AT_LIMIT = 1e-10  # rad: by which an angle may be beyond its limit before its stop closes
_SHARP = 1e-3  # of the unbalanced force accepted: what is left at a station, where that is more than round-off
_SHARPENINGS = 3
_SOFT = 0.1  # of what the elements can follow
_PULLS = 1e-9  # of the largest force or of EI/length: with which a stop may pull before it lets go
_DIFFERENCE = 1e-4  # of a step: what rates of gaps are seen by
_INSIDE = 0.01  # of these: how far within what counts as closed its place is sought
_SWITCHED = 1e-8  # rad, or of these: how near to its change a stop is found
_AIM = 0.84  # of the penetration asked: what the penalty of two beams leaves, so that its error follows a law
_STIFFEST = 1e9  # times what the elements can follow: the most that a penalty is raised to, for a penetration of
_STANDARD = 1e-4  # of elements that are as long as thick; at a tip that goes with the square of what it may be deep
_FIRMER, _FIRMEST = 1e3, 1e9  # times at once, and what the elements can follow: where a penalty ends a branch early
_EVEN = 0.03  # by which a penalty may differ from the one wanted
_SAME = 1e-9  # by which the one of a circle may
_POLISHINGS = 8  # tries after which a penetration below the one asked will do
_IN_A_POINT = 1.5  # the power of one over the penetration with which the penalty of a contact in a point goes
_FALLS = (1.0, 2.0)  # in an area, and at a tip
_SUNK = 0.3  # of how deep something may be and not have gone through: what is deeper is about to
_STIFFER = 10.0  # times: the penalty with which the step is tried again then
_STIFFENINGS = 3
_LOOSER = (1.0, 0.5)  # of the way from tight penalties to the loosest, in orders of magnitude, that are tried
_NONE: Mapping[Contact, Touch] = frozendict()

Trouble = tuple[Ending, str]


class StoppedError(Exception):
    """The march cannot go on; internal to this package: it becomes the answer's ending."""

    def __init__(self, ending: Ending, sentence: str) -> None:
        super().__init__(sentence)
        self.ending, self.sentence = ending, sentence


@dataclass(frozen=True, slots=True)
class Behind:
    """The last step, by which the value of what is stepped (number ``load``) changed ``by`` so much.

    Over u from −1 where it began to 0 where it ended, the branch goes by u times its rate at the end, ``second`` u²
    and ``third`` u³, (size,) each.  ``acting`` and ``contacts`` are what acted and which contacts were closed at its
    beginning.
    """

    load: int
    by: float
    second: Array
    third: Array
    acting: Acting
    contacts: frozenset[Contact]


@dataclass(frozen=True, slots=True)
class Left:
    """An end of a branch that nothing asked for and the march went on over: how it is told, and the record of it."""

    sentence: str
    record: GoneOver


@dataclass
class March:
    """Where the march stands: the state of the one loop that is allowed one.

    ``values`` are those of all that is stepped, without units; ``acting`` which pins and stops do; ``penalties`` the
    contacts that have closed so far, with their stiffness; ``closing`` the value of the stepped load or drive at which
    each did, and each stop first; ``switched`` that at which each stop last closed or let go; ``critical`` are the
    ends of branches that have been passed, and ``left`` those that nothing asked for; ``iterations``
    are counted since the last station; ``far`` is whether zones have been too far from one station to the last for
    tight penalties and have not come nearer since, so that the way to the next one begins with loose ones on what is
    rigid; ``loose`` whether penalties were loosened since they were tightened; ``course`` are the load, value and
    curvature of the step before, where ends of branches are looked for and penalties are tight; ``known`` is the last
    system whose smallest curvature was asked for, with that; ``behind`` is the last step, if it went along a branch;
    ``firm`` the least penalties of contacts that have to be stiffer to this station than their depth asks.
    """

    model: Model
    settings: Settings
    open: list[Contact]
    values: Array
    system: System
    acting: Acting
    penalties: dict[Contact, Penalty] = field(default_factory=dict)
    closing: dict[str, float] = field(default_factory=dict)
    switched: dict[str, float] = field(default_factory=dict)
    critical: list[Critical] = field(default_factory=list)
    left: list[Left] = field(default_factory=list)
    iterations: int = 0
    far: bool = False
    loose: bool = False
    known: tuple[System, float] | None = None
    behind: Behind | None = None
    course: tuple[int, float, float] | None = None
    firm: dict[str, float] = field(default_factory=dict)

    def foregone(self, load: int) -> list[tuple[float, float]]:
        """Value and curvature one step before, if that was one of the same ``load``."""
        if self.course is None or self.course[0] != load or self.course[1] == self.values[load]:
            return []
        return [self.course[1:]]

    @property
    def curvature(self) -> float:
        """The smallest curvature of the potential energy on the feasible directions, found once for every system."""
        if self.known is None or self.known[0] is not self.system:
            self.known = self.system, softest(self.model, self.system).curvature
        return self.known[1]

    @property
    def minimum(self) -> bool:
        """Whether that is positive."""
        if self.known is None or self.known[0] is not self.system:
            return positive(self.model, self.system)
        return self.known[1] > 0.0

    @property
    def held(self) -> bool:
        """Whether what presses is nowhere far deeper than it may be: where penalties could be tightened."""
        allowed = self.allowed()
        return all(one.penetration <= _HELD * allowed.get(one.pair, np.inf) for one in self.system.touches)

    @property
    def pull(self) -> float:
        """The largest axial force."""
        return float(np.abs(self.system.z[self.model.element_dofs[6]]).max())

    def saved(self) -> March:
        """A copy to come back to."""
        return replace(
            self,
            open=list(self.open),
            values=self.values.copy(),
            penalties=dict(self.penalties),
            closing=dict(self.closing),
            switched=dict(self.switched),
            critical=list(self.critical),
            left=list(self.left),
        )

    def restore(self, saved: March) -> None:
        """Go back to where a copy was taken, but for the iterations that have been spent; it can be done again."""
        self.open, self.values, self.system, self.acting = (
            list(saved.open),
            saved.values.copy(),
            saved.system,
            saved.acting,
        )
        self.penalties, self.closing, self.switched = dict(saved.penalties), dict(saved.closing), dict(saved.switched)
        self.far, self.loose, self.course = saved.far, saved.loose, saved.course

    def rate(self, load: int, system: System | None = None) -> Array:
        """dz/dvalue along the branch, here or in another ``system`` of it; zero where the tangent is singular."""
        system = system or self.system
        rate = system.solve(load_direction(self.model, load, system.z, self.acting))
        return np.zeros(self.model.size) if rate is None else rate

    def onward(self, load: int, rate: Array, target: float) -> Onward:
        """How the branch, whose ``rate`` (size,) that is but for what only touches yet, goes on to a ``target``."""
        sense = float(np.sign(target - self.values[load]))
        return onward(self.model, self.system, self.penalties, self.settings.quadrature, rate, sense)

    def solve(self, load: int, value: float, z: State, begun: Mapping[Contact, Touch] = _NONE) -> System | None:
        """Equilibrium at ``value`` near ``z``, with contacts that have ``begun`` there; None if there is none."""
        values = self.values.copy()
        values[load] = value
        depths = self.depths() | {pair: one.penetration for pair, one in begun.items() if isinstance(pair, Pair)}
        pushes = self.pushes() | {pair: one.pushes for pair, one in begun.items()}
        solved = equilibrium(self.model, self.settings, self.penalties, values, z, self.acting, depths, pushes)
        self.iterations += solved.iterations
        return solved.system if solved.converged else self._let_go(values, way_to(self.model, self.system.z, z))

    def _let_go(self, values: Array, foreseen: Array) -> System | None:
        """Equilibrium under ``values`` without one of the contacts that press here, but would pull a step further on.

        A beam that lies on something along itself comes off place by place: each iteration sets free what pulls, and
        presses elsewhere.  Without the contact there is nothing to search, and what does not overlap then is right.
        """
        for one in (one for one in self.system.touches if one.closed and one.foreseen(foreseen).sum() <= 0.0):
            left = {pair: penalty for pair, penalty in self.penalties.items() if pair is not one.pair}
            solved = equilibrium(
                self.model, self.settings, left, values, self.system.z, self.acting, self.depths(), self.pushes()
            )
            self.iterations += solved.iterations
            if solved.converged and zones_of(self.model, one.pair, solved.system.z).least >= 0.0:
                z = solved.system.z
                return assemble(self.model, self.penalties, self.settings.quadrature, values, z, self.acting)
        return None

    def step(self, load: int, value: float, onward: Onward) -> Trouble | None:
        """Try to step to ``value``, or to where a contact or stop changes before; the trouble if neither can be."""
        penalties = dict(self.penalties)
        self.look()
        before, start = self.system.z, float(self.values[load])
        predicted = advance(self.model, before, self._foreseen(load, value - start, onward.rate))
        predicted, begun = self._begun(onward, penalties, predicted, value - start)
        system = self.solve(load, value, predicted, begun)
        for _ in range(_STIFFENINGS):
            stiffer = self.stiffer(system) if system is not None else {}
            if not stiffer:
                break
            self.penalties.update(stiffer)
            system = self.solve(load, value, predicted)
        if system is not None and self._sees_more_ends(system):
            self.renew()
            system = self.solve(load, value, predicted)
        if system is None:
            return (
                Ending.STEP_TOO_SMALL,
                f"Newton's method finds no equilibrium beyond {self.shown(load, start)}",
            )
        if self.moved(system, predicted) > _CORRECTED:
            return (
                Ending.STEP_TOO_SMALL,
                f"beyond {self.shown(load, start)} the nearest equilibrium is on another branch",
            )
        touched = self.least_gap(system) < 0.0
        changing = [stop for stop in self.model.stops if self.room(stop, system) < 0.0]
        if touched:
            known = {start: self.system, value: system}
            found = self._first_touch(load, known)
            if found is None:
                return (
                    Ending.STEP_TOO_SMALL,
                    f"no closing of a contact or stop found beyond {self.shown(load, start)}",
                )
            value, system = found
            before_it = self._seen_otherwise(known, value)
            if before_it is not None:
                value, system, touched = before_it, known[before_it], False
            again = [stop.known_as for stop in changing if self.switched.get(stop.name) == value]
            if again:
                return (
                    Ending.STEP_TOO_SMALL,
                    f"beyond {self.shown(load, start)} {again[0]} neither holds nor lets go",
                )
        where = f"beyond {self.shown(load, start)}"
        trouble = self.passed(before, system, where) or self._slipped(system, where)
        if trouble is not None:
            return trouble
        self.values[load], self.system = value, system
        self.change_places()
        if touched:
            self._close_tightly(load, value - start)
            self.watch_what_touches(load, value - start)
            self.switch(load, changing)
        return None

    def _seen_otherwise(self, known: Mapping[float, System], value: float) -> float | None:
        """The last value before that of a touch, if beams lie otherwise there than they were looked at; else None.

        What touches begins with no overlap.  A place that comes to face another beam from the far side, round the end
        of that, is as deep as it is away, and is no touch.
        """
        pairs = (pair for pair in self.open if isinstance(pair, Pair) and pair.roles is None)
        if not any(least_gap(self.model, pair, known[value].z) < -pair.scale for pair in pairs):
            return None
        clear = [one for one in known if self.least_gap(known[one]) >= 0.0]
        last = min(clear, key=lambda one: abs(one - value), default=value)
        otherwise = [open_in(self.model, pair, known[last].z) for pair in self.open] != self.open
        return last if otherwise and last != value else None

    def _begun(
        self, onward: Onward, penalties: Mapping[Contact, Penalty], z: State, step: float
    ) -> tuple[State, dict[Contact, Touch]]:
        """The state near ``z`` in which contacts in a point push as foreseen after a ``step`` of the value.

        And, in that, those that only touch before it.
        """
        model, quadrature, way = self.model, self.settings.quadrature, step * onward.rate
        pressing = [one for one in self.system.touches if one.push > 0.0]
        known = known_depths(self.system, {one.pair: one.penetration for one in pressing}, self.pushes())
        foreseen = {one.pair: one.foreseen(way) for one in pressing}
        for pair, push in onward.pushes.items():
            known[pair] = Depth(self.settings.penetration * pair.scale, push * step)
            foreseen[pair] = np.array([push * step])
        z = sunk(model, penalties, quadrature, onward.system, z, foreseen, known)
        begun = (touch(model, pair, penalties[pair], quadrature, z) for pair in onward.pushes)
        return z, {one.pair: one for one in begun if one.closed}

    def gone(self, load: int, before: March, rate: Array, ahead: Array) -> Behind:
        """The step from ``before``, where the branch went by ``rate`` (size,), to here, where it goes by ``ahead``.

        By the states and rates at both ends under the penalties of the step: what tighter ones move them by is none of
        its bend.
        """
        by = float(self.values[load] - before.values[load])
        second, third = bend(self.model, before.system.z, self.system.z, (rate, ahead), by)
        return Behind(load, by, second, third, before.acting, frozenset(before.penalties))

    def stiffer(self, system: System) -> dict[Contact, Penalty]:
        """Stiffer penalties for what is too deep under those of now; none where all is as stiff as it may be.

        A circle's penalty is never stiffer than at a station, where it is as stiff as the depth asks in a point.
        """
        deep = {one: self.penalties[one].stiffness for one in _too_deep(self.model, system)}
        wide = {one.pair for one in system.touches if isinstance(one.pair, Circle) and not in_points(one)}
        limits = {one: one.stiffest if one in wide else np.inf for one in deep}
        return {one: Penalty(min(_STIFFER * now, limits[one])) for one, now in deep.items() if now < limits[one]}

    def _closes_more(self, system: System) -> bool:
        """Whether something overlaps in a system that is open now: no step could be made from there."""
        gaps = zip(self.gaps(self.system), self.gaps(system), strict=True)
        return any(after < 0.0 <= before for before, after in gaps)

    def _gone_through(self, system: System) -> bool:
        """Whether under other penalties something rigid has been gone through that presses."""
        rigid = (pair for pair in self.penalties if isinstance(pair, Rigid))
        return any(passed_through(self.model, pair, self.system.z, system.z) for pair in rigid)

    def _foreseen(self, load: int, step: float, rate: Array) -> Array:
        """By what a step will move, (size,): to third order by the rate and the last step, if that tells."""
        first, behind = step * rate, self.behind
        if behind is None or behind.load != load or behind.acting is not self.acting:
            return first
        if behind.contacts != frozenset(self.penalties) or not abs(step) <= _AHEAD * abs(behind.by):
            return first
        u = step / behind.by
        more = u**2 * behind.second + u**3 * behind.third
        bent, straight = (float(np.abs(way[self.model.moving]).max()) for way in (more, first))
        return first + more if bent <= _BENT * straight else first

    def passed(self, before: State, system: System, where: str) -> Trouble | None:
        """What must not have happened on the way from the state ``before`` to a system; a sentence says ``where``."""
        pressing = {one.pair for one in system.touches if one.closed}
        for pair in (*self.open, *self.penalties):
            if isinstance(pair, Face):
                continue  # its straight way is one in the frame of its body
            least, touching = zones_of(self.model, pair, system.z).least, CLOSED * pair.scale
            # of what does not press yet an overlap is on its way to be closed; of what has pressed, it has gone through
            if pair in pressing or (abs(least) if pair in self.penalties else least) <= touching:
                continue
            if self._overlapped_between(pair, before, system.z):
                return Ending.BEAMS_CROSSED, f"{where} what may touch in {pair.name} passes through each other"
        turned = float(np.abs(system.elements.rotation).max())
        if turned > _TURNED:
            return Ending.TURNED_TOO_FAR, f"{where} an element turns by {turned:.2f} rad: take more elements"
        for pair in (*self.open, *self.penalties):
            if passed_through(self.model, pair, before, system.z):
                return Ending.BEAMS_CROSSED, f"{where} what touches in {pair.name} passes through each other"
        return None

    def _slipped(self, system: System, where: str) -> Trouble | None:
        """Whether an end that presses has come past that of another beam, or past a corner, on the way to a system."""
        for one in self.system.touches:
            if slipped_off(self.model, one, self.system.z, system.z):
                return Ending.STEP_TOO_SMALL, f"{where} an end slips off a corner in {one.pair.name}"
            if gone_past(self.model, one, self.system.z, system.z):
                return Ending.STEP_TOO_SMALL, f"{where} an end slips off the other in {one.pair.name}"
        return None

    def room(self, stop: StopPart, system: System) -> float:
        """How far a stop is from closing (rad), or one that holds from letting go, without units."""
        if not self.acting.stopping:
            return np.inf
        limit = self.acting.limits.get(stop.name)
        if limit is None:
            return stop.room(system.z)[0] + _AT_LIMIT
        # the largest force may be the stop's own, which is of no size where it lets go
        return stop.press(system.z, limit) / max(1.0, system.scale) + _PULLS

    def switch(self, load: int, changing: Iterable[StopPart]) -> None:
        """Let those stops act, or act no more, that have arrived where they change."""
        arrived = [stop for stop in changing if self.room(stop, self.system) <= _SWITCHED]
        for stop in arrived:
            self.switched[stop.name] = float(self.values[load])
            self.turn(stop, load, self.system)
        if arrived:
            self.renew()

    def turn(self, stop: StopPart, load: int, system: System) -> None:
        """Let a stop act no more if it does, and otherwise at the limit that it is nearest to in a system."""
        if stop.name in self.acting.limits:
            self.acting = self.acting.released(stop.name)
        else:
            self.acting = self.acting.stopped(stop.name, stop.room(system.z)[1])
            self.closing.setdefault(stop.known_as, self.value(load))

    def act(self, acting: Acting) -> None:
        """Let other pins and stops act, without moving."""
        self.acting = acting
        self.renew()

    def renew(self) -> None:
        """The system of what acts and presses now, in the same state."""
        self.system = assemble(
            self.model, self.penalties, self.settings.quadrature, self.values, self.system.z, self.acting
        )

    def look(self) -> None:
        """See anew on which of their own sides beams lie, and on which of each other's while they are apart."""
        model, z = self.model, self.system.z
        self.open = [open_in(model, pair, z) for pair in self.open]
        self.penalties = {looked_at(model, pair, z): penalty for pair, penalty in self.penalties.items()}

    def value(self, load: int) -> float:
        """Of what is stepped, SI."""
        return float(self.values[load]) * self.model.stepped[load].unit

    def _overlapped_between(self, pair: Contact, before: State, after: State) -> bool:
        """Whether a contact that is open after a step overlaps on the straight way there, deeper than before.

        An overlap deeper than some elements is taken for the far side of a bent beam, so that a beam that has gone
        past the end of another in one step may lie open behind it.
        """
        way = after.values - before.values
        moved = float(np.abs(way[self.model.moving]).max())
        least = zones_of(self.model, pair, before).least
        if least > 2.0 * moved:
            return False
        deepest = least - _DEEPER * self._finest if least < 0.0 else 0.0
        thick = min(pair.distance, pair.scale) if isinstance(pair, Pair) else 0.0
        parts = max(2, int(np.ceil(moved / max(self._finest, _THROUGH * thick))))
        pace = against(self.model, pair, before, after) / parts

        def overlaps(first: int, last: int) -> bool:
            """Between two of the parts' ends; from where there is room for the whole way to either, nothing does."""
            if last - first < 2:
                return False
            middle = (first + last) // 2
            state = State.of(before.values + middle / parts * way)
            if room(self.model, pair, state) > pace * (last - middle):
                return False
            if zones_of(self.model, pair, state).least < deepest:
                return True
            if clear(self.model, pair, state) > pace * (last - middle):
                return False
            return overlaps(first, middle) or overlaps(middle, last)

        return overlaps(0, parts)

    @property
    def _finest(self) -> float:
        return min(float(self.model.line(beam, self.model.start).lengths.min()) for beam in self.model.beams)

    def _first_touch(self, load: int, known: dict[float, System]) -> tuple[float, System] | None:
        """The value at which the least gap of what may change is zero, on the equilibria where it has not.

        ``known`` are two equilibria by their values, one before and one beyond it.  Sought is where one of the gaps is
        zero, which is smooth, beginning with the one that comes first on a straight line.
        """

        def gaps(value: float) -> list[float]:
            if value not in known:
                low, high = max(v for v in known if v < value), min(v for v in known if v > value)
                system = self.solve(load, value, self._between(load, (low, known[low]), (high, known[high]), value))
                if system is None:
                    raise ArithmeticError
                known[value] = system
            return self.gaps(known[value])

        def sought(value: float, which: int) -> float:
            # what is as near counts as closed; beyond it an end without thickness would be on the other side, and so
            # what is aimed at is not its very edge
            gap = gaps(value)[which]
            return 0.0 if 0.0 <= gap <= 0.5 * arrived[which] else gap - _INSIDE * arrived[which]

        arrived = [*(CLOSED * pair.scale for pair in self.open), *(_SWITCHED for _ in self.model.stops)]
        clear, beyond = sorted(known, key=lambda value: min(gaps(value)), reverse=True)
        xtol = 1e-11 * max(abs(clear), abs(beyond))
        try:
            for _ in gaps(clear):
                pairs = list(zip(gaps(clear), gaps(beyond), strict=True))
                first = min((i for i, pair in enumerate(pairs) if pair[1] < 0.0), key=lambda i: _straight(*pairs[i]))
                root = float(brentq(sought, clear, beyond, (first,), xtol=xtol, rtol=1e-11))
                if gaps(root)[first] > arrived[first]:  # a jump: overlap that is not seen before it has some size
                    over = [value for value in known if gaps(value)[first] <= 0.0]
                    root = over[int(np.argmin(np.abs(np.array(over) - root)))]
                if min((*gaps(root)[:first], *gaps(root)[first + 1 :]), default=0.0) >= 0.0:
                    return root, known[root]
                beyond = root
        except (ArithmeticError, ValueError):
            return None
        return None

    def _between(self, load: int, low: tuple[float, System], high: tuple[float, System], value: float) -> State:
        """The state at a ``value`` between two equilibria with theirs, to third order by their rates."""
        (start, before), (end, after) = low, high
        rates = self.rate(load, before), self.rate(load, after)
        u = (value - end) / (end - start)
        second, third = bend(self.model, before.z, after.z, rates, end - start)
        return advance(self.model, after.z, (value - end) * rates[1] + u**2 * second + u**3 * third)

    def _close_tightly(self, load: int, way: float) -> None:
        """Where a contact or stop has closed, tighten the others and find again where it does.

        What sinks into loose penalties closes elsewhere.  ``way`` is that of the step.  If nothing is found, an open
        contact stays open.
        """
        loose = dict(self.penalties)
        self.tighten()
        if self.penalties == loose:
            return
        value, gap = float(self.values[load]), self.least_gap(self.system)
        for share in _NEARBY:
            other = value + np.copysign(share, gap) * way
            beyond = self.solve(load, other, advance(self.model, self.system.z, (other - value) * self.rate(load)))
            if beyond is None:
                return
            if self.least_gap(beyond) * gap <= 0.0:
                found = self._first_touch(load, {value: self.system, other: beyond})
                if found is not None:
                    self.values[load], self.system = found
                return

    def gaps(self, system: System) -> list[float]:
        """Of the open contacts, and how far stops are from changing."""
        gaps = [least_gap(self.model, pair, system.z) for pair in self.open]
        return [*gaps, *(self.room(stop, system) for stop in self.model.stops)]

    def least_gap(self, system: System) -> float:
        """The least of them."""
        return min(self.gaps(system), default=np.inf)

    def watch_what_touches(self, load: int, way: float = 0.0) -> None:
        """Give a penalty to every open contact whose gap has vanished, at the end of a step by a ``way``."""
        z = self.system.z
        closing = [p for p in self.open if least_gap(self.model, p, z) <= CLOSED * p.scale]
        for pair in closing:
            self.open.remove(pair)
            # an end that touches is to be the first beam's
            unseen = zones_of(self.model, pair, z).least > CLOSED * pair.scale
            closed = pair.about() if unseen and isinstance(pair, Pair) else pair
            self.penalties[closed] = Penalty(pair.stiffness)
            left = self._left(load, pair, way) * self.model.stepped[load].unit
            self.closing.setdefault(pair.name, self.value(load) + left)
        if closing:
            self.renew()

    def _left(self, load: int, pair: Contact, way: float) -> float:
        """How far, at the rate of now, a gap is from zero that a step by a ``way`` has closed but for a tolerance."""
        step = _DIFFERENCE * way
        moved = advance(self.model, self.system.z, step * self.rate(load))
        here, there = (least_gap(self.model, pair, z) for z in (self.system.z, moved))
        return step * here / (here - there) if 0.0 < here < (here - there) / _DIFFERENCE else 0.0

    def loosen(self, *kinds: type[Contact]) -> bool:
        """Go back to the loosest penalties: the ends of a zone move by a layer's width per iteration.

        Returns whether it could be done: not where that sinks in too far, slips or lets something overlap that is open.
        Most pairs of beams touch in a point, whose zone is found all the same.
        """
        return any(self._loosened(kinds, share) for share in _LOOSER)

    def _loosened(self, kinds: tuple[type[Contact], ...], share: float) -> bool:
        """The same by a ``share`` of the way, in orders of magnitude."""
        looser = {
            pair: Penalty(now.stiffness ** (1.0 - share) * pair.loosest**share)
            if isinstance(pair, kinds) and pair.loosest < now.stiffness
            else now
            for pair, now in self.penalties.items()
        }
        if looser == self.penalties:
            return False
        solved = equilibrium(
            self.model, self.settings, looser, self.values, self.system.z, self.acting, self.depths(), self.pushes()
        )
        self.iterations += solved.iterations
        if not solved.converged or _too_deep(self.model, solved.system) or self._closes_more(solved.system):
            return False
        there = self._gone_through(solved.system) or self._slipped(solved.system, "") is not None
        if self.moved(solved.system, self.system.z) <= _CORRECTED and not there:
            self.system, self.penalties, self.loose = solved.system, looser, True
            self.change_places()
            return True
        return False

    def change_places(self) -> None:
        """Let the beams of a pair change places where an end of the second presses: only ends of the first are seen.

        Where ends of the first press as well, each beam is to carry the zones at its own ends, and only as long as both
        press: an end that comes to stand upright on the other beam is one of which that lies on both sides.
        """
        for one in self.system.touches:
            pair, lacks = one.pair, one.lacks
            if not isinstance(pair, Pair) or pair.roles is not None:
                continue
            if pair.carried and one.closed and lacks <= LACKING and (alone := self._alone(one, pair)) is not None:
                solved = self._instead(pair, alone)
                if solved is not None and all(found.lacks <= LACKING for found in solved[0].touches):
                    self.system, self.penalties = solved
                continue
            about = pair.about()
            for other in (about, replace(pair, carried=pair.ends_m), replace(about, carried=about.ends_m)):
                if lacks <= LACKING:
                    break
                if other != pair and (solved := self._instead(pair, other)) is not None:
                    less = next((found.lacks for found in solved[0].touches if found.pair == other), 0.0)
                    if less < lacks:
                        (self.system, self.penalties), pair, lacks = solved, other, less

    def _sees_more_ends(self, system: System) -> bool:
        """Let closed pairs see what in a system overlaps of ends that their view leaves out; whether any did.

        Along the other beam such an end is met at an angle, later and deeper than it meets that one's side.
        """
        more: dict[Contact, Contact] = {}
        for one in system.touches:
            pair, z = one.pair, system.z
            if not isinstance(pair, Pair) or pair.roles is not None or pair.carried or not one.closed:
                continue
            last, last_m = (self.model.line(self.model.beams[i], z).n for i in (pair.first, pair.second))
            if at_ends(one.zones.zeta_m, last_m) or least_at_ends(self.model, pair, z) >= -CLOSED * pair.scale:
                continue
            more[pair] = replace(pair, carried=pair.ends_m) if at_ends(one.zones.intervals, last) else pair.about()
        self.penalties = {more.get(pair, pair): penalty for pair, penalty in self.penalties.items()}
        return bool(more)

    def _alone(self, one: Touch, pair: Pair) -> Pair | None:
        """A pair as that beam alone sees it whose ends press; None where ends of both do."""
        last, last_m = (self.model.line(self.model.beams[i], self.system.z).n for i in (pair.first, pair.second))
        if not at_ends(one.zones.intervals, last):
            return pair.about()
        return None if at_ends(one.zones.zeta_m, last_m) else replace(pair, carried=())

    def _instead(self, pair: Pair, other: Pair) -> tuple[System, dict[Contact, Penalty]] | None:
        """The equilibrium with a pair that is seen in an ``other`` way, and its penalties, if it is the same."""
        penalties = {other if one == pair else one: penalty for one, penalty in self.penalties.items()}
        depths = {other if one == pair else one: depth for one, depth in self.depths().items()}
        pushes = {one: push for one, push in self.pushes().items() if one != pair}
        solved = equilibrium(
            self.model, self.settings, penalties, self.values, self.system.z, self.acting, depths, pushes
        )
        self.iterations += solved.iterations
        if not solved.converged or self.moved(solved.system, self.system.z) > _CORRECTED:
            return None
        return solved.system, penalties

    def zones(self) -> dict[Contact, Array]:
        """Where the zones on what is rigid begin and end, (2,) each."""
        return {
            one.pair: np.array([one.zones.intervals.min(), one.zones.intervals.max()])
            for one in self.system.touches
            if isinstance(one.pair, Rigid) and one.closed
        }

    def tighten(self) -> None:
        """Change penalties, each time from the last equilibrium, until each leaves the penetration that it aims at.

        Contacts in a point begin at the depth at which they push as before, so that it takes a few iterations however
        much is changed at once.  Those of beams are held there meanwhile: another one that moves by more than they are
        deep would open them, or make of the overlap a force thousands of times their own.
        """
        self.loose = False
        most = _TIGHTEN
        falls: dict[Contact, float] = {}
        for tries in range(_TIGHTENINGS):
            allowed = self.allowed()
            factors = {
                one.pair: self._wanted(one, falls.get(one.pair, _IN_A_POINT), allowed.get(one.pair))
                for one in self.system.touches
            }
            pressures = {one.pair: resting_pressure(self.model, one, self.system.z) for one in self.system.touches}
            done = all(
                self._will_do(one, factors[one.pair], tries, allowed.get(one.pair)) for one in self.system.touches
            )
            if done and not self._misled(pressures):
                return
            tighter = dict(self.penalties)
            depths: dict[Contact, float] = {}
            held: dict[Contact, float] = {}
            for one in self.system.touches:
                narrow = one.closed and np.ptp(one.zones.intervals) < POINT
                limit = most**_NARROW if narrow else most
                factor = min(max(factors[one.pair], 1.0 / limit), limit)
                stiffness = factor * self.penalties[one.pair].stiffness
                tighter[one.pair] = Penalty(stiffness, pressures[one.pair] / stiffness)
                depths[one.pair] = one.penetration * factor ** (-1.0 / falls.get(one.pair, _IN_A_POINT))
                if narrow and isinstance(one.pair, Pair):
                    held[one.pair] = depths[one.pair]
            pushes = self.pushes()
            known = known_depths(self.system, depths, pushes)
            z = sunk(self.model, tighter, self.settings.quadrature, self.system, self.system.z, pushes, known)
            solved = equilibrium(self.model, self.settings, tighter, self.values, z, self.acting, held, pushes)
            self.iterations += solved.iterations
            near = solved.converged and self.moved(solved.system, self.system.z) <= _CORRECTED
            if near and not self._gone_through(solved.system):
                falls = self._falls(solved.system, tighter)
                self.system, self.penalties = solved.system, tighter
                most = min(most**1.5, _TIGHTEN)
            else:
                if most <= _GENTLEST:
                    return  # the next try would be this one again
                tried = max(max(factor, 1.0 / factor) for factor in factors.values())
                most = max(min(most, tried) ** 0.4, _GENTLEST)

    def firmer(self, name: str) -> bool:
        """Hold a contact by a far stiffer penalty as far as the station; whether that could be done."""
        pair = next(pair for pair in self.penalties if pair.name == name)
        stiffness = _FIRMER * self.penalties[pair].stiffness
        if stiffness > _FIRMEST * pair.stiffest:
            return False
        self.firm[name] = stiffness
        self.tighten()
        return self.penalties[pair].stiffness >= (1.0 - _EVEN) * stiffness

    def soft(self) -> bool:
        """Whether something presses by a penalty far from as stiff as the elements can follow."""
        return any(
            one.closed and self.penalties[one.pair].stiffness < _SOFT * one.pair.stiffest for one in self.system.touches
        )

    def sunk(self) -> bool:
        """Whether beams have sunk so far into the penalties of a way that a further step might bring them through."""
        return self.cut() or any(
            isinstance(one.pair, Pair) and one.penetration > _SINKING * one.pair.scale for one in self.system.touches
        )

    def cut(self) -> bool:
        """Whether tips of what is rigid have: on those that are sharp no step may find an equilibrium any more."""
        faces = (one.pair for one in self.system.touches if isinstance(one.pair, Face) and one.closed)
        return any(cut(self.model, face, self.system.z) > _SINKING * face.scale for face in faces)

    def settle(self, load: int) -> None:
        """Tighten penalties, and let stops change whose side is another with them, until all is as it should be.

        Beside an end that a stop holds on an edge, the stop and the pressure share a moment by what penalties give way.
        """
        for _ in range(_SETTLINGS):
            self.tighten()
            if self._close_what_overlaps(load):
                continue
            changing = [stop for stop in self.model.stops if self.room(stop, self.system) < 0.0]
            if not changing:
                return
            before, closing = self.acting, dict(self.closing)
            for stop in changing:
                self.turn(stop, load, self.system)
            system = self.solve(load, float(self.values[load]), self.system.z)
            if system is None or self.moved(system, self.system.z) > _CORRECTED:
                self.acting, self.closing = before, closing
                return
            self.system = system

    def _close_what_overlaps(self, load: int) -> bool:
        """Close open contacts that overlap with tight penalties and did not with loose ones; whether any did."""
        z = self.system.z
        closing = [pair for pair in self.open if least_gap(self.model, pair, z) < 0.0]
        if not closing:
            return False
        there = self.saved()
        for pair in closing:
            self.open.remove(pair)
            self.penalties[pair] = Penalty(pair.stiffness)
            self.closing.setdefault(pair.name, self.value(load))
        system = self.solve(load, float(self.values[load]), z)
        if system is None or self.moved(system, z) > _CORRECTED:
            self.restore(there)
            return False
        self.system = system
        return True

    def sharpen(self) -> None:
        """Take what is left of the unbalanced force down to round-off, where few iterations more do.

        What is accepted is a part of the largest force within the elements, which may be a hundred times the loads.
        """
        settings = replace(self.settings, residual=_SHARP * self.settings.residual, newton_limit=_SHARPENINGS)
        system = self.system
        if float(np.abs(system.residual).max()) > max(settings.residual * system.scale, system.floor):
            solved = equilibrium(
                self.model, settings, self.penalties, self.values, system.z, self.acting, self.depths(), self.pushes()
            )
            self.iterations += solved.iterations
            if solved.converged and self.moved(solved.system, system.z) <= _SHARP:
                self.system = solved.system

    def poise(self) -> None:
        """Take what gaps are rounded to, times a stiff penalty, out of the unbalanced force where it is felt.

        Where it is all there is, it is left to be told.
        """
        accepted = self.settings.residual * self.system.scale
        if self.system.told and float(np.abs(self.system.residual).max()) > accepted:
            self.system = poised(self.model, self.values, self.system, accepted)

    def allowed(self) -> dict[Contact, float]:
        """How deep contacts in points may be: by the penetration asked, or less where that is felt.

        Of those on what is rigid that are not sharp only the latter counts; what is not named is not held to any.
        """
        system, settings = self.system, self.settings
        known = felt(self.model, system, self.penalties, self.open, settings.quadrature)
        felt_at_most = min(_FELT * settings.penetration, FELT)
        found: dict[Contact, float] = {}
        for one in system.touches:
            if not one.closed:
                continue
            depth = settings.penetration * one.pair.scale if isinstance(one.pair, Pair) or one.sharp else np.inf
            if (share := known.get(one.pair, 0.0)) > 0.0:
                little = one.penetration * max(felt_at_most / share, 1.0 / _TIGHTEN)
                depth = min(depth, max(little, ROUNDED))
            if np.isfinite(depth):
                found[one.pair] = depth
        return found

    def _wanted(self, one: Touch, fall: float, allowed: float | None) -> float:
        """The factor from a penalty to the one that leaves the penetration ``allowed``, or to the least for a station.

        The penetration falls with the penalty to the power −1/``fall``: −2/3 in a point between sides, −1/2 at a tip,
        −1 in an area.  On what is rigid and not sharp a penalty stiffer than the elements can follow spoils more than
        the overlap that it leaves: its penalty is always the same.
        """
        least = max(one.pair.stiffest, self.firm.get(one.pair.name, 0.0)) / self.penalties[one.pair].stiffness
        if not one.closed:
            return 1.0
        if allowed is None:
            return max(1.0, least)
        aim = _AIM * allowed
        # what overlaps in spite of that has gone through, and is not pushed out again
        slender = max(1.0, self._finest / one.pair.scale)
        most = _STIFFEST * (slender * _STANDARD / self.settings.penetration) ** _FALLS[1] * least
        return float(min(max((one.penetration / aim) ** fall, least), most))

    def _will_do(self, one: Touch, factor: float, tries: int, allowed: float | None) -> bool:
        """Whether a penalty is as wanted; after some tries that of beams may be stiffer."""
        if allowed is None:
            return factor <= 1.0 + _SAME
        if abs(factor - 1.0) <= _EVEN:
            return True
        enough = one.penetration <= allowed
        stiff = one.pair.stiffest <= (1.0 + _EVEN) * self.penalties[one.pair].stiffness
        return tries >= _POLISHINGS and enough and stiff

    def _falls(self, system: System, tighter: Mapping[Contact, Penalty]) -> dict[Contact, float]:
        """How the penetrations have fallen from the penalties of now to those of ``system``: −ln ε by ln depth."""
        before = {one.pair: one.penetration for one in self.system.touches}
        found = {}
        for one in system.touches:
            factor = tighter[one.pair].stiffness / self.penalties[one.pair].stiffness
            share = one.penetration / before[one.pair] if before[one.pair] > 0.0 else 0.0
            if share > 0.0 and abs(np.log(share)) > _EVEN:
                found[one.pair] = float(np.clip(-np.log(factor) / np.log(share), *_FALLS))
        return found

    def _misled(self, pressures: Mapping[Contact, float]) -> bool:
        """Whether a lead belongs to another pressure than the axial forces give."""
        return any(
            abs(pressure / self.penalties[pair].stiffness - self.penalties[pair].lead)
            > _LED * max(pressure / self.penalties[pair].stiffness, self.settings.penetration * pair.scale)
            for pair, pressure in pressures.items()
        )

    def depths(self) -> dict[Contact, float]:
        """The penetrations of the closed contacts of beams; of those that do not press yet, what they will be allowed.

        A contact in search of its zone is none of them: its penalty is soft enough to be let go.
        """
        allowed = self.settings.penetration
        return {
            one.pair: one.penetration if one.push > 0.0 else allowed * one.pair.scale
            for one in self.system.touches
            if isinstance(one.pair, Pair)
            and one.zones.least <= CLOSED * one.pair.scale
            and self.penalties[one.pair].stiffness >= one.pair.stiffness
        }

    def pushes(self) -> dict[Contact, Array]:
        """What the points of the closed contacts push with."""
        return {one.pair: one.pushes for one in self.system.touches if one.closed}

    def moved(self, system: System, z: State) -> float:
        """The most by which anything differs."""
        return float(np.abs((system.z.values - z.values)[self.model.moving]).max())

    def turned(self, system: System, z: State) -> float:
        """The most by which a section of a beam, or a body, is turned against the state ``z``, rad."""
        return float(np.abs((system.z.values - z.values)[self.model.turning]).max())

    def shown(self, load: int, value: float) -> str:
        """What is stepped, and a value of it in SI."""
        part = self.model.stepped[load]
        return f"{part.name} = {value * part.unit:.6g}"


def _too_deep(model: Model, system: System) -> list[Contact]:
    """What sinks so far into what it touches that it is about to be taken for having gone through.

    Where neutral lines cross, the one does not lie on a side of the other any more, and no penalty parts them.
    """
    return [
        one.pair
        for one in system.touches
        if one.penetration > _SUNK * _deepest(one.pair)
        or (isinstance(one.pair, Face) and one.closed and cut(model, one.pair, system.z) > _SUNK * one.pair.scale)
    ]


def _deepest(what: Contact) -> float:
    """How deep something may be in what it touches and not have gone through; nothing is known of lines and edges."""
    match what:
        case Pair(distance=distance, scale=scale) if distance > 0.0:
            return scale
        case Circle():
            return what.deepest
        case _:
            return np.inf


def _straight(before: float, beyond: float) -> float:
    """The share of the way at which what falls from one to the other is zero on a straight line; first what is so."""
    return before / (before - beyond) if before > 0.0 else 0.0


def begin(model: Model, settings: Settings, contacts: tuple[Contact, ...]) -> March:
    """The undeformed mechanism, unloaded."""
    values = np.zeros(len(model.stepped))
    system = assemble(model, {}, settings.quadrature, values, model.start, model.drawn)
    return March(model, settings, list(contacts), values, system, model.drawn)
