"""Energy, closure and contact of the paper, with first derivatives, in dense NumPy.

=========  ====================================================================================================
symbol     meaning
=========  ====================================================================================================
z          unknowns: θ of the links that turn, then u, v, φ of the bodies, (n_z,)
p_j        place of a joint, eq. (6): the beam's start and L_i (cos θ_i, sin θ_i) of the links before it
s          a spot: reference place + (u, v) + R(φ) r
PE         Σ ½ k δ² − W, eq. (4)
Z, μ       equalities, and their multipliers
c, λ       contact constraints c ≤ 0, and their multipliers λ ≥ 0
J_x, J_y   derivatives of the joints' x and y over z
=========  ====================================================================================================

This is the textbook's way to hand such a problem to an optimiser, written a second time from the record alone: dense,
all constraints carried, nothing shared with the solver that is compared.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.peers.fitting import Fitted
from cprbm_scene.answer import Array, Ints

if TYPE_CHECKING:
    from benchmarks.peers.record import Discretised, FittedContact, RoundContact, Spot


@dataclass(frozen=True, slots=True)
class At:
    """What a z means: angles of all links (n,), ``bodies`` (B, 3), and places of each beam's joints."""

    theta: Array
    bodies: Array
    x: tuple[Array, ...]
    y: tuple[Array, ...]


