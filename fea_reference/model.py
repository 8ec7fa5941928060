"""Discretisation of a scene: nodes, elements, bodies, joints, guides, drives and loads, all dimensionless.

Lengths are relative to the longest beam and bending stiffnesses to the largest. The unit of force is therefore
EI/length², the unit of moment EI/length. A change of the scene's units leaves the problem unchanged to round-off.

The unknowns z are, in this order: the nodes' (x, y, θ) and the elements' axial forces N, numbered by scikit-fem; (X,
Y, φ) of every moving body, its displacement and rotation; the multipliers of all rows. A joint has two or three rows,
a hinge between bodies two, a drive and a stop a single row. The guide of a sliding body has two rows, against motion
across and rotation; with a pin in a slot the first row alone. The guide of a turning body has two rows for its pivot.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from skfem import CellBasis, ElementLineP0, ElementLineP1, ElementVector, MeshLine

from cprbm_scene.answer import Array
from cprbm_scene.clearance import is_apart
from cprbm_scene.frozendict import frozendict
from cprbm_scene.solving import refuse
from cprbm_scene.statement import (
    Beam,
    BeamEnd,
    BeamForce,
    BeamMoment,
    DisplacementDrive,
    DistributedLoad,
    Force,
    FreeEnd,
    Material,
    Moment,
    Scene,
    SlidingBody,
    TurningBody,
    WeldedEnd,
)
from fea_reference.acting import Acting
from fea_reference.curves import length, sample
from fea_reference.element import Chords, ElementForces, Elements, chords, forces, reference
from fea_reference.hermite import Index, NeutralLine, chord_speed_excess
from fea_reference.known import Memory
from fea_reference.leaning import LINE, TANGENTS, Chain, Lean, Span, places, tangent_angles
from fea_reference.own_pins import own_pins
from fea_reference.pattern import Patterns
from fea_reference.section import bending_stiffness, bending_stiffness_second, compliance
from fea_reference.settings import Settings
from fea_reference.state import State
from fea_reference.stops import ROUNDED, StopPart, stops_of
from fea_reference.upright import shear_layers

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)  # Gauss points per element: the neutral line is a cubic there


@dataclass(frozen=True, slots=True)
class Units:
    """Dimensional units: ``length`` (m) of the longest beam, ``bending`` stiffness (N·m²), ``origin`` (2,) (m)."""

    length: float
    bending: float
    origin: Array

    @property
    def force(self) -> float:
        """Unit of force, N."""
        return self.bending / self.length**2

    @property
    def moment(self) -> float:
        """Unit of moment, N·m."""
        return self.bending / self.length


@dataclass(frozen=True, slots=True)
class BeamPart:
    """A beam: the slices of its nodes and elements among all.

    ``length`` and ``thickness``, the largest, are dimensionless. ``record`` and ``material`` belong to the scene;
    ``unit`` is the unit of bending stiffness (N·m²).
    """

    name: str
    nodes: slice
    elements: slice
    length: float
    thickness: float
    record: Beam
    material: Material
    unit: float

    def bending(self, fractions: Array) -> Array:
        """EI at fractions (k,) of the arc length, dimensionless."""
        return bending_stiffness(self.record, self.material, fractions) / self.unit

    def bending_second(self, fractions: Array) -> Array:
        """Second derivative of EI by arc length at fractions (k,), dimensionless; at a knot the value behind."""
        return bending_stiffness_second(self.record, self.material, fractions) / self.unit / self.length**2

    @property
    def softest(self) -> float:
        """The least EI at the section's knots."""
        return float(self.bending(self.record.knots).min())

    @property
    def stiffest(self) -> float:
        """The largest EI at the section's knots."""
        return float(self.bending(self.record.knots).max())


@dataclass(frozen=True, slots=True)
class BodyPart:
    """A rigid body: reference ``centre`` (2,), ``points`` (2,) by name, and the three unknowns of a moving body."""

    name: str
    centre: Array
    points: dict[str, Array]
    dofs: Index | None


