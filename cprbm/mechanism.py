"""A scene made ready for solving: the problem, and the pairs of beams by which its answers are checked."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from cprbm.boundary import FittedBoundary, fitted_boundary
from cprbm.circle import Circle, circle_of
from cprbm.closure import closure_of
from cprbm.contact import Formulation, Group, Rows
from cprbm.edge import Edge, edge_of
from cprbm.energy import dead_loads, end_moments
from cprbm.hinging import hinges_of
from cprbm.holding import holds_of
from cprbm.itself import Itself, itself_of
from cprbm.kinematics import Positions, State, most_turned, positions
from cprbm.model import EVEN, Fit, Model, build
from cprbm.nearest import Pair, pair_of
from cprbm.point import Point, Problem
from cprbm.rigid import RigidCircle, rigid_circle
from cprbm.rigid_edge import RigidEdge, rigid_edge
from cprbm.settings import Settings
from cprbm.stops import AngleStop, stop_of
from cprbm.strands import NO_FACES
from scene import BeamContact, CircleContact, Mistake, Scene, SceneError, SelfContact

BETWEEN = np.arange(1, 8) / 8.0  # of the way between two states, where a beam is looked for within a circle or another
SHALLOW = 0.05  # of the radius: an overlap between rows of a coarse mesh
WAY = 0.02  # of the longest beam, by which a way of one radian may differ from the unknowns' even one
EDGE_WAY = 0.2  # the same of an edge, behind which what is rigid never ends: pinned ends leave their points meanwhile
DIP = 1e-3  # of the longest beam, by which a line may dip into an edge on the way, that goes round it or along it
SAG = 0.25  # of an element times what links turn by at its spring: twice the sag of an even bend

Boundary = FittedBoundary | RigidCircle | RigidEdge

Groups = Callable[[State, Positions], tuple[Group, ...]]
AnyPair = Pair | Circle | Edge | Itself


@dataclass(frozen=True, slots=True)
class Mechanism:
    """The problem with all contacts, the same without one of them, and the geometry of each contact.

    Attributes:
        problem: with every contact.
        pairs: smooth beams of each contact, which measure overlap whatever the formulation.
        boundaries: of the formulation ``paper``; empty for ``auto``.
        stops: limits of pins' angles.
        fit: what the mesh was made for.
    """

    problem: Problem
    pairs: dict[str, AnyPair]
    boundaries: dict[str, Boundary]
    stops: dict[str, AngleStop]
    fit: Fit

    def without(self, *names: str) -> Problem:
        """The problem in which some contacts and stops hold nothing."""
        pairs = {name: pair for name, pair in self.pairs.items() if name not in names}
        stops = {name: stop for name, stop in self.stops.items() if name not in names}
        formulation, steady = _formulations(pairs, self.boundaries, stops, _alone(self.pairs))
        return replace(self.problem, formulation=formulation, steady=steady)

    def seen(self, contact: str, rows: Rows) -> AnyPair:
        """The geometry of a contact, with what ``rows`` know of the sides by which a beam faces itself."""
        pair = self.pairs[contact]
        return pair.seen(rows.faces.get(contact, NO_FACES)) if isinstance(pair, Itself) else pair

    def overlap(self, contact: str, point: Point) -> float:
        """Largest constraint value of ``contact``, units of length: positive where it is violated."""
        groups = _groups(contact, {contact: self.seen(contact, point.rows)}, self.boundaries)(point.state, point.at)
        return max((float(group.values.max()) for group in groups), default=float("-inf"))

    def passed(self, before: Point, after: Point) -> str:
        """Name of a contact whose beam went across the circle or the other beam between two states; empty if none."""
        for name in self.pairs:
            pair = self.seen(name, before.rows)
            if isinstance(pair, Circle):
                across = pair.passed(before.at, after.at) or self._overlapped_between(pair, before.state, after.state)
            elif isinstance(pair, Edge):
                across = self._crossed_between(pair, before, after, EDGE_WAY)
            elif isinstance(pair, Itself):
                way = ((state, positions(self.problem.model, state)) for state in _between(before.state, after.state))
                across = pair.passed(way, (after.state, after.at), WAY * most_turned(before.state, after.state) ** 2)
            else:
                # without having been there a beam comes to lie beyond another by its end or through it
                across = pair.gone_round(after.state, after.at) and self._crossed_between(pair, before, after, WAY)
            if across:
                return pair.name
        return ""

    def _overlapped_between(self, circle: Circle, before: State, after: State) -> bool:
        """Whether the beam lay deep in the circle on the way from one state to another, the unknowns going evenly."""
        # the real way differs by the square of the step
        allowed = 0.5 * circle.offset + SHALLOW * circle.radius + WAY * _turned(before, after) ** 2
        for state in _between(before, after):
            at = positions(self.problem.model, state)
            places = circle.line(state, at).sampled
            if np.max(circle.offset - circle.placed(at).distance(places)) > allowed:
                return True
        return False

    def _crossed_between(self, pair: Pair | Edge, before: Point, after: Point, way: float) -> bool:
        """Whether a beam lay across what it may touch between two states, by more than the way between is known."""
        slack = max(pair.offset, DIP) if isinstance(pair, Edge) else pair.offset
        slack += self._sag(pair, after.state)
        allowed = slack + way * _turned(before.state, after.state) ** 2
        return any(
            pair.least_gap(state, positions(self.problem.model, state)) + pair.offset < -allowed
            for state in _between(before.state, after.state)
        )

    def _sag(self, pair: Pair | Edge, state: State) -> float:
        """By how much beams may sag between their joints, which are all that ``paper`` holds; units of length."""
        if not self.boundaries:
            return 0.0
        return max(SAG * chain.h * float(np.max(np.abs(np.diff(state.theta[chain.links])))) for chain in pair.chains)


def _turned(before: State, after: State) -> float:
    """The most that a link or a body turns by between two states, rad."""
    bodies = np.max(np.abs(after.bodies[:, 2] - before.bodies[:, 2]), initial=0.0)
    return max(most_turned(before, after), float(bodies))


def _between(before: State, after: State) -> Iterator[State]:
    """States on the way from one to another, the unknowns going evenly."""
    for part in BETWEEN:
        yield State(
            before.theta + part * (after.theta - before.theta), before.bodies + part * (after.bodies - before.bodies)
        )


def _groups(contact: str, pairs: Mapping[str, AnyPair], boundaries: Mapping[str, Boundary]) -> Groups:
    return boundaries[contact].groups if boundaries else pairs[contact].groups


def _alone(pairs: Mapping[str, AnyPair]) -> dict[str, Itself]:
    """Beams that may touch themselves, by contact."""
    return {name: pair for name, pair in pairs.items() if isinstance(pair, Itself)}


def _formulations(
    pairs: Mapping[str, AnyPair],
    boundaries: Mapping[str, Boundary],
    stops: Mapping[str, AngleStop],
    watched: Mapping[str, Itself],
) -> tuple[Formulation, Formulation]:
    """The rows of some contacts and stops, and the steady ones; of beams ``watched`` it is known how they face."""
    steady = {name: replace(pair, own_places=False) for name, pair in pairs.items()}
    limits: dict[str, Groups] = {name: stop.groups for name, stop in stops.items()}
    others, few = (
        {name: _groups(name, these, boundaries) for name, pair in these.items() if not isinstance(pair, Itself)}
        | limits
        for these in (pairs, steady)
    )
    return _formulation(others, _alone(pairs), watched), _formulation(few, _alone(steady), watched)


def _formulation(parts: dict[str, Groups], alone: Mapping[str, Itself], watched: Mapping[str, Itself]) -> Formulation:
    def rows(state: State, at: Positions, before: Rows) -> Rows:
        groups = [group for part in parts.values() for group in part(state, at)]
        faces = {}
        for name, pair in watched.items():
            facing = alone.get(name, pair).seen(before.faces.get(name, NO_FACES)).facing(state, at)
            faces[name] = facing.faces
            if name in alone:
                groups += alone[name].rows(facing, at)
        return Rows(tuple(groups), faces)

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


def _boundary(scene: Scene, model: Model, pair: AnyPair, settings: Settings) -> Boundary:
    """A contact in the paper's form.

    Raises:
        SceneError: the form lacks what it must be told, or is not offered for the contact's kind.
    """
    match pair:
        case Pair():
            return fitted_boundary(scene, model, pair.name, settings.degree)
        case Circle():
            return rigid_circle(scene, model, pair.name)
        case Edge() if all(corner.ends for corner in pair.corners):
            return rigid_edge(scene, model, pair)
        case Edge():
            found = "a line with a corner that stands out, which presses a beam between its joints"
            allowed = "a line without one, or the formulation 'auto'"
            raise SceneError([Mistake(f"contacts.{pair.name}.points", found, allowed, scene.file)])
    allowed = "a kind that the formulation 'paper' offers, or the formulation 'auto'"
    kind = scene.contacts[pair.name].kind
    raise SceneError([Mistake(f"contacts.{pair.name}.kind", repr(kind), allowed, scene.file)])


def mechanism_of(scene: Scene, settings: Settings, fit: Fit = EVEN) -> Mechanism:
    """Make a scene ready on even elements or those of a ``fit``.

    Raises:
        SceneError: the settings do not fit the scene, or the formulation lacks what it must be told.
    """
    model = build(scene, settings, fit)
    pairs = {name: _pair(scene, model, name, fit) for name in scene.contacts}
    boundaries: dict[str, Boundary] = {}
    if settings.formulation == "paper":
        boundaries = {name: _boundary(scene, model, pair, settings) for name, pair in pairs.items()}
    stops = {name: stop_of(scene, model, name) for name in scene.stops}
    closure = closure_of(model, hinges_of(scene, model), holds_of(scene, model))
    loads = dead_loads(scene, model) | end_moments(scene, model)
    problem = Problem(model, closure, loads, *_formulations(pairs, boundaries, stops, _alone(pairs)))
    return Mechanism(problem, pairs, boundaries, stops, fit)
