"""The problem statement: immutable records in SI units, angles in radians; a file may state other units.

Every record refuses unknown keys, NaN and infinity, and states the rules between the fields.  Rules between records
(a beam's end meets a body's point, a load acts on a movable body) are in :mod:`cprbm_scene.reading`.

Kinds are tagged unions: a new curve, joint, body, load, drive or contact is a new record with another ``kind`` (or
``joint``, or ``motion``).
"""

import re
from collections.abc import Collection, Iterator, Mapping
from typing import Annotated, Any, Literal, Self, cast

from pydantic import AfterValidator, Field, PrivateAttr, ValidationInfo, field_validator
from pydantic.json_schema import SkipJsonSchema

from cprbm_scene.contact_records import (
    BeamContact,
    CircleContact,
    Contact,
    EdgeContact,
    EllipseContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    PaperContact,
    PaperRigid,
    Related,
    RigidContact,
    SelfContact,
    SplineContact,
    Stop,
    measures,
)
from cprbm_scene.curve_records import Arc, Line, NeutralLine, Polynomial, Spline
from cprbm_scene.fields import (
    NAME,
    Name,
    Named,
    Of,
    OptionalNamed,
    Parameter,
    Point,
    PositiveShare,
    Reading,
    Record,
    Text,
    Title,
    Tolerance,
    Units,
    Word,
)
from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake, broken
from cprbm_scene.part_records import (
    Beam,
    BeamEnd,
    Body,
    BodyPin,
    FixedBody,
    FreeBody,
    FreeEnd,
    Material,
    PaperBeam,
    PinnedEnd,
    Profile,
    Size,
    SlidingBody,
    TurningBody,
    WeldedEnd,
)
from cprbm_scene.question_records import (
    CRITICAL,
    STRESSES,
    UNITS,
    Assembly,
    BeamForce,
    BeamMoment,
    BodyLoad,
    Claim,
    DisplacementDrive,
    DistributedLoad,
    Drive,
    Force,
    Load,
    Moment,
    Probe,
    Quantity,
    RotationDrive,
    Stage,
)

__all__ = [
    "CRITICAL",
    "STRESSES",
    "UNITS",
    "Arc",
    "Assembly",
    "Beam",
    "BeamContact",
    "BeamEnd",
    "BeamForce",
    "BeamMoment",
    "Body",
    "BodyLoad",
    "BodyPin",
    "CircleContact",
    "Claim",
    "Contact",
    "Curve",
    "DisplacementDrive",
    "DistributedLoad",
    "Drive",
    "EdgeContact",
    "EllipseContact",
    "FixedBody",
    "Force",
    "FreeBody",
    "FreeEnd",
    "FunctionContact",
    "HalfPlaneContact",
    "Line",
    "LineContact",
    "Load",
    "Material",
    "Moment",
    "PaperBeam",
    "PaperContact",
    "PaperRigid",
    "Parameter",
    "PinnedEnd",
    "Point",
    "Polynomial",
    "Probe",
    "Profile",
    "Quantity",
    "Record",
    "Related",
    "RigidContact",
    "RotationDrive",
    "Scene",
    "SelfContact",
    "Size",
    "SlidingBody",
    "Spline",
    "SplineContact",
    "Stage",
    "Stop",
    "Tolerance",
    "TurningBody",
    "Units",
    "WeldedEnd",
]

Curve = NeutralLine
MECHANISM = frozenset(
    ("beams", "bodies", "points", "loads", "drives", "contacts", "stops", "pins", "assembly", "stages", "units")
)
"""Tables of a file that decide how the mechanism moves."""


