"""Cubic spline of a beam's neutral line, linear in the positions of the chain's nodes.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
P_j      node j of the chain: the beam's start, the joints, the beam's end
D²P      second difference of the nodes, continued beyond both ends so that C ends at the outer nodes
Q        control polygon P − D²P/24
C(s)     neutral line: the uniform cubic B-spline with the control polygon Q
=======  ====================================================================================

A chain of elements with the constant curvature κ has nodes at C − κ h²/8 n, on the tangents at the borders of
elements.  The B-spline of P alone lies κ h²/6 inside the polygon; D²P/24 = κ h²/24 n makes up the difference: C
is right to fourth order.  The half links at both ends are continued to full links of the same curvature.
C is linear in the nodes, has a continuous second derivative, and follows rigid motions exactly.
At rest the spline of the nodes meets the neutral line at every joint.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.sparse import csr_matrix, identity, vstack
from scipy.sparse.linalg import spsolve

from cprbm_scene.answer import Array, Ints

CUBIC = np.array([[1.0, -3.0, 3.0, -1.0], [4.0, 0.0, -6.0, 3.0], [1.0, 3.0, 3.0, -3.0], [0.0, 0.0, 0.0, 1.0]]) / 6.0
"""Cubic B-spline on one piece: control points by powers of the local parameter."""

LINEAR = np.array([[1.0, -1.0], [0.0, 1.0]])
"""Straight piece between two control points, likewise."""


@dataclass(frozen=True, eq=False)
class NeutralLine:
    """Curve of a beam: pieces between ``arcs`` (count,), linear in the nodes.

    Attributes:
        control: matrix from nodes to control points.
        basis: control points of a piece by powers of the local parameter.
        size: arc length per unit of the local parameter, of each piece.
        offset: local parameter at the begin of each piece.
    """

    arcs: Array
    control: csr_matrix
    basis: Array
    size: Array
    offset: Array

    def place(self, nodes: Array, s: Array) -> Array:
        """Positions (k, 2) at arc lengths ``s`` of the curve with the given nodes (count, 2)."""
        points = self.control @ nodes
        piece, xi = self._local(s)
        factors = xi[:, None] ** np.arange(len(self.basis)) @ self.basis.T
        return np.asarray(np.einsum("kc,kcd->kd", factors, points[piece[:, None] + np.arange(len(self.basis))]))

    def integral(self, nodes: Array, s: Array) -> Array:
        """Integrals (k, 2) of the position from the beam's start to arc lengths ``s``."""
        points = self.control @ nodes
        power = 1.0 + np.arange(len(self.basis))

        def from_begin(piece: Ints, xi: Array) -> Array:
            rise = (xi[:, None] ** power - self.offset[piece][:, None] ** power) / power
            factors = self.size[piece][:, None] * (rise @ self.basis.T)
            return np.asarray(np.einsum("kc,kcd->kd", factors, points[piece[:, None] + np.arange(len(self.basis))]))

        pieces = np.arange(len(self.size))
        whole = from_begin(pieces, self.offset + np.diff(self.arcs) / self.size)
        piece, xi = self._local(s)
        return np.asarray(np.concatenate([np.zeros((1, 2)), np.cumsum(whole, axis=0)])[piece] + from_begin(piece, xi))

    def weights(self, s: Array) -> csr_matrix:
        """Weights (k, count) of the nodes in the positions at arc lengths ``s``."""
        piece, xi = self._local(s)
        count = len(self.basis)
        factors = xi[:, None] ** np.arange(count) @ self.basis.T
        columns = (piece[:, None] + np.arange(count)).ravel()
        rows = np.repeat(np.arange(len(s)), count)
        shape = (len(s), self.control.shape[0])
        return csr_matrix((factors.ravel(), (rows, columns)), shape=shape) @ self.control

    def _local(self, s: Array) -> tuple[Ints, Array]:
        """Pieces and local parameters at arc lengths ``s``."""
        piece = np.clip(np.searchsorted(self.arcs, s, side="right") - 1, 0, len(self.size) - 1)
        return piece, (s - self.arcs[piece]) / self.size[piece] + self.offset[piece]


def spline_line(arcs: Array) -> NeutralLine:
    """Spline of a corrected chain: all pieces of equal size, but half pieces at both ends."""
    pieces = len(arcs) - 1
    offset = np.zeros(pieces)
    # the first half link is the second half of the continued link
    offset[0] = 0.5
    return NeutralLine(arcs, control_polygon(len(arcs)), CUBIC, np.full(pieces, arcs[2] - arcs[1]), offset)


def polygon_line(arcs: Array) -> NeutralLine:
    """Polygon of a plain chain."""
    return NeutralLine(arcs, identity(len(arcs), format="csr"), LINEAR, np.diff(arcs), np.zeros(len(arcs) - 1))


@lru_cache(maxsize=16)
def control_polygon(count: int) -> csr_matrix:
    """Matrix (count + 2, count) from nodes to control points, with a further control point beyond either end."""
    inner = identity(count, format="lil")
    # the outer links are half links: the continued link has twice their length
    inner[0, 0], inner[0, 1] = 2.0, -1.0
    inner[-1, -1], inner[-1, -2] = 2.0, -1.0
    polygon = inner.tocsr()
    second = polygon[2:] - 2.0 * polygon[1:-1] + polygon[:-2]
    bends = vstack([2.0 * second[:1] - second[1:2], second[:1], second, second[-1:], 2.0 * second[-1:] - second[-2:-1]])
    before = 2.0 * polygon[:1] - polygon[1:2] + second[:1]
    behind = 2.0 * polygon[-1:] - polygon[-2:-1] + second[-1:]
    return (vstack([before, polygon, behind]) - bends / 24.0).tocsr()


def nodes_through(places: Array, control: csr_matrix) -> Array:
    """Nodes (count, 2) of the spline through the inner ``places`` (count, 2); the outer two are kept."""
    count = len(places)
    inner = (control[1:-3] + 4.0 * control[2:-2] + control[3:-1]) / 6.0
    ends = identity(count, format="csr")
    return np.asarray(spsolve(vstack([ends[:1], inner, ends[-1:]]).tocsc(), places))
