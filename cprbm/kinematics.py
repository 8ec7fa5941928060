"""Where the joints are, and how generalised forces come back from them to the link angles.

==========  ==================================================================
θ_i         link angles, all beams (n_links,)
u, v, φ     displacement of a free body's reference place and its rotation
x_j, y_j    joint positions, eq. (6): x_j = x_0 + Σ_{i<j} L_i cos θ_i
f_j         generalised force on joint j; F_i = Σ_{j>i} f_j of the same beam
==========  ==================================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cprbm.model import Layout, Model
from cprbm.once import once
from cprbm.posture import Posture, posture, stood
from cprbm.standing import Attachment
from cprbm_scene.answer import Array, Ints


@dataclass(frozen=True)
class State:
    """The unknowns: link angles ``theta`` (n_links,) and ``bodies`` (B, 3) of u, v, φ."""

    theta: Array
    bodies: Array

    def moved(self, step: Array, n_links: int) -> State:
        """The state after a ``step`` (n_links + 3B,) of all unknowns."""
        return State(self.theta + step[:n_links], self.bodies + step[n_links:].reshape(-1, 3))

    @once
    def posture(self) -> Posture:
        """How the bodies stand."""
        return posture(self.bodies)


def most_turned(before: State, after: State) -> float:
    """The most that a link turns by between two states, rad."""
    return float(np.abs(after.theta - before.theta).max())


def most_changed(before: State, after: State) -> float:
    """The most that a link or a body turns by between two states, rad: in the limit, a beam's tangent or a body."""
    bodies = np.abs(after.bodies - before.bodies)[:, 2]
    return max(most_turned(before, after), float(bodies.max(initial=0.0)))


def rest_state(model: Model) -> State:
    """The stress-free state."""
    return State(model.rest.copy(), np.zeros((model.n_bodies, 3)))


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
    known: dict[int, Any] = field(default_factory=dict, init=False, repr=False, compare=False)


def positions(model: Model, state: State) -> Positions:
    """Eq. (6) for all beams."""
    links, joints = _placed(model, state.theta, _roots(model.layout, state))
    return Positions(joints[0], joints[1], links[0], links[1])


def positions_of(model: Model, states: Sequence[State]) -> list[Positions]:
    """The same for some states at once."""
    layout = model.layout
    w = stood(np.array([state.bodies for state in states]))
    roots = (layout.places.base + w @ layout.places.over.T).reshape(len(states), 2, -1)
    links, joints = _placed(model, np.array([state.theta for state in states]), roots)
    return [Positions(*mine, *parts) for mine, parts in zip(joints, links, strict=True)]


def _roots(layout: Layout, state: State) -> Array:
    """x and y of what chains begin at, and of the marks, (2, k)."""
    places = layout.places
    # where nothing of that moves nobody asks how bodies stand
    return (places.values(state.posture) if layout.moving.size else places.base).reshape(2, -1)


def _placed(model: Model, theta: Array, roots: Array) -> tuple[Array, Array]:
    """Links' components (..., 2, n_links) and joints (..., 2, n_joints), of ``theta`` (..., n_links)."""
    layout = model.layout
    links, joints = np.empty((*roots.shape[:-1], model.n_links)), np.empty((*roots.shape[:-1], model.n_joints))
    np.cos(theta, out=links[..., 0, :])
    np.sin(theta, out=links[..., 1, :])
    links *= model.lengths
    joints[..., layout.roots] = roots
    for c, (own, behind) in enumerate(zip(layout.links, layout.behind, strict=True)):
        further = joints[..., behind]
        np.add.accumulate(links[..., own], axis=-1, out=further)
        further += roots[..., c : c + 1]
    return links, joints


def beyond(model: Model, fx: Array, fy: Array) -> Array:
    """Sums of forces ``fx``, ``fy`` (..., n_joints) from each joint to its beam's end, (2, ..., n_joints)."""
    layout, forces = model.layout, np.array((fx, fy))
    for joints in layout.joints_back:
        backwards = forces[..., joints]
        np.add.accumulate(backwards, axis=-1, out=backwards)
    return forces


def pulled_back(model: Model, state: State, at: Positions, fx: Array, fy: Array) -> tuple[Array, Array, Array, Array]:
    """What forces on joints mean for the unknowns.

    Returns:
        gradient over θ (n_links,) and over the bodies (3B,) of Σ f_j·p_j, and its second derivatives:
        the diagonal over θ (n_links,) and over φ of each body (B,).
    """
    sums = summed(model, fx, fy)
    Fx, Fy = sums[:, : model.n_links]
    over_bodies, _ = _held(model, state, sums)
    return at.dx * Fy - at.dy * Fx, over_bodies, *twice(model, state, at, sums)


def summed(model: Model, fx: Array, fy: Array) -> Array:
    """Sums of forces on all that hangs on each link, and on each start or mark on a body, (2, ..., n_links + k)."""
    return beyond(model, fx, fy)[..., model.layout.hung]


def twice(model: Model, state: State, at: Positions, sums: Array) -> tuple[Array, Array]:
    """Second derivatives of Σ f_j·p_j from :func:`summed` forces: over θ (n_links,) and over φ of each body (B,)."""
    Fx, Fy = sums[:, : model.n_links]
    return -(at.dx * Fx + at.dy * Fy), _held(model, state, sums)[1]


def over_unknowns(model: Model, state: State, at: Positions, fx: Array, fy: Array) -> Array:
    """The gradients (r, n_links + 3B) of r sums Σ f_j·p_j over all unknowns, for rows of forces (r, n_joints)."""
    return over_unknowns_by(model, state, at, *summed(model, fx, fy))


def behind(model: Model, joints: Ints) -> Array:
    """Which links, and which starts and marks on bodies, each of some ``joints`` (p,) hangs on: (p, n_links + k).

    Ones and noughts, the product of forces on the joints with which is what :func:`summed` sums.
    """
    if model.hanging is not None:
        return np.asarray(model.hanging[joints])
    alone = np.zeros((len(joints), model.n_joints))
    alone[np.arange(len(joints)), joints] = 1.0
    return np.asarray(summed(model, alone, alone)[0])


def over_unknowns_by(model: Model, state: State, at: Positions, fx: Array, fy: Array) -> Array:
    """What :func:`over_unknowns` says of forces by their sums (r, n_links + k), products with :func:`behind`."""
    n = model.n_links
    rows = np.empty((len(fx), model.n_unknowns))
    np.multiply(at.dx, fy[:, :n], out=rows[:, :n])
    rows[:, :n] -= at.dy * fx[:, :n]
    rows[:, n:], _ = _held(model, state, (fx, fy))
    return rows


def _held(model: Model, state: State, sums: Array | tuple[Array, Array]) -> tuple[Array, Array]:
    """What :func:`summed` forces mean for the bodies that beams' starts and marks are on."""
    (fx, fy), n, count = sums, model.n_links, model.n_bodies
    if not model.layout.moving.size:
        shape = fx.shape[:-1]
        return np.zeros((*shape, 3 * count)), np.zeros((*shape, count))
    return model.layout.moved.gradient(state.posture, np.concatenate((fx[..., n:], fy[..., n:]), axis=-1))
