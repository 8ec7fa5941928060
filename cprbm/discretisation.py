"""The problem that the formulation ``paper`` makes of a scene, as plain numbers that another optimiser can be handed.

=========  ==========================================================================================
symbol     meaning
=========  ==========================================================================================
θ_i        angles of the links of all beams, one beam behind the other
u, v, φ    displacement of a free body's reference place, and its rotation
PE         Σ ½ k_i (θ_{i+1} − θ_i − δ_i⁰)² − W, minimised
Z = 0      ends on their points, welds, pins between bodies, slides and drives
c ≤ 0      related joints against a fitted polynomial or a circle
=========  ==========================================================================================

Lengths are in units of the longest beam ℓ, energies and moments in units S of :mod:`cprbm.model`: the numbers are the
solver's own.  Loads and drives stand at the last value that the scene gives them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cprbm.boundary import FittedBoundary
from cprbm.energy import DeadLoad
from cprbm.mechanism import Mechanism, mechanism_of
from cprbm.model import Chain, Model, attached
from cprbm.rigid import RigidCircle
from cprbm.settings import Settings
from cprbm.standing import Attachment
from cprbm_scene import Mistake, Scene, SceneError
from cprbm_scene.answer import Array, Ints
from cprbm_scene.frozendict import frozendict


@dataclass(frozen=True, slots=True)
class Spot:
    """A point of a body: ``x``, ``y`` from its reference place; of the ground (``body`` −1) where it is."""

    body: int
    x: float
    y: float


@dataclass(frozen=True, slots=True)
class Beam:
    """Links ``first`` to ``first + count − 1``, joints 0 to ``count`` behind them, the first of them on ``start``."""

    first: int
    count: int
    start: Spot


@dataclass(frozen=True, slots=True)
class Held:
    """One equality on a body: ``along``·(its point's displacement) + ``turn``·φ = ``value``; ``drive`` names it."""

    drive: str
    at: Spot
    along: tuple[float, float]
    turn: float
    value: float


@dataclass(frozen=True, slots=True)
class Load:
    """A dead force at a body's point, and a moment on the body."""

    at: Spot
    force: tuple[float, float]
    moment: float


@dataclass(frozen=True, slots=True)
class FittedContact:
    """Eqs. (8)-(11): joints of one beam against the polynomial through offset points of another.

    Attributes:
        name: of the contact.
        boundary: number of the beam of the curve; points: its joints (n,).
        beam: number of the other; joints: those of it that are held (m,).
        degree: of the polynomial.
        along_x: whether it is y = g(x), or x = g(y).
        sense: +1 where the joints are to have the larger coordinate across, −1 the smaller.
        offset: distance of the offset points to the left of the boundary.
    """

    name: str
    boundary: int
    points: Ints
    beam: int
    joints: Ints
    degree: int
    along_x: bool
    sense: float
    offset: float


@dataclass(frozen=True, slots=True)
class RoundContact:
    """Joints (m,) of a beam at least ``radii`` (m,) away from a centre."""

    name: str
    beam: int
    joints: Ints
    centre: Spot
    radii: Array


@dataclass(frozen=True, slots=True)
class Discretised:
    """Everything that the minimum depends on, at one value of loads and drives.

    Attributes:
        unit_length: ℓ, m.
        unit_moment: S, N·m.
        lengths: L_i of the links (n,), in ℓ.
        rest: stress-free angles of the links (n,), rad.
        couplings: k_i of the springs between link i and i + 1 (n−1,), in S; zero between beams.
        rest_turns: δ_i⁰ of these springs (n−1,), rad.
        fixed: links that keep their stress-free angle.
        references: reference places of the bodies that move at rest (B, 2).
        beams: in the scene's order.
        ends: number of each beam whose last joint is on a spot, and that spot.
        welds: link, and body that it turns with, −1 for the ground.
        pins: spots that stay together, at the same place at rest.
        held: slides, pivots and drives.
        loads: at their values.
        fitted: contacts of two beams.
        circles: contacts of a beam and a circle.
        points: the scene's, by name.
        bodies: numbers of those that move, by name.
    """

    unit_length: float
    unit_moment: float
    lengths: Array
    rest: Array
    couplings: Array
    rest_turns: Array
    fixed: Ints
    references: Array
    beams: tuple[Beam, ...]
    ends: tuple[tuple[int, Spot], ...]
    welds: tuple[tuple[int, int], ...]
    pins: tuple[tuple[Spot, Spot], ...]
    held: tuple[Held, ...]
    loads: tuple[Load, ...]
    fitted: tuple[FittedContact, ...]
    circles: tuple[RoundContact, ...]
    points: Mapping[str, Spot]
    bodies: Mapping[str, int]


def discretised(scene: Scene, settings: Settings) -> Discretised:
    """The scene's last state as the formulation ``paper`` would have it found.

    Args:
        scene: the problem statement.
        settings: numerical choices, of which the links, the degree and the formulation count.

    Returns:
        The minimum over links and bodies as plain numbers, for other optimisers.

    Raises:
        SceneError: the settings do not fit the scene, the formulation does not offer what the scene asks, or the state
            is not a minimum over links and bodies alone (an assembly, whose way says which one is meant; stops; rigid
            edges; loads on beams).
    """
    mechanism = mechanism_of(scene, settings.model_copy(update={"formulation": "paper"}))
    _check(scene, mechanism)
    values = {stage.steps: stage.stations[-1] for stage in scene.stages}
    problem = mechanism.problem
    model, closure = problem.model, problem.closure
    contacts = mechanism.boundaries.values()
    loads = [(values.get(name, 0.0), load) for name, load in problem.loads.items() if isinstance(load, DeadLoad)]
    return Discretised(
        unit_length=model.unit_length,
        unit_moment=model.unit_moment,
        lengths=model.lengths,
        rest=model.rest,
        couplings=model.couplings,
        rest_turns=model.rest_turns,
        fixed=closure.fixed,
        references=model.references,
        beams=tuple(Beam(chain.first_link, chain.n + 1, _spot(chain.start)) for chain in model.chains),
        ends=tuple((number, _end(model.chains[number])) for number in closure.ends),
        welds=closure.welds,
        pins=tuple((_spot(hinge.points[0]), _spot(hinge.points[1])) for hinge in closure.hinges),
        held=tuple(
            Held(hold.drive, _spot(hold.at), hold.along, hold.turn, hold.unit * values.get(hold.drive, 0.0))
            for hold in closure.holds
        ),
        loads=tuple(
            Load(
                Spot(load.body, *(float(part) for part in load.point)),
                (float(value * load.force[0]), float(value * load.force[1])),
                float(value * load.moment),
            )
            for value, load in loads
            if value != 0.0
        ),
        fitted=tuple(_fitted(model, each) for each in contacts if isinstance(each, FittedBoundary)),
        circles=tuple(_circle(model, each) for each in contacts if isinstance(each, RigidCircle)),
        points=frozendict(
            {point: _spot(attached(scene, model, point)) for body in scene.bodies.values() for point in body.points}
        ),
        bodies=frozendict({name: number for number, name in enumerate(model.free_bodies) if name in scene.bodies}),
    )


def _check(scene: Scene, mechanism: Mechanism) -> None:
    """Refuse what the record has no place for.

    Raises:
        SceneError: there is something.
    """
    on_beams = [name for name in scene.loads if not isinstance(mechanism.problem.loads[name], DeadLoad)]
    edges = [
        name
        for name, boundary in mechanism.boundaries.items()
        if not isinstance(boundary, FittedBoundary | RigidCircle)
    ]
    found = [
        *(["assembly"] if scene.assembly is not None else []),
        *(f"stops.{name}" for name in scene.stops),
        *(f"contacts.{name}" for name in edges),
        *(f"loads.{name}" for name in on_beams),
        *(f"stages.{stage.name}.beyond" for stage in scene.stages if stage.beyond is not None),
    ]
    if found:
        allowed = "loads on bodies, drives, two beams that touch and circles, from the state without stress"
        raise SceneError([Mistake(key, "what a single minimum does not state", allowed, scene.file) for key in found])


def _spot(attachment: Attachment) -> Spot:
    return Spot(attachment.body, *(float(part) for part in attachment.point))


def _end(chain: Chain) -> Spot:
    assert chain.end is not None
    return _spot(chain.end)


def _located(model: Model, joints: Ints) -> tuple[int, Ints]:
    """Number of the beam that some joints are of, and their numbers on it."""
    number = next(c for c, chain in enumerate(model.chains) if chain.joints.start <= joints[0] < chain.joints.stop)
    return number, joints - model.chains[number].first_joint


def _fitted(model: Model, boundary: FittedBoundary) -> FittedContact:
    carrier, points = _located(model, boundary.points)
    beam, joints = _located(model, boundary.joints)
    return FittedContact(
        name=boundary.name,
        boundary=carrier,
        points=points,
        beam=beam,
        joints=joints,
        degree=boundary.degree,
        along_x=boundary.along_x,
        sense=boundary.sense,
        offset=boundary.side * boundary.offset,
    )


def _circle(model: Model, circle: RigidCircle) -> RoundContact:
    beam, joints = _located(model, circle.joints)
    mark = model.marks.get(circle.name)
    centre = Spot(-1, *(float(part) for part in circle.center)) if mark is None else _spot(mark)
    return RoundContact(circle.name, beam, joints, centre, circle.radius)
