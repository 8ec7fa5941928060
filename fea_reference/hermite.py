"""The smooth neutral line: cubic Hermite through the nodes, with the nodal rotations as tangents.

======  ======================================================================
symbol  meaning
======  ======================================================================
ζ       place on the beam: element number plus ξ in [0, 1] within the element
H       the four cubic shape functions of (x₁, m t₁, x₂, m t₂)
m       length of the element as it lies, L (1 + c N): its speed by ξ at both nodes
t, n    unit tangent (cos θ, sin θ) at a node, and its normal (−sin θ, cos θ)
======  ======================================================================

A speed that left out the stretch c N would bulge every element by h² κ c N/8, beside which the cubic's own
distance from a circle, of order h⁴, is nothing.
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

    ``points`` (2, n+1) and what their rounding left, ``rest`` (2, n+1); ``angles`` (n+1,); the elements'
    undeformed ``lengths`` (n,), their ``speeds`` m and what these ``give`` by N (n,); ``tangents`` and ``normals``
    (2, n+1); and the coefficients ``cubic`` (3, 2, n) of ξ, ξ², ξ³ of every element, from its first node.
    """

    points: Array
    rest: Array
    angles: Array
    lengths: Array
    speeds: Array
    give: Array
    tangents: Array
    normals: Array
    cubic: Array

    @classmethod
    def through(
        cls, points: Array, angles: Array, lengths: Array, rest: Array, compliance: Array, axial: Array
    ) -> NeutralLine:
        """The line through ``points`` + ``rest`` (2, n+1), its elements stretched by ``compliance`` ``axial`` (n,)."""
        cos, sin = np.cos(angles), np.sin(angles)
        tangents = np.stack([cos, sin])
        step, error = summed(points[:, 1:], -points[:, :-1])
        step = step + (error + np.diff(rest, axis=1))
        give = compliance * lengths
        speeds = lengths + give * axial
        t1, t2 = speeds * tangents[:, :-1], speeds * tangents[:, 1:]
        cubic = np.stack([t1, 3.0 * step - 2.0 * t1 - t2, t1 + t2 - 2.0 * step])
        return cls(points, rest, angles, lengths, speeds, give, tangents, np.stack([-sin, cos]), cubic)

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


def shapes(xi: Array) -> Array:
    """H at ``xi`` (k,), (4, k)."""
    return np.stack(
        [
            1.0 + xi**2 * (2.0 * xi - 3.0),
            xi * (1.0 - xi) ** 2,
            xi**2 * (3.0 - 2.0 * xi),
            xi**2 * (xi - 1.0),
        ]
    )


def shape_slopes(xi: Array) -> Array:
    """∂H/∂ξ at ``xi`` (k,), (4, k)."""
    bump = 6.0 * xi * (1.0 - xi)
    return np.stack([-bump, (1.0 - xi) * (1.0 - 3.0 * xi), bump, xi * (3.0 * xi - 2.0)])


def along(v: Array, H: Array, line: NeutralLine, e: Index) -> Array:
    """Derivative of v·x by (x₁, y₁, θ₁, x₂, y₂, θ₂, N) for fixed vectors ``v`` (2, k): (7, k)."""
    first = H[1] * (v * line.normals[:, e]).sum(axis=0)
    second = H[3] * (v * line.normals[:, e + 1]).sum(axis=0)
    ahead = H[1] * (v * line.tangents[:, e]).sum(axis=0) + H[3] * (v * line.tangents[:, e + 1]).sum(axis=0)
    m = line.speeds[e]
    return np.stack([H[0] * v[0], H[0] * v[1], m * first, H[2] * v[0], H[2] * v[1], m * second, line.give[e] * ahead])


def twice_along(v: Array, H: Array, line: NeutralLine, e: Index) -> Array:
    """Second derivatives of v·x by the same, (7, 7, k): by θ₁ and θ₂ twice, and by each of them and N."""
    both = np.zeros((7, 7, v.shape[1]))
    for i, h, node in ((2, H[1], e), (5, H[3], e + 1)):
        both[i, i] = -line.speeds[e] * h * (v * line.tangents[:, node]).sum(axis=0)
        both[i, 6] = both[6, i] = line.give[e] * h * (v * line.normals[:, node]).sum(axis=0)
    return both
