"""The problem statement: immutable records in SI units, angles in radians; a file may state other units.

Every record refuses unknown keys, NaN and infinity, and states the rules between the fields.  Rules between records
(a beam's end meets a body's point, a load acts on a movable body) are in :mod:`cprbm_scene.checks`.

Kinds are tagged unions: a new curve, joint, body, load, drive or contact is a new record with another ``kind`` (or
``joint``, or ``motion``).
"""

from __future__ import annotations

from bisect import bisect
from collections.abc import Iterator, Mapping
from math import isclose
from typing import Annotated, Any, Literal, Protocol, TypeVar

from pydantic import Field, PrivateAttr, ValidationInfo, field_validator

from cprbm_scene.beam_records import (
    Beam,
    BeamEnd,
    FreeEnd,
    Material,
    PaperBeam,
    PinnedEnd,
    Profile,
    Size,
    WeldedEnd,
)
from cprbm_scene.body_records import (
    Assembly,
    BeamForce,
    BeamMoment,
    Body,
    BodyLoad,
    BodyPin,
    DisplacementDrive,
    DistributedLoad,
    Drive,
    FixedBody,
    Force,
    FreeBody,
    Load,
    Moment,
    RotationDrive,
    SlidingBody,
    Stop,
    TurningBody,
)
from cprbm_scene.contact_records import (
    BeamContact,
    CircleContact,
    Contact,
    EdgeContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    PaperContact,
    PaperRigid,
    Related,
    RigidContact,
    SelfContact,
)
from cprbm_scene.curve_records import Arc, Line, NeutralLine, Polynomial, Spline
from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake
from cprbm_scene.parameters import Parameter, Tolerance, register
from cprbm_scene.record import Name, Named, Of, Record, Text, Title
from cprbm_scene.units import (
    ANGLE,
    FORCE,
    LENGTH,
    MOMENT,
    STRESS,
    Following,
    Point,
    Positive,
    PositiveShare,
    Reading,
    Unit,
    Units,
    mistake,
)

__all__ = [
    "CRITICAL",
    "STRESSES",
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
    "Stage",
    "Stop",
    "Tolerance",
    "TurningBody",
    "Units",
    "WeldedEnd",
]

Curve = NeutralLine
V = TypeVar("V")

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
"""Quantities at several places along a beam."""

_UNITS: Mapping[Quantity, Unit] = frozendict(
    {
        "displacement": LENGTH,
        "rotation": ANGLE,
        "force": FORCE,
        "centre": LENGTH,
        "ends": LENGTH,
        "bending_stress": STRESS,
        "combined_stress": STRESS,
        "reaction": FORCE,
        "reaction_moment": MOMENT,
        "potential_energy": MOMENT,
        "angle": ANGLE,
        "moment": MOMENT,
    }
)
"""Units of probes; a closing load has the unit of its stage."""

CRITICAL = "critical"
"""Name of a claim's probe for the first critical value of a stage."""


def _of_stage(reading: Reading, stage: Mapping[str, Any]) -> Unit | None:
    """Unit of a stage's stations: the unit of the stepped load or drive."""
    return reading.stepped.get(stage.get("steps", ""))


def _of_stations(reading: Reading, claim: Mapping[str, Any]) -> Unit | None:
    """Unit of the stations of a claim's stages."""
    stage = claim.get("stage")
    units = {unit for name, unit in reading.stages.items() if stage in (None, name)}
    if len(units) > 1 and reading.units != Units():
        found = "a number in the unit of several stages, which step different kinds"
        raise mistake(found, "a stage beside it")
    return next(iter(units), None)


def _of_value(reading: Reading, claim: Mapping[str, Any]) -> Unit | None:
    """Unit of a claim's probe."""
    probe = claim.get("probe")
    if probe == CRITICAL or reading.probes.get(str(probe), LENGTH) is None:
        return _of_stations(reading, claim)
    return reading.probes.get(str(probe))


Station = Annotated[float, Following(_of_stage)]


class Stage(Record):
    """Part of the loading: the values of a load or drive, in the order of stepping.

    Loads and drives are zero before a stage steps them (such a drive holds the initial place) and keep their last value
    in later stages.

    ``beyond`` selects the path at a critical point, where the state ceases to be a minimum of the potential
    energy: ``stop``, or ``jump`` to the state at the end of the energy descent.  Load steps are then short enough
    to pass no critical point.  Without ``beyond`` load steps are as long as possible, and a critical point is reported
    only where no step leads past; a branch jump to a state beside the critical point is reported in a note.  ``shown``
    are stations for tables and pictures, beside the last of all.  ``critical_limit`` (in the unit of the stations)
    replaces the usual largest difference and uncertainty of critical values for the verdict AGREE.
    """

    name: Name
    steps: Annotated[Name, Of("load or drive")]
    stations: Annotated[tuple[Station, ...], Field(min_length=1, max_length=10_001)]
    shown: tuple[Station, ...] = ()
    critical_limit: Annotated[float, Field(gt=0.0), Following(_of_stage)] | None = None
    beyond: Literal["stop", "jump"] | None = None

    def rules(self) -> Iterator[Mistake]:
        """Repeated stations, indistinguishable in an answer, and shown values without a station."""
        before: list[float] = []  # ascending
        for j, value in enumerate(self.stations):
            place = bisect(before, value)
            beside = before[max(0, place - 1) : place + 1]
            before.insert(place, value)
            if any(isclose(value, other, rel_tol=1e-9) for other in beside):
                allowed = "each value once in a stage; a further stage may go back to it"
                yield Mistake(f"stations[{j}]", f"{value:g} again", allowed)
        stations = set(self.stations)
        for j, value in enumerate(self.shown):
            if value not in stations:
                yield Mistake(f"shown[{j}]", f"{value:g}", "one of the stage's stations")


