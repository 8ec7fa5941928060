"""An edge of a beam's area as a curve with a continuous tangent through its nodes.

======  ==========================================================================
symbol  meaning
======  ==========================================================================
ζ       place along the edge: node number and what lies beyond it, in [0, N − 1]
x_k     nodes of the edge, N of them
x(ζ)    between nodes k and k + 1 the cubic with x_k, x_{k+1} and with the slopes
        (x_{k+1} − x_{k−1})/2 and (x_{k+2} − x_k)/2 there
======  ==========================================================================

The elements' own edges are parabolas that meet at an angle, small but enough that a pressure which slides over it has no
tangent.  Beyond its ends the row of nodes is continued by the parabola through the last three.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from scene.answer import Array, Ints

_CUBIC = 0.5 * np.array(  # powers of the place within (rows) by the nodes k − 1 to k + 2
    [[0.0, 2.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0], [2.0, -5.0, 4.0, -1.0], [-1.0, 3.0, -3.0, 1.0]]
)
_BEFORE = np.array([[3.0, -3.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
_BEHIND = _BEFORE[::-1, ::-1]


@dataclass(frozen=True, slots=True)
class Skin:
    """One edge of a beam.

    Attributes:
        beam: its number.
        side: 1 for the left edge, −1 for the right one.
        nodes: from the beam's start to its end (N,).
        places: X of the nodes (N, 2).
        u: fractions of the arc length of the nodes (N,).
        width: of the section at the nodes, over the largest (N,).
        thickness: the beam's least.
        stiffness: E over the length of an element at the nodes (N,), without units.
    """

    beam: int
    side: float
    nodes: Ints
    places: Array
    u: Array
    width: Array
    thickness: float
    stiffness: Array

    def shapes(self, zeta: Array) -> tuple[Ints, Array, Array, Array]:
        """Places (k, 4) among the edge's nodes, and their shape functions at ζ (k,) with two derivatives (k, 4) each."""
        last = self.nodes.size - 2
        k = np.clip(zeta.astype(np.intp), 0, last)
        s = zeta - k
        one = np.ones_like(s)
        powers = np.stack([one, s, s**2, s**3], axis=1)
        first = np.stack([0.0 * one, one, 2.0 * s, 3.0 * s**2], axis=1)
        second = np.stack([0.0 * one, 0.0 * one, 2.0 * one, 6.0 * s], axis=1)
        begin = np.clip(k - 1, 0, last - 2)
        kinds = np.stack([_CUBIC, _CUBIC @ _BEFORE, _CUBIC @ _BEHIND])[(k == 0) + 2 * (k == last)]
        return begin[:, None] + np.arange(4), *(
            np.einsum("kp,kpn->kn", each, kinds) for each in (powers, first, second)
        )

    def at(self, values: Array, zeta: Array) -> Array:
        """What has ``values`` (N,) at the nodes, at ζ (k,)."""
        nodes, N, _, _ = self.shapes(zeta)
        return np.asarray((N * values[nodes]).sum(axis=1))

    def curve(self, x: Array, zeta: Array) -> tuple[Array, Array, Array]:
        """x, x' and x'' (k, 2) at ζ (k,), of nodes ``x`` (N, 2)."""
        nodes, N, N1, N2 = self.shapes(zeta)
        own = x[nodes]
        return (N[:, None] @ own)[:, 0], (N1[:, None] @ own)[:, 0], (N2[:, None] @ own)[:, 0]

    def outward(self, slope: Array) -> Array:
        """Unit normals (k, 2) out of the area, of x' (k, 2)."""
        normal = self.side * np.stack([-slope[:, 1], slope[:, 0]], axis=1)
        return np.asarray(normal / np.hypot(*slope.T)[:, None])
