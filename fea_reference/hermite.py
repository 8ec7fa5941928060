"""Smooth neutral line: cubic Hermite interpolation of the nodes and tangents.

======  ======================================================================
symbol  meaning
======  ======================================================================
ζ       place on the beam: element number plus ξ in [0, 1] within the element
H       the four cubic shape functions of (x₁, m t₁, x₂, m t₂)
m       speed of the cubic at both nodes, L (1 + c N + (θ₂ − θ₁)²/48)
θ       tangent angle at a node, :mod:`fea_reference.leaning`
t, n    unit tangent (cos θ, sin θ) at a node, and its normal (−sin θ, cos θ)
======  ======================================================================

With this speed an element between nodes of an arc deviates from the arc by a share of h⁶ only. An arc of angle 2α
needs m = 4 R tan(α/2) = 2 R α (1 + α²/12 + ...), the handles of a Bézier arc. A speed of L would bulge the element by
h² κ c N/8 and h⁴ κ³/384. A stiff contact beside a clamp would then load the clamp instead.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.answer import Array
from fea_reference.state import Complex, summed

Index = NDArray[np.int64]
_ARC = 24.0


@dataclass(frozen=True, slots=True)
class NeutralLine:
    """Neutral line of a beam with n elements in a state.

    Attributes:
        points, rest: node positions (2, n+1) and their round-off.
        angles: tangent angles (n+1,) at the nodes.
        lengths, speeds: undeformed lengths and speeds m (n,) of the elements.
        give, arching: derivatives (n,) of m by N and by θ₂.
        tangents, aheads: unit tangents at the nodes, (2, n+1) and as complex numbers (n+1,).
        cubic: coefficients (3, n) of ξ, ξ², ξ³ from the first node of every element, complex x + i y.
        nodes, rests: ``points`` and ``rest`` as complex numbers (n+1,).
        longest: the largest of the lengths.
    """

    points: Array
    rest: Array
    angles: Array
    lengths: Array
    speeds: Array
    give: Array
    arching: Array
    tangents: Array
    aheads: Complex
    cubic: Complex
    nodes: Complex
    rests: Complex
    longest: float

    @classmethod
    def through(
        cls, points: Array, angles: Array, lengths: Array, rest: Array, compliance: Array, axial: Array
    ) -> NeutralLine:
        """The line through ``points`` + ``rest`` (2, n+1), with elements stretched by ``compliance`` ``axial`` (n,)."""
        cos, sin = np.cos(angles), np.sin(angles)
        nodes, rests, ahead = as_complex(points), as_complex(rest), as_complex((cos, sin))
        step, error = summed(nodes[1:], -nodes[:-1])
        step = step + (error + (rests[1:] - rests[:-1]))
        give = compliance * lengths
        turned = angles[1:] - angles[:-1]
        speeds = lengths * (1.0 + turned**2 / (2.0 * _ARC)) + give * axial
        t1, t2 = speeds * ahead[:-1], speeds * ahead[1:]
        cubic = np.array([t1, 3.0 * step - 2.0 * t1 - t2, t1 + t2 - 2.0 * step])
        arching = lengths * turned / _ARC
        tangents, longest = np.array([cos, sin]), float(np.maximum.reduce(lengths))
        return cls(points, rest, angles, lengths, speeds, give, arching, tangents, ahead, cubic, nodes, rests, longest)

    @property
    def n(self) -> int:
        """Number of elements."""
        return self.lengths.size

    def locate(self, zeta: Array) -> tuple[Index, Array]:
        """Element (k,) and ξ (k,) of places (k,)."""
        element = np.minimum(zeta.astype(np.int64), self.n - 1)
        return element, zeta - element

    def around(self, zeta: Array) -> Around:
        """Position relative to the element's first node and derivatives, at places (k,)."""
        e, xi = self.locate(zeta)
        t, b, a = self.cubic.take(e, axis=1)
        xi = xi.astype(np.complex128)  # converted once instead of at every product
        last = xi * a
        bent = b + last
        twice = bent + last
        half = twice + last
        return Around(e, xi * (t + xi * bent), t + xi * (bent + twice), half + half)

    def at(self, zeta: Array) -> tuple[Array, Array, Array]:
        """Position, first and second derivative by ζ, (2, k) all."""
        there = self.around(zeta)
        return as_plane(self.nodes[there.element] + there.way), as_plane(there.ahead), as_plane(there.bent)


