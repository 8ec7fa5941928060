"""Pieces of a rigid edge: straight ones, and graphs of polynomials.

==========  ==================================================================================
q           place, in the frame of the body that the edge is fixed to
τ, n        unit vector along the piece, and its normal towards the free side
D           distance of q from the piece, negative behind it
k           curvature with which the free side's distance bends: ∂²D/∂q² = k τ τᵀ
κ           curvature of the edge itself where q is seen, positive where the rigid side bulges; k = κ/(1 + κ D)
==========  ==================================================================================

Beyond its ends a piece is continued straight: so D has derivatives everywhere, and ``within`` says where it is the
piece that is seen.

What is rigid ends where the edge does, and goes straight back from there: its two sides are straight pieces too, and
end where they meet or come to the edge from behind.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.polynomial import polynomial

from cprbm.smooth import series
from cprbm_scene import EdgeContact, HalfPlaneContact, LineContact
from cprbm_scene.answer import Array, Flags

NEWTON_STEPS = 30
CLOSE = 1e-8  # of ℓ: a step whose square is nothing
SAMPLES = 65  # of a graph, from which the nearest place is sought
SAME = 1e-9  # of ℓ: ends of pieces that are closer are one
FAR = 1e3  # of ℓ: farther than any beam reaches
GRAPHS = 1024  # of which it is known how high and how sharp they are


@dataclass(frozen=True, slots=True)
class Seen:
    """A piece as it is seen from some places: D (k,), n (k, 2), k (k,), and whether it is the piece itself (k,)."""

    distance: Array
    normal: Array
    bend: Array
    within: Flags


@dataclass(frozen=True, slots=True)
class Roof:
    """What a piece does not stand out of, however it bends between its ends.

    Attributes:
        base, along, out: where coordinates v and w begin, and their directions, w towards the free side; (2,) each.
        low, high: v at the ends.
        top: the largest w.
        rise, fall: the steepest that w goes up and down as v grows.
    """

    base: tuple[float, float]
    along: tuple[float, float]
    out: tuple[float, float]
    low: float
    high: float
    top: float
    rise: float
    fall: float


class Face(Protocol):
    """One piece of an edge."""

    @property
    def roof(self) -> Roof:
        """What it lies under."""

    @property
    def ends(self) -> tuple[Array | None, Array | None]:
        """Where it begins and ends, (2,) each, with the free side on the left; None where it goes on for ever."""

    @property
    def course(self) -> Array:
        """Places along it from where it begins to where it ends (k, 2), far away where it goes on for ever."""

    @property
    def sharpest(self) -> float:
        """The largest |κ|."""

    @property
    def bulging(self) -> tuple[Array, Array]:
        """Places all over where it is round, as seen from the free side, and n there, (k, 2) each."""

    def seen(self, q: Array) -> Seen:
        """The piece from places ``q`` (k, 2)."""


@dataclass(frozen=True, slots=True)
class Straight:
    """A straight piece along ``tau`` (2,) from ``low`` to ``high`` beyond its ``origin`` (2,); both may be infinite."""

    origin: tuple[float, float]
    tau: tuple[float, float]
    normal: tuple[float, float]
    low: float
    high: float

    @property
    def ends(self) -> tuple[Array | None, Array | None]:
        """Where it begins and ends."""
        low, high = (
            np.array(self.origin) + far * np.array(self.tau) if np.isfinite(far) else None
            for far in (self.low, self.high)
        )
        return (low, high) if self._forwards else (high, low)

    @property
    def _forwards(self) -> bool:
        """Whether the free side is on the left along ``tau``."""
        (tx, ty), (nx, ny) = self.tau, self.normal
        return tx * ny - ty * nx > 0.0

    @property
    def roof(self) -> Roof:
        """What it lies under."""
        return Roof(self.origin, self.tau, self.normal, self.low, self.high, 0.0, 0.0, 0.0)

    @property
    def course(self) -> Array:
        """Both of its ends."""
        low, high = (
            np.array(self.origin) + np.clip(far, -FAR, FAR) * np.array(self.tau) for far in (self.low, self.high)
        )
        return np.array((low, high) if self._forwards else (high, low))

    @property
    def sharpest(self) -> float:
        """Nothing."""
        return 0.0

    @property
    def bulging(self) -> tuple[Array, Array]:
        """None."""
        return np.zeros((0, 2)), np.zeros((0, 2))

    def seen(self, q: Array) -> Seen:
        """The piece from places ``q`` (k, 2)."""
        distance = (q - np.array(self.origin)) @ np.array(self.normal)
        return Seen(distance, np.tile(self.normal, (len(q), 1)), np.zeros(len(q)), self.within(q))

    def within(self, q: Array) -> Flags:
        """Which places ``q`` (k, 2) are beside the piece and not beyond its ends."""
        along = (q - np.array(self.origin)) @ np.array(self.tau)
        return np.asarray((along >= self.low) & (along <= self.high))


@dataclass(frozen=True, slots=True)
class Graph:
    """w = f(v) for v from ``low`` to ``high``; ``side`` is +1 where w is larger on the free side.

    ``swapped`` where w is x and v is y; ``coefficients`` of f, ``origin`` of the frame in (v, w).
    """

    coefficients: tuple[float, ...]
    low: float
    high: float
    side: float
    swapped: bool
    origin: tuple[float, float]

    @property
    def ends(self) -> tuple[Array | None, Array | None]:
        """Where it begins and ends."""
        low, high = (self._placed(np.array([v]))[0] for v in (self.low, self.high))
        return (low, high) if (self.side > 0.0) != self.swapped else (high, low)

    @property
    def roof(self) -> Roof:
        """What it lies under."""
        return _roof(self)

    @property
    def course(self) -> Array:
        """At some samples."""
        places = self._placed(np.linspace(self.low, self.high, SAMPLES))
        return places if (self.side > 0.0) != self.swapped else places[::-1]

    @property
    def sharpest(self) -> float:
        """The largest |κ| at some samples."""
        return _sharpest(self)

    @property
    def bulging(self) -> tuple[Array, Array]:
        """Samples where κ is positive."""
        return _bulging(self)

    @property
    def samples(self) -> tuple[Array, Array, Array]:
        """v, the places and n there, (k,), (k, 2) and (k, 2)."""
        return _along(self)

    def at(self, v: Array) -> tuple[Array, Array, Array]:
        """Places at some v (k,) and their first two derivatives over v, (k, 2) each."""
        f1, f2 = (_value(each, v) for each in _derivatives(self.coefficients)[1:])
        first, second = np.stack((np.ones(len(v)), f1), axis=1), np.stack((np.zeros(len(v)), f2), axis=1)
        return self._placed(v), *((first[:, ::-1], second[:, ::-1]) if self.swapped else (first, second))

    def normal(self, v: Array) -> Array:
        """n at some v (k,), (k, 2)."""
        slope = _value(_derivatives(self.coefficients)[1], v)
        n = self.side * np.stack((-slope, np.ones(len(v))), axis=1) / np.hypot(1.0, slope)[:, None]
        return np.asarray(n[:, ::-1] if self.swapped else n)

    def _placed(self, v: Array) -> Array:
        w = polynomial.polyval(v, self.coefficients)
        places = np.stack((v - self.origin[0], w - self.origin[1]), axis=1)
        return np.asarray(places[:, ::-1] if self.swapped else places)

    def curvature(self, v: Array) -> Array:
        """κ at some v (k,)."""
        return self._curved(*(_value(each, v) for each in _derivatives(self.coefficients)[1:]))

    def _curved(self, f1: Array, f2: Array) -> Array:
        return np.asarray(-self.side * f2 / (1.0 + f1 * f1) ** 1.5)

    def seen(self, q: Array) -> Seen:
        """The piece from places ``q`` (k, 2)."""
        v, w = (q[:, ::-1] if self.swapped else q).T + np.array(self.origin)[:, None]
        table, (samples, heights) = _table(self.coefficients), _sampled(self)
        apart, across = np.subtract.outer(v, samples), np.subtract.outer(w, heights)
        at = samples[np.argmin(apart * apart + across * across, axis=1)]
        for _ in range(NEWTON_STEPS):
            f, slope, second = series(table, at)
            rest = f - w
            bent = 1.0 + slope * slope + rest * second
            # beyond the centre of curvature the place is farthest; it stays at its sample
            step = (at - v + rest * slope) / np.where(bent > 0.0, bent, np.inf)
            moved = np.minimum(np.maximum(at - step, self.low), self.high)
            step, at = moved - at, moved
            if np.abs(step).max(initial=0.0) < CLOSE:
                # what it has there, but for the step's square
                rest, slope = rest + slope * step, slope + second * step
                break
        else:
            f, slope, second = series(table, at)
            rest = f - w
        size = np.hypot(1.0, slope)
        tau = np.stack((1.0 / size, slope / size), axis=1)
        n = self.side * np.stack((-slope / size, 1.0 / size), axis=1)
        rv, rw = v - at, -rest
        along, distance = rv * tau[:, 0] + rw * tau[:, 1], rv * n[:, 0] + rw * n[:, 1]
        within = ~(((at <= self.low) & (along < 0.0)) | ((at >= self.high) & (along > 0.0)))
        kappa = self._curved(slope, second)
        bend = np.where(within, kappa / (1.0 + kappa * distance), 0.0)
        return Seen(distance, n[:, ::-1] if self.swapped else n, bend, within)


def _value(coefficients: Array, v: Array) -> Array:
    """A polynomial at some places (k,), by Horner's rule."""
    found = np.full(len(v), coefficients[-1])
    for coefficient in coefficients[-2::-1].tolist():
        found *= v
        found += coefficient
    return found


