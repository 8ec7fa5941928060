"""Cubic spline of a beam's neutral line, linear in the positions of the chain's nodes.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
P_j      node j of the chain: the beam's start, the joints, the beam's end
D²P      second difference of the nodes, continued with its end values beyond both ends
Q        control polygon P − D²P/24
C(s)     neutral line: the uniform cubic B-spline with the control polygon Q
=======  ====================================================================================

A chain whose elements have the constant curvature κ has its nodes at C − κ h²/8 n, on the tangents at the borders of
elements.  The B-spline of P alone lies κ h²/6 inside the polygon; D²P/24 = κ h²/24 n makes up the difference, so that C
is right to fourth order.  The half links at both ends are continued to full links of the same curvature.
C is linear in the nodes, has a continuous second derivative, and follows rigid motions exactly.
At rest the nodes are those whose spline meets the neutral line at every joint.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix, identity, vstack
from scipy.sparse.linalg import spsolve

from cprbm_scene.answer import Array

BASIS = np.array([[1.0, -3.0, 3.0, -1.0], [4.0, 0.0, -6.0, 3.0], [1.0, 3.0, 3.0, -3.0], [0.0, 0.0, 0.0, 1.0]]) / 6.0
"""Cubic B-spline on one piece: control points by powers of the local parameter."""


def control_polygon(count: int) -> csr_matrix:
    """Matrix (count + 2, count) from nodes to control points, with one more control point beyond either end."""
    inner = identity(count, format="lil")
    # the outer links are half links: the continued link has twice their length
    inner[0, 0], inner[0, 1] = 2.0, -1.0
    inner[-1, -1], inner[-1, -2] = 2.0, -1.0
    polygon = inner.tocsr()
    second = polygon[2:] - 2.0 * polygon[1:-1] + polygon[:-2]
    bends = vstack([second[:1], second[:1], second, second[-1:], second[-1:]])
    before = 2.0 * polygon[:1] - polygon[1:2] + second[:1]
    behind = 2.0 * polygon[-1:] - polygon[-2:-1] + second[-1:]
    return (vstack([before, polygon, behind]) - bends / 24.0).tocsr()


def nodes_through(places: Array) -> Array:
    """Nodes (count, 2) whose spline meets the inner ``places`` (count, 2); the outer two are kept."""
    count = len(places)
    control = control_polygon(count)
    inner = (control[1:-3] + 4.0 * control[2:-2] + control[3:-1]) / 6.0
    ends = identity(count, format="csr")
    return np.asarray(spsolve(vstack([ends[:1], inner, ends[-1:]]).tocsc(), places))


def spline_weights(arcs: Array, s: Array, order: int = 0) -> csr_matrix:
    """Weights (k, count) of the nodes in C(s), or in its derivative by the arc length of the given order.

    Args:
        arcs: arc lengths of the nodes (count,), the outer two links half as long as the others.
        s: arc lengths (k,).
        order: 0 or 1.
    """
    count, size = len(arcs), arcs[2] - arcs[1]
    piece = np.clip(np.searchsorted(arcs, s, side="right") - 1, 0, count - 2)
    # the first half link is the second half of its continued link
    xi = (s - arcs[piece]) / size + 0.5 * (piece == 0)
    powers = xi[:, None] ** np.arange(4)
    if order:
        powers = np.column_stack([np.zeros(len(s)), np.ones(len(s)), 2.0 * xi, 3.0 * xi**2]) / size
    columns = piece[:, None] + np.arange(4)
    rows = np.repeat(np.arange(len(s)), 4)
    basis = csr_matrix(((powers @ BASIS.T).ravel(), (rows, columns.ravel())), shape=(len(s), count + 2))
    return (basis @ control_polygon(count)).tocsr()


def linear_weights(arcs: Array, s: Array, order: int = 0) -> csr_matrix:
    """Weights (k, count) of the nodes in the polygon at arc lengths ``s`` (k,), or in its derivative."""
    piece = np.clip(np.searchsorted(arcs, s, side="right") - 1, 0, len(arcs) - 2)
    size = arcs[piece + 1] - arcs[piece]
    share = (s - arcs[piece]) / size
    pair = np.column_stack([-1.0 / size, 1.0 / size] if order else [1.0 - share, share])
    rows = np.repeat(np.arange(len(s)), 2)
    columns = (piece[:, None] + np.arange(2)).ravel()
    return csr_matrix((pair.ravel(), (rows, columns)), shape=(len(s), len(arcs)))