class Scene(Record):
    """The problem statement: mechanism, loading, requested quantities.

    Names of points, bodies, beams, contacts, stops, pins, loads and drives are unique across the scene.  A scene from a
    file has SI units, and ``display_units`` remember the file's.
    """

    name: Name
    """Name of the scene, for tables and file names."""
    title: Title = ""
    """Heading of tables and pages."""
    source: Text = ""
    """Origin of the scene, such as a publication."""
    units: Units = Units()
    """Units of the numbers in the file."""
    theory: Literal["bending", "stretch", "shear"] = "shear"
    """Beam theory of the CPRBM and the finite elements: bending alone, with stretch, or with stretch and shear."""
    parameters: Annotated[Mapping[Word, Parameter], AfterValidator(frozendict), Field(default_factory=frozendict)]
    """Named numbers for expressions."""
    materials: Named[Material]
    """Materials by name."""
    beams: Annotated[Named[Beam], Field(min_length=1, max_length=256)]
    """Beams by name."""
    bodies: Annotated[Named[Body], Field(max_length=256)]
    """Rigid bodies by name."""
    loads: OptionalNamed[Load]
    """Loads by name."""
    drives: OptionalNamed[Drive]
    """Drives by name."""
    contacts: Annotated[OptionalNamed[Contact], Field(max_length=1000)]
    """Contacts by name."""
    stops: OptionalNamed[Stop]
    """Stops by name."""
    pins: OptionalNamed[BodyPin]
    """Pins between bodies by name."""
    assembly: Assembly | None = None
    """Motion of beams to their points before the first stage."""
    may_cross: Annotated[tuple[tuple[Name, Name], ...], Of("beam or contact with a rigid edge")] = ()
    """Pairs that may pass through each other: two beams, a beam and a contact with a rigid edge, or a beam twice."""
    stages: Annotated[tuple[Stage, ...], Field(min_length=1)]
    """Stages of the loading, in order."""
    probes: Annotated[tuple[Probe, ...], Field(min_length=1)]
    """Requested numbers."""
    claims: tuple[Claim, ...] = ()
    """Statements of the source on probes."""
    verdict_limit: PositiveShare = 0.015
    """Largest stated uncertainty for the verdict AGREE, a fraction of a probe's scale."""
    file: SkipJsonSchema[str] = ""  # no key of a file
    _reading: Reading = PrivateAttr(default_factory=Reading)

    def rules(self) -> Iterator[Mistake]:
        """Pairs of the same edge."""
        return broken(
            *(
                one == other
                and one not in self.beams
                and Mistake(f"may_cross[{i}]", f"{one!r} twice", "two different names, or a beam twice")
                for i, (one, other) in enumerate(self.may_cross)
            )
        )

    @field_validator("units", "parameters", "loads", "drives", "stages")
    @classmethod
    def _register(cls, value: Any, info: ValidationInfo) -> object:  # noqa: ANN401 - of several fields
        """The value itself, with units stored for later fields; SI units in place of the file's units."""
        reading = info.context
        if not isinstance(reading, Reading):
            return value
        match info.field_name, value:
            case "units", Units() as units:
                reading.units = units
                return Units()
            case "parameters", Mapping() as parameters:
                return reading.register(parameters)
            case "stages", tuple() as stages:
                reading.stages = {stage.name: reading.stepped.get(stage.steps) for stage in stages}
            case _, Mapping() as parts:
                reading.stepped |= {name: UNITS[part.kind] for name, part in parts.items()}
        return value

    def completed(self) -> Mapping[str, object]:
        """Beams and bodies with a free body for each named free end, and a point of each fixed body without points."""
        beams, bodies = dict(self.beams), dict(self.bodies)
        for name, (side, end, place) in ((name, end) for name, beam in self.beams.items() for end in beam.ends):
            if isinstance(end, FreeEnd) and end.point is not None and f"{end.point}-body" not in bodies:
                bodies[f"{end.point}-body"] = FreeBody(motion="free", points=frozendict({end.point: place}))
                beams[name] = beams[name].model_copy(update={side: WeldedEnd(joint="weld", point=end.point)})
        for name, each in self.bodies.items():
            if not each.points:
                edges = (e for e in self.contacts.values() if isinstance(e, RigidContact) and e.body == name)
                places = [
                    *(measures(e)[0][0] for e in edges),
                    *(beam.curve.start for beam in beams.values()),
                    (0.0, 0.0),
                ]
                bodies[name] = FixedBody(motion="fixed", points=frozendict({f"{name}-point": places[0]}))
        return {"beams": frozendict(beams), "bodies": frozendict(bodies)}

    def with_parameters(self, **values: float) -> Self:
        """The scene with other values of its parameters, checked as a file is checked.

        Args:
            values: numbers in SI units by the names of parameters; other parameters keep their values.

        Returns:
            A scene.

        Raises:
            SceneError: a name is unknown, a value is out of range, or the new scene has mistakes.
            ValueError: the scene was not read from data with parameters, or was altered after reading.

        Example:
            >>> from cprbm_scene import read
            >>> hinge = read("comparisons/cases/hinge.toml").with_parameters(t=1.9e-3)
            >>> hinge.beams["beam1"].thickness
            0.0019
        """
        again, settings = self._reading.again, self._reading.settings
        if again is None or not self.parameters or again(parameters=settings) != self:
            raise ValueError("found a scene without parameters or altered after reading; allowed: a scene from a file")
        return cast("Self", again(parameters={**settings, **values}))

    def __repr__(self) -> str:
        """Name, and numbers of beams, contacts and probes."""
        return f"<Scene {self.name}: {len(self.beams)} beams, {len(self.contacts)} contacts, {len(self.probes)} probes>"

    __str__ = __repr__

    @property
    def display_units(self) -> Units:
        """Units of the scene's file, for tables and figures; ``model_fields_set`` lists the stated ones."""
        return self._reading.units

    def left_out(self, *tables: str) -> list[str]:
        """Names, but for forbidden names, of the parts of ``tables`` with mistakes that the reader left out."""
        return [
            name
            for table, name in sorted(self._reading.left_out)
            if table in tables and all(re.search(f"{NAME}|^$", part) for part in name.split("."))
        ]

    def lacks(self, name: str, *tables: str) -> bool:
        """True if the reader left out a part of this name, or parts of unknown names, of the ``tables``."""
        return not {name, ""}.isdisjoint(self.left_out(*tables))

    def whole(self, tables: Collection[str] = MECHANISM) -> bool:
        """False if the reader left out parts of the ``tables``."""
        return not any(table in tables for table, _ in self._reading.left_out)

    def limit(self, probe: Probe) -> float:
        """Largest total uncertainty, a fraction of the probe's scale, for the verdict AGREE."""
        return self.verdict_limit if probe.verdict_limit is None else probe.verdict_limit

    def probes_in(self, stage: str) -> tuple[Probe, ...]:
        """The probes that are asked in a stage."""
        return tuple(probe for probe in self.probes if probe.asked_in(stage))

    def holds(self, drive: Drive, stage: str) -> bool:
        """True if a drive prescribes its motion in a stage; False in stages before the drive's ``from``."""
        names = [each.name for each in self.stages]
        return drive.begins not in names[names.index(stage) + 1 :]

    def values_at(self, stage: str, value: float) -> dict[str, float]:
        """Values of loads and drives at a station, the ``value`` of a stage; later stages keep the last value.

        A drive with ``from`` has no value before the first stage of its own stations.
        """
        first, names = self.stages[0].name, [each.name for each in self.stages]
        values = dict.fromkeys((*self.loads, *(k for k, v in self.drives.items() if self.holds(v, first))), 0.0)
        for each in self.stages[: names.index(stage) + 1]:
            values |= dict.fromkeys(each.stepped, value if each.name == stage else each.stations[-1])
        return values

    def stepped(self, stage: Stage) -> Load | Drive:
        """The stepped load or drive of a stage.

        Raises:
            KeyError: no load or drive has the stage's name of ``steps``.
        """
        return self.loads[stage.steps] if stage.steps in self.loads else self.drives[stage.steps]

    def place_of(self, point: str) -> Point:
        """Initial position of a body's ``point``, m.

        Raises:
            KeyError: no body has a point of that name.
        """
        return self.bodies[self.body_of(point)].points[point]

    @property
    def owners(self) -> dict[str, str]:
        """Names of bodies by their points; for a repeated point the last body."""
        return {point: name for name, body in self.bodies.items() for point in body.points}

    def body_of(self, point: str) -> str:
        """Name of the body of a ``point``.

        Raises:
            KeyError: no body has a point of that name.
        """
        return self.owners[point]
