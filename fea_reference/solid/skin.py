"""An edge of a beam's area as a curve with a continuous tangent.

======  ==========================================================================
symbol  meaning
======  ==========================================================================
ζ       place along the edge, in nodes: in [0, N − 1], two to an element
ξ       place within an element, in [−1, 1]; ζ is ξ + 1 plus twice the element number
x_k     nodes of the edge, N of them
P       the element's own edge, the parabola through its three nodes
δ₋, δ₊  half of the neighbours' slopes minus the element's own, at both ends
x(ξ)    P − ξ (1 − ξ²) (7 ξ² − 3) [δ₋ (1 − ξ) + δ₊ (1 + ξ)]/16
======  ==========================================================================

The elements' own edges meet at a small angle, where a sliding pressure would have no tangent. The correction of P
vanishes at the nodes, averages the slopes at the ends, and has no integral and no first moment over the element. A
constant or linear pressure therefore has the same nodal forces as on P, so that two bodies pressed flat together
transmit the pressure exactly.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial import polynomial

from cprbm_scene.answer import Array, Ints

STENCIL = 7
"""Nodes of a place on an edge: those of its element and of both neighbours."""

_PARABOLA = np.array([[0.0, 1.0, 0.0], [-0.5, 0.0, 0.5], [0.5, -1.0, 0.5]])  # powers of ξ by nodes
# slopes of the parabola at ξ = −1 and 1, by nodes
_BEGIN, _END = np.array([-1.5, 2.0, -0.5]), np.array([0.5, -2.0, 1.5])
_WAVE = polynomial.polymul([0.0, 1.0, 0.0, -1.0], [-3.0 / 16.0, 0.0, 7.0 / 16.0])  # ξ (1 − ξ²) (7 ξ² − 3)/16


def _coefficients(elements: int) -> Array:
    """Coefficients (e, 7, 7) of powers of ξ by the stencil's nodes, for every element."""
    coefficients = np.zeros((elements, STENCIL, STENCIL))
    for e in range(elements):
        first = 2 * e - int(np.clip(2 * e - 2, 0, 2 * elements - STENCIL + 1))
        coefficients[e, :3, first : first + 3] = _PARABOLA
        for there, own, other, beside, sign in (
            (e > 0, _BEGIN, _END, -2, -1.0),
            (e < elements - 1, _END, _BEGIN, 2, 1.0),
        ):
            if not there:
                continue
            more = np.zeros(STENCIL)
            more[first + beside : first + beside + 3] += 0.5 * other
            more[first : first + 3] -= 0.5 * own
            coefficients[e] -= np.outer(polynomial.polymul(_WAVE, [1.0, sign]), more)
    return coefficients


@dataclass(frozen=True, slots=True)
class Skin:
    """An edge of a beam.

    Attributes:
        beam: number of the beam.
        side: 1 for the left edge, −1 for the right edge.
        nodes: from the beam's start to its end (N,).
        places: X of the nodes (N, 2).
        u: fractions of the arc length of the nodes (N,).
        width: of the section at the nodes, relative to the largest (N,).
        thickness: least thickness of the beam.
        stiffness: dimensionless E over the length of an element at the nodes (N,).
    """

    beam: int
    side: float
    nodes: Ints
    places: Array
    u: Array
    width: Array
    thickness: float
    stiffness: Array

    coefficients: Array = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "coefficients", _coefficients(self.nodes.size // 2))

    def shapes(self, zeta: Array) -> tuple[Ints, Array, Array, Array]:
        """Node numbers (k, 7) within the edge, and shape functions at ζ (k,) with two derivatives, (k, 7) all."""
        last = self.nodes.size // 2 - 1
        e = np.clip((0.5 * zeta).astype(np.intp), 0, last)
        xi = zeta - 2 * e - 1.0
        powers = xi[:, None] ** np.arange(STENCIL)
        n = np.arange(1, STENCIL)
        first, second = np.zeros_like(powers), np.zeros_like(powers)
        first[:, 1:] = n * powers[:, :-1]
        second[:, 2:] = n[1:] * n[:-1] * powers[:, :-2]
        begin = np.clip(2 * e - 2, 0, self.nodes.size - STENCIL)
        own = self.coefficients[e]
        N, N1, N2 = ((polynomials[:, None] @ own)[:, 0] for polynomials in (powers, first, second))
        return begin[:, None] + np.arange(STENCIL), N, N1, N2

    def at(self, values: Array, zeta: Array) -> Array:
        """Interpolation at ζ (k,) of ``values`` (N,) at the nodes."""
        nodes, N, _, _ = self.shapes(zeta)
        return np.asarray((N * values[nodes]).sum(axis=1))

    def curve(self, x: Array, zeta: Array) -> tuple[Array, Array, Array]:
        """x, x' and x'' (k, 2) at ζ (k,), for nodes ``x`` (N, 2)."""
        nodes, N, N1, N2 = self.shapes(zeta)
        own = x[nodes]
        return (N[:, None] @ own)[:, 0], (N1[:, None] @ own)[:, 0], (N2[:, None] @ own)[:, 0]

    def outward(self, slope: Array) -> Array:
        """Unit normals (k, 2) out of the area, for x' (k, 2)."""
        normal = self.side * np.stack([-slope[:, 1], slope[:, 0]], axis=1)
        return np.asarray(normal / np.hypot(*slope.T)[:, None])
