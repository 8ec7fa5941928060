"""Points of curves and closest points on curves, compiled.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
C(η)       point of a curve, with local parameter η on a piece; C', C'' by η
x          point whose closest point is sought
R          distance |x − C|, negative beyond the curve
T(η)       half thickness; a point contact with the force F on a beam counts as T − F c/2, :mod:`cprbm.contact.gap`
=========  =====================================================================================

The closest point minimises R − T(η): Newton's method on

    R (R − T)' = (C − x)·C' − R T',    R (R − T)'' ≈ |C'|² + (C − x)·C'' − R T''.

A step ends at the border of a piece, and the search goes on in the next piece.  The search rests at the ends of an
open curve, and at a convex corner of a polyline or of the thickness.  There the steps of both pieces lead to the
corner, and the closest point does not move along the curve.
"""

from math import copysign, hypot, sqrt

import numpy as np

from cprbm.chain import compiled, compiled_inner
from cprbm.contact.curve import STENCIL, CurveArrays
from cprbm_scene.answer import Array, Ints

STEPS = 60
"""Iterations; Newton's method needs fewer than ten, crossing a curve piece by piece the rest."""

ARRIVED = 1e-13
"""Change of the parameter at which the search ends: round-off of a piece."""

ROUNDED = 2e-15
"""Change of the place, over the longest beam, at which the search ends on short pieces: round-off of positions."""

LEAST_CURVATURE = 0.1
"""Share of |C'|² below which the second derivative is replaced by |C'|²: a step of descent far from the minimum."""

PASSED_OVER = 1e-9
"""Distance, over the longest beam, by which chords must be farther away to be passed over: more than round-off."""

GROUPS = 64
"""Most groups of pieces that wait in a search: half of them hold 2^32 pieces."""

BEYOND = 0.1
"""Share of the half thicknesses, or of a piece for lines, by which a place is on the other side of a beam."""

TURNED_BACK = 2.6
"""Turn of a beam between two places, rad, from which the beam may touch itself: nearly half a turn."""


@compiled_inner
def lost_at(curves: CurveArrays, piece: int, xi: float, order: int) -> float:  # pragma: no cover
    """c, c' or c'' of a piece."""
    value = 0.0
    for k in range(curves.lost.shape[1] - 1, order - 1, -1):
        factor = 1.0 if order == 0 else (k if order == 1 else k * (k - 1.0))
        value = value * xi + factor * curves.lost[piece, k]
    return value


@compiled_inner
def curve_jet(
    z: Array, curves: CurveArrays, piece: int, xi: float
) -> tuple[float, float, float, float, float, float]:  # pragma: no cover
    """C, C' and C'' at once."""
    x = y = u = v = k = m = 0.0
    for i in range(STENCIL):
        node, p, q = curves.stencil[piece, i], curves.real[piece, i], curves.imaginary[piece, i]
        zx, zy = z[node], z[node + 1]
        a = p[0] + xi * (p[1] + xi * (p[2] + xi * p[3]))
        b = q[0] + xi * (q[1] + xi * (q[2] + xi * q[3]))
        x += a * zx - b * zy
        y += b * zx + a * zy
        a, b = p[1] + xi * (2.0 * p[2] + 3.0 * xi * p[3]), q[1] + xi * (2.0 * q[2] + 3.0 * xi * q[3])
        u += a * zx - b * zy
        v += b * zx + a * zy
        a, b = 2.0 * p[2] + 6.0 * xi * p[3], 2.0 * q[2] + 6.0 * xi * q[3]
        k += a * zx - b * zy
        m += b * zx + a * zy
    return x, y, u, v, k, m


@compiled_inner
def curve_point(z: Array, curves: CurveArrays, piece: int, xi: float) -> tuple[float, float]:  # pragma: no cover
    """C."""
    return curve_jet(z, curves, piece, xi)[:2]


@compiled_inner
def weight_at(
    curves: CurveArrays, piece: int, i: int, xi: float, order: int
) -> tuple[float, float]:  # pragma: no cover
    """Real and imaginary part of the weight w_i of a piece, or of w_i' with ``order`` 1."""
    p, q = curves.real[piece, i], curves.imaginary[piece, i]
    if order == 1:
        return p[1] + xi * (2.0 * p[2] + 3.0 * xi * p[3]), q[1] + xi * (2.0 * q[2] + 3.0 * xi * q[3])
    return p[0] + xi * (p[1] + xi * (p[2] + xi * p[3])), q[0] + xi * (q[1] + xi * (q[2] + xi * q[3]))


@compiled_inner
def thickness_between(curves: CurveArrays, piece: int, xi: float, foot: int, eta: float) -> float:  # pragma: no cover
    """Sum of the half thicknesses of two points."""
    return float(
        curves.thickness[piece] + xi * curves.thickening[piece] + curves.thickness[foot] + eta * curves.thickening[foot]
    )


