"""Stops: limits of the angle at a pin, each with a moment of its own that holds it.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
θ, θ⁰   rotation of the section at the pinned end, and as drawn: the tangent angle of the line
φ       rotation of the body
β⁰      angle as drawn, from the line between the body's two points to the beam, in (−π, π]
β       angle, β⁰ + (θ − θ⁰) − φ
m       moment of the body on the end, counter-clockwise: m ≥ 0 at the least angle, m ≤ 0 at the most
======  =====================================================================================

Where a stop acts its row is β − limit = 0, and its multiplier −m adds −m (θ − φ) to the Lagrangian; where not, the row
is m = 0.  With shear the neutral line leans from the section by the angle of shear; the moment does its work on the
section, and it is the section that is limited.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import PinnedEnd, Scene
from fea_reference.acting import Acting
from fea_reference.hermite import Index
from fea_reference.state import State

_ROUNDED = 1e-9  # rad: an angle that is π may be drawn a little beyond


@dataclass(frozen=True, slots=True)
class StopPart:
    """A stop: unknown ``theta`` of the end, number of the ``body`` and its unknown ``phi`` if it moves, ``row`` of m.

    ``offset`` is β⁰ − θ⁰; ``point`` names the pin's, ``end`` the beam and which end of it.  ``owner`` names the contact
    whose edge the end is pinned to, of a stop that is one, see :mod:`fea_reference.own_pins`; ``beyond`` (rad) is how
    far an angle may be beyond a limit before the stop acts, and brings it there.
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
        """What it is to the scene: a stop of its own, or a contact."""
        return self.owner or self.name

    def angle(self, z: State) -> float:
        """β, rad."""
        turned = float(z.values[self.theta] + z.rest[self.theta])
        body = 0.0 if self.phi is None else float(z.values[self.phi] + z.rest[self.phi])
        return self.offset + turned - body

    def moment(self, z: State) -> float:
        """m, without units."""
        return -float(z.values[self.row])

    def room(self, z: State) -> tuple[float, float]:
        """How far the angle is from either limit, negative beyond it, and the nearer of the two limits; rad."""
        angle, found = self.angle(z), (np.inf, np.nan)
        for limit, sign in ((self.least, 1.0), (self.most, -1.0)):
            if limit is not None and sign * (angle - limit) + self.beyond < found[0]:
                found = (sign * (angle - limit) + self.beyond, limit)
        return found

    def press(self, z: State, limit: float) -> float:
        """With what the stop presses where it holds at a ``limit``; negative where it pulls."""
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
    found = []
    for i, (name, stop) in enumerate(scene.stops.items()):
        beam = scene.beams[stop.beam]
        end = beam.start if stop.end == "start" else beam.end
        assert isinstance(end, PinnedEnd)
        theta, drawn = ends[stop.beam, stop.end]
        line: Array = np.array(scene.place_of(stop.towards)) - np.array(scene.place_of(end.point))
        along = drawn if stop.end == "start" else drawn + np.pi  # out of the pin into the beam
        angle = float(np.remainder(along - np.arctan2(line[1], line[0]), 2.0 * np.pi))
        angle -= 2.0 * np.pi if angle > np.pi + _ROUNDED else 0.0
        number, dofs = bodies[scene.body_of(end.point)]
        phi = None if dofs is None else int(dofs[2])
        ends_of = (stop.beam, stop.end)
        found.append(
            StopPart(name, end.point, number, theta, phi, row + i, angle - drawn, stop.least, stop.most, ends_of)
        )
    return tuple(found)


def acting_stops(stops: tuple[StopPart, ...], acting: Acting) -> tuple[tuple[StopPart, float], ...]:
    """The stops that hold, each with its limit."""
    return tuple((stop, acting.limits[stop.name]) for stop in stops if stop.name in acting.limits)
