"""Records of stops and contacts: two beams, a beam with itself, a beam with a rigid shape; distances from rigid shapes.

A place is behind a rigid line if the nearest place of the line is no end of the line and the place lies opposite to the
line's normal towards the free side.
"""

from collections.abc import Iterator
from itertools import pairwise
from math import dist, isnan, nan
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from cprbm_scene.curve_records import MOST_POINTS, Ellipse, Graph, Polynomial, SmoothLine, shape_of
from cprbm_scene.curves import Array, Curve, unit_vector
from cprbm_scene.fields import Angle, Direction, Length, Name, Of, OptionalNamed, Point, PositiveLength, Record
from cprbm_scene.mistakes import Mistake, broken, first_alone
from cprbm_scene.part_records import BeamName, BodyName, PointName

BACKWARDS = 1e-3
"""1 + cos of the angle between two pieces of a line, below which the line turns back on itself: 2.6 degrees."""


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


class Related(Record):
    """Joints of a beam with possible contact, by their initial places."""

    x: tuple[Length, Length] | None = None
    """Range of the initial x of joints."""
    y: tuple[Length, Length] | None = None
    """Range of the initial y of joints; a table has one of the two."""

    def rules(self) -> Iterator[Mistake]:
        """Ranges of both coordinates or of none, and descending ranges."""
        ranges = {axis: span for axis, span in (("x", self.x), ("y", self.y)) if span is not None}
        return broken(
            len(ranges) != 1
            and Mistake("", "both x and y" if ranges else "neither x nor y", "a range in exactly one of x and y"),
            *(
                low >= high and Mistake(axis, str([low, high]), "a range from the smaller to the larger value")
                for axis, (low, high) in ranges.items()
            ),
        )


class PaperRigid(Record):
    """Joints of a beam outside the rigid shape, for the formulation ``paper``."""

    related: OptionalNamed[Related]
    """Joints with possible contact, by the names of beams; without an entry all joints."""


class PaperContact(PaperRigid):
    """Boundary function g_s of two beams, for the formulation ``paper``.

    The gap is g_s(x) − y along the axis ``y`` and g_s(y) − x along the axis ``x``.
    """

    boundary: Name
    """Beam of the fitted boundary function."""
    axis: Literal["x", "y"] = "y"
    """Axis of the gap."""


class BeamContact(Record):
    """Contact of two beams."""

    kind: Literal["beam-beam"]
    between: Annotated[tuple[Name, Name], Of("beam")]
    """The two beams; places are measured along the first beam."""
    thick: bool = True
    """Contact of edges, half of the thickness from the neutral line; otherwise of neutral lines."""
    paper: PaperContact | None = None
    """Data for the formulation ``paper``."""

    @property
    def beams(self) -> tuple[str, ...]:
        """Names of the beams; places are measured along the first beam."""
        return self.between

    def rules(self) -> Iterator[Mistake]:
        """A pair of the same beam twice."""
        return broken(
            len(set(self.between)) == 1
            and Mistake(
                "between",
                f"{self.between[0]!r} twice",
                "two different beams; a beam may touch itself in a contact of kind 'beam-self'",
            )
        )


class _OneBeam(Record):
    """Contact of a single beam."""

    beam: BeamName
    """The beam of the contact."""
    thick: bool = True
    """Contact of edges, half of the thickness from the neutral line; otherwise of neutral lines."""

    @property
    def beams(self) -> tuple[str, ...]:
        """Name of the beam."""
        return (self.beam,)


class SelfContact(_OneBeam):
    """Contact of a beam with itself, after enough rotation; the touching side follows from the motion."""

    kind: Literal["beam-self"]
    paper: ClassVar[None] = None  # the formulation has no form for self-contact


class RigidContact(_OneBeam):
    """Fields of all contacts of a beam with a rigid shape on a body, stated at the initial place."""

    body: BodyName
    """Body of the rigid shape."""
    paper: PaperRigid | None = None
    """Data for the formulation ``paper``."""


class CircleContact(RigidContact):
    """Contact of a beam with a rigid circle, from outside or inside."""

    kind: Literal["beam-circle"]
    center: Point
    """Center at the initial place."""
    radius: PositiveLength
    """Radius of the circle."""
    side: Literal["outside", "inside"] = "outside"
    """Side of the beam."""


