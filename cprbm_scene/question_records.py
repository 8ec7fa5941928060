"""Records of the question: assembly, loads, drives, stages, probes and claims.

Stations have the unit of the stepped load or drive, values of claims the unit of the probe's quantity.
"""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from math import isclose
from typing import Annotated, Any, Literal, cast

from pydantic import Field, WithJsonSchema, create_model, model_validator

from cprbm_scene.fields import (
    Direction,
    Measured,
    Name,
    Of,
    OptionalNamed,
    Positive,
    PositiveShare,
    Reading,
    Record,
    Share,
    Text,
    Units,
)
from cprbm_scene.mistakes import Mistake, broken, refuse_broken
from cprbm_scene.part_records import BeamName, BodyName, PointName
from cprbm_scene.units import ANGLE, FORCE, LENGTH, LINE_LOAD, MOMENT, STRESS, Unit

SHORTEST_STRETCH = 1e-6
"""Least length of a distributed load, of the beam's length."""


class Assembly(Record):
    """Motion of pinned ends, drawn apart from their points, to the points before the first stage.

    Three parts, without other loads or drives: the moments grow while the ends are free; the ends move straight to
    their points; the moments decrease to zero.  The moments select an assembled state among several.  Contacts act
    throughout, stops as soon as the ends are at their points.
    """

    moments: Annotated[OptionalNamed[Annotated[float, Measured(MOMENT)]], Of("beam")]
    """Moments on pinned ends by the names of beams, counter-clockwise."""


class Moment(Record):
    """Moment on a body, counter-clockwise."""

    kind: Literal["moment"]
    body: BodyName
    """Body under the moment, counter-clockwise."""


class Force(Record):
    """Dead force at a point of a body."""

    kind: Literal["force"]
    point: PointName
    """Point of a body under the force."""
    direction: Direction
    """Direction, constant while the part turns."""


class BeamForce(Record):
    """Dead force at a place of a beam."""

    kind: Literal["beam_force"]
    beam: BeamName
    """Beam under the load."""
    at: Share
    """Place, a fraction of the beam's arc length."""
    direction: Direction
    """Direction, constant while the part turns."""


class BeamMoment(Record):
    """Moment at a place of a beam, counter-clockwise."""

    kind: Literal["beam_moment"]
    beam: BeamName
    """Beam under the load."""
    at: Share
    """Place, a fraction of the beam's arc length."""


class DistributedLoad(Record):
    """Dead load per length of a beam, constant along a part: a weight, not a pressure."""

    kind: Literal["distributed"]
    beam: BeamName
    """Beam under the load."""
    direction: Direction
    """Direction, constant while the part turns."""
    along: tuple[Share, Share] = (0.0, 1.0)
    """Loaded part of the beam, fractions of the arc length."""

    def rules(self) -> Iterator[Mistake]:
        """A stretch without length."""
        begin, end = self.along
        return broken(
            end - begin < SHORTEST_STRETCH
            and Mistake(
                "along",
                f"a stretch from {begin:.9g} to {end:.9g}",
                "two fractions of the beam's length, the smaller one first",
            )
        )


Load = Annotated[Moment | Force | BeamForce | BeamMoment | DistributedLoad, Field(discriminator="kind")]
BodyLoad = Moment | Force


_From = create_model(  # type: ignore[call-overload]
    "_From",
    __base__=Record,
    **{
        "from": (
            Annotated[Name | None, Of("stage")],
            Field(None, description="First stage of the drive: before this stage the motion is free."),
        )
    },
)
"""Field with a name that Python reserves."""


class _Drive(_From):
    """Prescribed motion, from the begin of the first stage, or of the stage ``from``: before that the motion is free.

    From its stage on the drive holds the value that the motion has there, or goes on from it.
    """

    @property
    def begins(self) -> str | None:
        """Name of the stage before which the motion is free; None for a drive that holds from the start."""
        return cast("str | None", getattr(self, "from"))


class DisplacementDrive(_Drive):
    """Prescribed displacement of a point of a body along a direction."""

    kind: Literal["displacement"]
    point: PointName
    """Driven point of a body."""
    direction: Direction
    """Direction of the prescribed displacement; the point is free across it."""


class RotationDrive(_Drive):
    """Prescribed rotation of a body, counter-clockwise."""

    kind: Literal["rotation"]
    body: BodyName
    """Body with a prescribed rotation, counter-clockwise."""


Drive = Annotated[DisplacementDrive | RotationDrive, Field(discriminator="kind")]


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

UNITS: Mapping[str, Unit] = {
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
    "beam_force": FORCE,
    "beam_moment": MOMENT,
    "distributed": LINE_LOAD,
}
"""Units of quantities, and of kinds of loads and drives; a closing load has the unit of its stage."""

CRITICAL = "critical"
"""Name of a claim's probe for the first critical value of a stage."""


def _of_stage(reading: Reading, stage: Mapping[str, Any]) -> Unit | None:
    """Unit of a stage's stations: the unit of the stepped load or drive."""
    return reading.stepped.get(stage.get("steps", ""))


def _of_stations(reading: Reading, claim: Mapping[str, Any]) -> Unit | None:
    """Unit of the stations of a claim's stages."""
    units = {unit for name, unit in reading.stages.items() if claim.get("stage") in (None, name)} - {None}
    refuse_broken(
        len(units) > 1
        and reading.units != Units()
        and Mistake("", "a number in the unit of several stages, which step different kinds", "a stage beside it")
    )
    return next(iter(units), None)


