"""Boundaries of rigid solids, and corners of rigid curves.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
a, b     unit tangents of the pieces before and behind a border of two pieces
h        length of a beam's link
=======  ====================================================================================

The solid behind an open edge ends where the edge ends.  From there the boundary goes back at right angles, until both
sides meet, or a side comes to the edge from behind.

At a convex corner the boundary turns away from the beam.  The corner is a place of contact: a point of the boundary
before the beam's curve.  The boundary cannot pass the beam between two joints there.  A row of corners with less than h
between them is an edge with the corners' mean curvature; only where the row turns by more than a radian over h the
corners are places.  A circle smaller than a link is a corner too.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cprbm.contact.curve import Curve
from cprbm_scene.answer import Array

KINK = 1e-6
"""Least turn of a corner, rad: borders of a smooth edge's pieces turn by round-off."""

SHARPEST_ROW = 1.0
"""Turn of a row of corners within a link, rad, from which the corners are places: a radius of a link."""

BEHIND = 1e-9
"""Distance from an edge's end, over the longest beam, up to which a side does not meet the edge: round-off."""


class Corner(NamedTuple):
    """Number of a corner's curve of one point, and numbers of the edge's pieces ``before`` and ``behind``."""

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
    begins, ends = points[0] - points[1], points[-1] - points[-2]
    back = [side * np.array([chord[1], -chord[0]]) / np.hypot(*chord) for chord in (-begins, ends)]
    length = [min(_meetings(start, way, points), default=reach) for start, way in zip(points[[0, -1]], back, strict=True)]
    matrix = np.column_stack([back[0], -back[1]])
    if abs(np.linalg.det(matrix)) > BEHIND:
        meet = np.linalg.solve(matrix, points[-1] - points[0])
        if np.all(meet > BEHIND) and meet[0] < length[0] and meet[1] < length[1]:
            corner = points[:1] + meet[0] * back[0]
            return corner, corner
    return points[:1] + length[0] * back[0], points[-1:] + length[1] * back[1]


def _meetings(start: Array, way: Array, points: Array) -> list[float]:
    """Distances along a ``way`` at which the way meets the pieces between points."""
    found = []
    for begin, end in zip(points[:-1], points[1:], strict=True):
        matrix = np.column_stack([way, begin - end])
        if abs(np.linalg.det(matrix)) > BEHIND * np.hypot(*(end - begin)):
            along, share = np.linalg.solve(matrix, begin - start)
            if along > BEHIND and 0.0 <= share <= 1.0:
                found.append(float(along))
    return found


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
    spans = np.diff(curve.arcs)
    corners = np.flatnonzero(turns > KINK)
    total = float(curve.arcs[-1])

    def turn_around(piece: int) -> float:
        apart = np.abs(curve.arcs[corners] - curve.arcs[piece])
        apart = np.minimum(apart, total - apart) if curve.closed else apart
        return float(turns[corners[apart < 0.5 * link]].sum())

    return [
        piece
        for piece in corners.tolist()
        if max(spans[piece], spans[piece - 1]) >= link or turn_around(piece) > SHARPEST_ROW
    ]


def with_corners(curve: Curve, corners: list[int]) -> Curve:
    """The curve with marks at its corners."""
    marks = np.zeros(curve.pieces, dtype=bool)
    marks[corners] = True
    return replace(curve, corner=marks)


def corner_curve(curve: Curve, piece: int) -> Curve:
    """Curve of a single point: the begin of a piece of a rigid curve."""
    weights = curve.weights[[piece]].copy()
    weights[:, :, 1:] = 0.0
    return replace(
        curve,
        name=f"{curve.name}, corner {piece}",
        stencil=curve.stencil[[piece]],
        weights=weights,
        arcs=np.zeros(2),
        half_thickness=np.zeros(2),
        lost=curve.lost[[piece]],
        angles=curve.angles[[piece]],
        corner=np.zeros(1, dtype=bool),
        closed=False,
    )