class LineContact(RigidContact):
    """Contact of a beam with a rigid line of straight pieces.

    The solid lies behind the line and ends at right angles to the first and the last piece.  A line is closed, without
    ends, if the last point equals the first.
    """

    kind: Literal["beam-line"]
    points: Annotated[tuple[Point, ...], Field(min_length=2)]
    """Corners of the line, at most 1001."""
    side: Literal["left", "right"]
    """Free side, seen along the points."""

    @property
    def closed(self) -> bool:
        """True if the last point is the first."""
        return len(self.points) > 2 and self.points[0] == self.points[-1]

    @first_alone
    def rules(self) -> Iterator[Mistake]:
        """Too many points, repeated points, lines with reversals or crossings."""
        import shapely  # scenes without rigid lines need no Shapely

        pieces = list(pairwise(self.points))
        yield from broken(
            len(self.points) > MOST_POINTS
            and Mistake("points", f"{len(self.points)} points", f"at most {MOST_POINTS} of them"),
            *(
                a == b and Mistake(f"points[{i}]", "a point 0 m from the one before", "two different points")
                for i, (a, b) in enumerate(pieces, start=1)
            ),
        )
        tau = [unit_vector((b[0] - a[0], b[1] - a[1])) for a, b in pieces]
        yield from broken(
            *(
                1.0 + a @ b < BACKWARDS
                and Mistake(f"points[{i}]", "a point at which the line turns back on itself", "a line that goes on")
                for i, (a, b) in enumerate(pairwise([*tau, tau[0]] if self.closed else tau), start=1)
            )
        )
        lines = shapely.linestrings(pieces)
        first, second = shapely.STRtree(lines).query(lines, predicate="intersects").tolist()
        yield from (
            Mistake(
                "points",
                f"a piece from point {j} to {j + 1} that meets the one from {i} to {i + 1}",
                "a line that does not meet itself",
            )
            for i, j in sorted(zip(first, second, strict=True))
            if i + 1 < j and not (self.closed and j - i == len(pieces) - 1)
        )


class HalfPlaneContact(RigidContact):
    """Contact of a beam with a rigid half-plane."""

    kind: Literal["beam-half-plane"]
    point: Point
    """A point of the edge."""
    normal: Direction
    """Normal of the edge, towards the free side."""


class FunctionContact(RigidContact, Graph):
    """Contact of a beam with the graph of a polynomial f.

    As with a :class:`LineContact`, the solid lies behind the edge and ends at the edge's ends.
    """

    kind: Literal["beam-function"]
    side: Literal["above", "below"]
    """Free side: at a coordinate above or below f."""

    @property
    def curve(self) -> Polynomial:
        """The edge as a neutral line."""
        return Polynomial(kind="polynomial", axis=self.axis, coefficients=self.coefficients, range=self.range)


class SplineContact(RigidContact, SmoothLine):
    """Contact of a beam with a rigid edge along a spline.

    As with a :class:`LineContact`, the solid lies behind the edge and ends at the edge's ends.
    """

    kind: Literal["beam-spline"]
    side: Literal["left", "right"]
    """Free side, seen along the points."""


class EllipseContact(RigidContact, Ellipse):
    """Contact of a beam with a rigid ellipse, from outside or inside."""

    kind: Literal["beam-ellipse"]
    side: Literal["outside", "inside"] = "outside"
    """Side of the beam."""


EdgeContact = LineContact | HalfPlaneContact | FunctionContact
"""Contacts with edges on which a beam may lie up to its own pin; the edge then holds the pin like a stop."""

Rigid = CircleContact | EdgeContact | SplineContact | EllipseContact