def _of_value(reading: Reading, claim: Mapping[str, Any]) -> Unit | None:
    """Unit of a claim's probe, by the quantity in the probe's name."""
    quantity = str(claim.get("probe")).rpartition(".")[2]
    return _of_stations(reading, claim) if quantity in (CRITICAL, "closing_load") else UNITS.get(quantity)


Station = Annotated[float, Measured(_of_stage)]
_SEVERAL = {"anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}, "minItems": 2}]}


class Stage(Record):
    """Part of the loading: the values of a load or drive, in the order of stepping.

    Loads and drives are zero before a stage steps them (such a drive holds the initial place) and keep their last value
    in later stages.  After reading a list of loads, ``steps`` names the first.

    ``beyond`` selects the path at a critical point, where the state ceases to be a minimum of the potential
    energy: ``stop``, or ``jump`` to the state at the end of the energy descent.  Load steps are then short enough
    to pass no critical point.  Without ``beyond`` load steps are as long as possible, and a critical point is reported
    only where no step leads past; a branch jump to a state beside the critical point is reported in a note.
    """

    name: Name
    """Name of the stage."""
    steps: Annotated[Name, Of("load or drive"), WithJsonSchema(_SEVERAL)]
    """Load or drive with the values of the stations; a list steps several loads."""
    together: Annotated[tuple[Name, ...], Of("load", key="steps")] = ()
    """Loads of a list in ``steps``, written by the reader."""
    stations: Annotated[tuple[Station, ...], Field(min_length=1, max_length=10_001)]
    """Values of the load or drive, in order; a value stands once in a stage."""
    shown: tuple[Station, ...] = ()
    """Stations of tables and pictures, beside the last station of all."""
    critical_limit: Annotated[float, Field(gt=0.0), Measured(_of_stage)] | None = None
    """Largest uncertainty of critical values, in place of 0.3° of rotation or 1 % of the span."""
    beyond: Literal["stop", "jump"] | None = None
    """Search for the end of the branch: the answer ends there, or jumps to the next minimum of the energy."""

    @property
    def stepped(self) -> tuple[str, ...]:
        """Names of the loads, or of the drive, with the values of the stations."""
        return self.together or (self.steps,)

    @model_validator(mode="before")
    @classmethod
    def _first(cls, data: object) -> object:
        """The data with the first of several names of ``steps``."""
        if isinstance(data, Mapping) and isinstance(names := data.get("steps"), tuple) and len(names) > 1:
            return {**data, "steps": names[0], "together": names}
        return data

    def rules(self) -> Iterator[Mistake]:
        """Repeated stations, indistinguishable in an answer, and shown values without a station."""
        stations, together = self.stations, self.together
        ascending = sorted(range(len(stations)), key=stations.__getitem__)
        again = {max(i, j) for i, j in pairwise(ascending) if isclose(stations[i], stations[j], rel_tol=1e-9)}
        known = set(stations)
        return broken(
            *(
                Mistake(
                    f"stations[{j}]",
                    f"{stations[j]:g} again",
                    "each value once in a stage; a further stage may go back to it",
                )
                for j in sorted(again)
            ),
            not (together[:1] in ((), (self.steps,)) and len(set(together)) == len(together))
            and Mistake("steps", f"{list(together)}", "different loads, each once"),
            *(
                value not in known and Mistake(f"shown[{j}]", f"{value:g}", "one of the stage's stations")
                for j, value in enumerate(self.shown)
            ),
        )


class Probe(Record):
    """Requested number (or numbers) at every station, named ``of.quantity``.

    Places of stresses are equally spaced in arc length.  With ``stages``, answers of other stages have an empty value.
    """

    of: Name
    """Name of a point, body, beam, contact or stop, or ``scene``."""
    quantity: Quantity
    """Requested quantity."""
    points: Annotated[int, Field(ge=3, le=10_001)] = 81
    """Number of places along a beam, for stresses."""
    verdict_limit: PositiveShare | None = None
    """Limit in place of the scene's ``verdict_limit``."""
    stages: Annotated[Annotated[tuple[Name, ...], Field(min_length=1)] | None, Of("stage")] = None
    """Stages with the probe; without the key all stages."""

    def asked_in(self, stage: str) -> bool:
        """True if the probe is asked in a stage."""
        return self.stages is None or stage in self.stages

    @property
    def name(self) -> str:
        """The probe's name in tables and JSON."""
        return f"{self.of}.{self.quantity}"


class Claim(Record):
    """Statement of a publication on a probe: the relative difference stays below ``bound``.

    With a ``value`` the claim states the probe's value: ours then stays within ``bound`` of the value, a fraction of
    the value, or of the probe's scale if the value is zero.
    """

    probe: str
    """Name of a probe, ``NAME.QUANTITY``, or ``critical`` for the first critical value of a stage."""
    stage: Annotated[Name | None, Of("stage")] = None
    """Stage of the claim; without the key all stages."""
    station: Annotated[float, Measured(_of_stations)] | None = None
    """Station of the claim; without the key all stations with a value."""
    value: Annotated[float, Measured(_of_value)] | None = None
    """Stated value of the probe; without a value the claim compares both solvers."""
    bound: Positive
    """Largest relative difference."""
    text: Text = ""
    """Words of the source."""

    def speaks_of(self, stage: str, station: float) -> bool:
        """True if the claim concerns a station; stations are equal up to round-off."""
        return self.in_stage(stage) and (self.station is None or isclose(self.station, station, rel_tol=1e-9))

    def in_stage(self, stage: str) -> bool:
        """True if the claim concerns a stage."""
        return self.stage is None or self.stage == stage
