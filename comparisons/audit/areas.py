"""A beam as a solid: what its nodes' places say of forces inside, by the auditor's own elements.

=========  =====================================================================================
u, η       fraction of the arc length, and place across in [−1, 1]
X          place at rest, of a node: p(u) + η t/2 n, with the line p, its normal n to the left and the thickness t
x          place in the state
ξ, ℓ_a     place in an element along or across, in [−1, 1]; quadratics of Lagrange through −1, 0 and 1
F          ∂x/∂X
E, S       Green's strain (Fᵀ F − I)/2, and Young/(1 − ν²) [(1 − ν) E + ν (tr E) I], St. Venant–Kirchhoff's
            stress in plane stress
f_a        force of an element on its node a, ∫ F S ∂N_a/∂X w dX
M          moment at a section where elements meet, of the f_a there of the elements beyond it, about the line
=========  =====================================================================================

The elements beyond a section bear no force and no moment together, whatever their shape: what they exert on the nodes
of the section is in equilibrium with all that acts on the nodes beyond it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from comparisons.audit.rest import Complex, Rest, coordinates
from cprbm_scene.answer import Area, Array, Shape
from cprbm_scene.geometry import points_on, tangents_on

PER_ELEMENT = 8
ROW = 8.0  # sum of magnitudes in a row of a square element's stiffness, over Young's modulus and width
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
_MEAN = np.array([1.0, 4.0, 1.0]) / 6.0


@dataclass(frozen=True)
class AreaOfBeam:
    """A beam in one state."""

    rest: Rest
    inside: Area
    shape: Shape

    @cached_property
    def nodes(self) -> Complex:
        """x (2n+1, 2m+1)."""
        return np.asarray(self.inside.x + 1j * self.inside.y)

    @cached_property
    def _resting(self) -> Complex:
        """X (2n+1, 2m+1)."""
        beam, u = self.rest.beam, self.inside.along / self.rest.length
        line, tangent = (found @ (1.0, 1j) for found in (points_on(beam.curve, u), tangents_on(beam.curve, u)))
        half = 0.5 * beam.thickness_at(u)[:, None] * self.inside.across
        return np.asarray(line[:, None] + 1j * tangent[:, None] * half)

    @cached_property
    def _strained(self) -> tuple[Array, Array, Array]:
        """f_a (n, m, 9, 2), ½ E·S w dX (n, m, 9) and det F (n, m, 9), by elements and Gauss points."""
        values, slopes = _quadratics(_GAUSS)
        along = np.einsum("ia,jb->ijab", slopes, values).reshape(9, 9)
        across = np.einsum("ia,jb->ijab", values, slopes).reshape(9, 9)
        shape = np.einsum("ia,jb->ijab", values, values).reshape(9, 9)
        X, x = (_of_elements(grid) for grid in (self._resting, self.nodes))  # n, m, 9, 2
        J, j = (
            np.stack((np.einsum("qa,nmai->nmqi", along, places), np.einsum("qa,nmai->nmqi", across, places)), axis=-1)
            for places in (X, x)
        )
        F = j @ np.linalg.inv(J)
        E = 0.5 * (F.swapaxes(-1, -2) @ F - np.eye(2))
        young, nu = self.rest.E, self.rest.nu
        trace = np.trace(E, axis1=-2, axis2=-1)[..., None, None]
        S = young / (1.0 - nu**2) * ((1.0 - nu) * E + nu * trace * np.eye(2))
        u = np.broadcast_to((self.inside.along / self.rest.length)[:, None], self.nodes.shape).astype(complex)
        width = self.rest.beam.width_at(_of_elements(u)[..., 0] @ shape.T)
        # det J is negative where the grid is left-handed, which it is nowhere
        weight = np.linalg.det(J) * np.einsum("i,j->ij", _WEIGHTS, _WEIGHTS).ravel() * width
        gradients = np.einsum("kqa,nmqki->nmqai", np.stack((along, across)), np.linalg.inv(J))
        forces = np.einsum("nmqij,nmqaj,nmq->nmai", F @ S, gradients, weight)
        return forces, 0.5 * np.einsum("nmqij,nmqij->nmq", E, S) * weight, np.linalg.det(F)

    @property
    def strain_energy(self) -> float:
        """J."""
        return float(self._strained[1].sum())

    @property
    def thinnest(self) -> float:
        """The least det F at Gauss points."""
        return float(self._strained[2].min())

    @cached_property
    def cuts(self) -> tuple[Array, Complex, Array]:
        """Where elements meet, (n−1,): arc lengths, places of the line, and M."""
        forces, middle = self._strained[0], len(self.inside.across) // 2
        section = self.nodes[2:-1:2]
        begun = forces.reshape(*forces.shape[:2], 3, 3, 2)[1:, :, 0] @ (1.0, 1j)  # n−1, m, across
        at = np.stack([section[:, 2 * k : 2 * k + 3] for k in range(begun.shape[1])], axis=1)
        line = section[:, middle]
        moments = (np.conj(at - line[:, None, None]) * begun).imag.sum(axis=(1, 2))
        return self.inside.borders[1:-1], line, -moments

    @cached_property
    def left(self) -> Array:
        """What elements leave at the nodes, N (2n+1, 2m+1): nothing where nothing acts."""
        total, forces = np.zeros(self.nodes.shape, dtype=complex), self._strained[0] @ (1.0, 1j)
        n, m = forces.shape[:2]
        for i in range(3):
            for k in range(3):
                total[i : i + 2 * n - 1 : 2, k : k + 2 * m - 1 : 2] += forces[:, :, 3 * i + k]
        return np.abs(total)

    @property
    def rounding(self) -> float:
        """What round-off leaves of a moment, N·m."""
        rest, beam, h = self.rest, self.rest.beam, np.diff(self.inside.borders)
        stiff = rest.E * float(beam.width_at(beam.knots).max()) * max(beam.thickest / h.min(), h.max() / beam.thinnest)
        return float(ROW * stiff * np.spacing(np.abs(self.nodes).max()) * beam.thickest)

    @property
    def ends(self) -> tuple[tuple[complex, float], tuple[complex, float]]:
        """Place of the middle and turning from rest of the start's face and of the end's."""
        middle = len(self.inside.across) // 2
        faces = (self.nodes[i, -1] - self.nodes[i, 0] for i in (0, -1))
        rests = (self._resting[i, -1] - self._resting[i, 0] for i in (0, -1))
        first, last = (float(np.angle(face / rest)) for face, rest in zip(faces, rests, strict=True))
        return (complex(self.nodes[0, middle]), first), (complex(self.nodes[-1, middle]), last)

    def line(self, s: Array) -> tuple[Complex, Array]:
        """Means of the sections at arc lengths ``s`` (k,), where a load on them acts, and tangent angles of these."""
        mean = sum(
            0.5 * (self.inside.across[k + 2] - self.inside.across[k]) * self.nodes[:, k : k + 3] @ _MEAN
            for k in range(0, len(self.inside.across) - 1, 2)
        )
        return self._along(np.asarray(mean), s)

    def edge(self, side: int) -> Complex:
        """A fine line along the left edge (``side`` −1: the last of the nodes across) or the right one (0)."""
        return self._along(self.nodes[:, side], self.fine)[0]

    def resting_edge(self, side: int) -> Complex:
        """The same at rest."""
        return self._along(self._resting[:, side], self.fine)[0]

    def _along(self, nodes: Complex, s: Array) -> tuple[Complex, Array]:
        """Of what goes through ``nodes`` (2n+1,) places and tangent angles at arc lengths (k,)."""
        e = self.inside.borders
        element = np.clip(np.searchsorted(e, s, side="right") - 1, 0, len(e) - 2)
        xi = 2.0 * (s - e[element]) / np.diff(e)[element] - 1.0
        values, slopes = _quadratics(xi)
        own = nodes[2 * element[:, None] + np.arange(3)]
        return (values * own).sum(axis=1), np.angle((slopes * own).sum(axis=1))

    @cached_property
    def fine(self) -> Array:
        """Arc lengths of a fine line, borders among them."""
        e = self.inside.borders
        parts = e[:-1, None] + np.diff(e)[:, None] * (np.arange(PER_ELEMENT) / PER_ELEMENT)
        return np.append(parts.ravel(), e[-1])

    def misplaced(self, acting: Array) -> float:
        """How far the places of the shape are from the line of nodes, or the beam's end from its length, m."""
        off = self.shape.x + 1j * self.shape.y - self.nodes[:, len(self.inside.across) // 2]
        return float(max(np.max(np.abs(off)), abs(self.inside.along[-1] - self.rest.length)))


def _quadratics(xi: Array) -> tuple[Array, Array]:
    """ℓ_a at places (k,), and slopes, (k, 3)."""
    values = np.stack((0.5 * xi * (xi - 1.0), 1.0 - xi**2, 0.5 * xi * (xi + 1.0)), axis=1)
    return values, np.stack((xi - 0.5, -2.0 * xi, xi + 0.5), axis=1)


def _of_elements(grid: Complex) -> Array:
    """Of what stands at nodes (2n+1, 2m+1), as complex numbers, that of elements' nine (n, m, 9, 2)."""
    n, m = (size // 2 for size in grid.shape)
    found = np.empty((n, m, 3, 3), dtype=complex)
    for i in range(3):
        for k in range(3):
            found[:, :, i, k] = grid[i : i + 2 * n - 1 : 2, k : k + 2 * m - 1 : 2]
    return coordinates(found.reshape(n, m, 9))
