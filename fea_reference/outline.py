"""Signed distance of points from a rigid body's straight, broken or curved edge, in the frame of the body.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
y       point in the body's frame
d, n    distance, negative behind the edge, and its gradient, a unit vector
τ, b    n turned clockwise; the second derivative of d is b τ τᵀ
P, t    a place where n or b jumps lies on the straight line through P normal to t
======  =====================================================================================

The free side lies to the left of an edge; an edge with the free side to the right is reversed. At an end of the edge
the rigid body continues straight back, along two more sides at right angles to the first and last piece. The backward
sides are infinite unless they intersect, at a further corner, or meet the edge from behind. In front of a convex
corner d is the distance from the corner and b = 1/d; behind the corner the nearer side counts, and n jumps on the
bisector. At a concave corner front and back are exchanged.

For a graph b = κ/(1 + κ d), with the curvature κ positive where the body is convex.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import EdgeContact, FunctionContact, HalfPlaneContact, LineContact
from fea_reference.state import Complex, multiplied, summed

_SAME = 1e-6  # m: accepted distance of coinciding points of a scene
_STRAIGHT = 1e-9  # sine of a turn: round-off of coordinates
_SAMPLES = 257  # points of a graph for the initial guess of the closest point
_PIECES = 64  # pieces of a graph for the crossing check
_NEWTON_STEPS = 30
_ARRIVED = 1e-9  # times the span: last Newton step, with a quadratically smaller error


@dataclass(frozen=True, slots=True)
class Near:
    """d (k,), n (2, k), b (k,) of points (2, k), and True (k,) where the closest point is a corner."""

    distance: Array
    normal: Array
    bend: Array
    corner: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Corners:
    """Corners between two straight sides: ``points`` P, tangents and normals before and behind, (2, c) all."""

    points: Array
    tangents: tuple[Array, Array]
    normals: tuple[Array, Array]

    @property
    def bisectors(self) -> Array:
        """Tangents t (2, c) normal to the bisectors' lines."""
        both = self.tangents[0] + self.tangents[1]
        return np.asarray(both / np.hypot(both[0], both[1]))

    @property
    def turn(self) -> Array:
        """Sines (c,) of the turns, negative at convex corners, zero where two pieces go on straight."""
        a, b = self.tangents
        sine = a[0] * b[1] - a[1] * b[0]
        return np.where(np.abs(sine) < _STRAIGHT, 0.0, sine)

    @property
    def convex(self) -> NDArray[np.bool_]:
        """True (c,) for convex corners."""
        return np.asarray(self.turn < 0.0)


@dataclass(frozen=True, slots=True, eq=False)
class HalfPlane:
    """An infinite straight edge through ``point`` (2,) with ``normal`` (2,)."""

    point: Array
    normal: Array

    @property
    def corners(self) -> Corners:
        """No corners."""
        none = np.empty((2, 0))
        return Corners(none, (none, none), (none, none))

    @property
    def chain(self) -> Array:
        """No polyline (2, 0): a body behind an infinite line cannot be passed through unnoticed."""
        return np.empty((2, 0))

    @property
    def tips(self) -> tuple[Array, Array]:
        """No convex corners, see :class:`Broken`."""
        return np.empty((2, 0)), np.empty((2, 0))

    @property
    def straight(self) -> bool:
        """True: without curved parts."""
        return True

    @property
    def extent(self) -> float:
        """Largest depth behind the edge that counts as penetration."""
        return float(np.inf)

    def near(self, y: Array) -> Near:
        """Distance data of points (2, k)."""
        k = y.shape[1]
        return Near(
            self.normal @ (y - self.point[:, None]),
            np.repeat(self.normal[:, None], k, axis=1),
            np.zeros(k),
            np.zeros(k, dtype=bool),
        )

    def exact_distance(self, y: Array, rest: Array, _near: Near) -> Array:
        """d (k,) of points ``y`` + ``rest`` (2, k), without cancellation."""
        return _across(self.normal[:, None], y, rest, self.point[:, None])


