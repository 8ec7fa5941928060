"""Records of rigid bodies, pins between bodies, stops at pins, assembly, loads and drives."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isnan, nan
from typing import Annotated, ClassVar, Literal, cast

from pydantic import Field, create_model

from cprbm_scene.beam_records import PointName
from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake, broken, unknown_name
from cprbm_scene.units import (
    ANGLE,
    FORCE,
    LENGTH,
    LINE_LOAD,
    MOMENT,
    Angle,
    Direction,
    Measured,
    Name,
    Named,
    Of,
    Point,
    Record,
    Share,
    Unit,
)

SHORTEST_STRETCH = 1e-6
"""Least length of a distributed load, of the beam's length."""

Points = Annotated[Named[Point], Field(min_length=1)]
BodyName = Annotated[Name, Of("body")]
BeamName = Annotated[Name, Of("beam")]


class FixedBody(Record):
    """The ground: a rigid body at rest.

    A scene has a point at an edge of the body, or at the first beam, in place of no points.
    """

    motion: Literal["fixed"]
    points: Named[Point] = Field(default_factory=frozendict)
    """Points of the body by name, at their initial places."""


class FreeBody(Record):
    """Rigid body with two translations and a rotation."""

    motion: Literal["free"]
    points: Points
    """Points of the body by name, at their initial places."""


class SlidingBody(Record):
    """Rigid body on a frictionless guide of the ground, without rotation unless ``turns`` is true."""

    motion: Literal["slides"]
    along: Direction
    """Direction of the guide."""
    turns: bool = False
    """Rotation about the point ``about``: the body is a pin in a slot."""
    about: Name | None = None
    """Point of the body in the slot; a body with a single point needs no name."""
    points: Points
    """Points of the body by name, at their initial places."""

    @property
    def pin(self) -> Name | None:
        """The point in the slot, about which the body turns; None without ``turns``."""
        if not self.turns:
            return None
        return next(iter(self.points)) if self.about is None else self.about

    def rules(self) -> Iterator[Mistake]:
        """A pin without a point, of another body or without ``turns``."""
        return broken(
            _pivot(self.about, self.points),
            self.about in self.points
            and not self.turns
            and Mistake(
                "about",
                f"{self.about!r}, a point to turn about, of a body that does not turn",
                "turns = true, or no point",
            ),
            self.turns
            and self.about is None
            and len(self.points) > 1
            and Mistake(
                "about",
                "nothing: of the points of a body that slides and turns, one stays in the slot",
                f"one of {', '.join(map(repr, self.points))}",
            ),
        )


class TurningBody(Record):
    """Rigid body on a frictionless pivot of the ground."""

    motion: Literal["turns"]
    about: Name
    """Point of the body on the pivot."""
    points: Points
    """Points of the body by name, at their initial places."""

    def rules(self) -> Iterator[Mistake]:
        """A pivot outside the body's points."""
        return broken(_pivot(self.about, self.points))


def _pivot(about: Name | None, points: Mapping[Name, Point]) -> Mistake | bool:
    """The mistake of a pivot outside a body's points."""
    return about not in (None, *points) and unknown_name("about", str(about), "point of this body", points)


Body = Annotated[FixedBody | FreeBody | SlidingBody | TurningBody, Field(discriminator="motion")]


class BodyPin(Record):
    """Frictionless hinge between two bodies."""

    points: Annotated[tuple[Name, Name], Of("point")]
    """Two points at the same place, of two bodies."""


class Stop(Record):
    """Limits of the angle between a pinned beam and the body at the pin.

    The angle runs counter-clockwise from the line between the pin and ``towards``, another point of the same body, to
    the direction of the beam away from the pin.  As drawn the angle lies in (−π, π].  The angle is continuous and
    grows as the beam's ``end`` turns counter-clockwise against the body.  A reached limit holds by a moment, without
    friction.
    """

    beam: BeamName
    """Beam with a pinned end."""
    end: Literal["start", "end"]
    """Pinned end of the beam."""
    towards: PointName
    """Another point of the body at the pin."""
    least: Angle | None = None
    """Least angle."""
    most: Angle | None = None
    """Largest angle; a stop has at least one limit."""

    def rules(self) -> Iterator[Mistake]:
        """No limit, or limits in the wrong order."""
        least, most = (nan if limit is None else limit for limit in (self.least, self.most))
        return broken(
            isnan(least) and isnan(most) and Mistake("", "neither 'least' nor 'most'", "at least one of the two, rad"),
            least >= most
            and Mistake(
                "", f"least = {least:g} rad and most = {most:g} rad", "a least angle that is less than the most"
            ),
        )


class Assembly(Record):
    """Motion of pinned ends, drawn apart from their points, to the points before the first stage.

    Three parts, without other loads or drives: the moments grow while the ends are free; the ends move straight to
    their points; the moments decrease to zero.  The moments select an assembled state among several.  Contacts act
    throughout, stops as soon as the ends are at their points.
    """

    moments: Annotated[Named[Annotated[float, Measured(MOMENT)]], Of("beam")] = Field(default_factory=frozendict)
    """Moments on pinned ends by the names of beams, counter-clockwise."""


class Moment(Record):
    """Moment on a body, counter-clockwise."""

    unit: ClassVar[Unit] = MOMENT
    kind: Literal["moment"]
    body: BodyName
    """Body under the moment, counter-clockwise."""


class Force(Record):
    """Dead force at a point of a body."""

    unit: ClassVar[Unit] = FORCE
    kind: Literal["force"]
    point: PointName
    """Point of a body under the force."""
    direction: Direction
    """Direction, constant while the part turns."""


class BeamForce(Record):
    """Dead force at a place of a beam."""

    unit: ClassVar[Unit] = FORCE
    kind: Literal["beam_force"]
    beam: BeamName
    """Beam under the load."""
    at: Share
    """Place, a fraction of the beam's arc length."""
    direction: Direction
    """Direction, constant while the part turns."""


class BeamMoment(Record):
    """Moment at a place of a beam, counter-clockwise."""

    unit: ClassVar[Unit] = MOMENT
    kind: Literal["beam_moment"]
    beam: BeamName
    """Beam under the load."""
    at: Share
    """Place, a fraction of the beam's arc length."""


class DistributedLoad(Record):
    """Dead load per length of a beam, constant along a part: a weight, not a pressure."""

    unit: ClassVar[Unit] = LINE_LOAD
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

    unit: ClassVar[Unit] = LENGTH
    kind: Literal["displacement"]
    point: PointName
    """Driven point of a body."""
    direction: Direction
    """Direction of the prescribed displacement; the point is free across it."""


class RotationDrive(_Drive):
    """Prescribed rotation of a body, counter-clockwise."""

    unit: ClassVar[Unit] = ANGLE
    kind: Literal["rotation"]
    body: BodyName
    """Body with a prescribed rotation, counter-clockwise."""


Drive = Annotated[DisplacementDrive | RotationDrive, Field(discriminator="kind")]
