"""The problem of the formulation ``paper`` as plain numbers for other optimisers.

=========  ==========================================================================================
symbol     meaning
=========  ==========================================================================================
θ_i        angles of the links of all beams, beam after beam
u, v, φ    displacement of a free body's reference place, and rotation
PE         Σ ½ k_i (θ_{i+1} − θ_i − δ_i⁰)² − W, minimised
Z = 0      ends on their points, welds, pins between bodies, slides and drives
c ≤ 0      related joints against a fitted polynomial or a circle
=========  ==========================================================================================

Lengths are in units of the longest beam ℓ, energies and moments in units S of :mod:`cprbm.chain.mechanism`.  Loads and
drives have the last value that the scene gives.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from cprbm.chain import Mechanism, mechanism_of
from cprbm.chain.rows import ends_of, unit_direction
from cprbm.paper.contacts import fitted_boundary, refuse_contacts, related_joints
from cprbm.settings import Settings
from cprbm_scene import BeamContact, CircleContact, FreeEnd, Mistake, Scene, SceneError, WeldedEnd
from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import (
    DisplacementDrive,
    Force,
    Moment,
    SlidingBody,
    TurningBody,
)


@dataclass(frozen=True, slots=True)
class Spot:
    """A point of a body: ``x``, ``y`` from the reference place; of the ground (``body`` −1) the place itself."""

    body: int
    x: float
    y: float


@dataclass(frozen=True, slots=True)
class Beam:
    """Links ``first`` to ``first + count − 1``, joints 0 to ``count`` behind them, the first joint on ``start``."""

    first: int
    count: int
    start: Spot


@dataclass(frozen=True, slots=True)
class Held:
    """An equality: ``along``·(displacement of a spot) + ``turn``·φ = ``value``; ``drive`` names it."""

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
        boundary: number of the curve's beam; points: joints of that beam (n,).
        beam: number of the other beam; joints: constrained joints (m,).
        degree: of the polynomial.
        along_x: whether it is y = g(x), or x = g(y).
        sense: +1 where the joints have the larger coordinate across, −1 the smaller.
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
    """All data of the minimum, at one value of loads and drives.

    Attributes:
        unit_length: ℓ, m.
        unit_moment: S, N·m.
        lengths: L_i of the links (n,), in ℓ.
        rest: stress-free angles of the links (n,), rad.
        couplings: k_i of the springs between link i and i + 1 (n−1,), in S; zero between beams.
        rest_turns: δ_i⁰ of these springs (n−1,), rad.
        fixed: links that keep their stress-free angle.
        references: reference places of the moving bodies at rest (B, 2).
        beams: in the scene's order.
        ends: number of a beam whose last joint is on a spot, and that spot.
        welds: link, and body that turns with the link, −1 for the ground.
        pins: spots that stay together, at the same place at rest.
        held: slides, pivots and drives.
        loads: at their values.
        fitted: contacts of two beams.
        circles: contacts of a beam and a circle.
        points: the scene's, by name.
        bodies: numbers of the moving bodies, by name.
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
    """The minimum of the formulation ``paper`` at the scene's last state, as plain numbers.

    Args:
        scene: the problem statement.
        settings: numerical choices, of which the links and the degree count.

    Raises:
        SceneError: the settings do not fit the scene, the formulation has no form for a contact, or the state is no
            minimum over links and bodies alone (theory with compliance, assembly, stops, rigid edges, loads on beams).
    """
    settings.check(scene)
    refuse_contacts(scene)
    _check(scene)
    links = {beam: settings.links_of(beam) for beam in scene.beams}
    m = mechanism_of(scene, links, "bending", corrected=False)
    chains, places = list(m.chains.values()), _Places(m)
    first = np.cumsum([0, *(chain.links for chain in chains)])
    starts, ends, welds, fixed = _ends(m, places, first)
    couplings, turns = np.zeros(first[-1] - 1), np.zeros(first[-1] - 1)
    for chain, begin in zip(chains, first.tolist(), strict=False):
        own = slice(begin, begin + chain.links - 1)
        couplings[own], turns[own] = chain.stiffness, np.diff(chain.link_angle)
    fitted, circles = _contacts(m, settings.degree, places)
    return Discretised(
        unit_length=m.units.length,
        unit_moment=m.units.moment,
        lengths=np.concatenate([chain.link_length for chain in chains]),
        rest=np.concatenate([chain.link_angle for chain in chains]),
        couplings=couplings,
        rest_turns=turns,
        fixed=np.array(fixed, dtype=np.int64),
        references=np.array(places.references).reshape(-1, 2),
        beams=tuple(
            Beam(begin, chain.links, start) for begin, chain, start in zip(first.tolist(), chains, starts, strict=False)
        ),
        ends=ends,
        welds=welds,
        pins=tuple((places.spot(pin.points[0]), places.spot(pin.points[1])) for pin in scene.pins.values()),
        held=tuple(_held(m, places)),
        loads=tuple(_loads(m, places)),
        fitted=fitted,
        circles=circles,
        points={point: places.spot(point) for body in scene.bodies.values() for point in body.points},
        bodies=dict(places.bodies),
    )


