"""Records of neutral lines, and of graphs as rigid edges.

Bounds are on dimensionless numbers:

* length ≥ 1e-6 of the largest coordinate, and of a polynomial's largest term: a shorter curve has lost six digits;
* |f'| ≤ 1e3 and degree ≤ 20 of a polynomial f: a steeper graph is a function of the other coordinate;
* at most 1001 points of a spline, at least 1e-6 of the sum of their distances apart, and a speed of at least 0.1 with
  respect to the distance: at a lower speed the spline has a cusp.
"""

from collections.abc import Iterator
from functools import lru_cache, reduce
from itertools import accumulate, pairwise, repeat
from math import cos, dist, inf, sin
from typing import Annotated, Literal, cast

import numpy as np
from pydantic import BeforeValidator, Field, ValidationInfo

from cprbm_scene.curves import Curve, circular_arc, graph, spline, straight_line
from cprbm_scene.fields import (
    Angle,
    Coefficients,
    Direction,
    Length,
    Point,
    PositiveLength,
    Reading,
    Record,
)
from cprbm_scene.mistakes import Mistake, broken, first_alone, written_place
from cprbm_scene.units import read_points

SHORTEST = 1e-6
STEEPEST = 1e3
HIGHEST_DEGREE = 20
MOST_POINTS = 1001
SLOWEST = 0.1
OF_HALF_WAVE, MOST_HALF_WAVES = 64, 15
"""Points of an imperfect curve in a half wave, and half waves with at most 1001 points."""
MEETING = 1e-6
"""Distance between an end and its point, of the beam's length, and difference of an arc's radii, of the radius."""


def _of_table(value: object, info: ValidationInfo) -> object:
    """Points of the table that a text names, in the file's units; another value unchanged."""
    return (
        read_points(info.context.folder / value, info.context.units.length)
        if isinstance(value, str) and isinstance(info.context, Reading)
        else value
    )


SplinePoints = Annotated[
    tuple[Point, ...],
    Field(min_length=3),
    BeforeValidator(_of_table, json_schema_input_type=Annotated[tuple[Point, ...], Field(min_length=3)] | str),
]
"""Points of a spline, or the path of a table with the points, relative to the scene's folder."""


class _Curve(Record):
    """Neutral line between ``start`` and ``end``, m."""

    @first_alone
    def rules(self) -> Iterator[Mistake]:
        """Mistakes of ends, arcs and lengths."""
        curve = cast("NeutralLine", self)
        radii = [dist(end, curve.center) for end in (curve.start, curve.end)] if isinstance(curve, Arc) else [1.0, 1.0]
        yield from broken(
            curve.start == curve.end
            and Mistake(
                "", f"a start and an end at the same place {written_place(curve.start)} m", "two different places"
            ),
            min(radii) == 0.0 and Mistake("", "an end at the arc's own center", "ends on a circle about the center"),
            not abs(radii[1] - radii[0]) <= MEETING * radii[0]
            and Mistake(
                "",
                f"ends that lie on no common circle: the start is {radii[0]:.9g} m from the center, the end "
                f"{radii[1]:.9g} m",
                f"distances that differ by at most {MEETING:g} of the radius",
            ),
        )
        places = (curve.start, curve.end, *getattr(curve, "points", ()), getattr(curve, "center", curve.start))
        length, largest = shape_of(curve).length, max(abs(number) for place in places for number in place)
        term = curve.largest_term if isinstance(curve, Graph) else 0.0
        yield from broken(
            not SHORTEST * largest <= length < inf
            and Mistake(
                "",
                f"a length of {length:.3g} m at coordinates up to {largest:.3g} m",
                f"a length of at least {SHORTEST:g} of the largest coordinate",
            ),
            not SHORTEST * term <= length
            and Mistake(
                "coefficients",
                f"a term of {term:.3g} m in a curve of {length:.3g} m",
                f"a length of at least {SHORTEST:g} of the largest term",
            ),
        )


class Line(_Curve):
    """Straight line."""

    kind: Literal["line"]
    start: Point
    """First point of the line."""
    end: Point
    """Last point of the line."""