@dataclass(frozen=True, slots=True)
class JointPart:
    """A beam's end joined to a body's point: x − X − R(φ) r = 0 and, if welded, θ − φ − θ⁰ = 0.

    ``dofs`` are the unknowns of the end node, ``rows`` the two or three multipliers, ``arm`` is r and ``angle`` θ⁰.
    """

    point: str
    body: int
    dofs: Index
    rows: Index
    arm: Array
    angle: float


@dataclass(frozen=True, slots=True)
class HingePart:
    """A hinge of two bodies: X₁ + R(φ₁) r₁ − X₂ − R(φ₂) r₂ plus the difference of the reference centres is zero.

    ``arms`` are r₁ and r₂ (2,), ``points`` the names of the points, ``rows`` the two multipliers.
    """

    points: tuple[str, str]
    bodies: tuple[int, int]
    arms: tuple[Array, Array]
    rows: Index


@dataclass(frozen=True, slots=True)
class LoadPart:
    """A moment on a body (``direction`` is None), or a force along ``direction`` (2,) at its ``arm`` (2,)."""

    name: str
    body: int
    arm: Array
    direction: Array | None
    unit: float


@dataclass(frozen=True, slots=True)
class BeamLoadPart:
    """A unit load on beam number ``beam``: ``forces`` (2, k) at places ``zeta`` (k,), element number plus ξ.

    The load acts from place ``begin`` to ``end``, equal for a point force; ``density`` (2,) is the force, or the
    force per length.
    """

    name: str
    beam: int
    zeta: Array
    forces: Array
    begin: float
    end: float
    density: Array
    unit: float

    @property
    def distributed(self) -> bool:
        """True for a distributed load, False for a point force."""
        return self.begin < self.end


@dataclass(frozen=True, slots=True)
class BeamMomentPart:
    """A moment on beam number ``beam`` at the place ``zeta``, element number plus ξ."""

    name: str
    beam: int
    zeta: float
    unit: float


OnBeam = BeamLoadPart | BeamMomentPart


@dataclass(frozen=True, slots=True)
class DrivePart:
    """A row that prescribes a body's motion: direction·(X + R(φ) r − r) = value, or φ = value without a direction.

    ``row`` is the multiplier's number, ``arm`` is r, ``unit`` the unit of the value (m or rad).
    """

    name: str
    body: int
    row: int
    arm: Array
    direction: Array | None
    unit: float


@dataclass(frozen=True, slots=True)
class ApartPart:
    """A beam's end to be assembled: its ``joint``, and the dimensionless auxiliary ``moment``."""

    joint: JointPart
    moment: float


@dataclass(frozen=True, slots=True)
class SharePart:
    """A parameter of the assembly: the share of the auxiliary moments, or of the ends' way to their points."""

    name: str
    unit: float = 1.0


MOMENTS = SharePart("share of the assembly's moments")
WAY = SharePart("share of the ends' way to their points")


