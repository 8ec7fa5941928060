"""Records of contacts: two beams, a beam with itself, a beam with a rigid circle or edge."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, combinations, islice, pairwise
from math import cos, dist, sin
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from cprbm_scene.curve_records import MOST_POINTS, Polynomial, Spline, SplinePoints, graph_rules, shape_of
from cprbm_scene.curves import unit_vector
from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake, broken
from cprbm_scene.units import (
    Angle,
    Coefficients,
    Direction,
    Length,
    Name,
    Named,
    Of,
    Point,
    PositiveLength,
    Record,
)

BACKWARDS = 1e-3
"""1 + cos of the angle between two pieces of a line, below which the line turns back on itself: 2.6 degrees."""


class Related(Record):
    """Joints of a beam with possible contact: a range of the initial ``x`` or ``y`` (not both), m."""

    x: tuple[Length, Length] | None = None
    y: tuple[Length, Length] | None = None

    def rules(self) -> Iterator[Mistake]:
        """Ranges of both coordinates or of none, and descending ranges."""
        ranges = {axis: span for axis, span in (("x", self.x), ("y", self.y)) if span is not None}
        found = "both x and y" if ranges else "neither x nor y"
        return broken(
            len(ranges) != 1 and Mistake("", found, "a range in exactly one of x and y"),
            *(
                low >= high and Mistake(axis, str([low, high]), "a range from the smaller to the larger value")
                for axis, (low, high) in ranges.items()
            ),
        )


class PaperRigid(Record):
    """Joints of the beam outside the rigid shape in the formulation ``paper``; without an entry all joints."""

    related: Named[Related] = Field(default_factory=frozendict)

    def of_others(self, beams: tuple[str, ...], allowed: str) -> Iterator[Mistake]:
        """Entries for beams outside the contact."""
        return broken(
            *(
                beam not in beams and Mistake(f"paper.related.{beam}", f"the beam {beam!r}", allowed)
                for beam in self.related
            )
        )


class PaperContact(PaperRigid):
    """Data for the formulation ``paper``: beam and axis of the boundary function, related joints.

    ``boundary`` names the beam of the function g_s; ``axis`` is the axis of the gap: ``y`` for g_s(x) − y,
    ``x`` for g_s(y) − x.  Without an entry in ``related`` all joints of a beam are related.
    """

    boundary: Name
    axis: Literal["x", "y"] = "y"


class BeamContact(Record):
    """Frictionless contact of two beams; ``thick`` beams touch by their edges, other beams as lines."""

    kind: Literal["beam-beam"]
    between: Annotated[tuple[Name, Name], Of("beam")]
    thick: bool = True
    paper: PaperContact | None = None

    @property
    def beams(self) -> tuple[str, ...]:
        """Names of the beams; places are measured along the first beam."""
        return self.between

    def rules(self) -> Iterator[Mistake]:
        """A pair of the same beam twice, and data for ``paper`` of other beams."""
        (one, other), paper = self.between, self.paper
        allowed = f"one of the pair: {one!r}, {other!r}"
        different = "two different beams; a beam may touch itself in a contact of kind 'beam-self'"
        return broken(
            one == other and Mistake("between", f"{one!r} twice", different),
            paper is not None
            and paper.boundary not in self.between
            and Mistake("paper.boundary", repr(paper.boundary), allowed),
            *(paper.of_others(self.between, allowed) if paper is not None else ()),
        )


class _OneBeam(Record):
    """Contact of one beam, with the beam's edge if ``thick``."""

    beam: Annotated[Name, Of("beam")]
    thick: bool = True

    @property
    def beams(self) -> tuple[str, ...]:
        """Name of the beam."""
        return (self.beam,)


class SelfContact(_OneBeam):
    """Frictionless contact of a beam with itself, after enough rotation.

    A ``thick`` beam touches by the edges, half of the local thickness from the neutral line; another beam as a line.
    The touching side of the beam follows from the motion.
    """

    kind: Literal["beam-self"]
    paper: ClassVar[None] = None  # the formulation has no form for self-contact


class RigidContact(_OneBeam):
    """Fields of all contacts of a beam with a rigid shape, without friction.

    The shape is fixed to ``body`` and stated at the initial place, m.  A ``thick`` beam touches by the edge, half of
    the local thickness from the neutral line; another beam as a line.
    """

    body: Annotated[Name, Of("body")]
    paper: PaperRigid | None = None

    def rules(self) -> Iterator[Mistake]:
        """Data for ``paper`` of other beams, and shapes without geometry."""
        paper = () if self.paper is None else self.paper.of_others(self.beams, f"the contact's beam {self.beam!r}")
        return chain(paper, islice(self.shape_rules(), 1))

    def shape_rules(self) -> Iterator[Mistake]:
        """Mistakes of the shape, only the first of them valid; none by default."""
        return iter(())


class CircleContact(RigidContact):
    """Contact of a beam with a rigid circle of ``radius`` about ``center``, from outside or inside (``side``)."""

    kind: Literal["beam-circle"]
    center: Point
    radius: PositiveLength
    side: Literal["outside", "inside"] = "outside"


