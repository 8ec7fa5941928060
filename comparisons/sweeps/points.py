"""Points of a sweep: values of parameters in SI, from grids, samples and files."""

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

import numpy as np
from scipy.stats import qmc

from comparisons.formats import file_unit, joined, with_symbols
from cprbm_scene import Array, Mistake, Scene, SceneError
from cprbm_scene.mistakes import first_broken, mistake, refuse_broken
from cprbm_scene.units import rows_of, text_of

Point = Mapping[str, float]
"""Values of parameters by name, SI."""

InSI = Callable[[str, str], float]
"""Value of a parameter's name and a text such as ``1.9mm``, SI."""

MOST = 100_000
"""Largest number of points in a sweep."""

_LONGEST = 100_000_000
"""Largest size of a table of points in bytes."""

SEED = 905
"""Seed of the samples: a command always draws the same points."""

CORNERS = 6
"""Largest number of parameters whose corners are chosen: their number doubles with every parameter."""

_DIGITS = 12
"""Digits of a value in a grid: equal values of two grids are equal numbers."""

_VARIED = re.compile(r"\s*(?P<name>\w+)\s*=\s*(?P<low>.+?)\s*\.\.\s*(?P<high>.+?)\s*(?::\s*(?P<count>\d{1,6})\s*)?")
_QUANTITY = re.compile(r"(?P<number>[-+.\d]*\d\.?(?:[eE][-+]?\d+)?)\s*(?P<unit>[^-+.\deE\s].*)")


@dataclass(frozen=True, slots=True)
class Axis:
    """A parameter of a sweep.

    Attributes:
        name: of the parameter.
        low, high: first and last value, SI.
        count: number of equally spaced values; 0 in a sample.
        unit: displayed unit; size: of the unit in SI.
    """

    name: str
    low: float
    high: float
    count: int = 0
    unit: str = ""
    size: float = 1.0

    def values(self) -> list[float]:
        """The equally spaced values, SI."""
        return [float(f"{value:.{_DIGITS}g}") for value in np.linspace(self.low, self.high, self.count)]

    @property
    def column(self) -> str:
        """Name, and unit as in the scene's file."""
        return f"{self.name}, {self.unit}".rstrip(", ")

    @property
    def label(self) -> str:
        """Name, and unit with symbols."""
        return f"{self.name}, {with_symbols(self.unit)}".rstrip(", ")

    def of(self, point: Point) -> float:
        """Value of a point in the displayed unit."""
        return point[self.name] / self.size

    def text(self, value: float) -> str:
        """An SI value with name and unit."""
        return f"{self.name} = {joined(f'{value / self.size:.6g}', with_symbols(self.unit))}"


def place_text(axes: Iterable[Axis], point: Point) -> str:
    """Values of a point with names and units."""
    return ", ".join(axis.text(point[axis.name]) for axis in axes)


def axis_of(text: str, in_si: InSI) -> Axis:
    """The axis of a text such as ``t=1.8mm..2.2mm:11``; without a number of values the axis of a sample.

    Raises:
        SceneError: the text is no range, or the scene refuses an end of the range.
    """
    found = _VARIED.fullmatch(text)
    if found is None or found["count"] in ("0", "1"):
        raise mistake(repr(text), "NAME=FIRST..LAST:COUNT with two values or more, as t=1.8mm..2.2mm:11", "--vary")
    name, last = found["name"], found["high"]
    low, high = in_si(name, found["low"]), in_si(name, last)
    if low == high:
        raise mistake(repr(text), "two different values", "--vary")
    parts = _QUANTITY.fullmatch(last)
    number, unit = (float(parts["number"]), parts["unit"]) if parts else (0.0, "")
    count = int(found["count"] or 0)
    return Axis(name, low, high, count, unit, high / number) if number else Axis(name, low, high, count)


def grid(axes: Sequence[Axis]) -> tuple[Point, ...]:
    """All combinations of the values of the axes; the last axis changes fastest.

    Raises:
        SceneError: two axes have one name, an axis has no number of values, or there are too many points.
    """
    names, number = [axis.name for axis in axes], math.prod(axis.count for axis in axes)
    refuse_broken(
        *first_broken(
            len(set(names)) < len(names) and Mistake("--vary", ", ".join(names), "a parameter once"),
            *(
                not axis.count
                and Mistake("--vary", f"{axis.name} without a number of values", f"{axis.name}=FIRST..LAST:COUNT")
                for axis in axes
            ),
            number > MOST and Mistake("--vary", f"{number} points", f"at most {MOST}"),
        )
    )
    return tuple(dict(zip(names, values, strict=True)) for values in product(*(axis.values() for axis in axes)))