@dataclass(frozen=True, slots=True)
class Model:
    """Discretised scene; ``start`` is the undeformed state.

    ``guides`` are rows of drives with the constant value zero, and ``apart`` the ends to be assembled. ``stiffest``
    is the largest 12 EI/h² of the elements, and ``moving`` are the motions among the unknowns.

    ``spans`` are the beams' elements by name.

    ``known`` remembers results by state.
    """

    units: Units
    beams: tuple[BeamPart, ...]
    bodies: tuple[BodyPart, ...]
    joints: tuple[JointPart, ...]
    loads: tuple[LoadPart | OnBeam, ...]
    hinges: tuple[HingePart, ...]
    guides: tuple[DrivePart, ...]
    drives: tuple[DrivePart, ...]
    stops: tuple[StopPart, ...]
    apart: tuple[ApartPart, ...]
    elements: Elements
    node_dofs: Index
    element_dofs: Index
    multipliers: Index
    size: int
    start: State
    stiffest: float
    moving: Index
    patterns: Patterns = field(repr=False)
    spans: dict[str, Span] = field(repr=False)
    known: Memory = field(default_factory=Memory, repr=False)

    @property
    def stepped(self) -> tuple[LoadPart | OnBeam | DrivePart | SharePart, ...]:
        """The stepped parameters in the order of the values: loads, drives, then the two shares of the assembly."""
        return (*self.loads, *self.drives, *((MOMENTS, WAY) if self.apart else ()))

    @property
    def turning(self) -> Index:
        """The angles among the unknowns: of all nodes' sections and of all moving bodies."""
        bodies = [body.dofs[2:] for body in self.bodies if body.dofs is not None]
        return np.concatenate([self.node_dofs[2], *bodies])

    @property
    def initial_constraints(self) -> Acting:
        """Active constraints before the assembly: a stop at its limit as drawn is closed, and opens in tension.

        At an own pin the contact beside the pin decides about the stop.
        """
        if self.apart:
            return Acting(None, stopping=False)
        margins = {stop.name: stop.margin(self.start) for stop in self.stops if not stop.owner}
        limits = {name: limit for name, (margin, limit) in margins.items() if abs(margin) < ROUNDED}
        return Acting(np.zeros((0, 2)), stopping=True, limits=frozendict(limits))

    def free(self, joint: JointPart, acting: Acting) -> bool:
        """True if the joint is inactive because its end is not assembled yet."""
        return acting.ways is None and any(part.joint is joint for part in self.apart)

    def beam(self, name: str) -> BeamPart:
        """The beam of the given name."""
        return next(beam for beam in self.beams if beam.name == name)

    def chords(self, z: State) -> Chords:
        """Chords of all elements in state ``z``."""
        return self.known.recall(z, "chords", lambda: chords(self.elements, self.element_dofs, z))

    def bend(self, z: State) -> ElementForces:
        """Forces, stiffness and energy of all elements in state ``z``."""
        return self.known.recall(
            z, "forces", lambda: forces(self.elements, self.chords(z), z.values[self.element_dofs[6]])
        )

    def line(self, beam: BeamPart, z: State) -> NeutralLine:
        """A beam's neutral line in state ``z``."""
        return self.known.recall(z, ("line", beam.name), lambda: self._line(beam, z))

    def _line(self, beam: BeamPart, z: State) -> NeutralLine:
        theta = z.values[self.node_dofs[2, beam.nodes]]
        return self._through(beam, tangent_angles(self.spans[beam.name], theta, self.chords(z).shear[beam.elements]), z)

    def line_of_sections(self, beam: BeamPart, z: State) -> NeutralLine:
        """The neutral line with the sections' rotations as tangents, without the shear angle."""
        return self._through(beam, z[self.node_dofs[2, beam.nodes]], z)

    def _through(self, beam: BeamPart, angles: Array, z: State) -> NeutralLine:
        dofs = self.node_dofs[:, beam.nodes]
        return NeutralLine.through(
            z[dofs[:2]],
            angles,
            self.elements.length[beam.elements],
            z.rest[dofs[:2]],
            self.elements.compliance[beam.elements],
            z[self.element_dofs[6, beam.elements]],
        )

    def separate_elements(self, beam: BeamPart, e: Index, z: State) -> NeutralLine:
        """Separate cubics of elements (k,) of a beam, tangent at both ends by the element's own shear angle.

        The result is a line of 2 k − 1 elements, of which only 0, 2, … 2 k − 2 have a meaning. The speed l (1 + (ψ₂ −
        ψ₁)²/16) of the chord replaces the speed from the axial force.
        """
        return self.known.recall(z, ("line", beam.name, e.tobytes()), lambda: self._separate_line(beam, e, z))

    def _separate_line(self, beam: BeamPart, e: Index, z: State) -> NeutralLine:
        nodes = np.stack([e, e + 1], axis=1).ravel()
        dofs = self.node_dofs[:, beam.nodes][:, nodes]
        gamma = self.chords(z).shear[beam.elements][e]
        angles, lengths = z[dofs[2]] + np.repeat(gamma, 2), np.repeat(self.elements.length[beam.elements][e], 2)[:-1]
        dx, dy = z.difference(dofs[:2, 1:], dofs[:2, :-1])
        excess, *_ = chord_speed_excess(np.hypot(dx, dy), lengths, np.diff(angles))
        return NeutralLine.through(z[dofs[:2]], angles, lengths, z.rest[dofs[:2]], 1.0 / lengths, excess)

    def separate_chain(self, beam: BeamPart, e: Index, z: State) -> Chain:
        """Chain rule from the elements (k,) of :meth:`separate_elements` to the unknowns."""
        span, all_of_own = self.spans[beam.name], np.ones(e.size)
        own = tuple(Lean(row, 0, tuple(range(6)), e, span.part.start + e, all_of_own) for row in TANGENTS)
        return Chain(span.dofs[:, e], LINE, own if span.slips else (), (e,), self.chords(z))

    def chain(self, on: Sequence[tuple[BeamPart, Index]], z: State, body: Index | None = None) -> Chain:
        """Chain rule from line elements (k,) of beams, and a ``body``'s three unknowns, to the unknowns."""
        spans, elements = tuple(self.spans[beam.name] for beam, _ in on), tuple(e.tobytes() for _, e in on)
        return Chain(*places(spans, elements, () if body is None else tuple(body.tolist())), self.chords(z))

    def chain_of_sections(self, beam: BeamPart, e: Index, z: State) -> Chain:
        """Chain rule from :meth:`line_of_sections` to the unknowns, at elements (k,) of a beam."""
        return Chain(self.spans[beam.name].dofs[:, e], LINE, (), (e,), self.chords(z))

    def spread(self, dofs: Index, values: Array) -> Array:
        """The sum (size,) of ``values`` at unknowns ``dofs``, arrays of the same shape."""
        return np.asarray(np.bincount(dofs.ravel(), values.ravel(), self.size), dtype=float)

    def body_state(self, body: BodyPart, z: State) -> Array:
        """(X, Y, φ) of a body, zero for a fixed body."""
        return np.zeros(3) if body.dofs is None else np.asarray(z[body.dofs])

    def place(self, body: BodyPart, point: str, z: State) -> Array:
        """Current position (2,) of a body's point."""
        return self.carried(body, body.points[point] - body.centre, z)

    def carried(self, body: BodyPart, arm: Array, z: State) -> Array:
        """Current position (2,) of the point at ``arm`` (2,) from the body's centre."""
        X, Y, phi = self.body_state(body, z)
        return np.asarray(body.centre + np.array([X, Y]) + turned(arm, phi))