@dataclass(frozen=True)
class Formulas:
    """The functions of a problem; every one takes z (n_z,)."""

    problem: Discretised

    @cached_property
    def turning(self) -> Ints:
        """Numbers of the links that are unknowns."""
        return np.setdiff1d(np.arange(len(self.problem.rest)), self.problem.fixed)

    @cached_property
    def size(self) -> int:
        """n_z."""
        return len(self.turning) + self.problem.references.size // 2 * 3

    @cached_property
    def rest(self) -> Array:
        """z of the state without stress, at which every solve begins."""
        return np.concatenate((self.problem.rest[self.turning], np.zeros(self.size - len(self.turning))))

    @property
    def equalities(self) -> int:
        """Number of the rows of Z."""
        p = self.problem
        return 2 * len(p.ends) + len(p.welds) + 2 * len(p.pins) + len(p.held)

    def at(self, z: Array) -> At:
        """Angles, bodies and joints."""
        p = self.problem
        theta = p.rest.copy()
        theta[self.turning] = z[: len(self.turning)]
        bodies = z[len(self.turning) :].reshape(-1, 3)
        dx, dy = p.lengths * np.cos(theta), p.lengths * np.sin(theta)
        x, y = [], []
        for beam in p.beams:
            links = slice(beam.first, beam.first + beam.count)
            x0, y0 = self._place(beam.start, bodies)
            x.append(x0 + np.concatenate(([0.0], np.cumsum(dx[links]))))
            y.append(y0 + np.concatenate(([0.0], np.cumsum(dy[links]))))
        return At(theta, bodies, tuple(x), tuple(y))

    # energy

    def energy(self, z: Array) -> float:
        """PE."""
        p = self.problem
        theta = p.rest.copy()
        theta[self.turning] = z[: len(self.turning)]
        bodies = z[len(self.turning) :].reshape(-1, 3)
        turns = np.diff(theta) - p.rest_turns
        work = 0.0
        for load in p.loads:
            x, y = self._place(load.at, bodies)
            x0, y0 = self._place(load.at, np.zeros_like(bodies))
            work += load.force[0] * (x - x0) + load.force[1] * (y - y0) + load.moment * bodies[load.at.body, 2]
        return float(0.5 * np.dot(p.couplings * turns, turns) - work)

    def strain_slope(self, z: Array) -> Array:
        """The springs' part of ∂PE/∂z (n_z,)."""
        p, at = self.problem, self.at(z)
        moments = p.couplings * (np.diff(at.theta) - p.rest_turns)
        slope = np.append(0.0, moments) - np.append(moments, 0.0)
        return np.concatenate((slope[self.turning], np.zeros(at.bodies.size)))

    def energy_slope(self, z: Array) -> Array:
        """∂PE/∂z (n_z,)."""
        found, at = self.strain_slope(z), self.at(z)
        for load in self.problem.loads:
            rows_x, rows_y = self._spot_rows(load.at, at)
            found -= load.force[0] * rows_x + load.force[1] * rows_y
            found[self._phi(load.at.body)] -= load.moment
        return found

    # equalities

    def closure(self, z: Array) -> Array:
        """Z."""
        p, at = self.problem, self.at(z)
        values: list[float] = []
        for beam, spot in p.ends:
            x, y = self._place(spot, at.bodies)
            values += [at.x[beam][-1] - x, at.y[beam][-1] - y]
        for link, body in p.welds:
            values.append(at.theta[link] - p.rest[link] - (at.bodies[body, 2] if body >= 0 else 0.0))
        for one, other in p.pins:
            x, y = self._place(one, at.bodies)
            a, b = self._place(other, at.bodies)
            values += [x - a, y - b]
        for held in p.held:
            x, y = self._place(held.at, at.bodies)
            x0, y0 = self._place(held.at, np.zeros_like(at.bodies))
            moved = held.along[0] * (x - x0) + held.along[1] * (y - y0)
            values.append(moved + held.turn * at.bodies[held.at.body, 2] - held.value)
        return np.array(values)

    def closure_slope(self, z: Array) -> Array:
        """∂Z/∂z (rows, n_z)."""
        p, at = self.problem, self.at(z)
        rows: list[Array] = []
        for beam, spot in p.ends:
            last = np.array([p.beams[beam].count])
            for joint, point in zip(self._joint_rows(beam, last, at), self._spot_rows(spot, at), strict=True):
                rows.append(joint[0] - point)
        for link, body in p.welds:
            row = np.zeros(self.size)
            row[: len(self.turning)] = self.turning == link
            if body >= 0:
                row[self._phi(body)] -= 1.0
            rows.append(row)
        for one, other in p.pins:
            rows += [a - b for a, b in zip(self._spot_rows(one, at), self._spot_rows(other, at), strict=True)]
        for held in p.held:
            rows_x, rows_y = self._spot_rows(held.at, at)
            row = held.along[0] * rows_x + held.along[1] * rows_y
            row[self._phi(held.at.body)] += held.turn
            rows.append(row)
        return np.array(rows).reshape(-1, self.size)

    # contact

    def contact(self, z: Array) -> Array:
        """c of all contacts, those with a fitted curve first."""
        at = self.at(z)
        values = [self._fit(contact, at).values() for contact in self.problem.fitted]
        for circle in self.problem.circles:
            rx, ry = self._from_centre(circle, at)
            values.append(circle.radii - np.hypot(rx, ry))
        return np.concatenate([np.zeros(0), *values])

    def contact_slope(self, z: Array) -> Array:
        """∂c/∂z (m, n_z)."""
        at = self.at(z)
        rows = [self._fit(contact, at).slopes() @ self._entering(contact, at) for contact in self.problem.fitted]
        for circle in self.problem.circles:
            rx, ry = self._from_centre(circle, at)
            rows_x, rows_y = self._centre_rows(circle, at)
            rows.append(-(rx[:, None] * rows_x + ry[:, None] * rows_y) / np.hypot(rx, ry)[:, None])
        return np.concatenate([np.zeros((0, self.size)), *rows])

    def contact_forces(self, z: Array, lam: Array) -> dict[str, float]:
        """Magnitude of each contact's resultant on the beam whose joints are held."""
        at, found, first = self.at(z), {}, 0
        for contact in self.problem.fitted:
            m = len(contact.joints)
            over = lam[first : first + m] @ self._fit(contact, at).slopes()
            found[contact.name] = float(np.hypot(over[:m].sum(), over[m : 2 * m].sum()))
            first += m
        for circle in self.problem.circles:
            mine = lam[first : first + len(circle.joints)]
            rx, ry = self._from_centre(circle, at)
            rho = np.hypot(rx, ry)
            found[circle.name] = float(np.hypot(mine @ (rx / rho), mine @ (ry / rho)))
            first += len(circle.joints)
        return found

    def displaced(self, z: Array, point: str) -> Array:
        """By how much one of the scene's points has moved (2,), units of length."""
        at, spot = self.at(z), self.problem.points[point]
        return np.subtract(self._place(spot, at.bodies), self._place(spot, np.zeros_like(at.bodies)))

    # places

    def _phi(self, body: int) -> int:
        return len(self.turning) + 3 * body + 2

    def _arm(self, spot: Spot, bodies: Array) -> tuple[float, float]:
        if spot.body < 0:
            return spot.x, spot.y
        c, s = np.cos(bodies[spot.body, 2]), np.sin(bodies[spot.body, 2])
        return float(c * spot.x - s * spot.y), float(s * spot.x + c * spot.y)

    def _place(self, spot: Spot, bodies: Array) -> tuple[float, float]:
        rx, ry = self._arm(spot, bodies)
        if spot.body < 0:
            return rx, ry
        x, y = self.problem.references[spot.body]
        return float(x + bodies[spot.body, 0] + rx), float(y + bodies[spot.body, 1] + ry)

    def _spot_rows(self, spot: Spot, at: At) -> tuple[Array, Array]:
        """Derivatives of a spot's x and y (n_z,)."""
        rows = np.zeros((2, self.size))
        if spot.body >= 0:
            rx, ry = self._arm(spot, at.bodies)
            phi = self._phi(spot.body)
            rows[0, phi - 2] = rows[1, phi - 1] = 1.0
            rows[:, phi] = -ry, rx
        return rows[0], rows[1]

    def _joint_rows(self, beam: int, joints: Ints, at: At) -> tuple[Array, Array]:
        """J_x and J_y of some joints of a beam (k, n_z)."""
        p, mine = self.problem, self.problem.beams[beam]
        start_x, start_y = self._spot_rows(mine.start, at)
        rows_x, rows_y = np.tile(start_x, (len(joints), 1)), np.tile(start_y, (len(joints), 1))
        before = (self.turning >= mine.first) & (self.turning < mine.first + joints[:, None])
        links, m = self.turning, len(self.turning)
        rows_x[:, :m] = np.where(before, -p.lengths[links] * np.sin(at.theta[links]), 0.0)
        rows_y[:, :m] = np.where(before, p.lengths[links] * np.cos(at.theta[links]), 0.0)
        return rows_x, rows_y

    # what enters a contact

    def _from_centre(self, circle: RoundContact, at: At) -> tuple[Array, Array]:
        x, y = self._place(circle.centre, at.bodies)
        return at.x[circle.beam][circle.joints] - x, at.y[circle.beam][circle.joints] - y

    def _centre_rows(self, circle: RoundContact, at: At) -> tuple[Array, Array]:
        rows_x, rows_y = self._joint_rows(circle.beam, circle.joints, at)
        centre_x, centre_y = self._spot_rows(circle.centre, at)
        return rows_x - centre_x, rows_y - centre_y

    def _mean(self, contact: FittedContact, at: At) -> Array:
        """Tangent at the boundary's points, eq. (9)."""
        links = self.problem.beams[contact.boundary].first + contact.points
        return np.asarray(0.5 * (at.theta[links - 1] + at.theta[links]))

    def _offset(self, contact: FittedContact, at: At) -> tuple[Array, Array]:
        mean = self._mean(contact, at)
        return -contact.offset * np.sin(mean), contact.offset * np.cos(mean)

    def _fit(self, contact: FittedContact, at: At) -> Fitted:
        ox, oy = self._offset(contact, at)
        x, y = at.x[contact.beam][contact.joints], at.y[contact.beam][contact.joints]
        bx, by = at.x[contact.boundary][contact.points] + ox, at.y[contact.boundary][contact.points] + oy
        if contact.along_x:
            return Fitted(x, y, bx, by, contact.degree, contact.sense)
        return Fitted(y, x, by, bx, contact.degree, contact.sense)

    def _columns(self, contact: FittedContact, behind: int) -> Ints:
        """Where the link before (0) or behind (1) each of the boundary's points stands in z; −1 for a fixed one."""
        links = self.problem.beams[contact.boundary].first + contact.points - 1 + behind
        where = np.full(len(self.problem.rest), -1, dtype=np.intp)
        where[self.turning] = np.arange(len(self.turning))
        return where[links]

    def _entering(self, contact: FittedContact, at: At) -> Array:
        """Derivatives of (a, o, A, B) over z (2m + 2n, n_z)."""
        x, y = self._joint_rows(contact.beam, contact.joints, at)
        bx, by = self._joint_rows(contact.boundary, contact.points, at)
        ox, oy = self._offset(contact, at)
        for behind in (0, 1):
            columns = self._columns(contact, behind)
            there = np.flatnonzero(columns >= 0)
            bx[there, columns[there]] -= 0.5 * oy[there]
            by[there, columns[there]] += 0.5 * ox[there]
        return np.vstack((x, y, bx, by) if contact.along_x else (y, x, by, bx))
