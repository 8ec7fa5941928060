"""Boundaries of rigid solids, corners and sharp bends of rigid curves.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
a, b     unit tangents of the pieces before and behind a border of two pieces
h        length of a beam's link
=======  ====================================================================================

The solid behind an open edge ends where the edge ends.  From there the boundary goes back at right angles, until both
sides meet.  Where a side comes to the edge from behind instead, the side ends, and the other end has no side: the
solid lies between the edge and the side.

At a convex corner the boundary turns away from the beam.  The corner is a place of contact: a point of the boundary
before the beam's curve.  The boundary cannot pass the beam between two joints there.  In a fine polyline several
corners within a link are places.  A circle smaller than a link is a corner too.  A bend of a smooth edge with a radius
below a link is a curve of its own, on which a point of contact moves.
"""

from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from cprbm.contact.curve import BEND, CORNER, Curve
from cprbm_scene.answer import Array, Ints

KINK = 1e-6
"""Least turn of a corner, rad: borders of a smooth edge's pieces turn by round-off."""

BEHIND = 1e-9
"""Distance from an edge's end, over the longest beam, up to which a side does not meet the edge: round-off."""


class Corner(NamedTuple):
    """Number of the curve of a corner or a bend, and numbers of the edge's pieces ``before`` and ``behind``.

    The curve of a corner is a point.  Piece ``behind`` of the edge is the first piece of a bend's curve.
    """

    curve: int
    before: int
    behind: int


def sides_behind(points: Array, side: int, reach: float) -> tuple[Array, Array]:
    """Points (k, 2) of the boundary before the first and behind the last point of an edge.

    Args:
        points: of the edge (k, 2).
        side: side of the beam, +1 left.
        reach: length of a side that meets nothing.
    """
    first, last = (chord / np.hypot(*chord) for chord in (points[0] - points[1], points[-1] - points[-2]))
    ends, ways = (points[0], points[-1]), [side * np.array([-first[1], first[0]]), side * np.array([last[1], -last[0]])]
    crossings = [
        [_crossing(end, way, a, b - a) for a, b in pairwise(points)] for end, way in zip(ends, ways, strict=True)
    ]
    lengths = [
        min((far for far, share in found if far > BEHIND and 0.0 <= share <= 1.0), default=np.inf)
        for found in crossings
    ]
    meet = _crossing(ends[0], ways[0], ends[1], ways[1])
    if np.all((meet > BEHIND) & (meet < np.minimum(lengths, reach))):
        lengths = meet.tolist()
    elif min(lengths) < reach:
        lengths = [length if length < reach else 0.0 for length in lengths]
    begin, end = (end + min(length, reach) * way for end, length, way in zip(ends, lengths, ways, strict=True))
    return begin[None][: int(lengths[0] > 0.0)], end[None][: int(lengths[1] > 0.0)]


def _crossing(start: Array, way: Array, other: Array, along: Array) -> Array:
    """Shares (2,) of a ``way`` and of a vector ``along`` from another start where both meet; inf for parallel ways."""
    matrix = np.column_stack([way, -along])
    parallel = abs(np.linalg.det(matrix)) <= BEHIND * np.hypot(*along)
    return np.full(2, np.inf) if parallel else np.asarray(np.linalg.solve(matrix, other - start))


def sharp_corners(curve: Curve, side: int, link: float) -> list[int]:
    """Numbers of the pieces at whose begin a rigid curve has a corner that is a place of contact.

    Args:
        curve: the boundary; a circle smaller than a link is a corner.
        side: side of the beam, +1 left.
        link: length of the beam's links.
    """
    if curve.is_point:
        return [0] if curve.half_thickness[0] < link else []
    slopes = curve.weights[:, 1]
    a, b = np.roll(slopes[:, 1] + 2.0 * slopes[:, 2] + 3.0 * slopes[:, 3], 1), slopes[:, 1]
    turns = -side * np.angle(b * np.conj(a))
    turns[0] = turns[0] if curve.closed else 0.0
    return [int(piece) for piece in np.flatnonzero(turns > KINK)]


def sharp_bends(curve: Curve, side: int, link: float) -> list[Ints]:
    """Numbers of the pieces of every convex bend of a rigid curve with a least radius below a link.

    A bend reaches to twice the radius, so that the point of contact leaves the bend inside.
    """
    if curve.is_point:
        return []
    c, xi = curve.weights[:, 1, :, None], np.array([0.0, 0.5, 1.0])
    slope, second = c[:, 1] + xi * (2.0 * c[:, 2] + 3.0 * xi * c[:, 3]), 2.0 * c[:, 2] + 6.0 * xi * c[:, 3]
    bent = link * np.max(-side * np.imag(np.conj(slope) * second) / np.abs(slope) ** 3, axis=1)
    wide = bent > 0.5
    if curve.closed and wide.all():
        return [np.arange(curve.pieces)]
    begin = int(np.argmin(wide)) if curve.closed else 0
    order = (np.arange(curve.pieces) + begin) % curve.pieces
    runs = np.split(order, np.flatnonzero(np.diff(wide[order].astype(np.int64))) + 1)
    return [run for run in runs if bent[run].max() > 1.0]


def with_marks(curve: Curve, corners: list[int], bends: list[Ints]) -> Curve:
    """The curve with marks of corners and bends."""
    marks = np.zeros(curve.pieces, dtype=np.int64)
    for run in bends:
        marks[run] = BEND
    marks[corners] = CORNER
    return replace(curve, corner=marks)


def part_of(curve: Curve, run: Ints) -> Curve:
    """A run of pieces of a rigid curve without thickness, as a curve."""
    spans = np.diff(curve.arcs)[run]
    return replace(
        curve,
        name=f"{curve.name}, bend {run[0]}",
        stencil=curve.stencil[run],
        weights=curve.weights[run],
        arcs=np.concatenate([[0.0], np.cumsum(spans)]),
        half_thickness=curve.half_thickness[: len(run) + 1],
        lost=curve.lost[run],
        angles=curve.angles[run],
        corner=np.zeros(len(run), dtype=np.int64),
        closed=curve.closed and len(run) == curve.pieces,
    )


def corner_curve(curve: Curve, piece: int) -> Curve:
    """Curve of a single point: the begin of a piece of a rigid curve."""
    point = part_of(curve, np.array([piece]))
    constant = point.weights * [1.0, 0.0, 0.0, 0.0]
    return replace(point, name=f"{curve.name}, corner {piece}", weights=constant, arcs=np.zeros(2), closed=False)