@compiled_inner
def depth_beyond(curves: CurveArrays, piece: int, thickness: float) -> float:  # pragma: no cover
    """Largest overlap of two beams in contact; with a larger overlap a point is on the other side of a beam."""
    return BEYOND * (thickness if thickness > 0.0 else curves.span[piece])


@compiled_inner
def border_pieces(curves: CurveArrays, curve: int, piece: int, step: float) -> tuple[int, int]:  # pragma: no cover
    """Pieces behind and before the border that a step from a piece crosses; twice the piece at an end of the curve."""
    first, last = curves.first[curve], curves.last[curve]
    if piece == (last if step > 0.0 else first):
        return (first, last) if curves.closed[curve] else (piece, piece)
    return (piece + 1, piece) if step > 0.0 else (piece, piece - 1)


@compiled_inner
def moved_along(
    curves: CurveArrays, curve: int, piece: int, xi: float, step: float
) -> tuple[int, float, bool]:  # pragma: no cover
    """Piece and parameter behind a step, in pieces, across borders; True if the step ends at an end of the curve."""
    xi += step
    while xi > 1.0 or xi < 0.0:
        behind, before = border_pieces(curves, curve, piece, xi)
        if behind == before:
            return piece, min(1.0, max(0.0, xi)), True
        if xi > 1.0:
            piece, xi = behind, (xi - 1.0) * curves.span[before] / curves.span[behind]
        else:
            piece, xi = before, 1.0 + xi * curves.span[behind] / curves.span[before]
    return piece, xi, False


@compiled_inner
def is_corner(
    z: Array, curves: CurveArrays, piece: int, before: int, x: float, y: float, side: float
) -> bool:  # pragma: no cover
    """True if the border of two pieces is closest to (x, y): the steps of both pieces lead to the border.

    R is negative with a negative ``side``.
    """
    _, _, ax, ay, _, _ = curve_jet(z, curves, before, 1.0)
    px, py, bx, by, _, _ = curve_jet(z, curves, piece, 0.0)
    R = copysign(hypot(px - x, py - y), side)
    back, ahead = R * curves.thickening[before], R * curves.thickening[piece]
    return bool((px - x) * ax + (py - y) * ay < back and ahead < (px - x) * bx + (py - y) * by)


@compiled_inner
def closest_point(
    z: Array,
    curves: CurveArrays,
    curve: int,
    x: float,
    y: float,
    piece: int,
    eta: float,
    force: float,
    side: float,
) -> tuple[int, float, bool]:  # pragma: no cover
    """Closest point on a curve near a first guess: piece, parameter, True at an end, a corner or a circle's centre.

    ``force`` is F of a point contact, 0 otherwise.  R is negative for a point beyond the curve, seen from ``side``.
    """
    if curves.is_point[curve]:
        return piece, 0.0, True
    for _ in range(STEPS):
        px, py, tx, ty, kx, ky = curve_jet(z, curves, piece, eta)
        px, py = px - x, py - y
        R, square = hypot(px, py), tx * tx + ty * ty
        if side * (ty * px - tx * py) < 0.0:
            R = -R
        slope = px * tx + py * ty - R * (curves.thickening[piece] - 0.5 * force * lost_at(curves, piece, eta, 1))
        curvature = square + px * kx + py * ky + 0.5 * R * force * lost_at(curves, piece, eta, 2)
        step = -slope / (curvature if curvature > LEAST_CURVATURE * square else square)
        step = min(1.0, max(-1.0, step))
        arrived, rests = abs(step) < max(ARRIVED, ROUNDED / sqrt(square)), not 0.0 <= eta + step <= 1.0
        behind, before = border_pieces(curves, curve, piece, step) if rests else (piece, piece)
        rests = rests and behind == before
        if arrived or behind == before:
            # within round-off of a border the foot stays on the piece, whatever the direction of the next piece
            eta = min(1.0, max(0.0, eta + step))
        elif is_corner(z, curves, behind, before, x, y, R):
            return behind, 0.0, True
        else:
            # the next piece has another direction behind a corner: the search stops at the border
            piece, eta = behind if step > 0.0 else before, 0.0 if step > 0.0 else 1.0
        if arrived or (rests and abs(step) < 1.0):
            break
    return piece, eta, rests


