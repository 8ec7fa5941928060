"""The smooth neutral line: cubic Hermite through the nodes, with the nodal rotations as tangents.

======  ======================================================================
symbol  meaning
======  ======================================================================
ζ       place on the beam: element number plus ξ in [0, 1] within the element
H       the four cubic shape functions of (x₁, L t₁, x₂, L t₂)
t, n    unit tangent (cos θ, sin θ) at a node, and its normal (−sin θ, cos θ)
======  ======================================================================
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea_reference.state import summed
from scene.answer import Array

Index = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class NeutralLine:
    """A beam of n elements as it lies.

    ``points`` (2, n+1) and what their rounding left, ``rest`` (2, n+1); ``angles`` (n+1,), elements' ``lengths``
    (n,), ``tangents`` and ``normals`` (2, n+1), and the coefficients ``cubic`` (3, 2, n) of ξ, ξ², ξ³ of every
    element, from its first node.
    """

    points: Array
    rest: Array
    angles: Array
    lengths: Array
    tangents: Array
    normals: Array
    cubic: Array

    @classmethod
    def through(cls, points: Array, angles: Array, lengths: Array, rest: Array) -> NeutralLine:
        """The line through ``points`` + ``rest`` (2, n+1)."""
        cos, sin = np.cos(angles), np.sin(angles)
        tangents = np.stack([cos, sin])
        step, error = summed(points[:, 1:], -points[:, :-1])
        step = step + (error + np.diff(rest, axis=1))
        t1, t2 = lengths * tangents[:, :-1], lengths * tangents[:, 1:]
        cubic = np.stack([t1, 3.0 * step - 2.0 * t1 - t2, t1 + t2 - 2.0 * step])
        return cls(points, rest, angles, lengths, tangents, np.stack([-sin, cos]), cubic)

    @property
    def n(self) -> int:
        """Number of elements."""
        return self.lengths.size

    def locate(self, zeta: Array) -> tuple[Index, Array]:
        """Element and ξ of each place."""
        element = np.minimum(zeta.astype(np.int64), self.n - 1)
        return element, zeta - element

    def from_node(self, zeta: Array) -> Array:
        """From the first node of each place's element to the place, (2, k)."""
        e, xi = self.locate(zeta)
        t, b, a = self.cubic[:, :, e]
        return np.asarray(xi * (t + xi * (b + xi * a)))

    def at(self, zeta: Array) -> tuple[Array, Array, Array]:
        """Position, first and second derivative by ζ, each (2, k)."""
        e, xi = self.locate(zeta)
        t, b, a = self.cubic[:, :, e]
        return (
            self.points[:, e] + xi * (t + xi * (b + xi * a)),
            t + xi * (2.0 * b + xi * (3.0 * a)),
            2.0 * b + xi * (6.0 * a),
        )


def apart(first: NeutralLine, zeta: Array, second: NeutralLine, zeta_m: Array) -> Array:
    """From places ``zeta_m`` (k,) of the second line to ``zeta`` (k,) of the first, (2, k), with all digits."""
    e, e_m = first.locate(zeta)[0], second.locate(zeta_m)[0]
    value, error = summed(first.points[:, e], -second.points[:, e_m])
    nodes = value + (error + (first.rest[:, e] - second.rest[:, e_m]))
    return np.asarray(nodes + (first.from_node(zeta) - second.from_node(zeta_m)))


def shapes(xi: Array, L: Array) -> Array:
    """H of (x₁, θ₁, x₂, θ₂) at ``xi`` (k,), (4, k)."""
    return np.stack(
        [
            1.0 + xi**2 * (2.0 * xi - 3.0),
            L * xi * (1.0 - xi) ** 2,
            xi**2 * (3.0 - 2.0 * xi),
            L * xi**2 * (xi - 1.0),
        ]
    )


def shape_slopes(xi: Array, L: Array) -> Array:
    """∂H/∂ξ at ``xi`` (k,), (4, k)."""
    bump = 6.0 * xi * (1.0 - xi)
    return np.stack([-bump, L * (1.0 - xi) * (1.0 - 3.0 * xi), bump, L * xi * (3.0 * xi - 2.0)])


def along(v: Array, H: Array, line: NeutralLine, e: Index) -> Array:
    """Derivative of v·x by (x₁, y₁, θ₁, x₂, y₂, θ₂) for fixed vectors ``v`` (2, k): (6, k)."""
    first = H[1] * (v * line.normals[:, e]).sum(axis=0)
    second = H[3] * (v * line.normals[:, e + 1]).sum(axis=0)
    return np.stack([H[0] * v[0], H[0] * v[1], first, H[2] * v[0], H[2] * v[1], second])


def bending_along(v: Array, H: Array, line: NeutralLine, e: Index) -> Array:
    """Second derivative of v·x by θ₁ twice and by θ₂ twice, (2, k); all others are zero."""
    first = -H[1] * (v * line.tangents[:, e]).sum(axis=0)
    second = -H[3] * (v * line.tangents[:, e + 1]).sum(axis=0)
    return np.stack([first, second])