@dataclass(frozen=True, eq=False)
class Broken:
    """An edge of straight pieces along ``points`` (2, m+1), free side to the left.

    The edge is closed if the last point is the first.
    """

    points: Array

    @cached_property
    def corners(self) -> Corners:
        """Corners between the pieces and at the ends."""
        tau = self._tangents
        if self.closed:
            before = np.roll(tau, 1, axis=1)
            return Corners(self.points[:, :-1], (before, tau), (_left(before), _left(tau)))
        first, last = _left(tau[:, :1]), -_left(tau[:, -1:])
        points, before, behind = self.points, np.column_stack([first, tau]), np.column_stack([tau, last])
        if self._closed_behind:
            corner = self.points[:, -1:] + self._back[1] * last
            points, before = np.column_stack([points, corner]), np.column_stack([before, last])
            behind = np.column_stack([behind, first])
        return Corners(points, (before, behind), (_left(before), _left(behind)))

    @cached_property
    def tips(self) -> tuple[Array, Array]:
        """Convex corners (2, t) and the mean directions (2, t) of their contact forces."""
        return _tips(self.corners)

    @property
    def straight(self) -> bool:
        """True: without curved parts."""
        return True

    @cached_property
    def extent(self) -> float:
        """Largest depth behind the edge that counts as penetration, a share of the edge's size."""
        return 0.25 * float(np.hypot(*np.ptp(self.points, axis=1)))

    @property
    def chain(self) -> Array:
        """Boundary polyline (2, m+1), free side to the left."""
        return self.points

    def near(self, y: Array) -> Near:
        """Distance data of points (2, k)."""
        nearest, t, away = self._closest_side(y)
        _, _, low, high = self._sides
        normals = self._normals
        side = normals.take(nearest, axis=1)
        before = t <= low[nearest]
        corner = before | (t >= high[nearest])
        d = side[0] * away[0] + side[1] * away[1]
        if not corner.any():
            return Near(d, side, np.zeros(d.size), corner)
        # at a corner the sum of both normals gives the sign of the distance
        neighbour = np.where(before, nearest - 1, nearest + 1)
        round_it = self.closed or self._closed_behind
        neighbour = neighbour % low.size if round_it else np.minimum(np.maximum(neighbour, 0), low.size - 1)
        both = side + np.where(corner, normals.take(neighbour, axis=1), 0.0)
        r_corner = np.hypot(away[0], away[1])
        corner &= r_corner > 0.0
        sign = np.where((both * away).sum(axis=0) < 0.0, -1.0, 1.0)
        unit = away / np.where(corner, r_corner, 1.0)
        return Near(
            np.where(corner, sign * r_corner, d),
            np.where(corner, sign * unit, side),
            np.where(corner, sign / np.where(corner, r_corner, 1.0), 0.0),
            corner,
        )

    def exact_distance(self, y: Array, rest: Array, near: Near) -> Array:
        """d (k,) of points ``y`` + ``rest`` (2, k), without cancellation, from data at ``y``."""
        side, t, _ = self._closest_side(y)
        tangents, first, _, _ = self._sides
        begins = first.take(side, axis=1)
        away, more = summed(y, -(begins + t * tangents.take(side, axis=1)))
        away += more + rest
        round_it = np.sign(near.distance) * np.hypot(away[0], away[1])
        return np.asarray(np.where(near.corner, round_it, _across(self._normals.take(side, axis=1), y, rest, begins)))

    def _closest_side(self, y: Array) -> tuple[Ints, Array, Array]:
        """Closest side (k,) of points (2, k), distance (k,) along the side, and vector from the closest point."""
        tangents, first, low, high = self._sides
        begins, back = self._complex
        # components along and across every side, from its first point
        w = ((y[0] + 1j * y[1]) - begins) * back
        on_line = w.real
        t = np.minimum(np.maximum(on_line, low[:, None]), high[:, None])
        beyond, across = on_line - t, w.imag
        nearest = (beyond * beyond + across * across).argmin(axis=0)
        t = t[nearest, np.arange(y.shape[1])]
        return nearest, t, y - first.take(nearest, axis=1) - t * tangents.take(nearest, axis=1)

    @cached_property
    def _complex(self) -> tuple[Complex, Complex]:
        """First points and conjugate tangents of the sides, (m+2, 1) both, as complex numbers."""
        tangents, first, _, _ = self._sides
        return (first[0] + 1j * first[1])[:, None], (tangents[0] - 1j * tangents[1])[:, None]

    @cached_property
    def _sides(self) -> tuple[Array, Array, Array, Array]:
        """Tangents and first points (2, m+2) of the sides, and their range (m+2,) of distances from the first point."""
        tau = self._tangents
        length = np.hypot(*np.diff(self.points, axis=1))
        if self.closed:
            return tau, self.points[:, :-1], np.zeros(length.size), length
        tangents = np.column_stack([_left(tau[:, :1]), tau, -_left(tau[:, -1:])])
        first = np.column_stack([self.points[:, :1], self.points[:, :-1], self.points[:, -1:]])
        back = self._back
        return (
            tangents,
            first,
            np.append(-back[0], np.zeros(length.size + 1)),
            np.concatenate([[0.0], length, back[1:]]),
        )

    @cached_property
    def _normals(self) -> Array:
        """Normals (2, m+2) to the left of the sides."""
        return _left(self._sides[0])

    @cached_property
    def _back(self) -> Array:
        """Lengths (2,) of the backward sides at both ends of the edge."""
        common = self._common_point
        tau, ends = -_left(self._tangents[:, [0, -1]]), self.points[:, [0, -1]]
        length = np.hypot(*np.diff(self.points, axis=1))
        lengths = []
        for i in (0, 1):
            far, along = _crossing(ends[:, i], tau[:, i], self.points[:, :-1], self._tangents)
            meets = (far > _SAME) & (along >= 0.0) & (along <= length)
            lengths.append(min(float(far[meets].min(initial=np.inf)), float(common[i])))
        return np.array(lengths)

    @property
    def _common_point(self) -> Array:
        """Lengths (2,) of the backward sides up to their common point; infinite without a common point."""
        tau, ends = -_left(self._tangents[:, [0, -1]]), self.points[:, [0, -1]]
        far, along = _crossing(ends[:, 0], tau[:, 0], ends[:, 1:], tau[:, 1:])
        apart = np.append(far, along)
        return apart if (apart > _SAME).all() else np.full(2, np.inf)

    @cached_property
    def _closed_behind(self) -> bool:
        """True if the body ends where its two backward sides meet."""
        return not self.closed and bool(np.isfinite(self._back).all() and (self._back == self._common_point).all())

    @cached_property
    def closed(self) -> bool:
        """True if the edge is closed."""
        return bool(np.all(self.points[:, 0] == self.points[:, -1]))

    @property
    def _tangents(self) -> Array:
        along = np.diff(self.points, axis=1)
        return np.asarray(along / np.hypot(along[0], along[1]))


