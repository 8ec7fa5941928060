"""Linkages of pins, guides and drives alone without dead points before their stations.

======  ===================================================================================
symbol  meaning
======  ===================================================================================
q       displacement and rotation of every moving body about its first point, over ℓ
c(q)    residuals of pins, guides and drives: as many as there are q, or beams have a share
v       value of the drive of a stage
ℓ       extent of all points, m
======  ===================================================================================

From station to station v grows in steps.  Newton's method closes the linkage, c(q) = 0, after each step; a step without
a solution is halved.  A value of v that no step passes is a dead point.  This is geometry of rigid bodies.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from cprbm_scene import Mistake, SceneError, scene_from
from cprbm_scene.curves import unit_vector as unit
from cprbm_scene.freedoms import AXES, Freedoms
from cprbm_scene.solving import refuse
from cprbm_scene.statement import Point, RotationDrive, Scene, SlidingBody, TurningBody

Array = NDArray[np.float64]

STEP = 0.2
"""Largest step of a drive, rad or ℓ."""
HALVINGS = 30
_NEWTON_STEPS = 12
_CLOSED = 1e-10
_FARTHEST = 0.5
"""Largest change of q in a step, rad or ℓ: a larger change leads to another branch of the linkage."""
_SINGULAR = 1e-8
"""Least singular value of c' below which beams share in the motion."""


class Linkage:
    """Moving bodies of a scene with their places ``q`` (3·bodies,) and the ``values`` of the drives."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.freedoms = scene, Freedoms(scene)
        self.extent, self.values = self.freedoms.extent, dict.fromkeys(scene.drives, 0.0)
        moving = [name for name, body in scene.bodies.items() if body.motion != "fixed"]
        self._columns = {name: 3 * i for i, name in enumerate(moving)}
        self.q = np.zeros(3 * len(moving))

    def closing(self, q: Array) -> tuple[Array, Array]:
        """c(q) (rows,) and the derivatives (rows, 3·bodies)."""
        rows = list[tuple[float, Array]]()
        for pin in self.scene.pins.values():
            for axis in AXES:
                (one, by_one), (other, by_other) = (self._moved(point, axis, q) for point in pin.points)
                rows.append((one - other, by_one - by_other))
        for name, body in self.scene.bodies.items():
            if isinstance(body, TurningBody):
                rows += [self._moved(body.about, axis, q) for axis in AXES]
            elif isinstance(body, SlidingBody):
                across = (-body.along[1], body.along[0])
                rows.append(self._moved(body.pin or next(iter(body.points)), across, q))
                rows += [self._turned(name, q)] if body.pin is None else []
        for name, drive in self.scene.drives.items():
            if isinstance(drive, RotationDrive):
                (motion, by), size = self._turned(drive.body, q), 1.0
            else:
                (motion, by), size = self._moved(drive.point, drive.direction, q), self.extent
            rows.append((motion - self.values[name] / size, by))
        return np.array([c for c, _ in rows]), np.array([by for _, by in rows])

    def closed(self, q: Array) -> Array | None:
        """Places near ``q`` with c = 0; None without a solution within reach."""
        first = q
        for _ in range(_NEWTON_STEPS):
            c, by = self.closing(q)
            far = np.abs(q - first).max()
            if np.abs(c).max() <= _CLOSED:
                return q if far <= _FARTHEST else None
            if not far <= 2.0 * _FARTHEST:
                return None
            try:
                q = q - np.linalg.solve(by, c)
            except np.linalg.LinAlgError:
                return None
        return None

    def _moved(self, point: str, direction: Point, q: Array) -> tuple[float, Array]:
        """Displacement of a point along a direction, over ℓ, and the derivatives (3·bodies,)."""
        name, e, by = self.freedoms.owners[point], unit(direction), np.zeros(q.size)
        if name not in self._columns:
            return 0.0, by
        i = self._columns[name]
        x, y = self.freedoms.places[point] - np.array(next(iter(self.scene.bodies[name].points.values())))
        arm = np.array([x, y]) / self.extent
        turned = np.array([[np.cos(q[i + 2]), -np.sin(q[i + 2])], [np.sin(q[i + 2]), np.cos(q[i + 2])]]) @ arm
        by[i : i + 3] = (*e, turned[0] * e[1] - turned[1] * e[0])
        return float(e @ (q[i : i + 2] + turned - arm)), by

    def _turned(self, body: str, q: Array) -> tuple[float, Array]:
        """Rotation of a body, and the derivatives (3·bodies,)."""
        return float(q[self._columns[body] + 2]), np.eye(q.size)[self._columns[body] + 2]


def without_dead_point(data: dict[str, Any]) -> Scene:
    """The scene of plain ``data``.

    Raises:
        SceneError: the data are no valid scene, no solver answers the scene, or pins, guides and drives alone do not
            let a drive reach a station.
    """
    scene = scene_from(data)
    refuse(scene, "a random scene")
    if not scene.pins or not scene.drives:
        return scene
    linkage = Linkage(scene)
    _, by = linkage.closing(linkage.q)
    if by.shape[0] != by.shape[1] or np.linalg.svd(by, compute_uv=False).min() < _SINGULAR:
        return scene
    for stage in scene.stages:
        for station in stage.stations if stage.steps in scene.drives else ():
            if _followed(linkage, stage.steps, station) != station:
                raise SceneError([Mistake("stages", f"{station:g} of {stage.steps}", "no dead point before it")])
    return scene


def _followed(linkage: Linkage, drive: str, station: float) -> float:
    """The value of a drive on the way to a station, equal to the station without a dead point."""
    largest = STEP * (1.0 if isinstance(linkage.scene.drives[drive], RotationDrive) else linkage.extent)
    value, size = linkage.values[drive], largest
    while value != station and size >= largest / 2.0**HALVINGS:
        way = station - value
        linkage.values[drive] = station if abs(way) <= size else value + float(np.copysign(size, way))
        q = linkage.closed(linkage.q)
        if q is None:
            linkage.values[drive], size = value, 0.5 * min(size, abs(way))
        else:
            linkage.q, value = q, linkage.values[drive]
    return value