def turned(r: Array, phi: float) -> Array:
    """R(φ) r for a vector (2,)."""
    cos, sin = np.cos(phi), np.sin(phi)
    return np.array([cos * r[0] - sin * r[1], sin * r[0] + cos * r[1]])


def build(scene: Scene, settings: Settings) -> Model:
    """Discretise a scene.

    Raises:
        SceneError: the settings do not fit the scene.
    """
    refuse(scene, "the finite elements; 'cprbm solve' asks the CPRBM alone", "overlap at rest")
    counts = settings.elements_of(scene.beams)
    lengths = {name: length(beam.curve) for name, beam in scene.beams.items()}
    largest = max(
        float(bending_stiffness(beam, scene.materials[beam.material], beam.knots).max())
        for beam in scene.beams.values()
    )
    units = Units(max(lengths.values()), largest, np.array(next(iter(scene.beams.values())).curve.start))

    beams: list[BeamPart] = []
    arc, points, tangents, cells = [], [], [], []
    compliances = []
    node, cell, offset = 0, 0, 0.0
    for name, beam in scene.beams.items():
        n, material = counts[name], scene.materials[beam.material]
        own_length = lengths[name] / units.length
        fractions = np.linspace(0.0, 1.0, n + 1)
        where, angle = sample(beam.curve, fractions)
        arc.append(offset + own_length * fractions)
        points.append((where - units.origin) / units.length)
        tangents.append(angle)
        cells.append(node + np.stack([np.arange(n), np.arange(1, n + 1)]))
        compliances.append(compliance(beam, material, lengths[name], n, shear_layers(scene, name)))
        t = beam.thickest / units.length
        nodes_here, elements_here = slice(node, node + n + 1), slice(cell, cell + n)
        beams.append(BeamPart(name, nodes_here, elements_here, own_length, t, beam, material, units.bending))
        node, cell, offset = node + n + 1, cell + n, offset + own_length + 1.0

    # a single arc-length coordinate for all beams in sequence; no element spans the gaps between beams
    mesh = MeshLine(np.concatenate(arc)[None, :], np.concatenate(cells, axis=1))
    basis = CellBasis(mesh, ElementVector(ElementLineP1(), 3) * ElementLineP0(), intorder=2)
    nodes, angles = np.concatenate(points), np.concatenate(tangents)
    stretches, shears = settings.kinematics != "bending", settings.kinematics == "shear"
    elements = reference(
        mesh,
        nodes,
        angles,
        np.concatenate([part_compliance.bending for part_compliance in compliances], axis=2) * units.moment,
        np.concatenate([part_compliance.axial for part_compliance in compliances])
        * (stretches * units.force / units.length),
        np.concatenate([part_compliance.shear for part_compliance in compliances])
        * (shears * units.force / units.length),
    )
    node_dofs = np.asarray(basis.nodal_dofs, dtype=np.int64)
    size = int(basis.N)

    bodies: list[BodyPart] = []
    for name, body in scene.bodies.items():
        places = {key: (np.array(at) - units.origin) / units.length for key, at in body.points.items()}
        moves = body.motion != "fixed"
        dofs = np.arange(size, size + 3) if moves else None
        bodies.append(BodyPart(name, np.mean(list(places.values()), axis=0), places, dofs))
        size += 3 if moves else 0
    number = {body.name: i for i, body in enumerate(bodies)}

    first_row = size
    joints: list[JointPart] = []
    apart: list[ApartPart] = []
    at_ends: dict[tuple[str, str], tuple[int, float]] = {}
    for part in beams:
        ends = scene.beams[part.name]
        for which, end, at in (("start", ends.start, part.nodes.start), ("end", ends.end, part.nodes.stop - 1)):
            at_ends[part.name, which] = (int(node_dofs[2, at]), float(angles[at]))
            if isinstance(end, FreeEnd):
                continue
            joints.append(_joint(end, number[scene.body_of(end.point)], bodies, node_dofs[:, at], angles[at], size))
            size += joints[-1].rows.size
            if which == "end" and scene.assembly is not None and is_apart(scene, ends):
                apart.append(ApartPart(joints[-1], scene.assembly.moments.get(part.name, 0.0) / units.moment))

    hinges: list[HingePart] = []
    for both in scene.pins.values():
        part_compliance, other = (number[scene.body_of(point)] for point in both.points)
        arms = [
            bodies[i].points[point] - bodies[i].centre
            for i, point in zip((part_compliance, other), both.points, strict=True)
        ]
        hinges.append(HingePart(both.points, (part_compliance, other), (arms[0], arms[1]), np.arange(size, size + 2)))
        size += 2

    loads: list[LoadPart | OnBeam] = []
    for name, load in scene.loads.items():
        match load:
            case Moment():
                loads.append(LoadPart(name, number[load.body], np.zeros(2), None, units.moment))
            case Force():
                i = number[scene.body_of(load.point)]
                arm = bodies[i].points[load.point] - bodies[i].centre
                direction = np.array(load.direction) / np.hypot(*load.direction)
                loads.append(LoadPart(name, i, arm, direction, units.force))
            case BeamMoment():
                i = [part.name for part in beams].index(load.beam)
                # such a moment gives its element an angle of shear that no force makes
                elements.fourth[:, beams[i].elements][:, int(np.ceil(load.at * counts[load.beam])) - 1] = 0.0
                loads.append(BeamMomentPart(name, i, load.at * counts[load.beam], units.moment))
            case BeamForce() | DistributedLoad():
                loads.append(_on_beam(name, load, [part.name for part in beams].index(load.beam), beams, units))

    guides: list[DrivePart] = []
    for name, body in scene.bodies.items():
        if isinstance(body, SlidingBody):
            along, i = np.array(body.along) / np.hypot(*body.along), number[name]
            pin = np.zeros(2) if body.pin is None else bodies[i].points[body.pin] - bodies[i].centre
            guides.append(DrivePart(name, i, size, pin, turned(along, np.pi / 2), units.length))
            size += 1
            if body.pin is None:
                guides.append(DrivePart(name, i, size, np.zeros(2), None, 1.0))
                size += 1
        elif isinstance(body, TurningBody):
            i = number[name]
            arm = bodies[i].points[body.about] - bodies[i].centre
            for direction in np.eye(2):
                guides.append(DrivePart(name, i, size, arm, direction, units.length))
                size += 1
    drives: list[DrivePart] = []
    for name, drive in scene.drives.items():
        if isinstance(drive, DisplacementDrive):
            i = number[scene.body_of(drive.point)]
            arm, direction = bodies[i].points[drive.point] - bodies[i].centre, np.array(drive.direction)
            drives.append(DrivePart(name, i, size, arm, direction / np.hypot(*direction), units.length))
        else:
            drives.append(DrivePart(name, number[drive.body], size, np.zeros(2), None, 1.0))
        size += 1
    numbered = {body.name: (i, body.dofs) for i, body in enumerate(bodies)}
    stops = stops_of(scene, numbered, at_ends, size)
    stops += own_pins(scene, numbered, at_ends, size + len(stops))
    size += len(stops)

    start = np.zeros(size)
    start[node_dofs] = np.stack([nodes[:, 0], nodes[:, 1], angles])
    element_dofs = np.asarray(basis.element_dofs, dtype=np.int64)
    return Model(
        units,
        tuple(beams),
        tuple(bodies),
        tuple(joints),
        tuple(loads),
        tuple(hinges),
        tuple(guides),
        tuple(drives),
        stops,
        tuple(apart),
        elements,
        node_dofs,
        element_dofs,
        np.arange(first_row, size),
        size,
        State.of(start),
        max(12.0 * beam.stiffest / float(elements.length[beam.elements.start]) ** 2 for beam in beams),
        np.concatenate([node_dofs.ravel(), *(body.dofs for body in bodies if body.dofs is not None)]),
        Patterns(size),
        {part.name: _span(part, stops, elements, element_dofs) for part in beams},
    )