class Arc(_Curve):
    """Part of a circle, less than a full turn; both ends lie on the circle."""

    kind: Literal["arc"]
    center: Point
    """Center of the circle."""
    start: Point
    """First point of the line."""
    end: Point
    """Last point of the line."""
    direction: Literal["counterclockwise", "clockwise"]
    """Sense of rotation from start to end."""


class Graph(_Curve):
    """Graph of a polynomial f, in either sense along its axis."""

    axis: Literal["x", "y"]
    """Variable of f: ``x`` for y = f(x), ``y`` for x = f(y)."""
    coefficients: Coefficients
    """Coefficients of f, lowest power first, at most 21; f is a length and the variable a length."""
    range: tuple[Length, Length]
    """Variable at the start and at the end; the slope is at most 1000."""

    @property
    def start(self) -> Point:
        """Start of the line, m."""
        return self._at(self.range[0])

    @property
    def end(self) -> Point:
        """End of the line, m."""
        return self._at(self.range[1])

    def _at(self, variable: float) -> Point:
        value = reduce(lambda sum_, coefficient: sum_ * variable + coefficient, reversed(self.coefficients), 0.0)
        return (variable, value) if self.axis == "x" else (value, variable)

    @property
    def largest_term(self) -> float:
        """Largest term |c_k v^k| of f in the range, m; not finite beyond the range of floating-point numbers."""
        variable = max(abs(v) for v in self.range)
        powers = accumulate(repeat(variable, len(self.coefficients) - 1), lambda power, v: power * v, initial=1.0)
        return max(abs(c) * power if c else 0.0 for c, power in zip(self.coefficients, powers, strict=True))

    @first_alone
    def rules(self) -> Iterator[Mistake]:
        """Mistakes of coefficients and ranges without a graph of finite slope, then of the curve."""
        (first, last), count, axis = self.range, len(self.coefficients), "xy".index(self.axis)
        yield from broken(
            count > HIGHEST_DEGREE + 1
            and Mistake("coefficients", f"{count} coefficients", f"at most {HIGHEST_DEGREE + 1} of them"),
            first == last
            and Mistake("range", f"a range from {first:g} m to the same {last:g} m", "two different values"),
        )
        with np.errstate(all="ignore"):
            slopes = shape_of(self).derivative(shape_of(self).samples, 1)[:, 1 - axis] / (last - first)
            slope = float(np.nan_to_num(np.max(np.abs(slopes)), nan=inf, posinf=inf))
        yield from broken(
            not slope <= STEEPEST
            and Mistake(
                "coefficients",
                f"a slope of up to {slope:.3g} in the range",
                f"a slope of at most {STEEPEST:g} (a steeper curve may be a function of {'yx'[axis]})",
            )
        )
        yield from super().rules()


class Polynomial(Graph):
    """Graph of a polynomial f, in either sense along its axis."""

    kind: Literal["polynomial"]


class SmoothLine(_Curve):
    """Smooth line through points."""

    points: SplinePoints
    """At least three points of the line, or the path of a table with points."""
    start_direction: Direction | None = None
    """Tangent at the start; without a direction the first two pieces are a single cubic."""
    end_direction: Direction | None = None
    """Tangent at the end; without a direction the last two pieces are a single cubic."""

    @property
    def start(self) -> Point:
        """Start of the line, m."""
        return self.points[0]

    @property
    def end(self) -> Point:
        """End of the line, m."""
        return self.points[-1]

    @first_alone
    def rules(self) -> Iterator[Mistake]:
        """Mistakes of points, then of the curve."""
        count, chords = len(self.points), [dist(*pair) for pair in pairwise(self.points)]
        whole = sum(chords)
        yield from broken(
            count > MOST_POINTS and Mistake("points", f"{count} points", f"at most {MOST_POINTS} of them"),
            *(
                not SHORTEST * whole <= chord < inf
                and Mistake(
                    f"points[{i}]",
                    f"{written_place(self.points[i])} m, {chord:.3g} m from the point before",
                    f"a point at least {SHORTEST:g} of all the distances between the points away from the one before",
                )
                for i, chord in enumerate(chords, start=1)
            ),
        )
        shape = shape_of(self)
        # a pure number, zero at a cusp
        speed = shape.speed(shape.samples)
        yield from broken(
            not np.min(speed) >= SLOWEST
            and Mistake(
                "points",
                "points through which a smooth line has to turn back on the spot, near "
                f"{written_place(shape.place(shape.samples[[np.argmin(speed)]])[0])} m",
                "points (and directions) that a smooth line follows; more of them where it turns sharply",
            )
        )
        yield from super().rules()


