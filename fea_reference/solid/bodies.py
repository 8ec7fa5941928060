"""Rigid bodies, and the end faces of beams tied to them.

======  =====================================================================
symbol  meaning
======  =====================================================================
X, φ    displacement of a body's centre and its rotation
R(φ)    rotation by φ; S by a right angle
r       arm from the centre in the reference configuration
ψ       rotation of a face about its pin
o       from a pinned face's middle to its nodes, in the reference configuration
u       displacement of a node
======  =====================================================================

The whole face of a welded end moves with the body, u = X + (R(φ) − I) r. The face of a pinned end is rigid and
rotates about its middle, and the middle moves with the body. Then u = X + (R(φ) − I) a + (R(ψ) − I) o, with a from
the centre to the pin. The unknowns include both kinematically: nodes of a face have no unknowns, and a tie has no
violation. The face of an end drawn apart from its point is a separate body, pinned to the point by rows after the
assembly.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import Scene


@dataclass(frozen=True, slots=True)
class BodyPart:
    """A rigid body: ``centre`` (2,), ``points`` (2,) by name, and the unknowns (X, Y, φ) of a moving body."""

    name: str
    centre: Array
    points: dict[str, Array]
    dofs: Ints | None

    def state(self, z: Array) -> Array:
        """(X, Y, φ), zero for a fixed body."""
        return np.zeros(3) if self.dofs is None else np.asarray(z[self.dofs])

    def arm(self, point: str) -> Array:
        """r (2,) of a point."""
        return np.asarray(self.points[point] - self.centre)

    def carried(self, arms: Array, z: Array) -> Array:
        """Positions of points with ``arms`` (..., 2)."""
        X, Y, phi = self.state(z)
        return np.asarray(self.centre + np.array([X, Y]) + turned(arms, phi))

    def motion(self, arms: Array, z: Array) -> Array:
        """Displacements of points with ``arms`` (..., 2)."""
        X, Y, phi = self.state(z)
        return np.asarray(np.array([X, Y]) + displaced(arms, phi))


@dataclass(frozen=True, slots=True)
class Tie:
    """A beam's end face joined to a body's point.

    ``nodes`` (k,) run from the right to the left; ``pin`` is the arm of the face's middle (2,), ``offsets`` o (k, 2);
    ``psi`` is the unknown ψ, or None for a welded face.
    """

    beam: int
    end: str
    point: str
    body: int
    nodes: Ints
    pin: Array
    offsets: Array
    psi: int | None


def is_face_alone(tie: Tie, scene: Scene) -> bool:
    """True if a tie's body is the face alone, of an end drawn apart from its point."""
    return tie.body >= len(scene.bodies)


def rotation_unknown(tie: Tie, bodies: Sequence[BodyPart]) -> int | None:
    """Unknown of a face's own rotation: ψ, or φ of a body that is the face alone; None if neither exists."""
    dofs = bodies[tie.body].dofs
    return tie.psi if tie.psi is not None or dofs is None else int(dofs[2])


def turned(r: Array, phi: float) -> Array:
    """R(φ) r for vectors (..., 2)."""
    cos, sin = np.cos(phi), np.sin(phi)
    return np.stack([cos * r[..., 0] - sin * r[..., 1], sin * r[..., 0] + cos * r[..., 1]], axis=-1)


def displaced(r: Array, phi: float) -> Array:
    """(R(φ) − I) r for vectors (..., 2), without cancellation."""
    cos_minus_one, sin = -2.0 * np.sin(0.5 * phi) ** 2, np.sin(phi)
    return np.stack([cos_minus_one * r[..., 0] - sin * r[..., 1], sin * r[..., 0] + cos_minus_one * r[..., 1]], axis=-1)


def across(r: Array) -> Array:
    """S r for vectors (..., 2)."""
    return np.stack([-r[..., 1], r[..., 0]], axis=-1)
