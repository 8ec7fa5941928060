"""Dead forces on a beam, distributed uniformly over the thickness of the section.

======  ==================================================================
symbol  meaning
======  ==================================================================
ζ       place along, in elements
η       place across an element, in [−1, 1]
ℓ_i     quadratics of Lagrange through −1, 0 and 1
======  ==================================================================

A beam is loaded on its line. A point force on a solid would have unbounded displacements. Distributed over the
section the force has the same resultant on the line, and the difference decays within a thickness.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array, Ints
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import BeamForce, DistributedLoad, Scene
from fea_reference.solid.mesh import Mesh

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)


@dataclass(frozen=True, slots=True)
class AreaLoad:
    """A unit load: ``forces`` (k, 2) on ``nodes`` (k,)."""

    name: str
    nodes: Ints
    forces: Array
    unit: float


def on_area(
    name: str, load: BeamForce | DistributedLoad, scene: Scene, mesh: Mesh, force: float, length: float
) -> AreaLoad:
    """A force, or a force per length, on a beam; ``force`` (N) and ``length`` (m) are the units."""
    beam = mesh.names.index(load.beam)
    direction = np.array(load.direction) / np.hypot(*load.direction)
    if isinstance(load, BeamForce):
        at, share, unit = np.array([load.at]), np.ones(1), force
    else:
        corners = np.unique(mesh.u[mesh.line(beam, 1.0)][::2])
        fence = np.unique(np.clip(corners, *load.along))
        half = 0.5 * np.diff(fence)
        at = (fence[:-1] + half + half * _POINTS[:, None]).ravel()
        own = shape_of(scene.beams[load.beam].curve).length / length
        share, unit = (half * _WEIGHTS[:, None]).ravel() * own, force / length
    nodes, values = section(mesh, beam, at)
    weights = (values * share[:, None]).ravel()
    kept, place = np.unique(nodes.ravel(), return_inverse=True)
    return AreaLoad(name, kept, np.bincount(place, weights)[:, None] * direction, unit)


def section(mesh: Mesh, beam: int, u: Array) -> tuple[Ints, Array]:
    """Nodes (k, j) and means of their shape functions over the thickness (k, j) at sections ``u`` (k,)."""
    layers = np.unique(np.round(mesh.eta[mesh.beams == beam], 9))
    lines = [mesh.line(beam, float(eta)) for eta in layers]
    along = mesh.u[lines[0]]
    element = np.clip((np.searchsorted(along[::2], u, side="right") - 1), 0, (len(along) - 1) // 2 - 1)
    left, right = along[2 * element], along[2 * element + 2]
    xi = (2.0 * u - left - right) / (right - left)
    shapes = np.stack([0.5 * xi * (xi - 1.0), 1.0 - xi**2, 0.5 * xi * (xi + 1.0)], axis=1)
    # Simpson's rule over an element's thickness is exact for its quadratics
    across = np.zeros(len(layers))
    for first in range(0, len(layers) - 1, 2):
        across[first : first + 3] += 0.5 * (layers[first + 2] - layers[first]) * np.array([1.0, 4.0, 1.0]) / 6.0
    grid = np.stack(lines)[:, 2 * element[:, None] + np.arange(3)]  # layers, k, 3
    values = across[:, None, None] * shapes
    return grid.transpose(1, 0, 2).reshape(u.size, -1), values.transpose(1, 0, 2).reshape(u.size, -1)
