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

**Lost compliance.**  The spline spreads a point force over the nodes of a few links.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
h, EI, GA  length of an element, bending stiffness, shear stiffness
s          place of a transverse unit force, from the clamp of a cantilever
w_j        weight of node j in the spline's position at s: the force on node j
M_i, Q_j   moment in joint i, shear force in link j, of length L_j
ξ          local parameter of a piece, from 0 to 1
c(ξ)       lost compliance: of bending over h³/EI, of shear over h/GA
=========  =====================================================================================

The chain of fourth order has the compliance

    Σ M_i² h/EI + Σ L_j Q_j² h²/(12 EI)

in place of s³/(3 EI), and with shear Σ L_j Q_j²/GA in place of s/GA.  A point force makes a kink F/GA in the neutral
line, and the spline has none.  The differences depend on ξ alone: a polynomial of degree six on every piece, the same
on all pieces but the half links at the ends.  A half link beyond a clamp or a pin has nearly no compliance of its
own, a half link at a free end more; both follow from a cantilever loaded near its two ends.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from scipy.sparse import csr_matrix, identity, vstack
from scipy.sparse.linalg import SuperLU, splu

from cprbm_scene.answer import Array

CUBIC = np.array([[1.0, -3.0, 3.0, -1.0], [4.0, 0.0, -6.0, 3.0], [1.0, 3.0, 3.0, -3.0], [0.0, 0.0, 0.0, 1.0]]) / 6.0
"""Cubic B-spline on one piece: control points by powers of the local parameter."""

LINEAR = np.array([[1.0, -1.0], [0.0, 1.0]])
"""Straight piece between two control points, likewise."""

POWERS = 7
"""Coefficients of c: weights are cubic in ξ, moments and their squares follow."""

ELEMENTS = 16
"""Elements of the cantilever: the middle piece is free of the ends' influence to 1e-9."""

GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(2)
"""Exact for a cubic."""


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

    def weights(self, s: Array) -> csr_matrix:
        """Weights (k, count) of the nodes in the positions at arc lengths ``s``."""
        piece = np.clip(np.searchsorted(self.arcs, s, side="right") - 1, 0, len(self.size) - 1)
        xi, count = (s - self.arcs[piece]) / self.size[piece] + self.offset[piece], len(self.basis)
        factors = xi[:, None] ** np.arange(count) @ self.basis.T
        columns = (piece[:, None] + np.arange(count)).ravel()
        rows = np.repeat(np.arange(len(s)), count)
        shape = (len(s), self.control.shape[0])
        return csr_matrix((factors.ravel(), (rows, columns)), shape=shape) @ self.control

    def integrals(self, places: Array) -> csr_matrix:
        """Weights (k, count) of the nodes in the integrals of the position between ``places`` (k + 1,), in order.

        No end of a piece lies between two places.
        """
        half = 0.5 * np.diff(places)
        s = 0.5 * (places[1:] + places[:-1])[:, None] + half[:, None] * GAUSS_NODES
        gauss = (half[:, None] * GAUSS_WEIGHTS).ravel()
        return csr_matrix((gauss, np.arange(len(gauss)), 2 * np.arange(len(places)))) @ self.weights(s.ravel())


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


@lru_cache(maxsize=16)
def interpolation(count: int) -> SuperLU:
    """Factors of the matrix (count, count) from nodes to the spline's places; the outer nodes stay."""
    control, ends = control_polygon(count), identity(count, format="csr")
    inner = (control[1:-3] + 4.0 * control[2:-2] + control[3:-1]) / 6.0
    return splu(vstack([ends[:1], inner, ends[-1:]]).tocsc())


@lru_cache
def lost_compliance(part: Literal["bending", "shear"]) -> Array:
    """Coefficients of c, lowest power first, of the pieces of a beam.

    The rows (5, POWERS) are an inner piece, a first half link at a joint with a body, a free first half link, and both
    as last half links.
    """
    n = float(ELEMENTS)
    pieces = (0.5 * n - 0.5, 0.5 * n + 0.5), (0.0, 0.5), (n, n - 0.5), (0.5, 0.0), (n - 0.5, n)
    return np.array([_fitted(part, *ends) for ends in pieces])


def _fitted(part: str, begin: float, end: float) -> Array:
    """Coefficients of c between two places; the polynomial through POWERS places is exact."""
    xi = 0.5 - 0.5 * np.cos(np.pi * (np.arange(POWERS) + 0.5) / POWERS)
    lost = _lost(part, begin + (end - begin) * xi)
    return np.asarray(np.linalg.solve(np.vander(xi, POWERS, increasing=True), lost))


def _lost(part: str, s: Array) -> Array:
    """c at places ``s`` (k,) of a cantilever with h = EI = GA = 1."""
    arcs = np.concatenate([[0.0], np.arange(ELEMENTS) + 0.5, [float(ELEMENTS)]])
    force = spline_line(arcs).weights(s).toarray()
    sheared = np.cumsum(force[:, ::-1], axis=1)[:, ::-1][:, 1:] ** 2 @ np.diff(arcs)
    if part == "shear":
        return np.asarray(s - sheared)
    moment = force @ np.maximum(arcs[None, :] - arcs[1:-1, None], 0.0).T
    return np.asarray(s**3 / 3.0 - np.sum(moment**2, axis=1) - sheared / 12.0)
