"""Units of the numbers in a scene file, and the scene in SI that they stand for.

=============  ====================================================================
a, b, c, d     powers of length, force, angle and stress in a number's unit
u              size of the file's unit over the SI's: 1/1000 of mm, π/180 of deg
=============  ====================================================================

A number x of the file is x·u_lengthᵃ·u_forceᵇ·u_angleᶜ·u_stressᵈ in SI, by its decimal digits and rounded once:
9.7 mm is 0.0097 m, as if that were written.
What else there is follows: moments are forces times lengths, distributed loads forces over lengths, energies likewise.
Only a file has units; a :class:`~cprbm_scene.statement.Scene` that was read is in SI, and so is every answer.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeVar

from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake, SceneError
from cprbm_scene.statement import (
    CRITICAL,
    Arc,
    Assembly,
    Beam,
    BeamForce,
    BeamMoment,
    CircleContact,
    Claim,
    DisplacementDrive,
    DistributedLoad,
    FixedBody,
    Force,
    FreeBody,
    FunctionContact,
    HalfPlaneContact,
    Line,
    LineContact,
    Material,
    Moment,
    Polynomial,
    Profile,
    Quantity,
    Record,
    Related,
    RotationDrive,
    Scene,
    SlidingBody,
    Spline,
    Stage,
    Stop,
    TurningBody,
    Units,
)

_SIZES: Mapping[str, Fraction] = frozendict(
    {
        "m": Fraction(1),
        "cm": Fraction(1, 100),
        "mm": Fraction(1, 1000),
        "um": Fraction(1, 10**6),
        "in": Fraction(254, 10**4),
        "N": Fraction(1),
        "kN": Fraction(1000),
        "mN": Fraction(1, 1000),
        "uN": Fraction(1, 10**6),
        "Pa": Fraction(1),
        "kPa": Fraction(10**3),
        "MPa": Fraction(10**6),
        "GPa": Fraction(10**9),
    }
)
_DEGREES = 180
"""In the angle of a straight line, whose size in rad no fraction is."""


@dataclass(frozen=True, slots=True)
class Dimension:
    """Powers in a number's unit."""

    length: int = 0
    force: int = 0
    angle: int = 0
    stress: int = 0

    def in_si(self, value: float, units: Units) -> float:
        """A number of a file in SI.

        Raises:
            OverflowError: it is larger than any number.
        """
        size = Fraction(1)
        for name, power in ((units.length, self.length), (units.force, self.force), (units.stress, self.stress)):
            size *= _SIZES[name] ** power
        turn = math.pi / _DEGREES if units.angle == "deg" and self.angle else 1.0
        return float(Fraction(repr(value)) * size) * turn


LENGTH, FORCE, ANGLE, STRESS = Dimension(length=1), Dimension(force=1), Dimension(angle=1), Dimension(stress=1)
MOMENT, LINE_LOAD = Dimension(length=1, force=1), Dimension(length=-1, force=1)

MEASURED: Mapping[type[Record], Mapping[str, Dimension]] = frozendict(
    {
        Material: {"youngs_modulus": STRESS},
        Line: {"start": LENGTH, "end": LENGTH},
        Arc: {"center": LENGTH, "start": LENGTH, "end": LENGTH},
        Polynomial: {"range": LENGTH},
        Spline: {"points": LENGTH},
        Profile: {"values": LENGTH},
        Beam: {"thickness": LENGTH, "width": LENGTH},
        FixedBody: {"points": LENGTH},
        FreeBody: {"points": LENGTH},
        SlidingBody: {"points": LENGTH},
        TurningBody: {"points": LENGTH},
        Stop: {"least": ANGLE, "most": ANGLE},
        Assembly: {"moments": MOMENT},
        Related: {"x": LENGTH, "y": LENGTH},
        CircleContact: {"center": LENGTH, "radius": LENGTH},
        LineContact: {"points": LENGTH},
        HalfPlaneContact: {"point": LENGTH},
        FunctionContact: {"range": LENGTH},
    }
)
"""Keys whose numbers have a unit, by the table that they stand in."""

FOLLOWING: Mapping[type[Record], frozenset[str]] = frozendict(
    {
        Polynomial: frozenset({"coefficients"}),
        FunctionContact: frozenset({"coefficients"}),
        Stage: frozenset({"stations", "shown", "critical_limit"}),
        Claim: frozenset({"station", "value"}),
    }
)
"""Keys whose numbers have the unit that something else says: their power, what is stepped, a probe."""