@dataclass(frozen=True, eq=False)
class Graph:
    """An edge y₂ = f(y₁), or y₁ = f(y₂) if ``across``, with y₁ in ``span``; free where ``sign`` (y₂ − f) > 0.

    ``f`` is a polynomial of the distance from the middle of the span. About a distant origin the terms of a narrow
    graph would exceed their sum a thousandfold, with a corresponding round-off of the edge.
    """

    f: Polynomial
    span: tuple[float, float]
    across: bool
    sign: float

    @cached_property
    def corners(self) -> Corners:
        """Corners at both ends."""
        ends = np.array(self.span if self._forwards else self.span[::-1])
        points, tau, _ = self._at(ends)
        before = np.column_stack([_left(tau[:, :1]), tau[:, 1:]])
        behind = np.column_stack([tau[:, :1], -_left(tau[:, 1:])])
        return Corners(points, (before, behind), (_left(before), _left(behind)))

    @cached_property
    def tips(self) -> tuple[Array, Array]:
        """Convex corners and points of the ``chain``, (2, t), and the directions (2, t) of their contact forces."""
        v = np.linspace(*self.span, _PIECES + 1)[1:-1]
        points, tau, _ = self._at(v)
        ends, out = _tips(self.corners)
        return np.column_stack([ends, points]), np.column_stack([out, _left(tau)])

    @property
    def straight(self) -> bool:
        """True for a straight graph."""
        return not self.f.coef[2:].any()

    @cached_property
    def extent(self) -> float:
        """Largest depth behind the edge that counts as penetration, a share of the edge's size."""
        low, high = self._at(np.array(self.span))[0].T
        return 0.25 * float(np.hypot(*(high - low)))

    @property
    def chain(self) -> Array:
        """Boundary polyline (2, m+1), free side to the left."""
        v = np.linspace(*self.span, _PIECES + 1)
        return self._at(v if self._forwards else v[::-1])[0]

    def near(self, y: Array) -> Near:
        """Distance data of points (2, k)."""
        at = self._nearest(y)
        point, tau, kappa = self._at(at)
        away = y - point
        side = _left(tau)
        d, beyond = (side * away).sum(axis=0), (tau * away).sum(axis=0)
        first, last = self.span if self._forwards else self.span[::-1]
        past = ((at == first) & (beyond < 0.0)) | ((at == last) & (beyond > 0.0))
        r = np.hypot(away[0], away[1])
        past &= r > 0.0
        distance, normal = np.where(past, r, d), np.where(past, away / np.where(past, r, 1.0), side)
        bend = np.where(past, 1.0 / np.where(past, r, 1.0), kappa / (1.0 + kappa * d))
        # behind the edge the backward sides may be nearer; beyond the ends they are the nearest
        if (behind := d < 0.0).any():
            corners, end = self.corners, np.array([at == first, at == last])
            for i, back in ((0, corners.normals[0]), (1, corners.normals[1])):
                beside = back[:, i] @ (y - corners.points[:, i, None])
                nearer = behind & np.where(past, end[i], (beside > d) & (beside <= 0.0))
                distance = np.where(nearer, beside, distance)
                normal = np.where(nearer, back[:, i, None], normal)
                bend = np.where(nearer, 0.0, bend)
        return Near(distance, normal, bend, past & ~behind)

    def exact_distance(self, _y: Array, rest: Array, near: Near) -> Array:
        """d (k,) of points ``y`` + ``rest`` (2, k), up to round-off of the points of the edge, from data at ``y``."""
        return np.asarray(near.distance + (near.normal * rest).sum(axis=0))

    def _nearest(self, y: Array) -> Array:
        """Axis coordinate (k,) of the closest point of the edge to points (2, k)."""
        low, high = self.span
        v, w = y[::-1] if self.across else y
        samples, away = self._samples
        at = samples[(np.array([v, w, np.ones_like(v)]).T @ away).argmax(axis=1)]
        for _ in range(_NEWTON_STEPS):
            f, slope, second = self._f(at)
            rest = f - w
            bent = 1.0 + slope**2 + rest * second
            # beyond the centre of curvature the stationary point is a maximum of the distance: no step
            step = np.where(bent > 0.0, (at - v + rest * slope) / np.where(bent > 0.0, bent, 1.0), 0.0)
            moved = np.minimum(np.maximum(at - step, low), high)
            done = float(np.abs(moved - at).max(initial=0.0)) <= _ARRIVED * (high - low)
            at = moved
            if done:
                break
        return np.asarray(at)

    @cached_property
    def _samples(self) -> tuple[Array, Array]:
        """Axis coordinates (n,) of samples s, and a matrix from (y, 1) to −|s − y|² up to a term independent of s."""
        v = np.linspace(*self.span, _SAMPLES)
        f, _, _ = self._f(v)
        return v, np.array([2.0 * v, 2.0 * f, -(v**2 + f**2)])

    def _f(self, v: Array) -> tuple[Array, Array, Array]:
        """f and its first two derivatives at ``v`` (k,), (k,) all, by Horner's scheme."""
        f = slope = half = np.zeros_like(v)
        u = v - 0.5 * (self.span[0] + self.span[1])
        for coefficient in self.f.coef[::-1].tolist():
            half = half * u + slope
            slope = slope * u + f
            f = f * u + coefficient
        return f, slope, 2.0 * half

    @property
    def _forwards(self) -> bool:
        """True if the edge runs in the direction of the axis with the free side to its left."""
        return (self.sign > 0.0) != self.across

    def _at(self, v: Array) -> tuple[Array, Array, Array]:
        """Points and unit tangents (2, k) at ``v`` (k,), the free side to the left, and κ (k,)."""
        f, slope, second = self._f(v)
        long = np.hypot(1.0, slope)
        tau = np.array([np.ones_like(v), slope]) / long * (1.0 if self._forwards else -1.0)
        point = np.array([v, f])
        kappa = -self.sign * second / long**3  # convex where the graph bends away from the free side
        return (point[::-1], tau[::-1], kappa) if self.across else (point, tau, kappa)


