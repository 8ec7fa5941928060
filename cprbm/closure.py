"""Loop closures, welds, slides and drives: the equalities Z(θ) = 0 of eq. (1).

==========  =======================================================================
Z_x, Z_y    beam's last joint less the point of the body it is joined to, less how far apart they are meant to be
Z_w         angle of the first or last link, less its stress-free one, less φ
Z_p         of pins between bodies, :mod:`cprbm.hinging`
Z_h         of slides and drives, :mod:`cprbm.holding`
μ           multipliers: force and moment of the beam on what its end is joined to
==========  =======================================================================

The first joint of a beam sits at its point by construction.  A first link that
is welded to the ground does not turn and is no unknown at all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.hinging import Hinge
from cprbm.holding import Hold
from cprbm.kinematics import Positions, State, arm, place, position_rows
from cprbm.model import Model
from scene.answer import Array, Ints


@dataclass(frozen=True, slots=True)
class Closure:
    """Which equalities a mechanism has, in the order of their rows: ends' x, y, welds, pins' x, y, slides, drives.

    Attributes:
        ends: index of each beam whose end is joined to a point.
        end_joints: the last joints of those beams.
        welds: (link, body) of every welded link that is an unknown; body −1 is the ground.
        fixed: links that do not turn (ground welds at a beam's start).
        hinges: pins between bodies.
        holds: slides and drives.
    """

    ends: tuple[int, ...]
    end_joints: Ints
    welds: tuple[tuple[int, int], ...]
    fixed: Ints
    hinges: tuple[Hinge, ...]
    holds: tuple[Hold, ...]

    @property
    def rows(self) -> int:
        """Number of equalities."""
        return self.first_hold + len(self.holds)

    @property
    def first_hinge(self) -> int:
        """Row of the first pin between bodies."""
        return 2 * len(self.ends) + len(self.welds)

    @property
    def first_hold(self) -> int:
        """Row of the first slide or drive."""
        return self.first_hinge + 2 * len(self.hinges)


def closure_of(
    model: Model, hinges: tuple[Hinge, ...], holds: tuple[Hold, ...], free: frozenset[str] = frozenset()
) -> Closure:
    """The equalities of a mechanism; the ends of some beams are ``free`` as yet."""
    ends, welds, fixed = [], [], []
    for c, chain in enumerate(model.chains):
        start, end = chain.start, chain.end
        if start.welded:
            if start.body < 0:
                fixed.append(chain.first_link)
            else:
                welds.append((chain.first_link, start.body))
        if end is not None and chain.name not in free:
            ends.append(c)
            if end.welded:
                welds.append((chain.first_link + chain.n, end.body))
    last = [model.chains[c].first_joint + model.chains[c].n + 1 for c in ends]
    return Closure(
        tuple(ends), np.array(last, dtype=np.intp), tuple(welds), np.array(fixed, dtype=np.intp), hinges, holds
    )


def apart_by(beam: str) -> tuple[str, str]:
    """Names of the values that say how far, along x and y, a beam's end is apart from its point, m."""
    return f"{beam}.apart.x", f"{beam}.apart.y"  # no name in a scene holds a dot


def closure_values(model: Model, closure: Closure, state: State, at: Positions, given: dict[str, float]) -> Array:
    """Z (rows,) with the ``given`` values (SI) of drives and of how far ends are apart; without one they are zero."""
    values = []
    for c, joint in zip(closure.ends, closure.end_joints, strict=True):
        end = model.chains[c].end
        assert end is not None
        px, py = place(model, end, state.bodies)
        gx, gy = (given.get(name, 0.0) / model.unit_length for name in apart_by(model.chains[c].name))
        values += [at.x[joint] - px - gx, at.y[joint] - py - gy]
    for link, body in closure.welds:
        turned = state.bodies[body, 2] if body >= 0 else 0.0
        values.append(state.theta[link] - model.rest[link] - turned)
    for hinge in closure.hinges:
        values += hinge.values(model, state)
    values += [hold.value(state, given) for hold in closure.holds]
    return np.array(values, dtype=float)


def closure_rows(model: Model, closure: Closure, state: State, at: Positions) -> Array:
    """∂Z over all unknowns, (rows, n_links + 3B)."""
    n = model.n_links
    rows = np.zeros((closure.rows, n + 3 * len(model.free_bodies)))
    rows_x, rows_y = position_rows(model, state, at, closure.end_joints)
    k = 2 * len(closure.ends)
    rows[0:k:2], rows[1:k:2] = rows_x, rows_y
    for r, c in enumerate(closure.ends):
        end = model.chains[c].end
        assert end is not None
        if end.body >= 0:
            rx, ry = arm(end, state.bodies)
            b = n + 3 * end.body
            rows[2 * r, b] -= 1.0
            rows[2 * r, b + 2] += ry
            rows[2 * r + 1, b + 1] -= 1.0
            rows[2 * r + 1, b + 2] -= rx
    for r, (link, body) in enumerate(closure.welds, start=k):
        rows[r, link] = 1.0
        if body >= 0:
            rows[r, n + 3 * body + 2] = -1.0
    for p, hinge in enumerate(closure.hinges):
        r = closure.first_hinge + 2 * p
        for body, block in hinge.rows(state):
            rows[r : r + 2, n + 3 * body : n + 3 * body + 3] += block
    for r, hold in enumerate(closure.holds, start=closure.first_hold):
        b = n + 3 * hold.at.body
        rows[r, b : b + 3] = hold.row(state)
    return rows


def closure_forces(model: Model, closure: Closure, multipliers: Array) -> tuple[Array, Array]:
    """The multipliers as generalised forces on the joints, fx and fy (n_joints,)."""
    fx, fy = np.zeros(model.n_joints), np.zeros(model.n_joints)
    k = 2 * len(closure.ends)
    fx[closure.end_joints] = multipliers[0:k:2]
    fy[closure.end_joints] = multipliers[1:k:2]
    return fx, fy


def closure_second(model: Model, closure: Closure, state: State, multipliers: Array) -> Array:
    """Second derivative over φ of each body (B,) of Σ μ·Z, the part of the bodies' own points."""
    second = np.zeros(len(model.free_bodies))
    for r, c in enumerate(closure.ends):
        end = model.chains[c].end
        assert end is not None
        if end.body >= 0:
            rx, ry = arm(end, state.bodies)
            second[end.body] += multipliers[2 * r] * rx + multipliers[2 * r + 1] * ry
    for p, hinge in enumerate(closure.hinges):
        r = closure.first_hinge + 2 * p
        for body, bent in hinge.second(state, multipliers[r : r + 2]):
            second[body] += bent
    for mu, hold in zip(multipliers[closure.first_hold :], closure.holds, strict=True):
        second[hold.at.body] += mu * hold.second(state)
    return second
