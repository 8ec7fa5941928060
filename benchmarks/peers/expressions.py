"""The same functions as expressions of CasADi, which differentiates them itself.

Symbols and equations are those of :mod:`benchmarks.peers.formulas` and :mod:`benchmarks.peers.fitting`; CasADi is the
optional extra ``peers``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.peers.formulas import Formulas

if TYPE_CHECKING:
    from benchmarks.peers.record import Discretised, FittedContact, RoundContact, Spot


SX = Any  # a matrix of CasADi's scalar expressions, or a number


def expressions(formulas: Formulas) -> tuple[SX, SX, SX]:
    """z, PE, and Z and c one below the other.

    Raises:
        ModuleNotFoundError: CasADi is not installed.
    """
    import casadi as ca

    problem = formulas.problem
    z = ca.SX.sym("z", formulas.size)
    theta = ca.SX(problem.rest)
    theta[formulas.turning] = z[: len(formulas.turning)]
    here = _Here(problem, theta, z[len(formulas.turning) :])
    turns = theta[1:] - theta[:-1] - problem.rest_turns
    energy = 0.5 * ca.dot(problem.couplings, turns**2)
    for load in problem.loads:
        x, y = here.moved(load.at)
        energy -= load.force[0] * x + load.force[1] * y + load.moment * here.phi(load.at.body)
    rows = []
    for beam, spot in problem.ends:
        x, y = here.place(spot)
        rows += [here.x[beam][-1] - x, here.y[beam][-1] - y]
    rows += [theta[link] - problem.rest[link] - here.phi(body) for link, body in problem.welds]
    for one, other in problem.pins:
        rows += [a - b for a, b in zip(here.place(one), here.place(other), strict=True)]
    for held in problem.held:
        x, y = here.moved(held.at)
        rows.append(held.along[0] * x + held.along[1] * y + held.turn * here.phi(held.at.body) - held.value)
    rows += [here.fitted(contact) for contact in problem.fitted]
    rows += [here.outside(circle) for circle in problem.circles]
    return z, energy, ca.vertcat(*rows)


class _Here:
    """Places in a state."""

    def __init__(self, problem: Discretised, theta: SX, bodies: SX) -> None:
        import casadi as ca

        self.problem, self.theta, self.bodies, self.ca = problem, theta, bodies, ca
        self.x, self.y = [], []
        for beam in problem.beams:
            links = slice(beam.first, beam.first + beam.count)
            x, y = self.place(beam.start)
            self.x.append(ca.vertcat(x, x + ca.cumsum(problem.lengths[links] * ca.cos(theta[links]))))
            self.y.append(ca.vertcat(y, y + ca.cumsum(problem.lengths[links] * ca.sin(theta[links]))))

    def phi(self, body: int) -> SX:
        return self.bodies[3 * body + 2] if body >= 0 else 0.0

    def moved(self, spot: Spot) -> tuple[SX, SX]:
        x, y = self.place(spot)
        rx, ry = (self.problem.references[spot.body] if spot.body >= 0 else (0.0, 0.0)) + np.array([spot.x, spot.y])
        return x - rx, y - ry

    def place(self, spot: Spot) -> tuple[SX, SX]:
        if spot.body < 0:
            return spot.x, spot.y
        c, s = self.ca.cos(self.phi(spot.body)), self.ca.sin(self.phi(spot.body))
        x0, y0 = self.problem.references[spot.body]
        u, v = self.bodies[3 * spot.body], self.bodies[3 * spot.body + 1]
        return x0 + u + c * spot.x - s * spot.y, y0 + v + s * spot.x + c * spot.y

    def fitted(self, contact: FittedContact) -> SX:
        ca = self.ca
        links = self.problem.beams[contact.boundary].first + contact.points
        mean = 0.5 * (self.theta[(links - 1).tolist()] + self.theta[links.tolist()])
        points, joints = contact.points.tolist(), contact.joints.tolist()
        bx = self.x[contact.boundary][points] - contact.offset * ca.sin(mean)
        by = self.y[contact.boundary][points] + contact.offset * ca.cos(mean)
        x, y = self.x[contact.beam][joints], self.y[contact.beam][joints]
        a, o, A, B = (x, y, bx, by) if contact.along_x else (y, x, by, bx)
        # a centre and a width that move as the points do: the curve is the same for any
        centre, width = 0.5 * (A[0] + A[-1]), 0.5 * (A[-1] - A[0])

        def powers(at: SX) -> SX:
            u = (at - centre) / width
            columns = [ca.SX.ones(at.shape[0])]
            for _ in range(contact.degree):
                columns.append(columns[-1] * u)
            return ca.horzcat(*columns)

        V = powers(A)
        return contact.sense * (powers(a) @ ca.solve(V.T @ V, V.T @ B) - o)

    def outside(self, circle: RoundContact) -> SX:
        joints = circle.joints.tolist()
        x, y = self.place(circle.centre)
        rx, ry = self.x[circle.beam][joints] - x, self.y[circle.beam][joints] - y
        return circle.radii - self.ca.sqrt(rx**2 + ry**2)
