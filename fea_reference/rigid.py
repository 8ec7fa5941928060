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
from fea_reference.model import MOMENTS, WAY, BodyPart, DrivePart, JointPart, LoadPart, Model
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
    """Sums of forces, by unknown, and of entries of the tangent, by row and column."""

    def __init__(self) -> None:
        self.forces: list[tuple[int, float]] = []
        self.entries: list[tuple[int, int, float]] = []

    def link(self, row: int | None, multiplier: float, unknown: int, slope: float) -> None:
        """Add a row's derivative by an unknown; a load has a value in place of the multiplier, and no row."""
        self.forces.append((unknown, multiplier * slope))
        if row is not None:
            self.entries += ((row, unknown, slope), (unknown, row, slope))

    def hold(self, row: int | None, multiplier: float, frame: _Frame, n: Vector, a: Vector) -> None:
        """Add a row's derivative n·(X + a) by the motions of a body."""
        if not frame.dofs:
            return
        for dof, slope in zip(frame.dofs, (*n, a[0] * n[1] - a[1] * n[0]), strict=True):
            if slope != 0.0 or dof == frame.dofs[2]:
                self.link(row, multiplier, dof, slope)
        self.entries.append((frame.dofs[2], frame.dofs[2], -multiplier * (n[0] * a[0] + n[1] * a[1])))

    def guide(self, row: int | None, multiplier: float, part: LoadPart | DrivePart, frame: _Frame) -> float:
        """The motion of a body along a part's direction, or its rotation, whose derivative is added."""
        if part.direction is None:
            self.link(row, multiplier, frame.dofs[2], 1.0)
            return frame.phi
        (nx, ny), a, (x, y) = part.direction.tolist(), frame.turned(part.arm), part.arm.tolist()
        self.hold(row, multiplier, frame, (nx, ny), a)
        return float(nx * (frame.X + a[0] - x) + ny * (frame.Y + a[1] - y))

    def collected(self, size: int) -> tuple[Array, Single]:
        """The forces (size,) and the entries."""
        unknowns, forces = np.array(self.forces).reshape(-1, 2).T
        rows, columns, entries = np.array(self.entries).reshape(-1, 3).T
        residual = np.bincount(unknowns.astype(np.int64), forces, size)
        return np.asarray(residual, dtype=float), Single(rows.astype(np.int64), columns.astype(np.int64), entries)


def rigid(model: Model, values: Array, z: State, acting: Acting) -> tuple[Array, Single]:
    """Residual (size,) and tangent of all rigid parts."""
    sums, frames = _Sums(), [_Frame(body, z) for body in model.bodies]
    ends = () if acting.ways is None else zip(model.apart, acting.ways, strict=True)
    ways = {int(end.joint.rows[0]): (1.0 - values[model.stepped.index(WAY)]) * way for end, way in ends}
    inactive = [row for joint in model.joints if model.free(joint, acting) for row in joint.rows.tolist()]
    inactive += [stop.row for stop in model.stops if stop.name not in acting.limits]
    sums.forces += [(row, z.values.item(row)) for row in inactive]  # their multipliers vanish
    sums.entries += [(row, row, 1.0) for row in inactive]
    for joint in model.joints:
        if not model.free(joint, acting):
            _join(sums, joint, frames[joint.body], z, ways.get(int(joint.rows[0]), np.zeros(2)).tolist())
    for hinge in model.hinges:
        for i, r, sign in zip(hinge.bodies, hinge.arms, (1.0, -1.0), strict=True):
            frame, a = frames[i], frames[i].turned(r)
            for row, n, c, X, own, rest in zip(
                hinge.rows.tolist(),
                ((sign, 0.0), (0.0, sign)),
                frame.centre,
                (frame.X, frame.Y),
                a,
                frame.rest,
                strict=True,
            ):
                sums.forces.append((row, sign * (c + X + own) + sign * rest))
                sums.hold(row, z.values.item(row), frame, n, a)
    prescribed = values[len(model.loads) : len(model.loads) + len(model.drives)].tolist()
    for part, value in zip((*model.guides, *model.drives), (*[0.0] * len(model.guides), *prescribed), strict=True):
        motion = sums.guide(part.row, z.values.item(part.row), part, frames[part.body])
        sums.forces.append((part.row, motion - value))
    for end in model.apart:
        sums.forces.append((int(end.joint.dofs[2]), -float(values[model.stepped.index(MOMENTS)]) * end.moment))
    for stop, limit in acting_stops(model.stops, acting):
        multiplier = z.values.item(stop.row)
        sums.forces.append((stop.row, stop.angle(z) - limit))
        sums.link(stop.row, multiplier, stop.theta, 1.0)
        if stop.phi is not None:
            sums.link(stop.row, multiplier, stop.phi, -1.0)
    for load, value in zip(model.loads, values.tolist(), strict=False):
        if isinstance(load, LoadPart) and frames[load.body].dofs:
            sums.guide(None, -value, load, frames[load.body])
    return sums.collected(model.size)


def _join(sums: _Sums, joint: JointPart, frame: _Frame, z: State, way: Sequence[float]) -> None:
    """Add the two or three rows of a joint."""
    rows, dofs, a = joint.rows.tolist(), joint.dofs.tolist(), frame.turned(joint.arm)
    for i, n, X in ((0, (-1.0, 0.0), frame.X), (1, (0.0, -1.0), frame.Y)):
        multiplier = z.values.item(rows[i])
        gap = z.values.item(dofs[i]) - frame.centre[i] - X - a[i] + z.rest.item(dofs[i])
        sums.forces.append((rows[i], gap - way[i]))
        sums.link(rows[i], multiplier, dofs[i], 1.0)
        sums.hold(rows[i], multiplier, frame, n, a)
    if len(rows) == 3:
        multiplier = z.values.item(rows[2])
        sums.forces.append((rows[2], z.values.item(dofs[2]) - frame.phi - joint.angle + z.rest.item(dofs[2])))
        sums.link(rows[2], multiplier, dofs[2], 1.0)
        if frame.dofs:
            sums.link(rows[2], multiplier, frame.dofs[2], -1.0)
