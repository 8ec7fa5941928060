"""Stops: limits of the angle at a pin, enforced by a moment.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
θ, θ⁰   rotation of the section at the pinned end, and in the reference configuration: the line's tangent angle
φ       rotation of the body
β⁰      reference angle from the line between the body's two points to the beam, in (−π, π]
β       angle, β⁰ + (θ − θ⁰) − φ
m       moment of the body on the end, counter-clockwise: m ≥ 0 at the least angle, m ≤ 0 at the most
======  =====================================================================================

A closed stop has the row β − limit = 0, and its multiplier −m adds −m (θ − φ) to the Lagrangian; an open stop has the
row m = 0. With shear the stop limits the section, not the tangent of the neutral line: the moment works on the
section.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import PinnedEnd, Scene
from fea_reference.acting import Acting
from fea_reference.hermite import Index
from fea_reference.state import State

ROUNDED = 1e-9
"""Tolerance (rad) for a reference angle of π, and for a limit at the reference angle: round-off of coordinates."""


@dataclass(frozen=True, slots=True)
class StopPart:
    """A stop: unknown ``theta`` of the end, number of the ``body``, its unknown ``phi`` if moving, ``row`` of m.

    ``offset`` is β⁰ − θ⁰; ``point`` is the pin's name, ``end`` the beam and which end. ``owner`` names the contact of
    a stop at a contact edge, see :mod:`fea_reference.own_pins`. ``beyond`` (rad) is the permitted excess of an angle
    before the stop closes at its limit.
    """

    name: str
    point: str
    body: int
    theta: int
    phi: int | None
    row: int
    offset: float
    least: float | None
    most: float | None
    end: tuple[str, str]
    owner: str = ""
    beyond: float = 0.0

    @property
    def known_as(self) -> str:
        """Name for the user: of the stop, or of its contact."""
        return self.owner or self.name

    def angle(self, z: State) -> float:
        """β, rad."""
        turned = float(z.values[self.theta] + z.rest[self.theta])
        body = 0.0 if self.phi is None else float(z.values[self.phi] + z.rest[self.phi])
        return self.offset + turned - body

    def moment(self, z: State) -> float:
        """m, dimensionless."""
        return -float(z.values[self.row])

    def margin(self, z: State) -> tuple[float, float]:
        """Distance (rad) from the nearest limit, negative beyond, and that limit (rad)."""
        angle, nearest = self.angle(z), (np.inf, np.nan)
        for limit, sign in ((self.least, 1.0), (self.most, -1.0)):
            if limit is not None and sign * (angle - limit) + self.beyond < nearest[0]:
                nearest = (sign * (angle - limit) + self.beyond, limit)
        return nearest

    def press(self, z: State, limit: float) -> float:
        """Moment of a closed stop in the direction of pressing; negative in tension."""
        return self.moment(z) if limit == self.least else -self.moment(z)


def stops_of(
    scene: Scene, bodies: dict[str, tuple[int, Index | None]], ends: dict[tuple[str, str], tuple[int, float]], row: int
) -> tuple[StopPart, ...]:
    """The scene's stops.

    Args:
        scene: the scene.
        bodies: number and unknowns of the bodies.
        ends: unknown of the rotation and θ⁰ (rad) at the ends of the beams, by beam and end.
        row: of the first stop.
    """
    stops = []
    for i, (name, stop) in enumerate(scene.stops.items()):
        beam = scene.beams[stop.beam]
        end = beam.start if stop.end == "start" else beam.end
        assert isinstance(end, PinnedEnd)
        theta, drawn = ends[stop.beam, stop.end]
        line: Array = np.array(scene.place_of(stop.towards)) - np.array(scene.place_of(end.point))
        along = drawn if stop.end == "start" else drawn + np.pi  # out of the pin into the beam
        angle = float(np.remainder(along - np.arctan2(line[1], line[0]), 2.0 * np.pi))
        angle -= 2.0 * np.pi if angle > np.pi + ROUNDED else 0.0
        number, dofs = bodies[scene.body_of(end.point)]
        phi = None if dofs is None else int(dofs[2])
        ends_of = (stop.beam, stop.end)
        stops.append(
            StopPart(name, end.point, number, theta, phi, row + i, angle - drawn, stop.least, stop.most, ends_of)
        )
    return tuple(stops)


def acting_stops(stops: tuple[StopPart, ...], acting: Acting) -> tuple[tuple[StopPart, float], ...]:
    """The closed stops with their limits."""
    return tuple((stop, acting.limits[stop.name]) for stop in stops if stop.name in acting.limits)