Outline = HalfPlane | Broken | Graph


def outline_of(contact: EdgeContact, origin: Array, unit: float, places: Sequence[Array] = ()) -> Outline:
    """Outline of a contact, dimensionless with ``origin`` (2,) (m) and length ``unit`` (m).

    Corner points near ``places`` (2,) are replaced by these.
    """
    match contact:
        case HalfPlaneContact():
            normal = np.array(contact.normal) / np.abs(contact.normal).max()
            return HalfPlane((np.array(contact.point) - origin) / unit, normal / np.hypot(*normal))
        case LineContact():
            points = (np.array(contact.points).T - origin[:, None]) / unit
            for place in places:
                points[:, np.hypot(*(points - place[:, None])) < _SAME] = place[:, None]
            return Broken(points if contact.side == "left" else points[:, ::-1])
        case FunctionContact():
            across = contact.axis == "y"
            first, other = origin[::-1] if across else origin
            low, high = sorted((end - first) / unit for end in contact.range)
            middle = Polynomial([first + unit * 0.5 * (low + high), unit])
            f = (Polynomial(contact.coefficients)(middle) - other) / unit
            return Graph(f, (float(low), float(high)), across, 1.0 if contact.side == "above" else -1.0)


def ends_at(outline: Outline, place: Array, near: float) -> tuple[Array | None, Array | None]:
    """Directions (2,) of the edge away from a ``place`` (2,) on it: forward, free side to the left, and backward.

    None for a direction in which the edge ends there.
    """
    corners = outline.corners
    at = np.flatnonzero(np.hypot(*(corners.points - place[:, None])) <= near)
    normal = outline.near(place[:, None]).normal[:, 0]
    ahead = np.array([normal[1], -normal[0]])
    if at.size == 0:
        return ahead, -ahead
    corner, last = int(at[0]), (outline.points if isinstance(outline, Broken) else corners.points).shape[1] - 1
    round_it = isinstance(outline, Broken) and outline.closed
    return (
        corners.tangents[1][:, corner] if round_it or corner < last else None,
        -corners.tangents[0][:, corner] if round_it or corner > 0 else None,
    )