def sample(text: str, axes: Sequence[Axis]) -> tuple[Point, ...]:
    """Points of ``sobol:K`` or ``lhs:K`` between the ends of the axes; a longer Sobol sample begins as a shorter does.

    Raises:
        SceneError: the text is no sample, or there is no axis.
    """
    found = re.fullmatch(r"(sobol|lhs):(\d{1,6})", text)
    if found is None or not 1 <= int(found[2]) <= MOST:
        raise mistake(repr(text), f"sobol:K or lhs:K with K from 1 to {MOST}, or a file that ends in .csv", "--sample")
    if not axes:
        raise mistake(f"{text} without a range", "--vary NAME=FIRST..LAST, or a parameter with a range", "--sample")
    count, size = int(found[2]), len(axes)
    if found[1] == "lhs":
        unit = qmc.LatinHypercube(size, seed=SEED).random(count)
    else:
        unit = qmc.Sobol(size, seed=SEED).random_base2(math.ceil(math.log2(count)))[:count]
    low, high = (np.array([getattr(axis, end) for axis in axes]) for end in ("low", "high"))
    rows = low + unit * (high - low)
    return tuple({axis.name: float(x) for axis, x in zip(axes, row, strict=True)} for row in rows)


def read_points(path: Path, in_si: InSI) -> tuple[Point, ...]:
    """Points of a table: names of parameters in the first row, numbers with or without units below.

    Raises:
        SceneError: the file cannot be read, or a row is wrong; the error names file and row.
    """
    points, where = list[Point](), ""
    try:
        (_, names), *rows = rows_of(text_of(path, "a table in UTF-8", most=_LONGEST)) or [(1, [])]
        refuse_broken(
            not 1 <= len(rows) <= MOST
            and Mistake(
                "",
                f"{len(rows)} rows below the names {', '.join(names) or '(none)'}",
                f"names of parameters in the first row, and 1 to {MOST} rows of numbers",
            )
        )
        for row, cells in rows:
            where, point = f"row {row}", dict(zip(names, cells, strict=False))
            refuse_broken(
                not len(cells) == len(names) == len(point)
                and Mistake("", f"{len(cells)} values of {', '.join(names)}", "a value for every name, each name once")
            )
            points.append({name: in_si(name, cell) for name, cell in point.items()})
    except SceneError as error:
        raise SceneError([Mistake(where, each.found, each.allowed, str(path)) for each in error.mistakes]) from None
    return tuple(points)


def axes_of(points: Sequence[Point]) -> tuple[Axis, ...]:
    """Axes of a sample: the least and the largest value of every parameter."""
    columns = {name: [point[name] for point in points] for name in points[0]}
    return tuple(Axis(name, min(values), max(values)) for name, values in columns.items())


def ranges_of(scene: Scene) -> tuple[Axis, ...]:
    """Axes of the parameters with a range."""
    ranges = {name: each.range for name, each in scene.parameters.items() if each.range is not None}
    return tuple(Axis(name, *ends) for name, ends in ranges.items())


def in_file_units(scene: Scene, axes: Sequence[Axis]) -> tuple[Axis, ...]:
    """The axes, with the units of the scene's file for axes without a unit."""
    units = (file_unit(scene, scene.parameters[axis.name].unit) for axis in axes)
    return tuple(
        axis if axis.unit else replace(axis, size=size, unit=unit)
        for axis, (size, unit) in zip(axes, units, strict=True)
    )


def chosen_for_check(points: Sequence[Point], axes: Sequence[Axis], count: int) -> frozenset[int]:
    """Places of ``count`` points for a check: the corners first, then the points next to a Sobol sequence."""
    span = np.array([axis.high - axis.low or 1.0 for axis in axes])
    unit: Array = (np.array([[point[axis.name] for axis in axes] for point in points]) - [a.low for a in axes]) / span
    corners = list(product((0.0, 1.0), repeat=len(axes))) if len(axes) <= CORNERS else []
    sobol = qmc.Sobol(len(axes), seed=SEED)
    left = np.ones(len(points), dtype=bool)
    found: list[int] = []
    while len(found) < min(count, len(points)):
        wanted = np.array(corners.pop(0)) if corners else sobol.random(1)[0]
        away = np.where(left, np.sum((unit - wanted) ** 2, axis=1), np.inf)
        found.append(int(np.argmin(away)))
        left[found[-1]] = False
    return frozenset(found)
