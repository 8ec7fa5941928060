"""A scene made ready for solving: the problem, and the pairs of beams by which its answers are checked."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import numpy as np

from cprbm.circle import Circle, circle_of
from cprbm.clearance import Clearances, clearances_of
from cprbm.closest import clear
from cprbm.closure import closure_of
from cprbm.edge import Edge, edge_of
from cprbm.energy import dead_loads, end_moments
from cprbm.feet import distance_along
from cprbm.first_contact import Formulation, Group, Rows
from cprbm.hinging import hinges_of
from cprbm.holding import holds_of
from cprbm.itself import Itself, itself_of
from cprbm.kinematics import Positions, State, most_changed, most_turned, positions_of
from cprbm.made import Made
from cprbm.model import EVEN, Fit, Model, build
from cprbm.nearest import Pair, pair_of
from cprbm.overlap import may_be_beyond, never_beyond
from cprbm.point import Point, Problem
from cprbm.settings import Settings
from cprbm.sighting import UNSEEN, sight
from cprbm.stops import AngleStop, stop_of
from cprbm.strands import NO_FACES
from cprbm.sweeping import swath, swept
from cprbm_scene import (
    BeamContact,
    CircleContact,
    Scene,
    SelfContact,
)
from cprbm_scene.answer import Array

NARROWED = 4  # contacts that may have been passed, from which on their clearances between two states are asked for
BETWEEN = np.arange(1, 8) / 8.0  # of the way between two states, where a beam is looked for within a circle or another
SHALLOW = 0.05  # of the radius: an overlap between rows of a coarse mesh
PASSING = 0.2  # rad: a beam that goes through another in a step that turns its links by less is in it at a step's end
STEEP = 3.0  # a cubic whose ends are no steeper than so many times its chord goes one way only
WAY = 0.02  # of the longest beam, by which a way of one radian may differ from the unknowns' even one
EDGE_WAY = 0.2  # the same of an edge, behind which what is rigid never ends: pinned ends leave their points meanwhile
DIP = 1e-3  # of the longest beam, by which a line may dip into an edge on the way, that goes round it or along it

Groups = Callable[[State, Positions], tuple[Group, ...]]
AnyPair = Pair | Circle | Edge | Itself
Way = Callable[[], list[tuple[State, Positions]]]
Rates = tuple[Array, Array]


@dataclass(frozen=True, slots=True)
class Mechanism:
    """The problem with all contacts, the same without one of them, and the geometry of each contact.

    Attributes:
        problem: with every contact.
        pairs: smooth beams of each contact.
        stops: limits of pins' angles.
        fit: what the mesh was made for.
        clearances: which contacts are so far open that they need not be looked at.
        alone: those of beams that may touch themselves.
    """

    problem: Problem
    pairs: Mapping[str, AnyPair]
    stops: dict[str, AngleStop]
    fit: Fit
    clearances: Clearances
    alone: Mapping[str, Itself]

    def without(self, *names: str) -> Problem:
        """The problem in which some contacts and stops hold nothing."""
        stops = {name: stop for name, stop in self.stops.items() if name not in names}
        formulation, steady = _formulations(self.pairs, stops, self.clearances, self.alone, frozenset(names))
        return replace(self.problem, formulation=formulation, steady=steady)

    def near(self, state: State, at: Positions) -> list[str]:
        """Names of the contacts that are not so far open that they need not be looked at."""
        return self.clearances.near(state, at)

    def seen(self, contact: str, rows: Rows) -> AnyPair:
        """The geometry of a contact, with what ``rows`` know of the sides by which a beam faces itself, or another."""
        pair = self.pairs[contact]
        if isinstance(pair, Pair):
            return pair.sighted(rows.sides.get(contact, UNSEEN))
        return pair.seen(rows.faces.get(contact, NO_FACES)) if isinstance(pair, Itself) else pair

    def overlap(self, contact: str, point: Point) -> float:
        """Largest constraint value of ``contact``, units of length: positive where it is violated."""
        groups = self.seen(contact, point.rows).groups(point.state, point.at)
        return max((float(group.values.max()) for group in groups), default=float("-inf"))

    def passed(self, before: Point, after: Point, rates: Rates | None = None) -> str:
        """Name of a contact whose beam went across the circle or the other beam between two states; empty if none.

        ``rates`` are the ways (n_links,) that those at both states make of the step, where they are known.
        """
        start, end = (before.state, before.at), (after.state, after.at)
        names = self.clearances.may_pass(start, end)

        @cache
        def way() -> list[tuple[State, Positions]]:
            between = _between(before.state, after.state, rates)
            return list(zip(between, positions_of(self.problem.model, between), strict=True))

        if len(names) > NARROWED:
            parts = pairwise([start, *way(), end])
            possible = {name for part in parts for name in self.clearances.may_pass(*part)}
            names = [name for name in names if name in possible]
        for name in names:
            pair = self.seen(name, before.rows)
            if isinstance(pair, Circle):
                across = _swept(pair, start, way(), pair, end) or self._overlapped_between(pair, before, after, way)
            elif isinstance(pair, Edge):
                # in a long step what the way is known by hides that an edge was gone through: a shorter one shows it
                long = most_turned(before.state, after.state) > PASSING
                across = _swept(pair, start, way(), pair, end)
                across = across or self._crossed_between(pair, before, after, way, WAY if long else EDGE_WAY)
            elif isinstance(pair, Itself):
                allowed = WAY * most_turned(before.state, after.state) ** 2
                across = pair.passed(start, way(), end, allowed)
            else:
                # without having been there a beam comes to lie beyond another by its end or through it
                gone = may_be_beyond(pair, *end) and pair.gone_round(*end)
                across = gone and self._crossed_between(pair, before, after, way, WAY)
                if not gone and may_be_beyond(pair, *start) and pair.gone_round(*start):
                    # nor does it come back
                    across = any(pair.crossed(state, at) for state, at in way())
                if not across and most_turned(before.state, after.state) > PASSING:
                    # or aside of where it would be beyond
                    allowed = self._allowed(pair, before, after, WAY)
                    states = [start, *way(), end]
                    across = not never_beyond(pair, states[1:], allowed) and _gone_through(pair, states, allowed)
            if across:
                return pair.name
        return ""

    def _overlapped_between(self, circle: Circle, before: Point, after: Point, way: Way) -> bool:
        """Whether the beam lay deep in the circle on the way from one state to another."""
        # the real way differs by the square of the step
        allowed = 0.5 * circle.offset + SHALLOW * circle.radius + WAY * most_changed(before.state, after.state) ** 2
        for state, at in way():
            here = circle.placed(at)
            if here.no_closer(state, at) - circle.offset < -allowed:
                places = circle.line(state, at).sampled
                if np.max(circle.offset - here.distance(places)) > allowed:
                    return True
        return False

    def _crossed_between(self, pair: Pair | Edge, before: Point, after: Point, way: Way, uneven: float) -> bool:
        """Whether a beam lay across what it may touch between two states, by more than the way between is known."""
        allowed = self._allowed(pair, before, after, uneven)

        def across(state: State, at: Positions) -> bool:
            if isinstance(pair, Edge) and pair.no_closer(state, at) + pair.offset >= -allowed:
                return False
            return pair.least_gap(state, at) + pair.offset < -allowed

        return any(across(state, at) for state, at in way())

    def _allowed(self, pair: Pair | Edge, before: Point, after: Point, uneven: float) -> float:
        """By how much a beam may seem to lie across on a way that is known by ``uneven`` times the turn's square."""
        slack = max(pair.offset, DIP) if isinstance(pair, Edge) else pair.offset or clear(pair)
        return slack + uneven * most_changed(before.state, after.state) ** 2