@dataclass
class _Places:
    """Numbers and reference places of the moving bodies; a beam's free start counts as a body."""

    m: Mechanism
    bodies: dict[str, int] = field(default_factory=dict)
    references: list[Array] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.bodies = {name: number for number, name in enumerate(self.m.bodies)}
        self.references = [self.m.reference(name) for name in self.m.bodies]

    def spot(self, point: str) -> Spot:
        """A named point."""
        return self.on(self.m.scene.body_of(point), self.m.units.place(self.m.scene.place_of(point)))

    def on(self, body: str, place: Array) -> Spot:
        """A place (2,) on a body."""
        number = self.bodies.get(body, -1)
        x, y = place - self.references[number] if number >= 0 else place
        return Spot(number, float(x), float(y))

    def free(self, place: Array) -> Spot:
        """A free start at a place (2,)."""
        self.references.append(place)
        return Spot(len(self.references) - 1, 0.0, 0.0)


def _check(scene: Scene) -> None:
    """Refuse scenes that a single minimum does not state.

    Raises:
        SceneError: the scene is one of them.
    """
    contacts = scene.contacts.items()
    found = [
        *(["theory"] if scene.theory != "bending" else []),
        *(["assembly"] if scene.assembly is not None else []),
        *(f"stops.{name}" for name in scene.stops),
        *(f"contacts.{name}" for name, each in contacts if not isinstance(each, BeamContact | CircleContact)),
        *(f"contacts.{name}.side" for name, each in contacts if getattr(each, "side", "") == "inside"),
        *(f"loads.{name}" for name, load in scene.loads.items() if not isinstance(load, Force | Moment)),
        *(f"stages.{stage.name}.beyond" for stage in scene.stages if stage.beyond is not None),
    ]
    if found:
        allowed = "loads on bodies, drives, two beams that touch and circles, in bending, from the state without stress"
        raise SceneError([Mistake(key, "no part of a single minimum", allowed, scene.file) for key in found])


def _ends(
    m: Mechanism, places: _Places, first: Ints
) -> tuple[list[Spot], tuple[tuple[int, Spot], ...], tuple[tuple[int, int], ...], list[int]]:
    """Spots of the starts; ends on spots; welds; links welded to the ground at the start."""
    starts, ends, welds, fixed = list[Spot](), list[tuple[int, Spot]](), list[tuple[int, int]](), list[int]()
    for number, beam in enumerate(m.scene.beams):
        start, end = ends_of(m.scene, beam)
        link = int(first[number])
        if isinstance(start, FreeEnd):
            starts.append(places.free(m.chains[beam].nodes[0]))
            welds.append((link, starts[-1].body))
        else:
            starts.append(places.spot(start.point))
            if isinstance(start, WeldedEnd) and starts[-1].body < 0:
                fixed.append(link)
            elif isinstance(start, WeldedEnd):
                welds.append((link, starts[-1].body))
        if not isinstance(end, FreeEnd):
            ends.append((number, places.spot(end.point)))
            if isinstance(end, WeldedEnd):
                welds.append((int(first[number + 1]) - 1, ends[-1][1].body))
    return starts, tuple(ends), tuple(welds), fixed


