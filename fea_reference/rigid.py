"""Residual and tangent of the rigid parts: joints, hinges, guides, drives, stops and loads on bodies.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
X, φ    displacement of a body's reference centre c, and its rotation
r, a    a point of the body from its centre, and R(φ) r, so that the point is at c + X + a
k ×     a vector turned counter-clockwise
λ       multiplier of a row
======  =====================================================================================

A point moves by δX + (k × a) δφ, and its second derivative by φ is −a. A row that prescribes n·(X + a) therefore adds
λ n to the force and λ n·(k × a) to the moment of the body, and −λ n·a to the derivative of the moment.

The parts are few and different, so that plain numbers are faster than arrays.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.acting import Acting
from fea_reference.model import MOMENTS, WAY, BodyPart, JointPart, LoadPart, Model
from fea_reference.pattern import Single
from fea_reference.state import State
from fea_reference.stops import acting_stops

Vector = tuple[float, float]


class _Frame:
    """A body in a state: ``dofs``, empty for a fixed body, and place and orientation."""

    def __init__(self, body: BodyPart, z: State) -> None:
        self.dofs: list[int] = [] if body.dofs is None else body.dofs.tolist()
        self.centre: list[float] = body.centre.tolist()
        self.X, self.Y, self.phi = (z.values.item(dof) for dof in self.dofs) if self.dofs else (0.0, 0.0, 0.0)
        self.rest = tuple(z.rest.item(dof) for dof in self.dofs[:2]) if self.dofs else (0.0, 0.0)
        self.cos, self.sin = math.cos(self.phi), math.sin(self.phi)

    def turned(self, r: Array) -> Vector:
        """a of a point."""
        x, y = r.tolist()
        return self.cos * x - self.sin * y, self.sin * x + self.cos * y


class _Sums:
    """Sums of forces and of entries of the tangent."""

    def __init__(self) -> None:
        self.at: list[int] = []
        self.forces: list[float] = []
        self.rows: list[int] = []
        self.columns: list[int] = []
        self.entries: list[float] = []

    def push(self, unknown: int, force: float) -> None:
        """Add a force to an unknown."""
        self.at.append(unknown)
        self.forces.append(force)

    def couple(self, row: int, unknown: int, value: float) -> None:
        """Add a derivative of a row by an unknown, and its mirror image."""
        self.rows += (row, unknown)
        self.columns += (unknown, row)
        self.entries += (value, value)

    def stiffen(self, unknown: int, value: float) -> None:
        """Add a derivative of the unknown's own force."""
        self.rows.append(unknown)
        self.columns.append(unknown)
        self.entries.append(value)

    def vanish(self, row: int, multiplier: float) -> None:
        """Let the multiplier of an inactive row vanish."""
        self.push(row, multiplier)
        self.stiffen(row, 1.0)

    def hold(self, row: int, multiplier: float, frame: _Frame, n: Vector, a: Vector) -> None:
        """Add a row's derivative n·(X + a) by the motions of a body."""
        lever = a[0] * n[1] - a[1] * n[0]
        if frame.dofs:
            for dof, slope in zip(frame.dofs, n, strict=False):
                if slope != 0.0:
                    self.link(row, multiplier, dof, slope)
            self.link(row, multiplier, frame.dofs[2], lever)
            self.stiffen(frame.dofs[2], -multiplier * (n[0] * a[0] + n[1] * a[1]))

    def link(self, row: int, multiplier: float, unknown: int, slope: float) -> None:
        """Add a row's constant derivative by an unknown."""
        self.push(unknown, multiplier * slope)
        self.couple(row, unknown, slope)


