"""Mesh of all beams' areas: quadrilaterals of second order, mapped from rectangles.

======  ================================================================
symbol  meaning
======  ================================================================
u, η    fraction of a beam's arc length, and place across in [−1, 1]
X       reference position of a node, over the longest beam
N_a     shape function of an element's node a, biquadratic
======  ================================================================

The rectangle of beam b is [2b, 2b + 1] × [−1, 1], with n elements along, m across, and nine nodes per element. Every
node is moved to the area's point at its u and η. scikit-fem provides ∂N_a/∂X and the weights at 3 × 3 Gauss points.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem import CellBasis, ElementQuad2, MeshQuad, MeshQuad2

from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import Scene
from fea_reference.solid.areas import fractions, points

_ON = 1e-9  # of η or u: tolerance for a node on an edge

Rectangle = Callable[[Array, int], tuple[Array, NDArray[np.int64]]]
"""Corners (2, k) and quadrilaterals (4, c) of the rectangle [0, 1] × [−1, 1], from places along and a number across."""


@dataclass(frozen=True, slots=True)
class Mesh:
    """Nodes and elements of all beams.

    Attributes:
        names: of the beams, by number.
        places: X (N, 2).
        u: fractions of the arc length (N,).
        eta: places across (N,).
        beams: beam number of every node (N,).
        cells: node numbers of every element (e, 9).
        gradients: ∂N_a/∂X (e, 9 Gauss points, 9 nodes, 2).
        weights: areas of the Gauss points (e, 9), times the local width over the largest.
        owners: beam number of every element (e,).
        origin: origin of the places (2,), m.
    """

    names: tuple[str, ...]
    places: Array
    u: Array
    eta: Array
    beams: Ints
    cells: Ints
    gradients: Array
    weights: Array
    owners: Ints
    origin: Array

    def line(self, beam: int, eta: float) -> Ints:
        """The nodes of a beam at a place across, from its start to its end."""
        nodes = np.flatnonzero((self.beams == beam) & (np.abs(self.eta - eta) < _ON))
        return np.asarray(nodes[np.argsort(self.u[nodes])])

    def face(self, beam: int, u: float) -> Ints:
        """The nodes of a beam's section, from its right to its left."""
        nodes = np.flatnonzero((self.beams == beam) & (np.abs(self.u - u) < _ON))
        return np.asarray(nodes[np.argsort(self.eta[nodes])])


def plain_rectangle(along: Array, across: int) -> tuple[Array, NDArray[np.int64]]:
    """A rectangle by NumPy alone, see :data:`Rectangle`."""
    mesh = MeshQuad.init_tensor(along, np.linspace(-1.0, 1.0, across + 1))
    return np.ascontiguousarray(mesh.p), np.ascontiguousarray(mesh.t)


def build_mesh(
    scene: Scene, counts: Mapping[str, int], across: int, length: float, rectangle: Rectangle = plain_rectangle
) -> Mesh:
    """Mesh of a scene's beams.

    Args:
        scene: with the beams.
        counts: elements along every beam.
        across: elements across all beams.
        length: of the longest beam, m.
        rectangle: mesher of a rectangle.
    """
    corners, quadrilaterals, first = [], [], 0
    for number, (name, beam) in enumerate(scene.beams.items()):
        p, t = rectangle(fractions(beam, counts[name]), across)
        corners.append(p + np.array([[2.0 * number], [0.0]]))
        quadrilaterals.append(t + first)
        first += p.shape[1]
    flat = MeshQuad2.from_mesh(MeshQuad(np.ascontiguousarray(np.hstack(corners)), np.hstack(quadrilaterals)))
    number = np.minimum((flat.doflocs[0] // 2.0).astype(np.intp), len(scene.beams) - 1)
    u, eta = np.clip(flat.doflocs[0] - 2.0 * number, 0.0, 1.0), np.asarray(flat.doflocs[1])
    places = np.empty((u.size, 2))
    for i, beam in enumerate(scene.beams.values()):
        own = number == i
        places[own] = points(beam, u[own], eta[own]) / length
    origin = places[0].copy()
    places -= origin  # avoids round-off of places far from the scene's origin
    basis = CellBasis(MeshQuad2(np.ascontiguousarray(places.T), flat.t), ElementQuad2(), intorder=5)
    cells = np.asarray(basis.element_dofs.T, dtype=np.intp)
    gradients = np.stack([np.asarray(shape[0].grad) for shape in basis.basis])  # (9, 2, e, q)
    owners = number[cells[:, 0]]
    values = np.stack([np.asarray(shape[0])[0] for shape in basis.basis])  # (9, q)
    widest = max(float(beam.width_at(beam.knots).max()) for beam in scene.beams.values())
    width = np.empty(basis.dx.shape)
    for i, beam in enumerate(scene.beams.values()):
        own = owners == i
        width[own] = beam.width_at(u[cells[own]] @ values) / widest
    return Mesh(
        tuple(scene.beams),
        places,
        u,
        eta,
        number,
        cells,
        np.ascontiguousarray(gradients.transpose(2, 3, 0, 1)),
        np.asarray(basis.dx) * width,
        owners,
        origin * length,
    )
