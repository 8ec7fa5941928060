"""Where bodies are at a station, with what is fixed to them.

======  =====================================================
symbol  meaning
======  =====================================================
p₀, p   first point of a body and any place on it as drawn, m
d, φ    displacement of p₀, m, and rotation of the body
q       the place at the station: p₀ + d + R(φ)(p − p₀)
======  =====================================================

Answers that say what acts state d and φ.  Of others two known places of a body say them, or one if it does not turn.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from comparisons.bodies_drawn import Places, places_at, rotation
from comparisons.geometry import edge_places, is_free_on_the_left
from cprbm_scene import Scene, StationAnswer
from cprbm_scene.answer import Array
from cprbm_scene.statement import (
    CircleContact,
    EdgeContact,
    FixedBody,
    HalfPlaneContact,
    LineContact,
    RigidContact,
    SlidingBody,
)

_ROUND = 120
"""Corners of a circle as drawn."""


@dataclass(frozen=True, slots=True)
class Motion:
    """How a body has moved: ``first`` is p₀ (2,), ``shift`` d (2,), ``angle`` φ."""

    first: Array
    shift: Array
    angle: float

    def carried(self, places: Array) -> Array:
        """q (k, 2) of places (k, 2)."""
        c, s = cos(self.angle), sin(self.angle)
        return np.asarray(self.first + self.shift + (places - self.first) @ np.array([[c, s], [-s, c]]))


@dataclass(frozen=True, slots=True)
class Obstacle:
    """Something rigid that a beam may touch: its ``outline`` (k, 2), m, that goes round or is an edge.

    ``solid`` (k, 2) is the corresponding place behind the edge, on the side where it is rigid; of what goes round its
    middle.  ``width``, m, is that of the beam that may touch it.  ``known`` says that it is where the station has it,
    not where it began.
    """

    name: str
    outline: Array
    solid: Array
    round: bool
    width: float
    known: bool


def motions(scene: Scene, station: StationAnswer) -> dict[str, Motion | None]:
    """How each body has moved; None where the answer does not say it."""
    places = places_at(scene, station)
    return {name: _motion(scene, station, places, name) for name in scene.bodies}


def _motion(scene: Scene, station: StationAnswer, places: Places, name: str) -> Motion | None:
    body = scene.bodies[name]
    first = np.array(next(iter(body.points.values())))
    if isinstance(body, FixedBody):
        return Motion(first, np.zeros(2), 0.0)
    if name in station.bodies:
        x, y, angle = station.bodies[name]
        return Motion(first, np.array([x, y]), float(angle))
    known = next((point for point in body.points if point in places), None)
    turned = 0.0 if isinstance(body, SlidingBody) and not body.turns else rotation(scene, name, places)
    if known is None or turned is None:
        return None
    begun = Motion(np.array(body.points[known]), np.array(places[known]) - np.array(body.points[known]), turned)
    return Motion(first, begun.carried(first[None])[0] - first, turned)


def points_at(scene: Scene, station: StationAnswer) -> Places:
    """Where a station has the points of bodies, as far as the answer says it, m."""
    found = dict(places_at(scene, station))
    for name, motion in motions(scene, station).items():
        if motion is not None:
            for point, at in scene.bodies[name].points.items():
                x, y = motion.carried(np.array([at]))[0]
                found.setdefault(point, (float(x), float(y)))
    return found


def obstacles(scene: Scene, station: StationAnswer, reach: float, depth: float) -> list[Obstacle]:
    """What is rigid, where a station has it: half-planes ``reach`` to either side, edges ``depth`` deep, m."""
    moved = motions(scene, station)
    found = []
    for name, contact in scene.contacts.items():
        if not isinstance(contact, RigidContact):
            continue
        motion = moved[contact.body]
        outline, solid, round_ = _outline(contact, reach, depth)
        if motion is not None:
            outline, solid = motion.carried(outline), motion.carried(solid)
        u = np.array(scene.beams[contact.beam].knots)
        width = float(scene.beams[contact.beam].width_at(u).max())
        found.append(Obstacle(name, outline, solid, round_, width, motion is not None))
    return found


def _outline(contact: RigidContact, reach: float, depth: float) -> tuple[Array, Array, bool]:
    """Places (k, 2) along an obstacle as drawn, places behind them, and whether it goes round."""
    if isinstance(contact, CircleContact):
        angle = np.linspace(0.0, 2.0 * np.pi, _ROUND + 1)
        centre = np.array(contact.center)
        outline = centre + contact.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return outline, np.broadcast_to(centre, outline.shape), True
    assert isinstance(contact, EdgeContact)
    places = edge_places(contact, reach, _ROUND)
    if isinstance(contact, HalfPlaneContact):
        places, to_rigid = places[::-1], -1.0
    else:
        to_rigid = -1.0 if is_free_on_the_left(contact) else 1.0
    if isinstance(contact, LineContact) and contact.closed and to_rigid * _area(places) > 0.0:
        return places, np.broadcast_to(places[:-1].mean(axis=0), places.shape), True
    return places, places + to_rigid * depth * _normals(places), False


def _area(places: Array) -> float:
    """Area that a closed polygon (k, 2) goes round, positive counter-clockwise."""
    x, y = places.T
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def _normals(places: Array) -> Array:
    """Normals (k, 2) to the left of a polyline, between two pieces such that both are as deep."""
    way = np.diff(places, axis=0)
    way = way / np.hypot(way[:, 0], way[:, 1])[:, None]
    left = np.stack([-way[:, 1], way[:, 0]], axis=1)
    both = np.concatenate([left[:1], left[1:] + left[:-1], left[-1:]])
    if np.array_equal(places[0], places[-1]):
        both[0] = both[-1] = left[0] + left[-1]
    half = np.concatenate([left[:1], left])
    return np.asarray(both / np.maximum(np.sum(both * half, axis=1), 0.3)[:, None])