def _tips(corners: Corners) -> tuple[Array, Array]:
    """Convex corners (2, t) and the sums of their sides' normals (2, t)."""
    some = corners.convex
    return corners.points[:, some], (corners.normals[0] + corners.normals[1])[:, some]


def _crossing(place: Array, ahead: Array, places: Array, aheads: Array) -> tuple[Array, Array]:
    """Distances (k,) along a straight line to its crossings with others, and along the others from ``places`` (2, k).

    Infinite for parallel lines.
    """
    across = ahead[0] * aheads[1] - ahead[1] * aheads[0]
    parallel = np.abs(across) <= _SAME
    x, y = places - place[:, None]
    share = 1.0 / np.where(parallel, 1.0, across)
    far, along = (x * aheads[1] - y * aheads[0]) * share, (x * ahead[1] - y * ahead[0]) * share
    return np.where(parallel, np.inf, far), np.where(parallel, np.inf, along)


def _across(normal: Array, y: Array, rest: Array, point: Array) -> Array:
    """n·(y + rest − point) of points (2, k), with normals and points (2, k) or (2, 1), without cancellation."""
    away, more = summed(y, -point)
    (a, a_error), (b, b_error) = multiplied(normal[0], away[0]), multiplied(normal[1], away[1])
    value, error = summed(a, b)
    return np.asarray(value + (error + a_error + b_error + (normal * (more + rest)).sum(axis=0)))


def _left(tangents: Array) -> Array:
    """Vectors (2, k) turned counter-clockwise by a right angle."""
    return np.array([-tangents[1], tangents[0]])
