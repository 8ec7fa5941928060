"""Where the joints are, and how generalised forces come back from them to the link angles.

==========  ==================================================================
θ_i         link angles, all beams (n_links,)
u, v, φ     displacement of a free body's reference place and its rotation
x_j, y_j    joint positions, eq. (6): x_j = x_0 + Σ_{i<j} L_i cos θ_i
f_j         generalised force on joint j; F_i = Σ_{j>i} f_j of the same beam
==========  ==================================================================
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from cprbm.model import Attachment, Model
from scene.answer import Array, Ints


@dataclass(frozen=True, slots=True)
class State:
    """The unknowns: link angles ``theta`` (n_links,) and ``bodies`` (B, 3) of u, v, φ."""

    theta: Array
    bodies: Array

    def moved(self, step: Array, n_links: int) -> State:
        """The state after a ``step`` (n_links + 3B,) of all unknowns."""
        return State(self.theta + step[:n_links], self.bodies + step[n_links:].reshape(-1, 3))


def most_turned(before: State, after: State) -> float:
    """The most that a link turns by between two states, rad."""
    return float(np.max(np.abs(after.theta - before.theta)))


def rest_state(model: Model) -> State:
    """The stress-free state."""
    return State(model.rest.copy(), np.zeros((len(model.free_bodies), 3)))


def arm(attachment: Attachment, bodies: Array) -> tuple[float, float]:
    """R(φ)·r of the point a beam's end is joined to; the point itself on the ground."""
    px, py = attachment.point
    if attachment.body < 0:
        return px, py
    phi = bodies[attachment.body, 2]
    cos, sin = np.cos(phi), np.sin(phi)
    return float(cos * px - sin * py), float(sin * px + cos * py)


def place(model: Model, attachment: Attachment, bodies: Array) -> tuple[float, float]:
    """Present position of the point a beam's end is joined to."""
    rx, ry = arm(attachment, bodies)
    if attachment.body < 0:
        return rx, ry
    x, y = model.references[attachment.body] + bodies[attachment.body, :2]
    return float(x + rx), float(y + ry)


@dataclass(frozen=True, slots=True)
class Positions:
    """Joint positions x, y (n_joints,) and the links' components dx, dy (n_links,).

    ``known`` is for what others derive from them and the state once, by the first link of the beam that it is of.
    """

    x: Array
    y: Array
    dx: Array
    dy: Array
    known: dict[int, object] = field(default_factory=dict, init=False, repr=False, compare=False)


def positions(model: Model, state: State) -> Positions:
    """Eq. (6) for all beams."""
    dx = model.lengths * np.cos(state.theta)
    dy = model.lengths * np.sin(state.theta)
    x, y = np.empty(model.n_joints), np.empty(model.n_joints)
    for chain in model.chains:
        x0, y0 = place(model, chain.start, state.bodies)
        first = chain.first_joint
        x[first], y[first] = x0, y0
        np.cumsum(dx[chain.links], out=x[first + 1 : first + chain.n + 2])
        np.cumsum(dy[chain.links], out=y[first + 1 : first + chain.n + 2])
        x[first + 1 : first + chain.n + 2] += x0
        y[first + 1 : first + chain.n + 2] += y0
    for j, mark in enumerate(model.marks.values(), start=model.first_mark):
        x[j], y[j] = place(model, mark, state.bodies)
    return Positions(x, y, dx, dy)


def beyond(model: Model, forces: Array) -> tuple[Array, Array]:
    """F_i, the sum of ``forces`` (n_joints,) beyond link i, (n_links,), and each beam's total (chains,)."""
    sums, totals = np.empty(model.n_links), np.empty(len(model.chains))
    for c, chain in enumerate(model.chains):
        backwards = np.cumsum(forces[chain.joints][::-1])[::-1]
        sums[chain.links] = backwards[1:]
        totals[c] = backwards[0]
    return sums, totals


def pulled_back(model: Model, state: State, at: Positions, fx: Array, fy: Array) -> tuple[Array, Array, Array, Array]:
    """What forces on joints mean for the unknowns.

    Returns:
        gradient over θ (n_links,) and over the bodies (3B,) of Σ f_j·p_j, and its second derivatives:
        the diagonal over θ (n_links,) and over φ of each body (B,).
    """
    Fx, tx = beyond(model, fx)
    Fy, ty = beyond(model, fy)
    over_theta = at.dx * Fy - at.dy * Fx
    second = -(at.dx * Fx + at.dy * Fy)
    over_bodies = np.zeros((len(model.free_bodies), 3))
    second_bodies = np.zeros(len(model.free_bodies))
    for c, chain in enumerate(model.chains):
        start = chain.start
        if start.body >= 0:
            rx, ry = arm(start, state.bodies)
            over_bodies[start.body] += (tx[c], ty[c], rx * ty[c] - ry * tx[c])
            second_bodies[start.body] -= rx * tx[c] + ry * ty[c]
    for j, mark in enumerate(model.marks.values(), start=model.first_mark):
        rx, ry = arm(mark, state.bodies)
        over_bodies[mark.body] += (fx[j], fy[j], rx * fy[j] - ry * fx[j])
        second_bodies[mark.body] -= rx * fx[j] + ry * fy[j]
    return over_theta, over_bodies.ravel(), second, second_bodies


def position_rows(model: Model, state: State, at: Positions, joints: Ints) -> tuple[Array, Array]:
    """Derivatives of x and y of some ``joints`` (k,) over all unknowns: two arrays (k, n_links + 3B)."""
    n = model.n_links
    rows_x = np.zeros((len(joints), n + 3 * len(model.free_bodies)))
    rows_y = np.zeros_like(rows_x)
    for chain in model.chains:
        mine = np.flatnonzero((joints >= chain.first_joint) & (joints < chain.first_joint + chain.n + 2))
        if not mine.size:
            continue
        before = np.arange(chain.n + 1) < (joints[mine] - chain.first_joint)[:, None]
        rows_x[mine, chain.links] = np.where(before, -at.dy[chain.links], 0.0)
        rows_y[mine, chain.links] = np.where(before, at.dx[chain.links], 0.0)
        start = chain.start
        if start.body >= 0:
            rx, ry = arm(start, state.bodies)
            b = n + 3 * start.body
            rows_x[mine, b], rows_x[mine, b + 2] = 1.0, -ry
            rows_y[mine, b + 1], rows_y[mine, b + 2] = 1.0, rx
    for j, mark in enumerate(model.marks.values(), start=model.first_mark):
        mine = np.flatnonzero(joints == j)
        rx, ry = arm(mark, state.bodies)
        b = n + 3 * mark.body
        rows_x[mine, b], rows_x[mine, b + 2] = 1.0, -ry
        rows_y[mine, b + 1], rows_y[mine, b + 2] = 1.0, rx
    return rows_x, rows_y
