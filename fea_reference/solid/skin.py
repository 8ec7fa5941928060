"""An edge of a beam's area as a curve with a continuous tangent.

======  ==========================================================================
symbol  meaning
======  ==========================================================================
ζ       place along the edge, in nodes: in [0, N − 1], two to an element
ξ       place within an element, in [−1, 1]; ζ is ξ + 1 and twice its number
x_k     nodes of the edge, N of them
P       the element's own edge, the parabola through its three nodes
δ₋, δ₊  half of what the neighbours' slopes at its ends are more than its own
x(ξ)    P − ξ (1 − ξ²) (7 ξ² − 3) [δ₋ (1 − ξ) + δ₊ (1 + ξ)]/16
======  ==========================================================================

Elements' own edges meet at an angle, small but enough that a pressure which slides over it has no tangent.  What is
added to P vanishes at the nodes, brings the slopes at the ends to their means, and has no integral nor first moment
over the element: an even pressure, or one that goes straight, is passed on to the nodes as by P itself, so that two
bodies pressed flat on each other hold it exactly.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial import polynomial

from cprbm_scene.answer import Array, Ints

STENCIL = 7
"""Nodes on which a place of an edge depends: those of its element and of both neighbours."""

_PARABOLA = np.array([[0.0, 1.0, 0.0], [-0.5, 0.0, 0.5], [0.5, -1.0, 0.5]])  # powers of ξ by nodes
_BEGIN, _END = np.array([-1.5, 2.0, -0.5]), np.array([0.5, -2.0, 1.5])  # its slopes at ξ = −1 and 1, by nodes
_WAVE = polynomial.polymul([0.0, 1.0, 0.0, -1.0], [-3.0 / 16.0, 0.0, 7.0 / 16.0])  # ξ (1 − ξ²) (7 ξ² − 3)/16


def _coefficients(elements: int) -> Array:
    """Powers of ξ by the stencil's nodes, of every element (e, 7, 7)."""
    found = np.zeros((elements, STENCIL, STENCIL))
    for e in range(elements):
        first = 2 * e - int(np.clip(2 * e - 2, 0, 2 * elements - STENCIL + 1))
        found[e, :3, first : first + 3] = _PARABOLA
        for there, own, other, beside, sign in (
            (e > 0, _BEGIN, _END, -2, -1.0),
            (e < elements - 1, _END, _BEGIN, 2, 1.0),
        ):
            if not there:
                continue
            more = np.zeros(STENCIL)
            more[first + beside : first + beside + 3] += 0.5 * other
            more[first : first + 3] -= 0.5 * own
            found[e] -= np.outer(polynomial.polymul(_WAVE, [1.0, sign]), more)
    return found


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

    coefficients: Array = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "coefficients", _coefficients(self.nodes.size // 2))

    def shapes(self, zeta: Array) -> tuple[Ints, Array, Array, Array]:
        """Places (k, 7) among the edge's nodes, and shape functions at ζ (k,) with two derivatives (k, 7) each."""
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
        N, N1, N2 = ((each[:, None] @ own)[:, 0] for each in (powers, first, second))
        return begin[:, None] + np.arange(STENCIL), N, N1, N2

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