@compiled_inner
def write_chords(z: Array, curves: CurveArrays, curve: int, chords: Array) -> None:  # pragma: no cover
    """Write the chords (2 pieces, 5) of a curve's pieces and of groups of pieces: both ends and a distance.

    Row 2 ``first`` + k holds group k: the groups 2k and 2k + 1 together, from the number of pieces on a single piece.
    The chords of a group's pieces lie within the distance of the group's chord.
    """
    base, count = 2 * curves.first[curve], curves.last[curve] + 1 - curves.first[curve]
    for piece in range(curves.first[curve], curves.last[curve] + 1):
        chord = chords[piece + curves.first[curve] + count]
        chord[0], chord[1] = curve_point(z, curves, piece, 0.0)
        chord[2], chord[3] = curve_point(z, curves, piece, 1.0)
        chord[4] = 0.0
    for k in range(count - 1, 0, -1):
        chord, one, two = chords[base + k], chords[base + 2 * k], chords[base + 2 * k + 1]
        chord[0], chord[1], chord[2], chord[3] = one[0], one[1], two[2], two[3]
        aside = max(_to_chord(chord, one[2], one[3])[1], _to_chord(chord, two[0], two[1])[1])
        chord[4] = max(one[4], two[4]) + aside


@compiled_inner
def _to_chord(chord: Array, x: float, y: float) -> tuple[float, float]:  # pragma: no cover
    """Parameter of the closest point of a chord, and its distance."""
    ax, ay = chord[0], chord[1]
    cx, cy = chord[2] - ax, chord[3] - ay
    square = cx * cx + cy * cy
    at = min(1.0, max(0.0, ((x - ax) * cx + (y - ay) * cy) / square)) if square > 0.0 else 0.0
    return at, hypot(ax + at * cx - x, ay + at * cy - y)


@compiled_inner
def closest_of(
    z: Array,
    curves: CurveArrays,
    curve: int,
    chords: Array,
    waiting: Ints,
    guess: int,
    x: float,
    y: float,
    turn: tuple[float, float],
) -> tuple[int, float, float]:  # pragma: no cover
    """Piece and parameter of the closest chord of all pieces, and its distance: a first guess.

    A group of pieces farther away than a known piece is passed over.

    Args:
        z, curves, curve: the state and the curve.
        chords: of :func:`write_chords`.
        waiting: scratch space (GROUPS,).
        guess: a piece; a near one saves time.
        x, y: the point.
        turn: an angle, and the least turn of a piece's link from there; the distance is inf without any such piece.
    """
    first, count = curves.first[curve], curves.last[curve] + 1 - curves.first[curve]
    best, found, share, size = np.inf, first, 0.0, 1
    bound = _to_chord(chords[guess + first + count], x, y)[1] if turn[1] == 0.0 else np.inf
    waiting[0] = 1
    while size > 0:
        size -= 1
        group = waiting[size]
        piece = first + group - count
        at, distance = _to_chord(chords[2 * first + group], x, y)
        if distance - chords[2 * first + group, 4] > min(best, bound) + PASSED_OVER:
            continue
        if group < count:
            waiting[size], waiting[size + 1], size = 2 * group + 1, 2 * group, size + 2
        elif turn[1] > 0.0 and abs(z[curves.angle[piece]] - turn[0]) < turn[1]:
            continue
        elif distance < best or (distance == best and piece < found):
            best, found, share = distance, piece, at
    return found, share, best


@compiled
def closest_chord(
    z: Array, curves: CurveArrays, curve: int, x: float, y: float
) -> tuple[int, float, float]:  # pragma: no cover
    """Piece and parameter of the closest chord of all pieces, and its distance."""
    chords, waiting = np.empty((2 * curves.span.size, 5)), np.empty(GROUPS, np.int64)
    write_chords(z, curves, curve, chords)
    return closest_of(z, curves, curve, chords, waiting, curves.first[curve], x, y, (0.0, 0.0))


@compiled
def curve_boxes(z: Array, curves: CurveArrays) -> Array:  # pragma: no cover
    """Boxes (curves, 4) that hold the curves with their thickness: least x and y, largest x and y.

    A point of a piece is at most max |C''|/8 away from a point of the chord; C'' is linear along a piece.
    """
    boxes = np.array([np.inf, np.inf, -np.inf, -np.inf]) * np.ones((curves.first.size, 1))
    for curve in range(curves.first.size):
        box = boxes[curve]
        for piece in range(curves.first[curve], curves.last[curve] + 1):
            ax, ay, _, _, kx, ky = curve_jet(z, curves, piece, 0.0)
            bx, by, _, _, mx, my = curve_jet(z, curves, piece, 1.0)
            room = sqrt(max(kx * kx + ky * ky, mx * mx + my * my)) / 8.0
            room += max(curves.thickness[piece], curves.thickness[piece] + curves.thickening[piece])
            box[0], box[1] = min(box[0], min(ax, bx) - room), min(box[1], min(ay, by) - room)
            box[2], box[3] = max(box[2], max(ax, bx) + room), max(box[3], max(ay, by) + room)
    return boxes
