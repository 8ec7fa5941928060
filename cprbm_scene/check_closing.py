"""Linkages that pins and drives alone hold: can they follow their inputs?

======  =====================================================================================
symbol  meaning
======  =====================================================================================
q       displacement and rotation of every body that moves, about its first point; lengths over the extent of all
c(q)    what pins, guides and drives make vanish: as many rows as there are q, or beams have a say
v       value of the drive that a stage steps
======  =====================================================================================

From station to station v goes in steps, and Newton's method closes the linkage after each; where it cannot, steps are
halved.  What no step leads beyond is a dead point, from which on the bodies are too short, or too long, for the input.
This is geometry of rigid bodies and no mechanics: it says which questions make sense.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.freedoms import unit
from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import RotationDrive, Scene, SlidingBody, TurningBody

Array = NDArray[np.float64]

STEP = 0.2  # rad (and extents) at a time
HALVINGS = 30
_NEWTON_STEPS = 12
_CLOSED = 1e-10
_FARTHEST = 0.5  # rad (and extents) in one step: farther is another way to close
_SINGULAR = 1e-8


@dataclass(slots=True)
class _Linkage:
    """The bodies that move, by name, and where they are: ``q`` (3·bodies,)."""

    scene: Scene
    extent: float
    moving: list[str]
    q: Array
    values: dict[str, float] = field(default_factory=dict)

    def closing(self, q: Array) -> tuple[Array, Array]:
        """c(q) and its derivatives by q, row by row."""
        scene, rows = self.scene, list[tuple[float, Array]]()
        for pin in scene.pins.values():
            one, other = (self._place(point, q) for point in pin.points)
            rows += [(one[0][k] - other[0][k], one[1][k] - other[1][k]) for k in (0, 1)]
        for name, body in scene.bodies.items():
            if isinstance(body, TurningBody):
                moved, by = self._moved(body.about, q)
                rows += [(moved[k], by[k]) for k in (0, 1)]
            elif isinstance(body, SlidingBody):
                e = unit(body.along)
                moved, by = self._moved(body.pin or next(iter(body.points)), q)
                rows.append((e[0] * moved[1] - e[1] * moved[0], e[0] * by[1] - e[1] * by[0]))
                if body.pin is None:
                    rows.append(self._turned(name, q))
        for name, drive in scene.drives.items():
            value = self.values.get(name, 0.0)
            if isinstance(drive, RotationDrive):
                turn, by = self._turned(drive.body, q)
                rows.append((turn - value, by))
            else:
                moved, by = self._moved(drive.point, q)
                e = unit(drive.direction)
                rows.append((float(e @ moved) - value / self.extent, e @ by))
        return np.array([c for c, _ in rows]), np.array([by for _, by in rows])

    def closed(self, q: Array) -> Array | None:
        """Where the linkage closes near ``q``; None where it does not."""
        first = q
        for _ in range(_NEWTON_STEPS):
            c, by = self.closing(q)
            if np.abs(c).max() <= _CLOSED:
                return q if np.abs(q - first).max() <= _FARTHEST else None
            try:
                q = q - np.linalg.solve(by, c)
            except np.linalg.LinAlgError:
                return None
            if not np.abs(q - first).max() <= 2.0 * _FARTHEST:
                return None
        return None

    def _place(self, point: str, q: Array) -> tuple[Array, Array]:
        """Where a point is, (2,), and its derivatives, (2, 3·bodies)."""
        name = self.scene.body_of(point)
        r, by = np.array(self.scene.place_of(point)) / self.extent, np.zeros((2, q.size))
        if name not in self.moving:
            return r, by
        i = 3 * self.moving.index(name)
        pole = np.array(next(iter(self.scene.bodies[name].points.values()))) / self.extent
        cos, sin = np.cos(q[i + 2]), np.sin(q[i + 2])
        arm = np.array([[cos, -sin], [sin, cos]]) @ (r - pole)
        by[:, i : i + 3] = [[1.0, 0.0, -arm[1]], [0.0, 1.0, arm[0]]]
        return pole + q[i : i + 2] + arm, by

    def _moved(self, point: str, q: Array) -> tuple[Array, Array]:
        """How far a point has moved, likewise."""
        place, by = self._place(point, q)
        return place - np.array(self.scene.place_of(point)) / self.extent, by

    def _turned(self, body: str, q: Array) -> tuple[float, Array]:
        """How far a body has turned, and its derivatives (3·bodies,)."""
        by = np.zeros(q.size)
        i = 3 * self.moving.index(body) + 2
        by[i] = 1.0
        return float(q[i]), by


def open_linkages(scene: Scene) -> Iterator[Mistake]:
    """Stations at which bodies that only pins, guides and drives hold cannot be where these want them.

    The scene is one in which nothing else about bodies, pins and drives is wrong.
    """
    if not scene.pins or not scene.drives:
        return
    linkage = _linkage(scene)
    if linkage is None:
        return
    for i, stage in enumerate(scene.stages):
        if stage.steps not in scene.drives:
            continue
        unit_value = 1.0 if isinstance(scene.drives[stage.steps], RotationDrive) else linkage.extent
        for j, station in enumerate(stage.stations):
            reached = _followed(linkage, stage.steps, station, STEP * unit_value)
            if reached is not None:
                found = f"{station:g}, where the linkage cannot close: {stage.steps} comes to {reached:.6g} from before"
                allowed = "what pins, guides and the other drives let it reach, without a dead point on the way"
                yield Mistake(f"stages[{i}].stations[{j}]", found, allowed)
                return


def _linkage(scene: Scene) -> _Linkage | None:
    """The scene's, where it begins; None unless pins, guides and drives give every motion."""
    places = np.array([place for body in scene.bodies.values() for place in body.points.values()])
    extent = float(np.abs(places - places[0]).max()) or 1.0
    moving = [name for name, body in scene.bodies.items() if body.motion != "fixed"]
    linkage = _Linkage(scene, extent, moving, np.zeros(3 * len(moving)))
    _, by = linkage.closing(linkage.q)
    if by.shape[0] != by.shape[1] or np.linalg.svd(by, compute_uv=False).min() < _SINGULAR:
        return None
    q = linkage.closed(linkage.q)
    if q is None:
        return None
    linkage.q = q
    return linkage


def _followed(linkage: _Linkage, drive: str, station: float, step: float) -> float | None:
    """Step a drive to a station; the value that it comes to if it cannot be reached."""
    value, size = linkage.values.get(drive, 0.0), step
    smallest = step / 2.0**HALVINGS
    while value != station:
        way = station - value
        target = station if abs(way) <= size else value + float(np.copysign(size, way))
        linkage.values[drive] = target
        q = linkage.closed(linkage.q)
        if q is None:
            linkage.values[drive] = value
            size = 0.5 * min(size, abs(way))
            if size < smallest:
                return value
        else:
            linkage.q, value = q, target
    return None
