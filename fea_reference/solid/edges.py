"""Rigid edges of straight pieces or graphs of functions, in the frame of their body.

======  ========================================================================================
symbol  meaning
======  ========================================================================================
ξ       a point
g       distance from the nearest side, negative behind the side
h, H    ∂g/∂ξ, the side's normal, and ∂²g/∂ξ² = κ/(1 + κ g) τ τᵀ
τ, κ    tangent with the free side on its left; curvature, positive where the edge is convex
======  ========================================================================================

A point behind the edge belongs to the side at the least depth. At an end of the edge the body continues straight
back, along two more sides. The backward sides are infinite unless they intersect, in a corner, or meet the edge from
behind. No side is opposite to a point in front of a convex corner: the corner itself is in contact with the smooth
edge of the beam, see :mod:`fea_reference.solid.pricking`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from cprbm_scene.answer import Array
from cprbm_scene.statement import FunctionContact, LineContact

_SAMPLES = 257  # points of a graph for the initial guess of the closest point
_NEWTON_STEPS = 20
_SAME = 1e-12  # relative length: tolerance of a place at the beginning of a side


@dataclass(frozen=True, slots=True, eq=False)
class Corner:
    """A convex corner at ``point`` (2,) with bisector ``normal`` (2,)."""

    point: Array
    normal: Array


@dataclass(frozen=True, slots=True, eq=False)
class Broken:
    """Straight sides from ``first`` (s, 2) along ``tangent`` (s, 2), between distances ``low`` and ``high`` (s,)."""

    first: Array
    tangent: Array
    low: Array
    high: Array

    def measured(self, xi: Array) -> tuple[Array, Array, Array]:
        """g (k,), infinite if no side is opposite, h (k, 2) and H (k, 2, 2) at ξ (k, 2)."""
        away = xi[:, None] - self.first
        along, normal = (away * self.tangent).sum(axis=2), left(self.tangent)
        g = (away * normal).sum(axis=2)
        past = along - np.clip(along, self.low, self.high)
        nearest = np.hypot(g, past).argmin(axis=1)
        every = np.arange(len(xi))
        gaps = np.where(past[every, nearest] == 0.0, g[every, nearest], np.inf)  # otherwise a corner is nearest
        return gaps, normal[nearest], np.zeros((len(xi), 2, 2))


@dataclass(frozen=True, slots=True, eq=False)
class Graph:
    """An edge y₂ = f(y₁), or y₁ = f(y₂) if ``across``, with the variable in ``span``, and its backward ``sides``.

    ``forwards`` is True if the edge runs along the variable with the free side on its left.
    """

    f: Polynomial
    span: tuple[float, float]
    across: bool
    forwards: bool
    sides: Broken

    def measured(self, xi: Array) -> tuple[Array, Array, Array]:
        """g (k,), infinite if no side is opposite, h (k, 2) and H (k, 2, 2) at ξ (k, 2)."""
        v = self._nearest(xi)
        point, tangent, kappa = self.at(v)
        away, normal = xi - point, left(tangent)
        g = (away * normal).sum(axis=1)
        beyond = np.abs((away * tangent).sum(axis=1)) > 1e-9 * (self.span[1] - self.span[0])
        bend = kappa / np.maximum(1.0 + kappa * g, 0.1)
        H = bend[:, None, None] * tangent[:, :, None] * tangent[:, None, :]
        back, h_back, _ = self.sides.measured(xi)
        behind = (g < 0.0) & (back > g) & (back <= 0.0)
        g = np.where(beyond, np.inf, np.where(behind, back, g))
        return g, np.where(behind[:, None], h_back, normal), np.where(behind[:, None, None], 0.0, H)

    def at(self, v: Array) -> tuple[Array, Array, Array]:
        """Points and unit tangents (k, 2), and κ (k,), at values ``v`` (k,) of the variable."""
        slope, second = self.f.deriv(1)(v), self.f.deriv(2)(v)
        point = np.stack([v, self.f(v)], axis=1)
        direction = 1.0 if self.forwards else -1.0
        tangent = direction * np.stack([np.ones_like(v), slope], axis=1) / np.hypot(1.0, slope)[:, None]
        # a graph that bends to the left of its direction is concave; across, left and right are exchanged
        kappa = (direction if self.across else -direction) * second / np.hypot(1.0, slope) ** 3
        return (point[:, ::-1], tangent[:, ::-1], kappa) if self.across else (point, tangent, kappa)

    def _nearest(self, xi: Array) -> Array:
        """The variable (k,) at the closest point to ξ (k, 2)."""
        low, high = self.span
        w, y = xi.T[::-1] if self.across else xi.T
        samples = np.linspace(low, high, _SAMPLES)
        v = samples[((w[:, None] - samples) ** 2 + (y[:, None] - self.f(samples)) ** 2).argmin(axis=1)]
        slope, second = self.f.deriv(1), self.f.deriv(2)
        for _ in range(_NEWTON_STEPS):
            rest, rise = self.f(v) - y, slope(v)
            bent = 1.0 + rise**2 + rest * second(v)
            moved = np.clip(v - (v - w + rest * rise) / np.where(bent > 0.0, bent, np.inf), low, high)
            done = np.abs(moved - v).max(initial=0.0) <= 1e-14 * (high - low)
            v = moved
            if done:
                break
        return np.asarray(v)


def broken(contact: LineContact, origin: Array, unit: float) -> tuple[Broken, tuple[Corner, ...]]:
    """The edge of straight pieces with its corners, dimensionless with ``origin`` (2,) (m) and length ``unit`` (m)."""
    points = (np.array(contact.points) - origin) / unit
    if contact.side == "right":
        points = points[::-1]
    vectors = np.diff(points, axis=0)
    length = np.hypot(*vectors.T)
    tangent = vectors / length[:, None]
    first, low, high = points[:-1], np.zeros_like(length), length
    if contact.closed:
        return Broken(first, tangent, low, high), corners(first, np.roll(tangent, 1, axis=0), tangent)
    back, meeting = ends(points, tangent[[0, -1]])
    before = np.vstack([back.tangent[:1], tangent])
    behind = np.vstack([tangent, back.tangent[1:]])
    return (
        Broken(
            np.vstack([first, back.first]),
            np.vstack([tangent, back.tangent]),
            np.concatenate([low, back.low]),
            np.concatenate([high, back.high]),
        ),
        (*corners(points, before, behind), *meeting),
    )


def graph(contact: FunctionContact, origin: Array, unit: float) -> tuple[Graph, tuple[Corner, ...]]:
    """The edge of a function's graph with its corners, dimensionless with ``origin`` (2,) (m) and ``unit`` (m)."""
    across = contact.axis == "y"
    here, other = origin[::-1] if across else origin
    f = (Polynomial(contact.coefficients)(Polynomial([here, unit])) - other) / unit
    low, high = sorted((end - here) / unit for end in contact.range)
    forwards = (contact.side == "above") != across
    bare = Graph(f, (low, high), across, forwards, Broken(*np.empty((2, 0, 2)), *np.empty((2, 0))))
    points, tangent, _ = bare.at(np.array([low, high] if forwards else [high, low]))
    along, _, _ = bare.at(np.linspace(*((low, high) if forwards else (high, low)), _SAMPLES))
    back, meeting = ends(along, tangent)
    before, behind = np.stack([back.tangent[0], tangent[1]]), np.stack([tangent[0], back.tangent[1]])
    return Graph(f, (low, high), across, forwards, back), (*corners(points, before, behind), *meeting)


