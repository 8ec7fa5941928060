"""A moment on a beam: a couple of a linear traction over the section, rotating with the section.

======  ====================================================================================
symbol  meaning
======  ====================================================================================
x_j     nodes about the section, η_j their places across, N_j its shape functions
w_j     weights, 3/2 ∫ N_j η dη: zero in sum, and Σ w_j η_j = 1
d       Σ w_j x_j, half of the section, from its line to its left, as a least-squares straight line
θ       angle of d against the reference configuration
M       moment, counter-clockwise
======  ====================================================================================

The work is M θ. Its forces f_j = M w_j S d/|d|² are the traction M η across d. Their resultant is zero, and their
moment is Σ x_j × f_j = M at any orientation. The second derivative is

    ∂²θ/∂d² = −(n τᵀ + τ nᵀ)/|d|²,    n = d/|d|,  τ = S n.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import BeamMoment
from fea_reference.solid.beam_loads import section
from fea_reference.solid.bodies import across
from fea_reference.solid.mesh import Mesh


@dataclass(frozen=True, slots=True)
class CouplePart:
    """A unit moment on a section.

    Attributes:
        name: of the load.
        nodes: about the section (k,).
        weights: w (k,).
        way: nodes (m, 2) on the right and left of the sections from a held end to this section, to count full turns.
        unit: N·m.
    """

    name: str
    nodes: Ints
    weights: Array
    way: Ints
    unit: float

    def forces(self, places: Array) -> Array:
        """Forces (k, 2) on the nodes, for positions ``places`` (N, 2) of all nodes."""
        d = self.weights @ places[self.nodes]
        return np.asarray(self.weights[:, None] * across(d) / (d @ d))

    def tangent(self, places: Array) -> tuple[Ints, Array]:
        """Unknowns (2k,) among the nodes' displacements, and the second derivative (2k, 2k) of θ."""
        d = self.weights @ places[self.nodes]
        n, tau = d / np.hypot(*d), across(d) / np.hypot(*d)
        bent = -(np.outer(n, tau) + np.outer(tau, n)) / (d @ d)
        dofs = np.stack([2 * self.nodes, 2 * self.nodes + 1], axis=1).ravel()
        return dofs, np.asarray(np.kron(np.outer(self.weights, self.weights), bent), dtype=float)

    def turned(self, drawn: Array, places: Array, start: float) -> float:
        """θ, rad, from positions ``drawn`` to ``places`` (N, 2).

        ``start`` (rad) is the rotation of the first section of the way.
        """
        leaning = [self._directions(x) for x in (drawn, places)]
        turns = np.angle(leaning[1] / leaning[0])
        turns = np.unwrap(np.concatenate([[start], turns]))
        return float(turns[-1])

    def _directions(self, places: Array) -> Array:
        """Directions (m + 1,) of the way's sections and of this section, as complex numbers."""
        apart = places[self.way[:, 1]] - places[self.way[:, 0]]
        both = np.vstack([apart, self.weights @ places[self.nodes]])
        return np.asarray(both[:, 0] + 1j * both[:, 1])


def couple(name: str, load: BeamMoment, mesh: Mesh, unit: float, *, from_end: bool) -> CouplePart:
    """A moment on a beam held at its end if ``from_end``, else at its start."""
    beam = mesh.names.index(load.beam)
    nodes, values = section(mesh, beam, np.array([load.at]))
    weights = 3.0 * values[0] * mesh.eta[nodes[0]]
    right, left = mesh.line(beam, -1.0), mesh.line(beam, 1.0)
    before = mesh.u[right] >= load.at if from_end else mesh.u[right] <= load.at
    way = np.stack([right[before], left[before]], axis=1)
    kept = weights != 0.0
    return CouplePart(name, nodes[0][kept], weights[kept], way[::-1] if from_end else way, unit)