def _held(m: Mechanism, places: _Places) -> list[Held]:
    """Slides, pivots and drives."""
    scene, found = m.scene, list[Held]()
    values = {stage.steps: stage.stations[-1] for stage in scene.stages}
    for body in scene.bodies.values():
        if isinstance(body, TurningBody):
            at = places.spot(body.about)
            found += [Held("", at, along, 0.0, 0.0) for along in ((1.0, 0.0), (0.0, 1.0))]
        elif isinstance(body, SlidingBody):
            at, along = places.spot(body.pin or next(iter(body.points))), unit_direction(body.along)
            found.append(Held("", at, (-along[1], along[0]), 0.0, 0.0))
            found += [] if body.turns else [Held("", at, (0.0, 0.0), 1.0, 0.0)]
    for name, drive in scene.drives.items():
        value = values.get(name, 0.0)
        if isinstance(drive, DisplacementDrive):
            along = unit_direction(drive.direction)
            found.append(Held(name, places.spot(drive.point), along, 0.0, value / m.units.length))
        else:
            found.append(Held(name, Spot(places.bodies[drive.body], 0.0, 0.0), (0.0, 0.0), 1.0, value))
    return found


def _loads(m: Mechanism, places: _Places) -> list[Load]:
    """Loads on moving bodies that act at last."""
    found = []
    for stage in m.scene.stages:
        load, value = m.scene.loads.get(stage.steps), stage.stations[-1]
        if isinstance(load, Force) and m.scene.body_of(load.point) in places.bodies:
            x, y = unit_direction(load.direction)
            force = value / m.units.force
            found.append((stage.steps, Load(places.spot(load.point), (force * x, force * y), 0.0)))
        elif isinstance(load, Moment) and load.body in places.bodies:
            at = Spot(places.bodies[load.body], 0.0, 0.0)
            found.append((stage.steps, Load(at, (0.0, 0.0), value / m.units.moment)))
    # a later stage of the same load holds
    return [load for load in dict(found).values() if any((*load.force, load.moment))]


def _contacts(m: Mechanism, degree: int, places: _Places) -> tuple[tuple[FittedContact, ...], tuple[RoundContact, ...]]:
    """Contacts of two beams, and contacts with circles."""
    fitted, circles, beams = list[FittedContact](), list[RoundContact](), list(m.scene.beams)
    for name, contact in m.scene.contacts.items():
        if isinstance(contact, BeamContact):
            boundary, other = fitted_boundary(m, name, degree)
            carrier = next(beam for beam in contact.between if beam != other)
            fitted.append(
                FittedContact(
                    name=name,
                    boundary=beams.index(carrier),
                    points=np.searchsorted(m.beam_nodes(carrier), boundary.points),
                    beam=beams.index(other),
                    joints=np.searchsorted(m.beam_nodes(other), boundary.joints),
                    degree=boundary.degree,
                    along_x=boundary.along == 0,
                    sense=boundary.sense,
                    offset=boundary.offset,
                )
            )
        elif isinstance(contact, CircleContact):
            joints, chain = related_joints(m, name, contact.beam, fewest=1), m.chains[contact.beam]
            half = 0.5 * chain.section.thickness(chain.arcs[joints]) if contact.thick else np.zeros(len(joints))
            centre = places.on(contact.body, m.units.place(contact.center))
            radii = contact.radius / m.units.length + half
            circles.append(RoundContact(name, beams.index(contact.beam), joints, centre, radii))
    return tuple(fitted), tuple(circles)