@dataclass(frozen=True, slots=True)
class Around:
    """k places on a line, as complex numbers.

    The ``element``, the vector ``way`` from its first node, and x', x'' by ζ as ``ahead`` and ``bent``.
    """

    element: Index
    way: Complex
    ahead: Complex
    bent: Complex

    def moved(self, by: Array) -> Around:
        """The places moved by small ``by`` (k,), to first order."""
        return Around(self.element, self.way + by * self.ahead, self.ahead + by * self.bent, self.bent)


def as_complex(vectors: Array | tuple[Array, Array]) -> Complex:
    """Vectors (2, k) as x + i y."""
    number = np.empty(vectors[0].shape, dtype=np.complex128)
    number.real, number.imag = vectors
    return number


def as_plane(number: Complex) -> Array:
    """x + i y as (2, k)."""
    return np.array([number.real, number.imag])


def line_difference(first: NeutralLine, at: Around, second: NeutralLine, at_m: Around) -> Complex:
    """Vectors x + i y (k,) from places of the second line to places of the first, without cancellation."""
    e, e_m = at.element, at_m.element
    value, error = summed(first.nodes[e], -second.nodes[e_m])
    nodes = value + (error + (first.rests[e] - second.rests[e_m]))
    return np.asarray(nodes + (at.way - at_m.way))


def chord_speed_excess(l: Array, L: Array, turned: Array) -> tuple[Array, Array, Array, Array, Array]:  # noqa: E741 - the chord's length
    """Excess of the speed l (1 + t²/16) of a chord l that turns by t over the unstretched speed L (1 + t²/48).

    The excess (k,) and its derivatives by l, by t, by both, and twice by t.
    """
    by_l, rest = 1.0 + turned**2 / 16.0, l / 8.0 - L / 24.0
    return l * by_l - L * (1.0 + turned**2 / (2.0 * _ARC)), by_l, rest * turned, turned / 8.0, rest


def shapes(xi: Array) -> Array:
    """H at ``xi`` (k,), (4, k)."""
    square, rest = xi * xi, 1.0 - xi
    last = square * (3.0 - 2.0 * xi)
    return np.array([1.0 - last, xi * rest * rest, last, -square * rest])


def shape_slopes(xi: Array) -> Array:
    """∂H/∂ξ at ``xi`` (k,), (4, k)."""
    bump = 6.0 * xi * (1.0 - xi)
    return np.array([-bump, (1.0 - xi) * (1.0 - 3.0 * xi), bump, xi * (3.0 * xi - 2.0)])


def _turned_by(v: Array, H: Array, line: NeutralLine, e: Index) -> tuple[Complex, Complex]:
    """H₂ (v·t₁ + i v·n₁) and H₄ (v·t₂ + i v·n₂), (k,) both, for constant vectors ``v`` (2, k)."""
    fixed = as_complex(v)
    return H[1] * (fixed * line.aheads[e].conj()), H[3] * (fixed * line.aheads[e + 1].conj())


def projected_gradient(v: Array, H: Array, line: NeutralLine, e: Index) -> Array:
    """Derivative (7, k) of v·x by (x₁, y₁, θ₁, x₂, y₂, θ₂, N) for constant vectors ``v`` (2, k)."""
    before, behind = _turned_by(v, H, line, e)
    ahead = before.real + behind.real
    m, turn = line.speeds[e], line.arching[e] * ahead
    first, second = before.imag, behind.imag
    return np.array(
        [H[0] * v[0], H[0] * v[1], m * first - turn, H[2] * v[0], H[2] * v[1], m * second + turn, line.give[e] * ahead]
    )


def projected_hessian(v: Array, H: Array, line: NeutralLine, e: Index) -> Array:
    """Second derivatives (7, 7, k) of v·x by the same unknowns, for constant vectors ``v`` (2, k).

    Only m (H₂ t₁ + H₄ t₂) is nonlinear, in θ₁, θ₂ and N.
    """
    at_first, at_second = _turned_by(v, H, line, e)
    (before, first), (behind, second) = (at_first.real, at_first.imag), (at_second.real, at_second.imag)
    m, arching, give = line.speeds[e], line.arching[e], line.give[e]
    bow = line.lengths[e] / _ARC * (before + behind)
    both = np.zeros((7, 7, v.shape[1]))
    both[2, 2] = bow - 2.0 * arching * first - m * before
    both[5, 5] = bow + 2.0 * arching * second - m * behind
    both[2, 5] = both[5, 2] = arching * (first - second) - bow
    both[2, 6] = both[6, 2] = give * first
    both[5, 6] = both[6, 5] = give * second
    return both
