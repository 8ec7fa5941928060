"""Reactions of fixed bodies, rows and loads."""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.solid.beam_loads import AreaLoad
from fea_reference.solid.beam_moments import CouplePart
from fea_reference.solid.bodies import Tie, turned
from fea_reference.solid.model import Model, SharePart
from fea_reference.solid.rows import Row
from fea_reference.solid.system import System

Wrench = tuple[Array, float]
"""A force (2,) and a moment about a stated point."""


def tie_reaction(model: Model, system: System, tie: Tie) -> Wrench:
    """Force and moment of a tie's body on the face, about the face's middle; a pinned face has no moment."""
    forces = system.nodal.reshape(-1, 2)[tie.nodes]
    if tie.psi is not None:
        return forces.sum(axis=0), 0.0
    arms = turned(tie.offsets, float(model.bodies[tie.body].state(system.z)[2]))
    return forces.sum(axis=0), float(cross(arms, forces).sum())


def place(model: Model, system: System, tie: Tie) -> Array:
    """Position of a tied face's middle (2,)."""
    return model.bodies[tie.body].carried(tie.pin, system.z)


def row_reaction(row: Row, system: System) -> Wrench:
    """Force and moment of a row on its first body, at the arm's point: the negative multiplier."""
    pull = -float(system.z[row.multiplier])
    direction = row.shares[0].direction
    return (np.zeros(2), pull) if direction is None else (pull * direction, 0.0)


def moving_share(model: Model, row: Row) -> int | None:
    """Number of a row's only share on a moving body, with the others on fixed bodies; None otherwise."""
    moving = [i for i, share in enumerate(row.shares) if model.bodies[share.body].dofs is not None]
    return moving[0] if len(moving) == 1 else None


def balance(model: Model, system: System, values: Array) -> tuple[float, float]:
    """|ΣF| and |ΣM| of loads, supports, rows and contacts with fixed bodies, relative to the largest.

    Moments are about the origin.
    """
    z = system.z
    forces: list[Array] = []
    moments: list[float] = []

    def enter(force: Array, at: Array, moment: float = 0.0) -> None:
        forces.append(force)
        moments.append(moment + float(cross(at, force)))

    for tie in model.ties:
        if model.bodies[tie.body].dofs is None:
            force, moment = tie_reaction(model, system, tie)
            enter(force, place(model, system, tie), moment)
    for row in model.rows:
        i = moving_share(model, row)
        if i is not None:
            share, pull = row.shares[i], -float(z[row.multiplier])
            body = model.bodies[share.body]
            if share.direction is None:
                moments.append(pull)
            else:
                enter(pull * share.direction, body.carried(share.arm, z))
    for part, value in zip(model.loads, values[: len(model.loads)], strict=True):
        if isinstance(part, CouplePart):
            moments.append(float(value))
        elif isinstance(part, SharePart):
            moments.append(float(value * part.moments.sum()))
        elif isinstance(part, AreaLoad):
            places = (model.mesh.places + system.q.reshape(-1, 2))[part.nodes]
            forces.append(value * part.forces.sum(axis=0))
            moments.append(float(cross(places, value * part.forces).sum()))
        elif part.direction is None:
            moments.append(float(value))
        else:
            enter(value * part.direction, model.bodies[part.body].carried(part.arm, z))
    moments += [stop.moment(z) for stop in model.stops if model.bodies[stop.body].dofs is None]
    for contact in system.touches:
        if contact.zeta.size and contact.pair.body >= 0 and model.bodies[contact.pair.body].dofs is None:
            forces.append(contact.push.sum(axis=0))
            moments.append(float(cross(contact.points, contact.push).sum()))
    largest = max([float(np.hypot(*force)) for force in forces] + [abs(moment) for moment in moments], default=0.0)
    scale = max(largest, system.floor / 1e-9)
    return float(np.hypot(*sum(forces, np.zeros(2)))) / scale, abs(sum(moments)) / scale


def cross(a: Array, b: Array) -> Array:
    """a × b for vectors (..., 2)."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