class Spline(SmoothLine):
    """Smooth line through points, from the first to the last.

    x and y are cubic splines of t; t is zero at the first point and grows between points by their distance.  Tangent
    and curvature are continuous.  At an end with a direction the derivative is the unit vector of the direction, in the
    sense of the beam.  The spline of three points without directions is the parabola through the points.
    """

    kind: Literal["spline"]


class Ellipse(Record):
    """Closed curve, counter-clockwise."""

    center: Point
    """Center at the initial place."""
    semi_axes: tuple[PositiveLength, PositiveLength]
    """Semi-axes of the ellipse."""
    angle: Angle = 0.0
    """Angle of the first axis, counter-clockwise from x."""


NeutralLine = Line | Arc | Polynomial | Spline
CurveField = Annotated[NeutralLine, Field(discriminator="kind")]


@lru_cache(maxsize=256)
def shape_of(curve: NeutralLine | Graph | SmoothLine | Ellipse) -> Curve:
    """Geometry of a curve by fractions of the arc length; curves without mistakes have a geometry.

    An ellipse is a spline through 513 points, within a·(2π/512)⁴/384 = 6e-11 a of the ellipse.
    """
    match curve:
        case Line():
            return straight_line(curve.start, curve.end)
        case Arc():
            return circular_arc(curve.center, curve.start, curve.end, clockwise=curve.direction == "clockwise")
        case Graph():
            return graph(curve.coefficients, *curve.range, along=int(curve.axis == "y"))
        case SmoothLine():
            return spline(curve.points, (curve.start_direction, curve.end_direction))
        case Ellipse():
            turn, c, s = np.linspace(0.0, 2.0 * np.pi, 513), cos(curve.angle), sin(curve.angle)
            x, y = curve.semi_axes[0] * np.cos(turn), curve.semi_axes[1] * np.sin(turn)
            places = np.array(curve.center) + np.column_stack((x * c - y * s, x * s + y * c))
            return spline([(x, y) for x, y in places.tolist()], ((-s, c), (-s, c)))


def with_half_waves(curve: NeutralLine, amplitude: float, half_waves: int) -> Spline:
    """Spline of a curve with an offset w = a sin(nπu) along the left normal.

    Args:
        curve: a curve without mistakes.
        amplitude: a, m; of either sign.
        half_waves: n, from 1 to :data:`MOST_HALF_WAVES`.

    Returns:
        Spline through :data:`OF_HALF_WAVE` points of each half wave (of a single one twice as many).  Its deviation
        from the offset curve is below a·(π/OF_HALF_WAVE)⁴/384 = 2e-8 a for a straight line.
    """
    shape, u = shape_of(curve), np.linspace(0.0, 1.0, OF_HALF_WAVE * max(half_waves, 2) + 1)
    tangent = shape.tangent(u)
    normal = np.column_stack((-tangent[:, 1], tangent[:, 0]))
    inner = shape.point(u) + amplitude * np.sin(half_waves * np.pi * u)[:, None] * normal
    # with the curvature κ to the left the derivative of the offset curve is (1 - κw) t + w' n; w vanishes at the ends
    slope = amplitude * half_waves * np.pi / shape.length * np.array([1.0, (-1.0) ** half_waves])
    ends = tangent[[0, -1]] + slope[:, None] * normal[[0, -1]]
    start, *points, end = ((x, y) for x, y in np.vstack((ends[:1], inner[1:-1], ends[1:])).tolist())
    return Spline.model_construct(
        kind="spline", points=(curve.start, *points, curve.end), start_direction=start, end_direction=end
    )