class Probe(Record):
    """Requested number (or numbers) at every station, named ``of.quantity``.

    ``of`` is the name of a body's point, a body, a beam, a contact, a stop, or ``scene``.  ``points`` is the number of
    places, equally spaced in arc length, of a beam's stress.  ``verdict_limit`` replaces the scene's for this probe.
    """

    of: Name
    quantity: Quantity
    points: Annotated[int, Field(ge=3, le=10_001)] = 81
    verdict_limit: PositiveShare | None = None

    @property
    def name(self) -> str:
        """The probe's name in tables and JSON."""
        return f"{self.of}.{self.quantity}"

    def rules(self) -> Iterator[Mistake]:
        """Places of quantities other than stress."""
        if "points" in self.model_fields_set and self.quantity not in STRESSES:
            allowed = "points for 'bending_stress' and 'combined_stress' only"
            yield Mistake("points", f"places along {self.name!r}", allowed)


class Claim(Record):
    """Statement of a publication on a probe: the relative difference stays below ``bound``.

    Without a ``station`` the claim concerns every station with a value of the probe, without a ``stage`` every stage.
    With a ``value`` (SI) the claim states the probe's value: ours then stays within ``bound`` of the value, a fraction
    of the value, or of the probe's scale if the value is zero.

    The probe ``critical`` is the first critical value of the ``stage``, without a stage of every stage.
    """

    probe: str
    stage: Name | None = None
    station: Annotated[float, Following(_of_stations)] | None = None
    value: Annotated[float, Following(_of_value)] | None = None
    bound: Positive
    text: Text = ""

    def speaks_of(self, stage: str, station: float) -> bool:
        """True if the claim concerns a station; stations are equal up to round-off."""
        return self.in_stage(stage) and (self.station is None or isclose(self.station, station, rel_tol=1e-9))

    def in_stage(self, stage: str) -> bool:
        """True if the claim concerns a stage."""
        return self.stage is None or self.stage == stage


class Source(Protocol):
    """Data of a scene with parameters, for another reading."""

    def read(self, values: Mapping[str, float | str]) -> Scene:
        """The scene with other values of parameters."""


class Scene(Record):
    """The problem statement: mechanism, loading, requested quantities.

    Names of points, bodies, beams, contacts, stops, pins, loads and drives are unique across the scene.
    ``verdict_limit`` is the largest total uncertainty, a fraction of a probe's scale, for the
    verdict AGREE; a probe may have another limit.  ``units`` are those of a file; a scene from a file has SI units.
    """

    name: Name
    title: Title = ""
    source: Text = ""
    units: Units = Units()
    parameters: Named[Parameter] = Field(default_factory=frozendict)
    materials: Named[Material]
    beams: Annotated[Named[Beam], Field(min_length=1, max_length=256)]
    bodies: Annotated[Named[Body], Field(max_length=256)]
    loads: Named[Load] = Field(default_factory=frozendict)
    drives: Named[Drive] = Field(default_factory=frozendict)
    contacts: Annotated[Named[Contact], Field(max_length=1000)] = Field(default_factory=frozendict)
    stops: Named[Stop] = Field(default_factory=frozendict)
    pins: Named[BodyPin] = Field(default_factory=frozendict)
    assembly: Assembly | None = None
    stages: Annotated[tuple[Stage, ...], Field(min_length=1)]
    probes: Annotated[tuple[Probe, ...], Field(min_length=1)]
    claims: tuple[Claim, ...] = ()
    verdict_limit: PositiveShare = 0.015
    file: str = ""
    _source: Source | None = PrivateAttr(default=None)

    @field_validator("units", "parameters", "loads", "drives", "stages", "probes")
    @classmethod
    def _register(cls, value: V, info: ValidationInfo) -> V | Units | Mapping[str, Parameter]:
        """The value itself, with units stored for later fields; SI units in place of the file's units."""
        reading = info.context
        if not isinstance(reading, Reading):
            return value
        match info.field_name, value:
            case "units", _:
                return Units()
            case "parameters", Mapping() as parameters:
                return register(reading, parameters)
            case "stages", tuple(stages):
                units = ((stage.name, reading.stepped.get(stage.steps)) for stage in stages)
                reading.stages.update({name: unit for name, unit in units if unit is not None})
            case "probes", tuple(probes):
                reading.probes.update({probe.name: _UNITS.get(probe.quantity) for probe in probes})
            case _, Mapping() as acting:
                reading.stepped.update({name: each.unit for name, each in acting.items()})
        return value

    def with_parameters(self, **values: float) -> Scene:
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
        if self._source is None or self._source.read({}) != self:
            raise ValueError("found a scene without parameters or altered after reading; allowed: a scene from a file")
        return self._source.read(values)

    def limit(self, probe: Probe) -> float:
        """Largest total uncertainty, a fraction of the probe's scale, for the verdict AGREE."""
        return self.verdict_limit if probe.verdict_limit is None else probe.verdict_limit

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
        """Names of bodies by their points; for a repeated point the first body."""
        return {point: name for name, body in reversed(list(self.bodies.items())) for point in body.points}

    def body_of(self, point: str) -> str:
        """Name of the body of a ``point``.

        Raises:
            KeyError: no body has a point of that name.
        """
        return self.owners[point]