def rigid(model: Model, values: Array, z: State, acting: Acting) -> tuple[Array, Single]:
    """Residual (size,) and tangent of all rigid parts."""
    sums, frames = _Sums(), [_Frame(body, z) for body in model.bodies]
    ways: dict[int, list[float]] = {}
    if acting.ways is not None and model.apart:
        share = 1.0 - values[model.stepped.index(WAY)]
        ways = {
            int(end.joint.rows[0]): (share * way).tolist() for end, way in zip(model.apart, acting.ways, strict=True)
        }
    for joint in model.joints:
        if model.free(joint, acting):
            for row in joint.rows.tolist():
                sums.vanish(row, z.values.item(row))
        else:
            _join(sums, joint, frames[joint.body], z, ways.get(int(joint.rows[0]), (0.0, 0.0)))
    for hinge in model.hinges:
        for i, r, sign in zip(hinge.bodies, hinge.arms, (1.0, -1.0), strict=True):
            frame, rows = frames[i], hinge.rows.tolist()
            a = frame.turned(r)
            for row, n, c, X, own, rest in zip(
                rows, ((sign, 0.0), (0.0, sign)), frame.centre, (frame.X, frame.Y), a, frame.rest, strict=True
            ):
                sums.push(row, sign * (c + X + own) + sign * rest)
                sums.hold(row, z.values.item(row), frame, n, a)
    prescribed = values[len(model.loads) : len(model.loads) + len(model.drives)].tolist()
    for part, value in zip((*model.guides, *model.drives), (*[0.0] * len(model.guides), *prescribed), strict=True):
        frame, multiplier = frames[part.body], z.values.item(part.row)
        if part.direction is None:
            sums.push(part.row, frame.phi - value)
            sums.link(part.row, multiplier, frame.dofs[2], 1.0)
            continue
        (nx, ny), a, (x, y) = part.direction.tolist(), frame.turned(part.arm), part.arm.tolist()
        sums.push(part.row, nx * (frame.X + a[0] - x) + ny * (frame.Y + a[1] - y) - value)
        sums.hold(part.row, multiplier, frame, (nx, ny), a)
    if model.apart:
        moments = float(values[model.stepped.index(MOMENTS)])
        for end in model.apart:
            sums.push(int(end.joint.dofs[2]), -moments * end.moment)
    for stop, limit in acting_stops(model.stops, acting):
        multiplier = z.values.item(stop.row)
        sums.push(stop.row, stop.angle(z) - limit)
        sums.link(stop.row, multiplier, stop.theta, 1.0)
        if stop.phi is not None:
            sums.link(stop.row, multiplier, stop.phi, -1.0)
    for stop in model.stops:
        if stop.name not in acting.limits:
            sums.vanish(stop.row, z.values.item(stop.row))
    for load, value in zip(model.loads, values.tolist(), strict=False):
        if isinstance(load, LoadPart) and frames[load.body].dofs:
            _load(sums, load, frames[load.body], value)
    residual = np.bincount(np.array(sums.at, dtype=np.int64), np.array(sums.forces), model.size)
    rows, columns = (np.array(of, dtype=np.int64) for of in (sums.rows, sums.columns))
    return np.asarray(residual, dtype=float), Single(rows, columns, np.array(sums.entries))


def _join(sums: _Sums, joint: JointPart, frame: _Frame, z: State, way: Sequence[float]) -> None:
    """Add the two or three rows of a joint."""
    rows, dofs, a = joint.rows.tolist(), joint.dofs.tolist(), frame.turned(joint.arm)
    for i, n, X in ((0, (-1.0, 0.0), frame.X), (1, (0.0, -1.0), frame.Y)):
        multiplier = z.values.item(rows[i])
        gap = z.values.item(dofs[i]) - frame.centre[i] - X - a[i] + z.rest.item(dofs[i])
        sums.push(rows[i], gap - way[i])
        sums.link(rows[i], multiplier, dofs[i], 1.0)
        sums.hold(rows[i], multiplier, frame, n, a)
    if len(rows) == 3:
        multiplier = z.values.item(rows[2])
        sums.push(rows[2], z.values.item(dofs[2]) - frame.phi - joint.angle + z.rest.item(dofs[2]))
        sums.link(rows[2], multiplier, dofs[2], 1.0)
        if frame.dofs:
            sums.link(rows[2], multiplier, frame.dofs[2], -1.0)


def _load(sums: _Sums, load: LoadPart, frame: _Frame, value: float) -> None:
    """Add a dead load on a moving body."""
    if load.direction is None:
        sums.push(frame.dofs[2], -value)
        return
    (nx, ny), a = load.direction.tolist(), frame.turned(load.arm)
    for dof, along in zip(frame.dofs, (nx, ny, a[0] * ny - a[1] * nx), strict=True):
        sums.push(dof, -value * along)
    sums.stiffen(frame.dofs[2], value * (nx * a[0] + ny * a[1]))
