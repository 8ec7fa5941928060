"""Rigid lines, half-planes and functions that beams may touch: stated well, in proportion, no beam behind them.

======  =============================================================================
symbol  meaning
======  =============================================================================
P, τ    a corner of a rigid line, and the unit vector along the piece that begins there
n       normal towards the free side
d       distance of a place from what is rigid, negative behind it, m
t       thickness of the beam, m; without meaning for a beam that is a line
======  =============================================================================

The beam's edge lies on the free side where d ≥ t/2, with t of the place; for a line, where d ≥ 0.  A place is behind a
line if the nearest place of the line is no end of it and the place lies on the other side.

What is compared is in lengths of the beam, so that bounds stand on dimensionless numbers only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import combinations, pairwise
from math import inf, isfinite

import numpy as np
from numpy.polynomial import polynomial

from cprbm_scene.check_overlaps import OVERLAP
from cprbm_scene.check_shapes import MEETING, SHORTEST, is_beam, wrong_polynomial
from cprbm_scene.freedoms import unit
from cprbm_scene.geometry import Array, arc_length, distance, points_on, scaled
from cprbm_scene.mistakes import Mistake
from cprbm_scene.sampling import least
from cprbm_scene.statement import (
    Beam,
    EdgeContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    Point,
    Polynomial,
    Scene,
)

MOST_POINTS = 1001
BACKWARDS = 1e-3  # 1 + the cosine of the angle between two pieces: less is a line that turns back on itself
_SAMPLES = 2001  # of a beam
_ON_EDGE = 257  # samples of a function, from which the nearest place is sought
_NEWTON_STEPS = 20

Distance = Callable[[Array], Array]


def wrong_edges(scene: Scene) -> Iterator[Mistake]:
    """Lines, half-planes and functions that are none, are out of proportion, or meet one beam in two contacts."""
    seen: dict[tuple[object, ...], str] = {}
    for name, contact in scene.contacts.items():
        if not isinstance(contact, EdgeContact):
            continue
        stated = tuple(value for key, value in contact if key not in {"thick", "paper"})
        if stated in seen:
            yield Mistake(f"contacts.{name}", f"the beam and the edge of contacts.{seen[stated]} again", "each once")
        seen.setdefault(stated, name)
        beam = scene.beams.get(contact.beam)
        if (
            beam is not None
            and is_beam(beam)
            and (mistake := _wrong(name, contact, arc_length(beam.curve))) is not None
        ):
            yield mistake


def edge_overlaps(scene: Scene) -> Iterator[Mistake]:
    """Beams that are behind what they may touch, or overlap it, where they start."""
    for name, contact in scene.contacts.items():
        if not isinstance(contact, EdgeContact):
            continue
        beam = scene.beams.get(contact.beam)
        if beam is None or not is_beam(beam):
            continue
        length = arc_length(beam.curve)
        if _wrong(name, contact, length) is not None:
            continue
        apart = _apart(contact, beam, length)
        u = np.union1d(np.linspace(0.0, 1.0, _SAMPLES), beam.knots)
        depth = -least(apart, u)
        measure, of = (beam.thinnest / length, "its thickness") if contact.thick else (1.0, "its length")
        held = any(getattr(end, "point", None) in _own_points(scene, contact) for end in (beam.start, beam.end))
        allowed = max(OVERLAP * measure, MEETING if held else 0.0)
        if depth > allowed:
            yield Mistake(
                f"contacts.{name}",
                f"the beam {contact.beam!r} on the wrong side of what it may touch, or overlapping it, at the start by "
                f"{depth * length:.3g} m, {depth / measure:.3g} of {of}",
                f"a beam that touches from the free side or is apart (overlap at most {OVERLAP:g} of {of})",
            )


def distance_from(contact: EdgeContact, size: float) -> Distance:
    """d over ``size`` of places (k, 2) over ``size``: a function of these."""
    match contact:
        case LineContact():
            points = np.array(contact.points) / size
            return lambda p: _from_line(points, 1.0 if contact.side == "left" else -1.0, p, closed=contact.closed)
        case HalfPlaneContact():
            point, n = np.array(contact.point) / size, unit(contact.normal)
            return lambda p: np.asarray((p - point) @ n)
        case FunctionContact():
            curve = scaled(contact.curve, size)
            assert isinstance(curve, Polynomial)
            return lambda p: _from_function(curve, 1.0 if contact.side == "above" else -1.0, p)


def _apart(contact: EdgeContact, beam: Beam, length: float) -> Distance:
    """d − t/2 at fractions u (k,) of the beam, in its lengths."""
    curve, away = scaled(beam.curve, length), distance_from(contact, length)

    def apart(u: Array) -> Array:
        half = 0.5 * beam.thickness_at(u) / length if contact.thick else 0.0
        return np.asarray(away(points_on(curve, u)) - half)

    return apart


def _from_line(points: Array, sign: float, p: Array, *, closed: bool) -> Array:
    along = np.diff(points, axis=0)
    length = np.hypot(along[:, 0], along[:, 1])
    tau = along / length[:, None]
    n = sign * np.column_stack((-tau[:, 1], tau[:, 0]))
    r = p[:, None, :] - points[None, :-1]
    t = np.clip((r * tau).sum(axis=2), 0.0, length)
    away = r - t[:, :, None] * tau
    nearest = np.hypot(away[:, :, 0], away[:, :, 1]).argmin(axis=1)
    every = np.arange(len(p))
    away, t = away[every, nearest], t[every, nearest]
    # at a corner both of its pieces say on which side a place is
    other = np.where(t <= 0.0, nearest - 1, np.where(t >= length[nearest], nearest + 1, nearest))
    other = other % len(tau) if closed else other
    beyond = (other < 0) | (other >= len(tau))
    towards = n[nearest] + n[np.clip(other, 0, len(tau) - 1)]
    behind = ~beyond & ((away * towards).sum(axis=1) < 0.0)
    return np.asarray(np.where(behind, -1.0, 1.0) * np.hypot(away[:, 0], away[:, 1]))


def _from_function(curve: Polynomial, sign: float, p: Array) -> Array:
    f = np.array(curve.coefficients)
    f1 = polynomial.polyder(f)
    f2 = polynomial.polyder(f1)
    low, high = sorted(curve.range)
    v, w = (p[:, 0], p[:, 1]) if curve.axis == "x" else (p[:, 1], p[:, 0])
    samples = np.linspace(low, high, _ON_EDGE)
    squares = (samples - v[:, None]) ** 2 + (polynomial.polyval(samples, f) - w[:, None]) ** 2
    at = samples[squares.argmin(axis=1)]
    for _ in range(_NEWTON_STEPS):
        slope, rest = polynomial.polyval(at, f1), polynomial.polyval(at, f) - w
        bent = 1.0 + slope**2 + rest * polynomial.polyval(at, f2)
        # beyond the centre of curvature the place is farthest; it stays at its sample
        step = np.where(bent > 0.0, (at - v + rest * slope) / np.where(bent > 0.0, bent, 1.0), 0.0)
        at = np.clip(at - step, low, high)
    slope, rest = polynomial.polyval(at, f1), w - polynomial.polyval(at, f)
    side = sign * (rest - slope * (v - at))
    beyond = ((at <= low) & (v - at + rest * slope < 0.0)) | ((at >= high) & (v - at + rest * slope > 0.0))
    return np.asarray(np.where(beyond | (side >= 0.0), 1.0, -1.0) * np.hypot(v - at, rest))


def _own_points(scene: Scene, contact: EdgeContact) -> set[str]:
    """Points of the body that the edge is fixed to."""
    body = scene.bodies.get(contact.body)
    return set() if body is None else set(body.points)


def _wrong(name: str, contact: EdgeContact, length: float) -> Mistake | None:
    """What is wrong with an edge for a beam of that ``length``."""
    key = f"contacts.{name}"
    match contact:
        case LineContact():
            if (mistake := _wrong_line(f"{key}.points", contact, length)) is not None:
                return mistake
            places = contact.points
        case HalfPlaneContact():
            if contact.normal == (0.0, 0.0):
                return Mistake(f"{key}.normal", "[0, 0]", "a direction, at least one number not zero")
            places = (contact.point,)
        case FunctionContact():
            if (mistake := wrong_polynomial(key, contact.curve)) is not None:
                return mistake
            places = (contact.curve.start, contact.curve.end)
            extent = arc_length(contact.curve)
            if not SHORTEST * length <= extent < inf:
                found = f"an edge of {extent:.3g} m, which is {extent / length:.3g} of the beam's length"
                return Mistake(f"{key}.range", found, f"at least {SHORTEST:g} of the beam's length")
    largest = max(abs(coordinate) for place in places for coordinate in place)
    if not (isfinite(largest) and SHORTEST * largest <= length):
        return Mistake(
            key,
            f"coordinates up to {largest:.3g} m beside a beam of {length:.3g} m",
            f"coordinates of which the beam's length is at least {SHORTEST:g}",
        )
    return None


def _wrong_line(key: str, contact: LineContact, length: float) -> Mistake | None:
    points = contact.points
    if len(points) > MOST_POINTS:
        return Mistake(key, f"{len(points)} points", f"at most {MOST_POINTS} of them")
    for i, (one, other) in enumerate(pairwise(points)):
        if not distance(one, other) >= SHORTEST * length:
            found = f"a point {distance(one, other):.3g} m from the one before"
            return Mistake(f"{key}[{i + 1}]", found, f"at least {SHORTEST:g} of the beam's length between them")
    tau = [unit((b[0] - a[0], b[1] - a[1])) for a, b in pairwise(points)]
    for i, (before, behind) in enumerate(pairwise([*tau, tau[0]] if contact.closed else tau)):
        if 1.0 + float(before @ behind) < BACKWARDS:
            return Mistake(f"{key}[{i + 1}]", "a point at which the line turns back on itself", "a line that goes on")
    for (i, (a, b)), (j, (c, d)) in combinations(enumerate(pairwise(points)), 2):
        if (
            j > i + 1
            and not (contact.closed and j - i == len(tau) - 1)
            and _turn(a, b, c) * _turn(a, b, d) <= 0.0
            and _turn(c, d, a) * _turn(c, d, b) <= 0.0
        ):
            found = f"a piece from point {j} to {j + 1} that meets the one from {i} to {i + 1}"
            return Mistake(key, found, "a line that does not meet itself")
    return None


def _turn(a: Point, b: Point, c: Point) -> float:
    """Twice the signed area of the triangle a, b, c."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