class LineContact(RigidContact):
    """Contact of a beam with a rigid line of straight pieces between ``points``.

    The beam lies on the free ``side``, seen along the points.  The solid lies behind the line and ends at right angles
    to the first and the last piece.  A line is closed, without ends, if the last point equals the first.
    """

    kind: Literal["beam-line"]
    points: Annotated[tuple[Point, ...], Field(min_length=2)]
    side: Literal["left", "right"]

    @property
    def closed(self) -> bool:
        """True if the last point is the first."""
        return len(self.points) > 2 and self.points[0] == self.points[-1]

    def shape_rules(self) -> Iterator[Mistake]:
        """Too many points, repeated points, lines with reversals or crossings."""
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
        corners = enumerate(pairwise([*tau, tau[0]] if self.closed else tau), start=1)
        back = "a point at which the line turns back on itself"
        yield from broken(
            *(1.0 + a @ b < BACKWARDS and Mistake(f"points[{i}]", back, "a line that goes on") for i, (a, b) in corners)
        )
        for (i, first), (j, second) in combinations(enumerate(pieces), 2):
            neighbours = j - i in ((1, len(pieces) - 1) if self.closed else (1,))
            if not neighbours and _crosses(first, second) and _crosses(second, first):
                found = f"a piece from point {j} to {j + 1} that meets the one from {i} to {i + 1}"
                yield Mistake("points", found, "a line that does not meet itself")


def _crosses(piece: tuple[Point, Point], other: tuple[Point, Point]) -> bool:
    """True if the ends of ``other`` lie on different sides of the line of ``piece``, or on the line."""
    (ax, ay), (bx, by) = piece
    one, two = ((bx - ax) * (y - ay) - (by - ay) * (x - ax) for x, y in other)
    return one * two <= 0.0


class HalfPlaneContact(RigidContact):
    """Contact of a beam with a rigid half-plane with a straight edge through ``point``.

    ``normal`` points away from the half-plane, towards the beam; the solver makes the normal a unit vector.
    """

    kind: Literal["beam-half-plane"]
    point: Point
    normal: Direction


class FunctionContact(RigidContact):
    """Contact of a beam with a rigid edge y = f(x) (``axis`` is ``x``) or x = f(y) (``axis`` is ``y``).

    ``coefficients`` of f, lowest power first, f in metres for a variable in metres within ``range``.  The beam lies
    ``above`` the edge, at a coordinate larger than f, or ``below``.  As with a :class:`LineContact`, the solid lies
    behind the edge and ends at the edge's ends.
    """

    kind: Literal["beam-function"]
    axis: Literal["x", "y"]
    coefficients: Coefficients
    range: tuple[Length, Length]
    side: Literal["above", "below"]

    @property
    def curve(self) -> Polynomial:
        """The edge as a curve."""
        return Polynomial(kind="polynomial", axis=self.axis, coefficients=self.coefficients, range=self.range)

    def shape_rules(self) -> Iterator[Mistake]:
        """Coefficients and ranges without a graph of finite slope."""
        return graph_rules(self.curve)


class SplineContact(RigidContact):
    """Contact of a beam with a rigid edge along a :class:`Spline` through ``points``, on the free ``side``.

    ``start_direction`` and ``end_direction`` are those of the spline.  As with a :class:`LineContact`, the solid lies
    behind the edge and ends at the edge's ends.
    """

    kind: Literal["beam-spline"]
    points: SplinePoints
    start_direction: Direction | None = None
    end_direction: Direction | None = None
    side: Literal["left", "right"]

    @property
    def curve(self) -> Spline:
        """The edge as a curve."""
        ends = {"start_direction": self.start_direction, "end_direction": self.end_direction}
        return Spline(kind="spline", points=self.points, **ends)

    def shape_rules(self) -> Iterator[Mistake]:
        """Mistakes of the spline."""
        return self.curve.rules()


class EllipseContact(RigidContact):
    """Contact of a beam with a rigid ellipse about ``center``, from outside or inside (``side``).

    ``semi_axes`` a and b, m; ``angle`` of the first axis, counter-clockwise from x.
    """

    kind: Literal["beam-ellipse"]
    center: Point
    semi_axes: tuple[PositiveLength, PositiveLength]
    angle: Angle = 0.0
    side: Literal["outside", "inside"] = "outside"

    @property
    def curve(self) -> Spline:
        """The edge as a closed curve, counter-clockwise, within a·(2π/512)⁴/384 = 6e-11 a of the ellipse."""
        turn, c, s = np.linspace(0.0, 2.0 * np.pi, 513), cos(self.angle), sin(self.angle)
        x, y = self.semi_axes[0] * np.cos(turn), self.semi_axes[1] * np.sin(turn)
        places = np.array(self.center) + np.column_stack((x * c - y * s, x * s + y * c))
        points = tuple((x, y) for x, y in places.tolist())
        return Spline(kind="spline", points=points, start_direction=(-s, c), end_direction=(-s, c))


def measures(contact: RigidContact) -> tuple[tuple[Point, ...], list[tuple[str, float]]]:
    """Places of a rigid shape, the first on the shape or at its center, and sizes by their keys, m."""
    match contact:
        case CircleContact(center=center, radius=radius):
            return (center,), [("radius", radius)]
        case EllipseContact(center=center, curve=curve):
            return (center, curve.start), [("semi_axes", shape_of(curve).length)]
        case LineContact(points=points):
            return points, [(f"points[{i}]", dist(*ends)) for i, ends in enumerate(pairwise(points), start=1)]
        case FunctionContact(curve=curve) | SplineContact(curve=curve):
            part = "range" if isinstance(contact, FunctionContact) else "points"
            return (curve.start, curve.end), [(part, shape_of(curve).length)]
        case HalfPlaneContact(point=point):
            return (point,), []
    raise TypeError(type(contact))


EdgeContact = LineContact | HalfPlaneContact | FunctionContact
"""Contacts with edges on which a beam may lie up to its own pin; the edge then holds the pin like a stop."""


Contact = Annotated[
    BeamContact | SelfContact | CircleContact | EdgeContact | SplineContact | EllipseContact,
    Field(discriminator="kind"),
]