@lru_cache(maxsize=GRAPHS)
def _sampled(graph: Graph) -> tuple[Array, Array]:
    """Places of a graph from which the nearest is sought, v and f(v), (SAMPLES,) each."""
    samples = np.linspace(graph.low, graph.high, SAMPLES)
    return samples, _value(_derivatives(graph.coefficients)[0], samples)


@lru_cache(maxsize=GRAPHS)
def _table(coefficients: tuple[float, ...]) -> Array:
    """The same row by row (3, at least 2)."""
    found = np.zeros((3, max(len(coefficients), 2)))
    for row, each in zip(found, _derivatives(coefficients), strict=True):
        row[: len(each)] = each
    return found


@lru_cache(maxsize=GRAPHS)
def _derivatives(coefficients: tuple[float, ...]) -> tuple[Array, Array, Array]:
    """Coefficients of a polynomial and of its first two derivatives."""
    f, f1, f2 = (np.asarray(polynomial.polyder(coefficients, m), dtype=float) for m in range(3))
    return f, f1, f2


@lru_cache(maxsize=GRAPHS)
def _roof(graph: Graph) -> Roof:
    f, f1 = (graph.side * each for each in _derivatives(graph.coefficients)[:2])
    # w is measured from the base, f from the axis
    base, along, out = (-graph.origin[0], -graph.origin[1]), (1.0, 0.0), (0.0, graph.side)
    if graph.swapped:
        base, along, out = base[::-1], along[::-1], out[::-1]
    rise, fall = (max(_largest(graph, slope), 0.0) for slope in (f1, -f1))
    return Roof(base, along, out, graph.low, graph.high, _largest(graph, f), rise, fall)


