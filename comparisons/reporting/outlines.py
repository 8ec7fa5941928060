"""Shapes as the data of SVG paths, in the units of a picture whose larger side has 1000 of them.

======  ===========================================================================
symbol  meaning
======  ===========================================================================
x, y    place in the scene, m; y grows upwards
X, Y    place in the picture; Y grows downwards, Y = 0 at the top
ε       how far a line that is left with fewer points may be from the whole one
======  ===========================================================================
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array

WIDE = 1000.0
_EPSILON = 0.3
_HEAD = 11.0
"""Length of an arrow's head."""


@dataclass(frozen=True, slots=True)
class Frame:
    """Which part of the plane a picture shows: its ``corner`` at the upper left, m, and ``scale`` units to 1 m."""

    corner: tuple[float, float]
    scale: float
    width: float
    height: float

    def of(self, places: Array) -> Array:
        """Where places (k, 2), m, are in the picture, (k, 2)."""
        x0, y0 = self.corner
        return np.asarray((np.reshape(places, (-1, 2)) - (x0, y0)) * (self.scale, -self.scale))


def frame(places: Array, margin: float) -> Frame:
    """The part that holds all ``places`` (k, 2), m, with a ``margin`` as a share of the larger side."""
    low, high = places.min(axis=0), places.max(axis=0)
    beyond = margin * float(np.max(high - low))
    size = high - low + 2.0 * beyond
    scale = WIDE / float(np.max(size))
    return Frame(
        (float(low[0] - beyond), float(high[1] + beyond)), scale, float(size[0] * scale), float(size[1] * scale)
    )


def line(points: Array, *, closed: bool = False) -> str:
    """A line through points (k, 2) of the picture, without those that are on it anyway."""
    if len(points) == 0:
        return ""
    kept = points[_telling(points)]
    return "M" + "L".join(_pair(*each) for each in kept) + ("Z" if closed else "")


def dots(points: Array) -> str:
    """A dot at each of some points (k, 2), as round as the ends of its stroke are."""
    return "".join(f"M{_pair(x, y)}h0" for x, y in points)


def circle(centre: Array, radius: float) -> str:
    """A circle about a point (2,) of the picture."""
    x, y = centre
    r = _short(radius)
    turn = f"a{r},{r} 0 1 0 "
    return f"M{_pair(x - radius, y)}{turn}{_short(2.0 * radius)},0{turn}{_short(-2.0 * radius)},0"


def arrows(ends: Iterable[tuple[Array, Array]]) -> str:
    """Arrows from points to points (2,) of the picture; none where both are one."""
    return "".join(_arrow(start, end) for start, end in ends)


def _arrow(start: Array, end: Array) -> str:
    way = end - start
    size = float(np.hypot(*way))
    if size < 1.0:
        return ""
    along = way / size
    return f"M{_pair(*start)}L{_pair(*end)}{_head(end, along, min(_HEAD, 0.6 * size))}"


def turned(centre: Array, radius: float, *, counterclockwise: bool) -> str:
    """An arrow three quarters round a point (2,) of the picture, as a moment is drawn."""
    angles = np.linspace(-0.75 * np.pi, 0.75 * np.pi, 25) * (1.0 if counterclockwise else -1.0)
    points = centre + radius * np.stack([np.cos(angles), -np.sin(angles)], axis=1)
    along = points[-1] - points[-2]
    return line(points) + _head(points[-1], along / np.hypot(*along), _HEAD)


def _head(tip: Array, along: Array, size: float) -> str:
    across = np.array([-along[1], along[0]])
    sides = (tip - size * along + side * 0.45 * size * across for side in (1.0, -1.0))
    one, other = sides
    return f"M{_pair(*one)}L{_pair(*tip)}L{_pair(*other)}"


def _telling(points: Array) -> list[int]:
    """Which points of a line tell of it within ε (Ramer, Douglas and Peucker), ascending."""
    kept = {0, len(points) - 1}
    open_ = [(0, len(points) - 1)]
    while open_:
        first, last = open_.pop()
        if last - first < 2:
            continue
        away = _distance(points[first + 1 : last], points[first], points[last])
        worst = int(np.argmax(away))
        if away[worst] > _EPSILON:
            middle = first + 1 + worst
            kept.add(middle)
            open_ += [(first, middle), (middle, last)]
    return sorted(kept)


def _distance(points: Array, start: Array, end: Array) -> Array:
    """Of points (k, 2) from the straight piece between two, (k,)."""
    way = end - start
    square = float(way @ way)
    share = np.clip((points - start) @ way / square, 0.0, 1.0) if square > 0.0 else np.zeros(len(points))
    return np.asarray(np.hypot(*(points - start - share[:, None] * way).T))


def _pair(x: float, y: float) -> str:
    return f"{_short(x)},{_short(y)}"


def _short(value: float) -> str:
    """To a tenth, without what tells nothing."""
    text = f"{value:.1f}".removesuffix(".0")
    return "0" if text == "-0" else text


def band(points: Array, thickness: Sequence[float] | Array) -> str:
    """The area that a line through points (k, 2) covers with a ``thickness`` (k,) at each, in the picture's units."""
    along = np.gradient(points, axis=0)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.maximum(np.hypot(*along.T), 1e-12)[:, None]
    half = 0.5 * np.asarray(thickness)[:, None] * across
    return line(np.concatenate([points + half, (points - half)[::-1]]), closed=True)