def measures(contact: Rigid) -> tuple[tuple[Point, ...], list[tuple[str, float]]]:
    """Places of a rigid shape, the first on the shape or at its center, and sizes by their keys, m."""
    match contact:
        case CircleContact(center=center, radius=radius):
            return (center,), [("radius", radius)]
        case EllipseContact(center=center):
            shape = shape_of(contact)
            return (center, (shape.origin[0], shape.origin[1])), [("semi_axes", shape.length)]
        case LineContact(points=points):
            return points, [(f"points[{i}]", dist(*ends)) for i, ends in enumerate(pairwise(points), start=1)]
        case FunctionContact() | SplineContact():
            key = "range" if isinstance(contact, FunctionContact) else "points"
            return (contact.start, contact.end), [(key, shape_of(contact).length)]
        case HalfPlaneContact(point=point):
            return (point,), []


_ON_EDGE = 257
"""Samples of a curve, from the nearest of which Newton's method starts."""
_STEPS = 20


def distance(contact: Rigid, p: Array) -> Array:
    """The distances D (k,), m, of places ``p`` (k, 2), m, from a rigid shape."""
    sign = 1.0 if getattr(contact, "side", "") in ("outside", "left", "above") else -1.0
    match contact:
        case CircleContact():
            return np.asarray(sign * (np.hypot(*(p - np.array(contact.center)).T) - contact.radius))
        case LineContact():
            return _from_line(np.array(contact.points), sign, p, closed=contact.closed)
        case HalfPlaneContact():
            return np.asarray((p - np.array(contact.point)) @ unit_vector(contact.normal))
        case FunctionContact():
            sign *= 1.0 if (contact.range[0] < contact.range[1]) == (contact.axis == "x") else -1.0
        case EllipseContact():
            sign = -sign  # the curve runs counter-clockwise, with the inside on the left
    return _from_curve(shape_of(contact), sign, p, closed=isinstance(contact, EllipseContact))


def _from_line(points: Array, sign: float, p: Array, *, closed: bool) -> Array:
    along = np.diff(points, axis=0)
    length = np.hypot(*along.T)
    tau = along / length[:, None]
    r = p[:, None, :] - points[None, :-1]
    t = np.clip((r * tau).sum(axis=2), 0.0, length)
    away = r - t[:, :, None] * tau
    nearest, every = np.hypot(away[:, :, 0], away[:, :, 1]).argmin(axis=1), np.arange(len(p))
    away, t = away[every, nearest], t[every, nearest]
    # at a corner the directions of both pieces decide the side; no place is behind an end of an open line
    around = np.vstack((tau[-1:], tau, tau[:1])) if closed else np.pad(tau, ((1, 1), (0, 0)), constant_values=np.nan)
    towards = tau[nearest] + around[nearest + 1 + (t >= length[nearest]) - (t <= 0.0)]
    behind = sign * (towards[:, 0] * away[:, 1] - towards[:, 1] * away[:, 0]) < 0.0
    return np.asarray(np.where(behind, -1.0, 1.0) * np.hypot(*away.T))


def _from_curve(curve: Curve, sign: float, p: Array, *, closed: bool) -> Array:
    samples = curve.samples[:: max(1, len(curve.samples) // _ON_EDGE)]
    samples = samples if closed else np.append(samples, 1.0)
    places = curve.place(samples)
    w = samples[((places[:, 0] - p[:, :1]) ** 2 + (places[:, 1] - p[:, 1:]) ** 2).argmin(axis=1)]
    for _ in range(_STEPS):
        away, along = curve.place(w) - p, curve.derivative(w, 1)
        slope, bent = (away * along).sum(axis=1), (along**2 + away * curve.derivative(w, 2)).sum(axis=1)
        # beyond the centre of curvature the distance has a maximum: the sample stays
        w = w - np.where(bent > 0.0, slope / np.where(bent > 0.0, bent, 1.0), 0.0)
        w = w % 1.0 if closed else np.clip(w, 0.0, 1.0)
    away, along = p - curve.place(w), curve.derivative(w, 1)
    slope, side = (away * along).sum(axis=1), sign * (along[:, 0] * away[:, 1] - along[:, 1] * away[:, 0])
    beyond = ((w <= 0.0) & (slope < 0.0)) | ((w >= 1.0) & (slope > 0.0))
    return np.asarray(np.where((beyond & (not closed)) | (side >= 0.0), 1.0, -1.0) * np.hypot(*away.T))


Contact = Annotated[
    BeamContact | SelfContact | Rigid,
    Field(discriminator="kind"),
]
