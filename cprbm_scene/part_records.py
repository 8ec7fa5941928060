"""Records of the parts: materials, rigid bodies with pins and stops, beams with ends and sizes.

Bounds are on dimensionless numbers, with thickness t, arc length L and curvature κ:

* 1e-5 ≤ t/L ≤ 0.2: a thicker beam has no beam theory, a thinner beam's EI/L³ is lost in round-off;
* t κ/2 < 0.5: the inner edge keeps at least half of the neutral line's length; for a varying t, at every place;
* values of a size within a factor of 1e5, at places at least 1e-6 of the length apart.
"""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Annotated, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag

from cprbm_scene.curve_records import (
    MOST_HALF_WAVES,
    MOST_POINTS,
    SHORTEST,
    CurveField,
    NeutralLine,
    shape_of,
    with_half_waves,
)
from cprbm_scene.curves import SAMPLES, Array
from cprbm_scene.fields import (
    Direction,
    Length,
    Measured,
    Name,
    Named,
    Number,
    Of,
    OptionalNamed,
    Point,
    PositiveLength,
    Record,
)
from cprbm_scene.mistakes import Mistake, broken, first_broken, refuse_broken, unknown_name, written_place
from cprbm_scene.units import NUMBER, STRESS

THINNEST, THICKEST = 1e-5, 0.2
MOST_CURVED = 0.5
LARGEST_RATIO = 1e5
BACKWARDS = 1e-9
"""Component of a unit tangent that counts as zero."""
LEAST_EXTENT = 1e-3
"""Extent of a beam along an axis, of the length, below which the beam does not run along the axis."""


class Material(Record):
    """Linear elastic, isotropic material."""

    youngs_modulus: Annotated[float, Field(gt=0.0), Measured(STRESS)]
    """Young's modulus."""
    poisson_ratio: Annotated[float, Field(gt=-1.0, le=0.5), Measured(NUMBER)]
    """Poisson's ratio."""


PointName = Annotated[Name, Of("point")]
BodyName = Annotated[Name, Of("body")]
BeamName = Annotated[Name, Of("beam")]


Points = Annotated[Named[Point], Field(min_length=1)]


class FixedBody(Record):
    """The ground: a rigid body at rest.

    A scene has a point at an edge of the body, or at the first beam, in place of no points.
    """

    motion: Literal["fixed"]
    points: OptionalNamed[Point]
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
        return (self.about or next(iter(self.points))) if self.turns else None

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


class WeldedEnd(Record):
    """End of a beam that moves and turns with a body."""

    joint: Literal["weld"]
    point: PointName
    """Point of a body; the end lies on the point."""


class PinnedEnd(Record):
    """End of a beam at a body's point, free to turn about the point."""

    joint: Literal["pin"]
    point: PointName
    """Point of a body; the end lies on the point, or is brought there by an assembly."""


class FreeEnd(Record):
    """End of a beam without a joint.

    A scene has a free body of this point, welded to the end, in place of a named free end.
    """

    joint: Literal["free"]
    point: Name | None = None
    """New name of the end, for probes, loads and drives."""


BeamEnd = Annotated[WeldedEnd | PinnedEnd | FreeEnd, Field(discriminator="joint")]


class Profile(Record):
    """Thickness or width that varies along the beam."""

    at: Annotated[tuple[Number, ...], Field(min_length=2)]
    """Fractions of the arc length, ascending from 0 to 1."""
    values: Annotated[tuple[PositiveLength, ...], Field(min_length=2)]
    """Sizes at the fractions; straight lines connect them."""

    def rules(self) -> Iterator[Mistake]:
        """Places without ascent from 0 to 1, or more or fewer than the values; jumps of the size."""
        at, values = self.at, self.values
        return first_broken(
            len(at) != len(values)
            and Mistake("values", f"{len(values)} values at {len(at)} places", "as many values as places in at"),
            len(at) > MOST_POINTS and Mistake("at", f"{len(at)} places", f"at most {MOST_POINTS} of them"),
            (at[0], at[-1]) != (0.0, 1.0)
            and Mistake(
                "at",
                f"places from {at[0]:.9g} to {at[-1]:.9g}",
                "fractions of the beam's length that begin with 0 and end with 1",
            ),
            not max(values) / LARGEST_RATIO <= min(values)
            and Mistake(
                "values",
                f"values from {min(values):g} m to {max(values):g} m",
                f"values of which the largest is at most {LARGEST_RATIO:g} times the least",
            ),
            *(
                not place - before >= SHORTEST
                and Mistake(
                    f"at[{i}]",
                    f"{place:.9g} after {before:.9g}",
                    f"places that ascend, each at least {SHORTEST:g} after the one before",
                )
                for i, (before, place) in enumerate(pairwise(at), start=1)
            ),
        )


Size = Annotated[
    Annotated[PositiveLength, Tag("number")] | Annotated[Profile, Tag("profile")],
    Discriminator(lambda value: "profile" if isinstance(value, Mapping | Profile) else "number"),
]


class PaperBeam(Record):
    """Elements of a beam in the formulation ``paper``, even along an axis instead of the arc length."""

    uniform: Literal["x", "y"]
    """Axis with even steps of the elements."""


class Imperfection(Record):
    """Offset of a beam's neutral line along the left normal, a sine of the arc length, zero at both ends."""

    amplitude: Length
    """Largest offset, to the left of the beam if positive."""
    half_waves: Annotated[int, Field(ge=1, le=MOST_HALF_WAVES)] = 1
    """Number of half waves."""


