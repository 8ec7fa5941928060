"""Total Lagrangian elements of a St. Venant–Kirchhoff material in plane stress.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
u       displacement of the nodes
F       deformation gradient, I + ∂u/∂X
E       Green's strain, (Fᵀ F − I)/2, as (E₁₁, E₂₂, 2 E₁₂)
C       plane stress: E/(1 − ν²) [[1, ν, 0], [ν, 1, 0], [0, 0, (1 − ν)/2]]
S       second Piola–Kirchhoff stress, C E
B       ∂E/∂u at a Gauss point
σ       stress in the second part of the tangent: S, or the predicted S
======  =====================================================================================

The energy is ∫ ½ Eᵀ C E, the force ∫ Bᵀ S, the tangent ∫ Bᵀ C B + ∂N·σ·∂N. During Newton's iterations σ is the
prediction of the last step, C (E + B δu). The residual stays exact, and spurious stresses of an intermediate state do
not stiffen a rotating slender body. Source: mixed integration points of Magisano, Leonetti, Garcea, Int. J. Numer.
Meth. Engng 109 (2017) 1237.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix

from cprbm_scene.answer import Array, Ints
from fea_reference.solid.mesh import Mesh


@dataclass(frozen=True, slots=True)
class Pattern:
    """Constant sparsity pattern of the elements' matrices.

    ``index`` (e·18·18,) gives the matrix entry of every element entry; ``rows`` and ``pointers`` belong to a
    :class:`scipy.sparse.csc_matrix`.
    """

    index: Ints
    rows: Ints
    pointers: Ints
    size: int

    def matrix(self, local: Array) -> csc_matrix:
        """The sum of local symmetric matrices (e, 18, 18)."""
        data = np.bincount(self.index, local.ravel(), self.rows.size)
        return csc_matrix((data, self.rows, self.pointers), (self.size, self.size))


@dataclass(frozen=True, slots=True)
class Elements:
    """Constant data: the ``mesh``, dimensionless C (e, 3, 3), the unknowns (e, 18), and the pattern."""

    mesh: Mesh
    elasticity: Array
    dofs: Ints
    pattern: Pattern


@dataclass(frozen=True, slots=True)
class Strained:
    """Elements in a state of displacement.

    Attributes:
        elements: constant data.
        F: deformation gradients (e, q, 2, 2).
        strain: E (e, q, 3).
        stress: S (e, q, 3).
        B: (e, q, 3, 18).
        determinants: det F at the Gauss points (e, q).
    """

    elements: Elements
    F: Array
    strain: Array
    stress: Array
    B: Array
    determinants: Array

    @property
    def energy(self) -> float:
        """Strain energy of all elements."""
        return 0.5 * float(np.einsum("eqi,eqi,eq->", self.strain, self.stress, self.elements.mesh.weights))

    @property
    def gradient(self) -> Array:
        """Forces of the elements' nodes (e, 18)."""
        weighted = self.stress * self.elements.mesh.weights[..., None]
        return np.asarray(np.einsum("eqij,eqi->ej", self.B, weighted))

    def predicted(self, step: Array) -> Array:
        """σ (e, q, 3): S after a ``step`` of the displacements (2N,), to first order."""
        change = np.einsum("eqij,ej->eqi", self.B, step[self.elements.dofs])
        return np.asarray((self.strain + change) @ self.elements.elasticity)

    def hessian(self, sigma: Array) -> Array:
        """The tangents (e, 18, 18) with σ (e, q, 3)."""
        mesh = self.elements.mesh
        e, q = mesh.weights.shape
        flat = self.B.reshape(e, 3 * q, 18)
        weighted = self.elements.elasticity[:, None] @ self.B * mesh.weights[:, :, None, None]
        local = flat.transpose(0, 2, 1) @ weighted.reshape(e, 3 * q, 18)
        tensor = sigma[..., [[0, 2], [2, 1]]] * mesh.weights[..., None, None]
        pulled = (mesh.gradients @ tensor).transpose(0, 2, 1, 3).reshape(e, 9, 2 * q)
        second = pulled @ mesh.gradients.transpose(0, 1, 3, 2).reshape(e, 2 * q, 9)
        local[:, 0::2, 0::2] += second
        local[:, 1::2, 1::2] += second
        return local


def build_elements(mesh: Mesh, elasticity: Array) -> Elements:
    """Elements of a mesh with C (beams, 3, 3) by beam."""
    dofs = np.stack([2 * mesh.cells, 2 * mesh.cells + 1], axis=2).reshape(len(mesh.cells), 18)
    size = 2 * len(mesh.places)
    rows = np.broadcast_to(dofs[:, :, None], (len(dofs), 18, 18)).ravel()
    columns = np.broadcast_to(dofs[:, None, :], (len(dofs), 18, 18)).ravel()
    keys, index = np.unique(columns * size + rows, return_inverse=True)
    pointers = np.searchsorted(keys // size, np.arange(size + 1))
    return Elements(mesh, elasticity[mesh.owners], dofs, Pattern(index, keys % size, pointers, size))


def plane_stress(youngs_modulus: float, poisson_ratio: float) -> Array:
    """C (3, 3), in the unit of Young's modulus."""
    nu = poisson_ratio
    return youngs_modulus / (1.0 - nu**2) * np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - nu)]])


def strain_elements(elements: Elements, u: Array) -> Strained:
    """The elements under displacements (2N,)."""
    mesh = elements.mesh
    e, q = mesh.weights.shape
    local = u[elements.dofs].reshape(e, 1, 9, 2)
    H = local.transpose(0, 1, 3, 2) @ mesh.gradients  # ∂u_i/∂X_j
    F = H + np.eye(2)
    green = 0.5 * (H + H.transpose(0, 1, 3, 2) + H.transpose(0, 1, 3, 2) @ H)
    strain = np.stack([green[..., 0, 0], green[..., 1, 1], 2.0 * green[..., 0, 1]], axis=-1)
    B = np.empty((e, q, 3, 9, 2))
    G = mesh.gradients
    B[:, :, 0] = F[:, :, None, :, 0] * G[..., 0, None]
    B[:, :, 1] = F[:, :, None, :, 1] * G[..., 1, None]
    B[:, :, 2] = F[:, :, None, :, 0] * G[..., 1, None] + F[:, :, None, :, 1] * G[..., 0, None]
    determinants = F[..., 0, 0] * F[..., 1, 1] - F[..., 0, 1] * F[..., 1, 0]
    return Strained(elements, F, strain, strain @ elements.elasticity, B.reshape(e, q, 3, 18), determinants)