def ends(points: Array, tangents: Array) -> tuple[Broken, tuple[Corner, ...]]:
    """Backward sides at both ends of ``points`` (k, 2) with ``tangents`` (2, 2), and their common corner, if any."""
    out, both, pieces = left(tangents), points[[0, -1]], np.diff(points, axis=0)
    far = np.full(2, np.inf)
    for i in (0, 1):
        share, along = _crossing(both[i], -out[i], points[:-1], pieces)
        far[i] = share[(share > _SAME) & (along >= 0.0) & (along <= 1.0)].min(initial=np.inf)
    (one,), (other,) = _crossing(both[0], -out[0], both[1:], -out[1:])
    meet = _SAME < one < far[0] and _SAME < other < far[1]
    far = np.array([one, other]) if meet else far
    back = Broken(both, np.stack([out[0], -out[1]]), np.array([-far[0], 0.0]), np.array([0.0, far[1]]))
    return back, corners(both[1:] - other * out[1:], back.tangent[1:], back.tangent[:1]) if meet else ()


def _crossing(place: Array, way: Array, places: Array, ways: Array) -> tuple[Array, Array]:
    """Multiples of ``way`` (2,) from ``place`` (2,), and of ``ways`` (k, 2) from ``places`` (k, 2), at the crossings.

    Infinite for parallel lines.
    """
    across = way[0] * ways[:, 1] - way[1] * ways[:, 0]
    parallel = np.abs(across) <= _SAME * np.hypot(*ways.T)
    x, y = (places - place).T
    shares = (x * ways[:, 1] - y * ways[:, 0], x * way[1] - y * way[0])
    far, along = (np.where(parallel, np.inf, share / np.where(parallel, 1.0, across)) for share in shares)
    return far, along


def corners(points: Array, before: Array, behind: Array) -> tuple[Corner, ...]:
    """The convex corners among places (c, 2) between sides with tangents (c, 2)."""
    turn = before[:, 0] * behind[:, 1] - before[:, 1] * behind[:, 0]
    half = left(before + behind)
    return tuple(
        Corner(point, normal / np.hypot(*normal))
        for point, normal, t in zip(points, half, turn, strict=True)
        if t < 0.0
    )


def left(vectors: Array) -> Array:
    """Vectors (k, 2) turned counter-clockwise by a right angle."""
    return np.stack([-vectors[:, 1], vectors[:, 0]], axis=1)