def _swept(
    pair: Circle | Edge,
    start: tuple[State, Positions],
    way: Sequence[tuple[State, Positions]],
    other: Circle | Edge,
    end: tuple[State, Positions],
) -> bool:
    """Whether a beam went through a place of what is rigid from one side to the other on a ``way`` from start to end.

    At the end the contact is the ``other``, which may have another mesh.
    """
    places, ahead = pair.standing_out
    if not len(places):
        return False
    course = [*((pair, state, at) for state, at in (start, *way)), (other, *end)]
    frames = [of.frame(state, at) for of, state, at in course]
    first, last = (
        swath(of.line(state, at), places, frame.m, frame.phi)
        for (of, state, at), frame in zip((course[0], course[-1]), (frames[0], frames[-1]), strict=True)
    )
    ends = [
        frame.inwards(np.array([(at.x[joint], at.y[joint]) for joint in (of.a.joints.start, of.a.joints.stop - 1)]))
        for (of, _, at), frame in zip(course, frames, strict=True)
    ]
    return bool(np.any(swept(first, last, np.stack(ends, axis=1), places, ahead)))


def swept_between(mechanism: Mechanism, point: Point, other: Mechanism, carried: Point) -> bool:
    """Whether a beam went through something rigid between a state and one beside it on an ``other`` mesh."""
    before, after = (point.state, point.at), (carried.state, carried.at)
    for name in {*mechanism.near(*before), *other.near(*after)}:
        pair, its = mechanism.pairs[name], other.pairs[name]
        if isinstance(pair, Circle | Edge) and isinstance(its, Circle | Edge) and _swept(pair, before, (), its, after):
            return True
    return False


def _between(before: State, after: State, rates: Rates | None) -> list[State]:
    """States on the way from one to another: the bodies going evenly, the links by cubics if ``rates`` are known.

    These are no longer than STEEP times what the links turn by: a cubic would swing out.
    """
    turned = after.theta - before.theta
    most = STEEP * float(np.max(np.abs(turned), initial=0.0))
    first, last = (turned, turned) if rates is None else (_shortened(rate, most) for rate in rates)
    part = BETWEEN[:, None]
    rest = 1.0 - part
    swing = part * rest * (rest * (first - turned) - part * (last - turned))
    bodies = before.bodies + part[:, None] * (after.bodies - before.bodies)
    return [State(*each) for each in zip(before.theta + part * turned + swing, bodies, strict=True)]


