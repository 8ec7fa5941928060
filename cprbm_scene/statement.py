"""The problem statement: frozen records in SI units, angles in radians; a file may state others (:mod:`.units`).

Every record refuses unknown keys, NaN and infinity.  Bounds stand only on
dimensionless numbers and on signs that have no meaning (a thickness is
positive).  What ties records together (a beam's end meets a body's point, a
load acts on something that can move) is checked in :mod:`cprbm_scene.checks`.

Kinds are tagged unions: a further curve, joint, body, load, drive or contact is a further
record with a ``kind`` (or ``joint``, or ``motion``) of its own, and nothing here changes.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isclose
from typing import Annotated, ClassVar, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, BaseModel, ConfigDict, Discriminator, Field, StringConstraints, Tag

from cprbm_scene.frozendict import frozendict

T = TypeVar("T")


def _freeze(value: Mapping[str, T]) -> Mapping[str, T]:
    return frozendict(value)


Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_-]*$", max_length=64)]
Named = Annotated[Mapping[Name, T], AfterValidator(_freeze)]
Point = tuple[float, float]
Positive = Annotated[float, Field(gt=0.0)]
Fraction = Annotated[float, Field(gt=0.0, le=1.0)]


class Record(BaseModel):
    """What all records share: immutable, strict, nothing unknown, no number that is not finite."""

    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)


class Material(Record):
    """A linear elastic, isotropic material: ``youngs_modulus`` in Pa, ``poisson_ratio`` a number."""

    youngs_modulus: Positive
    poisson_ratio: Annotated[float, Field(gt=-1.0, le=0.5)]


class Line(Record):
    """A straight neutral line from ``start`` to ``end``, metres."""

    kind: Literal["line"]
    start: Point
    end: Point


class Arc(Record):
    """A circular neutral line about ``center`` from ``start`` round to ``end``, metres.

    Both ends lie on the circle; ``direction`` says which way round, so that an arc is less than a full turn.
    """

    kind: Literal["arc"]
    center: Point
    start: Point
    end: Point
    direction: Literal["counterclockwise", "clockwise"]


class Polynomial(Record):
    """A neutral line y = f(x) (``axis`` is ``x``) or x = f(y) (``axis`` is ``y``), metres.

    ``coefficients`` of f, lowest power first, f in metres for a variable in metres; ``range`` is where the variable
    begins and ends, so that a beam may run against its axis.
    """

    kind: Literal["polynomial"]
    axis: Literal["x", "y"]
    coefficients: Annotated[tuple[float, ...], Field(min_length=2)]
    range: tuple[float, float]

    @property
    def start(self) -> Point:
        """Where the line begins, metres."""
        return self._at(self.range[0])

    @property
    def end(self) -> Point:
        """Where the line ends, metres."""
        return self._at(self.range[1])

    def _at(self, variable: float) -> Point:
        value = 0.0
        for coefficient in reversed(self.coefficients):
            value = value * variable + coefficient
        return (variable, value) if self.axis == "x" else (value, variable)


class Spline(Record):
    """A smooth neutral line through ``points`` (at least three), metres, from the first to the last.

    x and y are cubic splines of t, which is zero at the first point and grows from each to the next by their distance:
    cubic in between, with two continuous derivatives, so that tangent and curvature have no jumps.  At an end that has
    a ``start_direction`` or ``end_direction`` the derivative is its unit vector (in the sense in which the beam runs);
    at one that has none the outer two pieces are one cubic.  Of three points without directions it is the parabola
    through them.
    """

    kind: Literal["spline"]
    points: Annotated[tuple[Point, ...], Field(min_length=3)]
    start_direction: Point | None = None
    end_direction: Point | None = None

    @property
    def start(self) -> Point:
        """Where the line begins, metres."""
        return self.points[0]

    @property
    def end(self) -> Point:
        """Where the line ends, metres."""
        return self.points[-1]


Curve = Annotated[Line | Arc | Polynomial | Spline, Field(discriminator="kind")]


class WeldedEnd(Record):
    """The beam's end is fixed to a body's ``point``: it moves and turns with the body."""

    joint: Literal["weld"]
    point: Name


class PinnedEnd(Record):
    """The beam's end stays at a body's ``point`` and turns freely about it."""

    joint: Literal["pin"]
    point: Name


class FreeEnd(Record):
    """The beam's end is held by nothing."""

    joint: Literal["free"]


BeamEnd = Annotated[WeldedEnd | PinnedEnd | FreeEnd, Field(discriminator="joint")]