def _largest(graph: Graph, coefficients: Array) -> float:
    """The largest value of a polynomial between the ends of a graph."""
    flat = polynomial.polyroots(polynomial.polytrim(polynomial.polyder(coefficients)))
    inner = flat.real[(flat.real > graph.low) & (flat.real < graph.high)]
    return float(np.max(polynomial.polyval(np.append(inner, (graph.low, graph.high)), coefficients)))


@lru_cache(maxsize=GRAPHS)
def _sharpest(graph: Graph) -> float:
    return float(np.max(np.abs(graph.curvature(np.linspace(graph.low, graph.high, SAMPLES)))))


@lru_cache(maxsize=GRAPHS)
def _bulging(graph: Graph) -> tuple[Array, Array]:
    v = np.linspace(graph.low, graph.high, SAMPLES)[1:-1]
    v = v[graph.curvature(v) > 0.0]
    return graph._placed(v), graph.normal(v)


@lru_cache(maxsize=GRAPHS)
def _along(graph: Graph) -> tuple[Array, Array, Array]:
    v = np.linspace(graph.low, graph.high, SAMPLES)
    return v, graph._placed(v), graph.normal(v)


def faces_of(contact: EdgeContact, unit_length: float, origin: tuple[float, float]) -> tuple[Face, ...]:
    """The pieces of a contact's edge, units of length from an ``origin`` (2,), in order."""
    match contact:
        case LineContact():
            points = np.array(contact.points) / unit_length - np.array(origin)
            sign = 1.0 if contact.side == "left" else -1.0
            found = []
            for one, other in pairwise(points):
                length = float(np.hypot(*(other - one)))
                tx, ty = (other - one) / length
                begin = (float(one[0]), float(one[1]))
                normal = (float(-sign * ty), float(sign * tx))
                found.append(Straight(begin, (float(tx), float(ty)), normal, 0.0, length))
            return tuple(found)
        case HalfPlaneContact():
            x, y = np.array(contact.point) / unit_length - np.array(origin)
            nx, ny = np.array(contact.normal) / np.hypot(*contact.normal)
            return (Straight((float(x), float(y)), (float(ny), float(-nx)), (float(nx), float(ny)), -np.inf, np.inf),)
    swapped = contact.axis == "y"
    low, high = sorted(contact.range)
    # f and its variable in units of length
    powers = unit_length ** (np.arange(len(contact.coefficients)) - 1.0)
    return (
        Graph(
            coefficients=tuple((np.array(contact.coefficients) * powers).tolist()),
            low=low / unit_length,
            high=high / unit_length,
            side=1.0 if contact.side == "above" else -1.0,
            swapped=swapped,
            origin=origin[::-1] if swapped else origin,
        ),
    )