STEPPED: Mapping[type[Record], Dimension] = frozendict(
    {
        Moment: MOMENT,
        Force: FORCE,
        BeamForce: FORCE,
        BeamMoment: MOMENT,
        DistributedLoad: LINE_LOAD,
        DisplacementDrive: LENGTH,
        RotationDrive: ANGLE,
    }
)

QUANTITIES: Mapping[Quantity, Dimension] = frozendict(
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
"""Of all but the closing load, which is of what its stage steps."""

R = TypeVar("R", bound=Record)


def in_si(scene: Scene) -> Scene:
    """The scene in SI whose numbers are in the units that it states.

    Raises:
        SceneError: a claim may be of several kinds of numbers, or a number in SI is no number.
    """
    units = scene.units
    if units == Units():
        return scene
    try:
        stages = tuple(_stage(scene, stage) for stage in scene.stages)
        claims = tuple(_claim(scene, i, claim) for i, claim in enumerate(scene.claims))
        whole = _converted(scene, units)
    except OverflowError:
        raise SceneError(
            [Mistake("units", "a number that is too large in SI", "smaller numbers", scene.file)]
        ) from None
    return whole.model_copy(update={"stages": stages, "claims": claims, "units": Units()})


def _converted(record: R, units: Units) -> R:
    """A record in SI but for the numbers whose unit follows from others."""
    measured = MEASURED.get(type(record), {})
    found: dict[str, object] = {}
    for name in record.model_fields_set:  # what a file says, and not what it leaves out
        value = getattr(record, name)
        dimension = measured.get(name)
        found[name] = _walked(value, units) if dimension is None else _scaled(value, dimension, units)
    if isinstance(record, Polynomial | FunctionContact):
        # f is a length, and so is its variable
        found["coefficients"] = tuple(
            Dimension(length=1 - power).in_si(value, units) for power, value in enumerate(record.coefficients)
        )
    return record.model_copy(update=found)


def _walked(value: object, units: Units) -> object:
    """Whatever holds records, with these in SI."""
    if isinstance(value, Record):
        return _converted(value, units)
    if isinstance(value, Mapping):
        return frozendict({key: _walked(each, units) for key, each in value.items()})
    return tuple(_walked(each, units) for each in value) if isinstance(value, tuple) else value


def _scaled(value: object, dimension: Dimension, units: Units) -> object:
    """Whatever holds numbers of one dimension, in SI."""
    if isinstance(value, Record):  # a size that varies along a beam
        return _converted(value, units)
    if isinstance(value, Mapping):
        return frozendict({key: _scaled(each, dimension, units) for key, each in value.items()})
    if isinstance(value, tuple):
        return tuple(_scaled(each, dimension, units) for each in value)
    return dimension.in_si(value, units) if isinstance(value, float) else value


def _of_stage(scene: Scene, stage: Stage) -> Dimension | None:
    """Of a stage's stations; None where what it steps is not there, which is told elsewhere."""
    try:
        return STEPPED[type(scene.stepped(stage))]
    except KeyError:
        return None


def _stage(scene: Scene, stage: Stage) -> Stage:
    dimension = _of_stage(scene, stage)
    if dimension is None:
        return stage
    said = FOLLOWING[Stage] & stage.model_fields_set
    found = {name: _scaled(getattr(stage, name), dimension, scene.units) for name in said}
    return stage.model_copy(update=found)


def _claim(scene: Scene, number: int, claim: Claim) -> Claim:
    found: dict[str, object] = {}
    for key, dimensions in (("station", _stations(scene, claim)), ("value", _values(scene, claim))):
        several = set(dimensions)
        if getattr(claim, key) is None or not several:
            continue
        if len(several) > 1:
            several_kinds = "a number in the unit of several stages, which step different kinds"
            raise SceneError([Mistake(f"claims.{number}.{key}", several_kinds, "a stage beside it", scene.file)])
        found[key] = _scaled(getattr(claim, key), several.pop(), scene.units)
    return claim.model_copy(update=found)


def _stations(scene: Scene, claim: Claim) -> Iterator[Dimension]:
    """Of the stations that a claim may speak of."""
    found = (_of_stage(scene, stage) for stage in scene.stages if claim.in_stage(stage.name))
    return (each for each in found if each is not None)


def _values(scene: Scene, claim: Claim) -> Iterator[Dimension]:
    """Of the values that a claim may speak of."""
    if claim.probe == CRITICAL:
        yield from _stations(scene, claim)
    for probe in scene.probes:
        if probe.name == claim.probe and probe.quantity == "closing_load":
            yield from _stations(scene, claim)
        elif probe.name == claim.probe:
            yield QUANTITIES[probe.quantity]
