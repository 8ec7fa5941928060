"""Rigid shapes on a body, and their distance from points.

======  =====================================================================
symbol  meaning
======  =====================================================================
x       the point; c, X, φ a body's centre, displacement and rotation
ξ       the point in the frame of the body, R(φ)ᵀ (x − c − X)
g(ξ)    gap, positive outside; h = ∂g/∂ξ (a unit vector), H = ∂²g/∂ξ²
S       rotation by a right angle
======  =====================================================================

    ∂ξ/∂x = Rᵀ,   ∂ξ/∂X = −Rᵀ,   ∂ξ/∂φ = −S ξ,
    ∂²ξ/∂φ² = −ξ,   ∂²ξ/∂φ∂x = −S Rᵀ,   ∂²ξ/∂φ∂X = S Rᵀ.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.solid.bodies import BodyPart, turned
from fea_reference.solid.edges import Broken, Graph

_S = np.array([[0.0, -1.0], [1.0, 0.0]])


@dataclass(frozen=True, slots=True)
class Round:
    """A circle of ``radius`` about ``centre`` (2,), in the frame of the body."""

    centre: Array
    radius: float

    def measured(self, xi: Array) -> tuple[Array, Array, Array]:
        """g (k,), h (k, 2) and H (k, 2, 2) at ξ (k, 2)."""
        away = xi - self.centre
        distance = np.hypot(*away.T)
        h = away / distance[:, None]
        H = (np.eye(2) - h[:, :, None] * h[:, None, :]) / distance[:, None, None]
        return distance - self.radius, h, H


@dataclass(frozen=True, slots=True)
class Half:
    """A half-plane through ``point`` (2,) with outward ``normal`` (2,), in the frame of the body."""

    point: Array
    normal: Array

    def measured(self, xi: Array) -> tuple[Array, Array, Array]:
        """g (k,), h (k, 2) and H (k, 2, 2) at ξ (k, 2)."""
        return (xi - self.point) @ self.normal, np.broadcast_to(self.normal, xi.shape), np.zeros((len(xi), 2, 2))


Shape = Round | Half | Broken | Graph


def in_body_frame(body: BodyPart, points: Array, z: Array) -> Array:
    """ξ (k, 2) of points (k, 2)."""
    X, Y, phi = body.state(z)
    return turned(points - body.centre - np.array([X, Y]), -phi)


def variations(shape: Shape, body: BodyPart, points: Array, shapes: Array, z: Array) -> tuple[Array, Array, Array]:
    """g (k,), ∂g (k, 17) and ∂²g (k, 17, 17).

    The 17 unknowns are (x, y) of the point's seven nodes, with shape functions ``shapes`` (k, 7), and (X, Y, φ).
    """
    k, n = len(points), 2 * shapes.shape[1]
    xi = in_body_frame(body, points, z)
    g, h, H = shape.measured(xi)
    phi = float(body.state(z)[2])
    Rt = np.array([[np.cos(phi), np.sin(phi)], [-np.sin(phi), np.cos(phi)]])
    change = np.zeros((k, 2, n + 3))  # ∂ξ
    change[:, :, :n] = (shapes[:, None, :, None] * Rt[None, :, None, :]).reshape(k, 2, n)
    change[:, :, n : n + 2] = -Rt
    change[:, :, n + 2] = -xi @ _S.T
    first = np.einsum("ki,kij->kj", h, change)
    second = change.transpose(0, 2, 1) @ H @ change
    swing = -h @ (_S @ Rt)  # h·∂²ξ/∂φ∂x
    mixed = (shapes[:, :, None] * swing[:, None, :]).reshape(k, n)
    second[:, n + 2, :n] += mixed
    second[:, :n, n + 2] += mixed
    second[:, n + 2, n : n + 2] -= swing
    second[:, n : n + 2, n + 2] -= swing
    second[:, n + 2, n + 2] -= (h * xi).sum(axis=1)
    return g, first, second