def sides_of(faces: Sequence[Face]) -> tuple[Straight, ...]:
    """The sides of what is rigid behind the ``faces`` of an edge, in their order; none of what has no ends."""
    begins = {tuple(end) for face in faces if (end := face.ends[0]) is not None}
    stops = {tuple(end) for face in faces if (end := face.ends[1]) is not None}
    found = []
    for face in faces:
        for end, others, leads in zip(face.ends, (stops, begins), (-1.0, 1.0), strict=True):
            if end is None or any(np.hypot(*(end - np.array(other))) <= SAME for other in others):
                continue
            nx, ny = face.seen(end[None]).normal[0]
            # out of the edge, along it: to the right of n where the edge ends, to the left where it begins
            out = (float(leads * ny), float(-leads * nx))
            found.append(Straight((float(end[0]), float(end[1])), (float(-nx), float(-ny)), out, 0.0, np.inf))
    straight = [face for face in faces if isinstance(face, Straight)]
    return tuple(
        replace(
            side, high=min((_met(side, other) for other in (*straight, *found) if other is not side), default=np.inf)
        )
        for side in found
    )


def _met(side: Straight, other: Straight) -> float:
    """How far along a ``side`` it meets another piece; infinite where it does not."""
    (tx, ty), (ux, uy) = side.tau, other.tau
    across = tx * uy - ty * ux
    if abs(across) <= SAME:
        return np.inf
    x, y = np.array(other.origin) - np.array(side.origin)
    far, along = (x * uy - y * ux) / across, (x * ty - y * tx) / across
    return float(far) if far > SAME and other.low <= along <= other.high else np.inf