def _span(beam: BeamPart, stops: Sequence[StopPart], elements: Elements, dofs: Index) -> Span:
    """The elements of a beam."""
    own = {stop.end for stop in stops if stop.owner}
    ends = (("start", beam.record.start), ("end", beam.record.end))
    start, end = (isinstance(end, WeldedEnd) or (beam.name, which) in own for which, end in ends)
    slips = bool(elements.slip[:, beam.elements].any())
    return Span(beam.elements, dofs[:, beam.elements], (start, end), slips)


def _on_beam(
    name: str, load: BeamForce | DistributedLoad, number: int, beams: Sequence[BeamPart], units: Units
) -> BeamLoadPart:
    """A load on the beam of a ``number``."""
    beam = beams[number]
    n = beam.nodes.stop - 1 - beam.nodes.start
    direction = np.array(load.direction) / np.hypot(*load.direction)
    if isinstance(load, BeamForce):
        at = load.at * n
        return BeamLoadPart(name, number, np.array([at]), direction[:, None], at, at, direction, units.force)
    begin, end = (share * n for share in load.along)
    fence = np.unique(np.clip(np.arange(n + 1), begin, end))
    half = 0.5 * np.diff(fence)
    zeta = (fence[:-1, None] + half[:, None] * (1.0 + _POINTS)).ravel()
    weights = (half[:, None] * _WEIGHTS).ravel() * beam.length / n
    forces = direction[:, None] * weights
    return BeamLoadPart(name, number, zeta, forces, begin, end, direction, units.force / units.length)


def _joint(end: BeamEnd, body: int, bodies: list[BodyPart], dofs: Index, angle: float, row: int) -> JointPart:
    """The joint of a beam's end that is not free; its rows begin at ``row``."""
    assert not isinstance(end, FreeEnd)
    rows = np.arange(row, row + (3 if isinstance(end, WeldedEnd) else 2))
    return JointPart(end.point, body, dofs, rows, bodies[body].points[end.point] - bodies[body].centre, angle)
