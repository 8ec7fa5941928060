"""Stops: limits of the angle between a pinned face and its body, enforced by a stiff moment.

======  ==============================================================================
symbol  meaning
======  ==============================================================================
ψ, φ    rotation of the face, and of the body
β       angle, β⁰ + ψ − φ, with the reference angle β⁰ from the body's line to the beam, in (−π, π]
K       moment per angle beyond a limit
m       moment on the face, K (limit − β) beyond the limit, else 0
======  ==============================================================================

The energy is m²/(2 K). K is small against the nodal stiffness of the mesh and large against the stiffness of a beam's
end: a limit yields by a millionth of an angle.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import PinnedEnd, Scene
from fea_reference.solid.bodies import BodyPart, Tie, rotation_unknown

STIFFNESS = 1e6
"""K over the largest bending stiffness, per longest beam."""

_ROUNDED = 1e-9  # rad: tolerance for a reference angle of π


@dataclass(frozen=True, slots=True)
class StopPart:
    """A stop: ``psi`` is the unknown ψ, ``body`` the body's number and ``phi`` its unknown φ, None for a fixed body."""

    name: str
    psi: int
    body: int
    phi: int | None
    reference_angle: float
    least: float
    most: float

    def angle(self, z: Array) -> float:
        """β, rad."""
        return self.reference_angle + float(z[self.psi]) - (0.0 if self.phi is None else float(z[self.phi]))

    def moment(self, z: Array) -> float:
        """m, dimensionless."""
        angle = self.angle(z)
        return STIFFNESS * (float(np.clip(angle, self.least, self.most)) - angle)

    @property
    def dofs(self) -> tuple[tuple[int, float], ...]:
        """The unknowns of β with the derivatives ∂β."""
        return ((self.psi, 1.0),) if self.phi is None else ((self.psi, 1.0), (self.phi, -1.0))


def stops_of(scene: Scene, bodies: Sequence[BodyPart], ties: Sequence[Tie]) -> tuple[StopPart, ...]:
    """The scene's stops."""
    names = list(scene.beams)
    stops = []
    for name, stop in scene.stops.items():
        beam = scene.beams[stop.beam]
        end = beam.start if stop.end == "start" else beam.end
        tie = next(tie for tie in ties if (names[tie.beam], tie.end) == (stop.beam, stop.end))
        assert isinstance(end, PinnedEnd)
        psi = rotation_unknown(tie, bodies)
        assert psi is not None
        u, sign = (0.0, 1.0) if stop.end == "start" else (1.0, -1.0)
        leaving = sign * shape_of(beam.curve).tangent(np.array([u]))[0]
        line = np.array(scene.place_of(stop.towards)) - np.array(scene.place_of(end.point))
        turn = float(np.arctan2(line[0] * leaving[1] - line[1] * leaving[0], line @ leaving))
        turn += 2.0 * np.pi if turn < -np.pi + _ROUNDED else 0.0
        carrier = next(i for i, body in enumerate(bodies) if end.point in body.points)
        dofs = bodies[carrier].dofs
        least, most = (-np.inf if stop.least is None else stop.least), (np.inf if stop.most is None else stop.most)
        stops.append(StopPart(name, psi, carrier, None if dofs is None else int(dofs[2]), turn, least, most))
    return tuple(stops)