class Beam(Record):
    """Slender beam of rectangular section, free of stress in the shape of the ``curve``.

    An ``imperfection`` becomes a part of the curve: the beam then has the curve with the offset, as a spline.
    """

    curve: CurveField
    """Neutral line without stress."""
    thickness: Size
    """Size of the section in the plane of motion."""
    width: Size
    """Size of the section across the plane of motion."""
    material: Annotated[Name, Of("material")]
    """Material of the beam."""
    start: BeamEnd
    """Joint at the start of the curve."""
    end: BeamEnd
    """Joint at the end of the curve."""
    paper: PaperBeam | None = None
    """Data for the formulation ``paper``."""
    imperfection: Imperfection | None = None
    """Offset of the neutral line, without stress."""

    def completed(self) -> Mapping[str, object]:
        """The curve with the offset of the imperfection.

        Raises:
            SceneError: the offset leaves no smooth curve.
        """
        if self.imperfection is None:
            return {}
        curve = with_half_waves(self.curve, self.imperfection.amplitude, self.imperfection.half_waves)
        refuse_broken(*(each._replace(key=f"curve.{each.key}".rstrip(".")) for each in curve.rules()))
        return {"curve": curve, "imperfection": None}

    @property
    def ends(self) -> tuple[tuple[str, BeamEnd, Point], tuple[str, BeamEnd, Point]]:
        """Side, joint and initial place of the start and of the end."""
        return ("start", self.start, self.curve.start), ("end", self.end, self.curve.end)

    def thickness_at(self, u: Array) -> Array:
        """Thickness at fractions ``u`` of the arc length, m, in the same shape."""
        return np.asarray(np.interp(u, *_table(self.thickness)))

    def width_at(self, u: Array) -> Array:
        """Width at fractions ``u`` of the arc length, m, in the same shape."""
        return np.asarray(np.interp(u, *_table(self.width)))

    @property
    def knots(self) -> Array:
        """Fractions (k,) between which thickness and width are linear, from 0 to 1."""
        return np.union1d(_table(self.thickness)[0], _table(self.width)[0])

    @property
    def thinnest(self) -> float:
        """The least thickness, m."""
        return min(_table(self.thickness)[1])

    @property
    def thickest(self) -> float:
        """The largest thickness, m."""
        return max(_table(self.thickness)[1])

    @property
    def tapered(self) -> bool:
        """True if the thickness varies along the beam."""
        return self.thinnest < self.thickest

    def rules(self) -> Iterator[Mistake]:
        """Thickness out of proportion to the length or the curvature; elements along an axis with reversals."""
        length = shape_of(self.curve).length
        yield from broken(
            self.paper is not None
            and not _runs_along(self.curve, "xy".index(self.paper.uniform))
            and Mistake(
                "paper.uniform",
                f"{self.paper.uniform!r}, along which the curve turns back or does not run",
                "an axis along which the curve runs one way",
            )
        )
        yield from first_broken(
            *(
                not THINNEST <= size / length <= THICKEST
                and Mistake(
                    "thickness",
                    f"{size:g} m, which is {size / length:.3g} of the beam's length{mix_up(size / length)}",
                    f"a thickness between {THINNEST:g} and {THICKEST:g} of the beam's length",
                )
                for size in (self.thinnest, self.thickest)
            ),
            _too_curved(self),
        )


def _runs_along(curve: NeutralLine, axis: int) -> bool:
    """True if a curve has an extent along an axis, without reversals."""
    shape, extent = shape_of(curve), curve.end[axis] - curve.start[axis]
    forwards = np.sign(extent) * shape.tangent(np.linspace(0.0, 1.0, SAMPLES))[:, axis]
    return abs(extent) >= LEAST_EXTENT * shape.length and bool(np.all(forwards >= -BACKWARDS))


def _too_curved(beam: Beam) -> Mistake | bool:
    """The mistake of a thickness beside the radius of curvature; a bound on the largest curvature comes first."""
    shape = shape_of(beam.curve)
    u = np.union1d(np.linspace(0.0, 1.0, SAMPLES), beam.knots)
    bound = 0.5 * beam.thickest * shape.largest_curvature
    shares = 0.5 * beam.thickness_at(u) * shape.curvature(u) if bound >= MOST_CURVED else np.zeros(1)
    worst, share = u[[shares.argmax()]], float(shares.max()) if beam.tapered else bound
    return share >= MOST_CURVED and Mistake(
        "thickness",
        f"{float(beam.thickness_at(worst)[0]):g} m, half of which is {share:.3g} of the radius of curvature at "
        f"{float(worst[0]):.3g} of the length, near {written_place(shape.point(worst)[0])} m{mix_up(share)}",
        f"half a thickness less than {MOST_CURVED:g} of the radius of curvature",
    )


def mix_up(share: float) -> str:
    """A question about the unit of a thickness, for a ``share`` that a unit 1000 times smaller would make ordinary."""
    return " (in mm in place of m, or in um in place of mm?)" if 2.0 <= share <= 1e3 * THICKEST else ""


def _table(size: float | Profile) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Fractions of the arc length and values of a size."""
    return (size.at, size.values) if isinstance(size, Profile) else ((0.0, 1.0), (size, size))