def _shortened(rate: Array, most: float) -> Array:
    largest = float(np.max(np.abs(rate), initial=0.0))
    return rate if largest <= most else (most / largest) * rate


def _gone_through(pair: Pair, way: Iterable[tuple[State, Positions]], allowed: float) -> bool:
    """Whether a joint that sees a beam on its free side lies beyond it by more than ``allowed`` in the next state."""
    before = np.full(pair.a.n + 2, np.nan)
    for state, at in way:
        D, _, foot = distance_along(pair, pair.lines(state, at), pair.a.s)
        D = np.where(foot, D, np.nan)
        if np.any((before > 0.0) & (-allowed > D)):
            return True
        before = D
    return False


def _formulations(
    pairs: Mapping[str, AnyPair],
    stops: Mapping[str, AngleStop],
    clearances: Clearances,
    watched: Mapping[str, Itself],
    idle: frozenset[str] = frozenset(),
) -> tuple[Formulation, Formulation]:
    """The rows of all contacts but those ``idle`` and of some stops, and the steady ones.

    Of beams ``watched`` it is known how they face themselves.
    """
    steady = Made(pairs, lambda name: replace(pairs[name], own_places=False))
    looked = Made(watched, lambda name: replace(watched[name], own_places=False))
    return (
        _formulation(pairs, stops, clearances, watched, idle),
        _formulation(steady, stops, clearances, looked, idle),
    )


def _formulation(
    pairs: Mapping[str, AnyPair],
    stops: Mapping[str, AngleStop],
    clearances: Clearances,
    watched: Mapping[str, Itself],
    idle: frozenset[str],
) -> Formulation:
    def rows(state: State, at: Positions, before: Rows) -> Rows:
        near = [name for name in clearances.near(state, at) if name not in watched]
        groups, sides = list[Group](), before.sides
        for name in near:
            pair = pairs[name]
            if isinstance(pair, Pair) and not all(pair.seen):
                sides = {**sides, name: sight(pair, state, at, sides.get(name, UNSEEN))}
                pair = pair.sighted(sides[name])
            if name not in idle:
                groups += pair.groups(state, at)
        groups += [group for stop in stops.values() for group in stop.groups(state, at)]
        faces = {}
        for name, pair in watched.items():
            facing = pair.seen(before.faces.get(name, NO_FACES)).facing(state, at)
            faces[name] = pair.met(facing)
            if name not in idle:
                groups += pair.rows(facing, at)
        return Rows(tuple(groups), faces, sides)

    return rows


def _pair(scene: Scene, model: Model, name: str, fit: Fit) -> AnyPair:
    match scene.contacts[name]:
        case BeamContact():
            return pair_of(scene, model, name, fit)
        case SelfContact():
            return itself_of(scene, model, name, fit)
        case CircleContact():
            return circle_of(scene, model, name, fit)
    return edge_of(scene, model, name, fit)


def _cut_alike(before: Mechanism, settings: Settings, fit: Fit) -> bool:
    """Whether a mesh ``before`` of the scene has the same elements as that of a ``fit``, which may have other kinks."""
    if before.fit.borders.keys() != fit.borders.keys():
        return False
    return all(settings.links_of(chain.name) == chain.n for chain in before.problem.model.chains) and all(
        np.array_equal(borders, fit.borders[beam]) for beam, borders in before.fit.borders.items()
    )


def mechanism_of(scene: Scene, settings: Settings, fit: Fit = EVEN, before: Mechanism | None = None) -> Mechanism:
    """Make a scene ready on even elements or those of a ``fit``, with what is known from a mesh ``before`` of it.

    Raises:
        SceneError: the settings do not fit the scene.
    """
    known = None if before is None else before.problem.model
    if before is not None and known is not None and _cut_alike(before, settings, fit):
        model, clearances = known, before.clearances
    else:
        model = build(scene, settings, fit, None if known is None else known.outset)
        clearances = clearances_of(scene, model)
    pairs = Made(scene.contacts, lambda name: _pair(scene, model, name, fit))
    stops = {name: stop_of(scene, model, name) for name in scene.stops}
    selves = [name for name, contact in scene.contacts.items() if isinstance(contact, SelfContact)]
    alone = Made(selves, lambda name: itself_of(scene, model, name, fit))
    closure = closure_of(model, hinges_of(scene, model), holds_of(scene, model))
    loads = dead_loads(scene, model) | end_moments(scene, model)
    problem = Problem(model, closure, loads, *_formulations(pairs, stops, clearances, alone))
    return Mechanism(problem, pairs, stops, fit, clearances, alone)