class Profile(Record):
    """A size that varies along a beam: ``values`` (metres) at fractions ``at`` of its arc length, straight between.

    The first fraction is 0, the last 1, and they ascend.
    """

    at: Annotated[tuple[float, ...], Field(min_length=2)]
    values: Annotated[tuple[Positive, ...], Field(min_length=2)]


def _size_tag(value: object) -> str:
    return "profile" if isinstance(value, Mapping | Profile) else "number"


Size = Annotated[Annotated[Positive, Tag("number")] | Annotated[Profile, Tag("profile")], Discriminator(_size_tag)]


class PaperBeam(Record):
    """How the paper cuts a beam into elements: ``uniform`` along ``x`` or ``y``; without this even in arc length."""

    uniform: Literal["x", "y"]


class Beam(Record):
    """A slender beam of rectangular section, free of stress in the shape of its ``curve``.

    ``thickness`` lies in the plane of motion, ``width`` across it, both in metres; each is a number or varies along
    the beam.
    """

    curve: Curve
    thickness: Size
    width: Size
    material: Name
    start: BeamEnd
    end: BeamEnd
    paper: PaperBeam | None = None

    def thickness_at(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Thickness at fractions ``u`` of the arc length, m, in the same shape."""
        return _size_at(self.thickness, u)

    def width_at(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Width at fractions ``u`` of the arc length, m, in the same shape."""
        return _size_at(self.width, u)

    @property
    def knots(self) -> NDArray[np.float64]:
        """Fractions (k,) between which thickness and width go straight, from 0 to 1."""
        inner = [size.at for size in (self.thickness, self.width) if isinstance(size, Profile)]
        return np.array(sorted({0.0, 1.0}.union(*inner)))

    @property
    def thinnest(self) -> float:
        """The least thickness, m."""
        return min(self.thickness.values) if isinstance(self.thickness, Profile) else self.thickness

    @property
    def thickest(self) -> float:
        """The largest thickness, m."""
        return max(self.thickness.values) if isinstance(self.thickness, Profile) else self.thickness

    @property
    def tapered(self) -> bool:
        """Whether the thickness varies along the beam."""
        return self.thinnest < self.thickest


def _size_at(size: float | Profile, u: NDArray[np.float64]) -> NDArray[np.float64]:
    if isinstance(size, Profile):
        return np.asarray(np.interp(u, size.at, size.values))
    return np.full(np.shape(u), size)


Points = Annotated[Named[Point], Field(min_length=1)]


class FixedBody(Record):
    """The ground: a rigid body with named points (metres) that does not move."""

    motion: Literal["fixed"]
    points: Points


class FreeBody(Record):
    """A rigid body with two translations and a rotation; ``points`` in metres, initial position."""

    motion: Literal["free"]
    points: Points


class SlidingBody(Record):
    """A rigid body that the ground guides without friction: it moves ``along`` a direction and does not turn.

    Where it ``turns``, one of its points stays in the slot and it turns about that: ``about``, which a body with one
    point need not say.  ``along`` is made a unit vector; ``points`` in metres, initial position.
    """

    motion: Literal["slides"]
    along: Point
    turns: bool = False
    about: Name | None = None
    points: Points

    @property
    def pin(self) -> Name | None:
        """The point that stays in the slot as the body turns; None of a body that does not turn."""
        if not self.turns:
            return None
        return next(iter(self.points)) if self.about is None else self.about


class TurningBody(Record):
    """A rigid body on a frictionless pivot of the ground: it turns ``about`` one of its own points.

    ``points`` in metres, initial position.
    """

    motion: Literal["turns"]
    about: Name
    points: Points


Body = Annotated[FixedBody | FreeBody | SlidingBody | TurningBody, Field(discriminator="motion")]


class BodyPin(Record):
    """Joins two bodies by a frictionless hinge: the ``points``, one of each, stay together."""

    points: tuple[Name, Name]


class Stop(Record):
    """Limits the angle at which a pinned ``beam`` stands at its pin, rad: ``least`` and ``most``, or one of them.

    The angle runs counter-clockwise from the line that leads from the pin to ``towards``, another point of the same
    body, to the direction in which the beam leaves the pin.  As drawn it lies in (−π, π], and it is counted on from
    there: it grows as the beam's ``end`` turns counter-clockwise against the body.  Without friction; a limit that is
    reached holds by a moment.
    """

    beam: Name
    end: Literal["start", "end"]
    towards: Name
    least: float | None = None
    most: float | None = None


class Assembly(Record):
    """Beams are drawn free of stress, some with their pinned ``end`` apart from its point, and brought there first.

    Three parts, in which nothing else is loaded or driven: ``moments`` (N·m, counter-clockwise on that end of the
    beam of the name) grow while the ends are free; the ends go straight to their points; the moments go away.
    Where beams can be assembled in several ways, the moments say in which.  Contacts act throughout, stops as soon
    as the ends are at their points.
    """

    moments: Named[float] = Field(default_factory=frozendict)


class Moment(Record):
    """A moment on a ``body``, counter-clockwise positive, N·m."""

    kind: Literal["moment"]
    body: Name


class Force(Record):
    """A dead force at a body's ``point``: its ``direction`` (made a unit vector) stays as the body turns."""

    kind: Literal["force"]
    point: Name
    direction: Point


Share = Annotated[float, Field(ge=0.0, le=1.0)]


class BeamForce(Record):
    """A dead force on a ``beam``, N, ``at`` a fraction of its arc length from the start.

    Its ``direction`` (made a unit vector) stays as the beam turns.
    """

    kind: Literal["beam_force"]
    beam: Name
    at: Share
    direction: Point


class BeamMoment(Record):
    """A moment on a ``beam``, counter-clockwise positive, N·m, ``at`` a fraction of its arc length from the start."""

    kind: Literal["beam_moment"]
    beam: Name
    at: Share


class DistributedLoad(Record):
    """A dead load on a ``beam``, N per metre of its arc length, the same ``along`` it from one fraction to another.

    Its ``direction`` (made a unit vector) stays as the beam turns: a weight, not a pressure.
    """

    kind: Literal["distributed"]
    beam: Name
    direction: Point
    along: tuple[Share, Share] = (0.0, 1.0)


Load = Annotated[Moment | Force | BeamForce | BeamMoment | DistributedLoad, Field(discriminator="kind")]
BodyLoad = Moment | Force


class DisplacementDrive(Record):
    """Prescribes how far a body's ``point`` moves along ``direction`` (made a unit vector), m; across it is free."""

    kind: Literal["displacement"]
    point: Name
    direction: Point


class RotationDrive(Record):
    """Prescribes a ``body``'s rotation, counter-clockwise, rad."""

    kind: Literal["rotation"]
    body: Name


Drive = Annotated[DisplacementDrive | RotationDrive, Field(discriminator="kind")]


class Related(Record):
    """The joints of one beam that may touch: initial ``x`` or ``y`` (one of them) in the range, metres."""

    x: Point | None = None
    y: Point | None = None


class PaperContact(Record):
    """What the paper's contact must be told: whose offset is the boundary, along which axis, which joints.

    ``boundary`` names the beam that carries g_s; ``axis`` is the axis of the gap: ``y`` for g_s(x) − y,
    ``x`` for g_s(y) − x.  Without an entry in ``related`` all joints of a beam are related.
    """

    boundary: Name
    axis: Literal["x", "y"] = "y"
    related: Named[Related] = Field(default_factory=frozendict)


class PaperRigid(Record):
    """Which joints of the beam the paper's contact with something rigid holds outside; without an entry all."""

    related: Named[Related] = Field(default_factory=frozendict)


class BeamContact(Record):
    """Two beams that may touch, without friction; ``thick`` beams touch by their edges, others as lines."""

    kind: Literal["beam-beam"]
    between: tuple[Name, Name]
    thick: bool = True
    paper: PaperContact | None = None

    @property
    def beams(self) -> tuple[str, ...]:
        """The beams that may touch, the first of which places are measured along."""
        return self.between


class SelfContact(Record):
    """A beam that may touch itself, without friction, once it has turned far enough to come back to itself.

    A ``thick`` beam touches by its edges, half of the thickness of either place from its neutral line, another as a
    line.  Which of its sides meet is not told: it is the one on which a part of the beam comes near another.
    """

    kind: Literal["beam-self"]
    beam: Name
    thick: bool = True
    paper: ClassVar[None] = None  # its formulation has no form for this

    @property
    def beams(self) -> tuple[str, ...]:
        """The beam that may touch itself."""
        return (self.beam,)


class RigidContact(Record):
    """What contacts of a beam with something rigid have in common.  They are without friction.

    What the beam may touch is fixed to ``body`` and stated where it is initially, metres.  A ``thick`` beam touches by
    its edge, half of the thickness of the place from its neutral line, another as a line.
    """

    beam: Name
    body: Name
    thick: bool = True
    paper: PaperRigid | None = None

    @property
    def beams(self) -> tuple[str, ...]:
        """The beam that may touch."""
        return (self.beam,)


class CircleContact(RigidContact):
    """A beam that may touch a rigid circle of ``radius`` about ``center`` from outside."""

    kind: Literal["beam-circle"]
    center: Point
    radius: Positive


class LineContact(RigidContact):
    """A beam that may touch a rigid line of straight pieces between ``points``.

    The beam lies on the free ``side``, seen along the points.  What is rigid lies behind the line, and ends where it
    does: at right angles to its first and its last piece.  A line whose last point is its first goes round and has no
    ends.
    """

    kind: Literal["beam-line"]
    points: Annotated[tuple[Point, ...], Field(min_length=2)]
    side: Literal["left", "right"]

    @property
    def closed(self) -> bool:
        """Whether it goes round."""
        return len(self.points) > 2 and self.points[0] == self.points[-1]


class HalfPlaneContact(RigidContact):
    """A beam that may touch a rigid half-plane, whose straight edge goes through ``point``.

    ``normal`` points away from the half-plane, to where the beam lies; it is made a unit vector.
    """

    kind: Literal["beam-half-plane"]
    point: Point
    normal: Point


class FunctionContact(RigidContact):
    """A beam that may touch a rigid edge y = f(x) (``axis`` is ``x``) or x = f(y) (``axis`` is ``y``).

    ``coefficients`` of f, lowest power first, f in metres for a variable in metres, which is within ``range``.  The
    beam lies ``above``, where the other coordinate is larger than f, or ``below``.  As with a :class:`LineContact`,
    what is rigid lies behind the edge and ends where that does.
    """

    kind: Literal["beam-function"]
    axis: Literal["x", "y"]
    coefficients: Annotated[tuple[float, ...], Field(min_length=2)]
    range: tuple[float, float]
    side: Literal["above", "below"]

    @property
    def curve(self) -> Polynomial:
        """The edge."""
        return Polynomial(kind="polynomial", axis=self.axis, coefficients=self.coefficients, range=self.range)


EdgeContact = LineContact | HalfPlaneContact | FunctionContact
"""Contacts with what a beam may lie on up to its own pin, where it is held like by a stop."""

Contact = Annotated[BeamContact | SelfContact | CircleContact | EdgeContact, Field(discriminator="kind")]


class Stage(Record):
    """A part of the loading: the values of one load or drive, in the order in which they are reached.

    Loads and drives that no stage has stepped yet are zero (such a drive holds what it drives where it is);
    each keeps its last value in later stages.

    ``beyond`` asks where the branch that is followed ends because it is no minimum of the potential energy any more,
    and says what happens there: ``stop``, or ``jump`` to the state that the decrease of the energy leads to.  Then
    steps are so short that no end is passed.  Without it they are as long as they can be, and an end is told of only
    where a step finds no way past it; where the energy's decrease leads to a state beside it, both solvers go on there
    and say so in a note.  ``shown`` are the stations that tables and pictures are to show beside the last
    of all.  ``critical_limit`` (in the unit of the stations) is how far apart and how uncertain critical values may be
    within one theory with which the stage still wants to hear AGREE; without it what is usual.
    """

    name: Name
    steps: Name
    stations: Annotated[tuple[float, ...], Field(min_length=1, max_length=10_001)]
    shown: tuple[float, ...] = ()
    critical_limit: Positive | None = None
    beyond: Literal["stop", "jump"] | None = None


Quantity = Literal[
    "displacement",
    "rotation",
    "force",
    "centre",
    "ends",
    "closing_load",
    "bending_stress",
    "combined_stress",
    "reaction",
    "reaction_moment",
    "potential_energy",
    "angle",
    "moment",
]


STRESSES: frozenset[Quantity] = frozenset({"bending_stress", "combined_stress"})
"""Quantities that are wanted at places along a beam."""


class Probe(Record):
    """A number (or a few) that is wanted at every station, named ``of.quantity``.

    ``of`` is the name of a body's point, a body, a beam, a contact, a stop, or ``scene`` itself;
    ``points`` the number of equal arc-length steps plus one at which a beam's stress is wanted;
    ``verdict_limit`` stands in the place of the scene's for this probe.
    """

    of: Name
    quantity: Quantity
    points: Annotated[int, Field(ge=3, le=10_001)] = 81
    verdict_limit: Fraction | None = None

    @property
    def name(self) -> str:
        """The probe's name as tables and JSON show it."""
        return f"{self.of}.{self.quantity}"


CRITICAL = "critical"
"""What a claim of a critical value has in the place of a probe's name."""


class Claim(Record):
    """What a publication says of one probe: its relative difference stays below ``bound``.

    Without a ``station`` it says so of every station at which the probe has a value, without a ``stage`` of every
    stage.  With a ``value`` (SI) it says what the probe's is: ours then stays within ``bound`` of it, a share of the
    value, or of the probe's scale where the value is zero.

    Of the probe ``critical`` it speaks of the first critical value of the ``stage``, without one of every stage.
    """

    probe: str
    stage: Name | None = None
    station: float | None = None
    value: float | None = None
    bound: Positive
    text: str = ""

    def speaks_of(self, stage: str, station: float) -> bool:
        """Whether the claim is made at a station: at its own, whose digits may be written in another way, or at all."""
        return self.in_stage(stage) and (self.station is None or isclose(self.station, station, rel_tol=1e-9))

    def in_stage(self, stage: str) -> bool:
        """Whether the claim is made in a stage: in its own, or in all."""
        return self.stage is None or self.stage == stage


class Units(Record):
    """Units of the numbers in a file; moments, distributed loads and energies are of force and length."""

    length: Literal["m", "cm", "mm", "um", "in"] = "m"
    force: Literal["N", "kN", "mN", "uN"] = "N"
    angle: Literal["rad", "deg"] = "rad"
    stress: Literal["Pa", "kPa", "MPa", "GPa"] = "Pa"


class Scene(Record):
    """One problem statement: what is there, what happens to it, and what is asked.

    Names of points, bodies, beams, contacts, stops, pins, loads and drives are unique across the scene.
    ``may_cross`` lists pairs that may pass through each other without a contact: two beams, or a beam and a contact
    with a rigid edge.  ``verdict_limit`` is the largest total uncertainty (a fraction of a probe's scale)
    with which the scene still wants to hear AGREE; a probe may have its own.  ``units`` are those of a file; of a scene
    that was read they are SI (:mod:`cprbm_scene.units`).
    """

    name: Name
    title: str = ""
    source: str = ""
    units: Units = Units()
    materials: Named[Material]
    beams: Annotated[Named[Beam], Field(min_length=1, max_length=256)]
    bodies: Annotated[Named[Body], Field(max_length=256)]
    loads: Named[Load] = Field(default_factory=frozendict)
    drives: Named[Drive] = Field(default_factory=frozendict)
    contacts: Annotated[Named[Contact], Field(max_length=1000)] = Field(default_factory=frozendict)
    stops: Named[Stop] = Field(default_factory=frozendict)
    pins: Named[BodyPin] = Field(default_factory=frozendict)
    assembly: Assembly | None = None
    may_cross: tuple[tuple[Name, Name], ...] = ()
    stages: Annotated[tuple[Stage, ...], Field(min_length=1)]
    probes: Annotated[tuple[Probe, ...], Field(min_length=1)]
    claims: tuple[Claim, ...] = ()
    verdict_limit: Fraction = 0.015
    file: str = ""

    def __repr__(self) -> str:
        """Name, and numbers of beams, contacts, probes and stations."""
        stations = sum(len(stage.stations) for stage in self.stages)
        parts = {"beams": self.beams, "contacts": self.contacts, "probes": self.probes}
        counts = ", ".join(f"{len(found)} {name}" for name, found in parts.items())
        return f"<Scene {self.name}: {counts}, {stations} stations>"

    def limit(self, probe: Probe) -> float:
        """The largest total uncertainty, a fraction of the probe's scale, with which AGREE may be said of it."""
        return self.verdict_limit if probe.verdict_limit is None else probe.verdict_limit

    def stepped(self, stage: Stage) -> Load | Drive:
        """The load or drive that a stage steps.

        Raises:
            KeyError: nothing has the name that the stage says.
        """
        return self.loads[stage.steps] if stage.steps in self.loads else self.drives[stage.steps]

    def place_of(self, point: str) -> Point:
        """Initial position of a body's ``point``, m.

        Raises:
            KeyError: no body has a point of that name.
        """
        return self.bodies[self.body_of(point)].points[point]

    def body_of(self, point: str) -> str:
        """Name of the body that owns ``point``.

        Raises:
            KeyError: no body has a point of that name.
        """
        for name, body in self.bodies.items():
            if point in body.points:
                return name
        raise KeyError(point)
