"""The exact offset of a curve, from the curve's own normals: p(u) + t n(u).

======  ===================================================================
p, n    point of the curve and its left normal at the arc length's share u
q(u)    p(u) + t n(u), t positive to the left
a, o    coordinates of q on the axis that it is a graph over, and across it
======  ===================================================================

o at a given a needs u with a(u) = a.  A table of a brackets it, and u ← u − (a(u) − a)/m, with the bracket's own
slope m, gains the bracket's relative change of slope (about the table's step) in every turn.
"""

from __future__ import annotations

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import Curve

_TABLE = 2001
_TURNS = 5
_REACHED = 1e-12  # of the largest coordinate or offset


def offset_curve(curve: Curve, u: Array, distance: Array | float) -> Array:
    """q (n, 2), m, at the shares ``u`` (n,), with signed distances t (n,) or one for all."""
    tangents = shape_of(curve).tangent(u)
    normals = np.column_stack((-tangents[:, 1], tangents[:, 0]))
    return shape_of(curve).point(u) + np.reshape(distance, (-1, 1)) * normals


def ordinates(curve: Curve, at: Array, distance: float, *, along_x: bool) -> Array:
    """o (n,), m, of the exact offset curve where its a is ``at`` (n,); NaN beyond its ends.

    The offset must be a graph over the axis of a (x where ``along_x``), as the checks of a question see to.
    """
    graph, across = (0, 1) if along_x else (1, 0)
    table = np.linspace(0.0, 1.0, _TABLE)
    a = offset_curve(curve, table, distance)[:, graph]
    rising = 1.0 if a[-1] > a[0] else -1.0
    right = np.clip(np.searchsorted(rising * a, rising * at), 1, _TABLE - 1)
    slope = (a[right] - a[right - 1]) * (_TABLE - 1)
    u = table[right - 1] + (at - a[right - 1]) / slope
    for _ in range(_TURNS):
        u = np.clip(u - (offset_curve(curve, u, distance)[:, graph] - at) / slope, 0.0, 1.0)
    q = offset_curve(curve, u, distance)
    size = np.max(np.abs(q)) + abs(distance) + shape_of(curve).length
    return np.where(np.abs(q[:, graph] - at) <= _REACHED * size, q[:, across], np.nan)
